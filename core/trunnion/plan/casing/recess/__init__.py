"""Recesses sunk into the bottoms of casings."""
