"""Centrifugal impellers: blades that stand evenly on a hub."""
