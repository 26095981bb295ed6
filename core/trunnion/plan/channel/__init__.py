"""Channels between blades that stand on a hub: their coordinates, and what drives strategies in them."""
