"""Finishing of curved faces: areas, their parts, and the rest that earlier cutters left."""
