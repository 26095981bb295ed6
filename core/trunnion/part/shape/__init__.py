"""The shape of faces: sections, triangles, exact points, curvature, and what the proof touches."""
