"""Curved surfaces as arrays: B-splines, curvature, and what cutters are dropped on."""
