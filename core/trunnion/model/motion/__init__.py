"""Motions as arrays and as programs: toolpaths, drilling cycles, their neutral text."""
