"""Slices of a panel: spaces, the tree of those that overlap, and what they confirm."""
