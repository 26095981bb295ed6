"""Sinumerik 840D: its text, its cycles, and the ways in which it holds the tool's direction."""
