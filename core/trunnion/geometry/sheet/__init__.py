"""Sheets: joined triangles of a part's skin, and fields, level lines and ridges over them."""
