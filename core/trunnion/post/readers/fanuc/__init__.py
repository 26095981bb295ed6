"""Fanuc 30i/31i: decimal points, its cycles, and the ways in which it holds the tool's direction."""
