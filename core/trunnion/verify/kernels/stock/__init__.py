"""Compiled stock: material removal, engagement, and the mesh of what remains."""
