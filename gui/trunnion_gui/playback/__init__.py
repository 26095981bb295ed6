"""The playback: its clock, and what follows the tool."""
