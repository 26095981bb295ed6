"""Trunnion: from the CAD model of an aerospace part to a proven NC program."""

__version__ = "0.1.0"
