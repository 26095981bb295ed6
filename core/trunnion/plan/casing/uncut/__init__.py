"""Uncut pieces of casings: what a cutter leaves inside the outline of a boss, between bosses, and between bosses and the pocket's sides."""
