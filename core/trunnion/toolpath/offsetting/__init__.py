"""Contour-parallel passes: rings and levels, entries and leads, clearing of areas, wall contours."""
