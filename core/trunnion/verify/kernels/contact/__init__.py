"""Compiled contact of tools with faces and triangles, and the search for free poses."""
