"""Casings: thin walls of revolution about one axis, with bosses and flanges."""
