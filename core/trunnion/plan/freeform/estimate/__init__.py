"""Scallop heights, area rates and finishing times, by the arithmetic of the surface paper."""
