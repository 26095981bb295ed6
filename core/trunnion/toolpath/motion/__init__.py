"""Motions: collecting blocks, links, reorientation, feeds, easing by engagement, machine time."""
