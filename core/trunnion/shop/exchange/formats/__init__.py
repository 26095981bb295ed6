"""Formats of tool libraries: a module for each program, independent of the others."""
