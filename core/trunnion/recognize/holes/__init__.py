"""Holes of any part, from its face graph alone: runs of coaxial hollow faces that open to the outside, with their patterns."""
