"""Plane geometry of lines and arcs: curves, their crossings and parallels, areas with islands."""
