"""Roughing of curved parts: heights, layers, hollows, and the directions to come from."""
