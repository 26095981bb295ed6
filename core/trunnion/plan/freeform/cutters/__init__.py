"""Cutters for curved faces: where one touches, and which of the catalogue an area gets."""
