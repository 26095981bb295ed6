"""How fast: the feed of the cutter's centre where the contour is curved, and of moves that meet more material than planned."""

from __future__ import annotations

LEAST_SHARE = 0.25
"""A centre never goes slower than this share of the feed: a cutter that nearly stands still rubs."""


def arc_feed(feed: float, radius: float, cutter_radius: float, sweep: float) -> float:
    """Return the centre's feed on an arc of its path so that the cutting edge on the contour keeps `feed`.

    The material is on the right of the path (climb milling): an anticlockwise arc runs inside a corner, where the contour's radius is
    larger by the cutter's, so the centre goes slower; a clockwise one runs round a convex corner and keeps the feed.
    """
    if sweep <= 0.0:
        return feed
    return feed * max(radius / (radius + cutter_radius), LEAST_SHARE)
