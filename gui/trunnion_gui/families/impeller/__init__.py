"""Impellers in the window."""
