"""Faces and edges: identity, neighbours, trims, extents, and the attributed face graph."""
