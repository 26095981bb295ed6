"""Least-cost paths: over triangles, through tables, along rotary angles."""
