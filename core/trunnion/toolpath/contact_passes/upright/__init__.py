"""Passes of an upright tool: dropped on the skin, followed, linked."""
