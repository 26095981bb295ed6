"""Scallops between neighbouring passes of a round cutter, and the stepover that keeps them to a height.

A pass of radius R (of the cutter, across the feed) leaves circular grooves; on a face that is curved across the feed, of radius rho, the
grooves stand on a circle instead of a line. Ra of such a profile is the mean distance from its mean line.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats

HEIGHT_PER_RA = 2.5
"""Scallop height per wanted Ra: 0.004 mm for Ra 1.6 um (quick segmentation, experiment). By geometry alone it would be
9 sqrt 3 / 4 = 3.9 (parabolic grooves); the rest is for the machine, the cutter's wear and the feed marks."""


def height_of(ra: float) -> float:
    """Return the scallop height in mm that a wanted Ra requires in um."""
    return HEIGHT_PER_RA * ra / 1000.0


def stepover_on_plane(radius: float, height: float) -> float:
    """Return the stepover (mm) of passes of a radius on a plane that leaves scallops of a height: 2 sqrt(2 R h - h^2)."""
    return 2.0 * math.sqrt(max(2.0 * radius * height - height * height, 0.0))


def level_step(corner: float, height: float, up: Floats, most: float) -> Floats:
    """Return how far apart (k,) in mm level passes of a corner radius may lie on planes, normals `up` by a part (k,): scallops of
    a round corner, and steps that the flank of the upper pass and the end of the lower one leave, whichever is more; at most `most`."""
    up = np.clip(up, 0.0, 1.0)
    steps = np.divide(height, up, out=np.full(up.shape, np.inf), where=up > 0.0)
    round_ = stepover_on_plane(corner, height) * np.sqrt(1.0 - up * up)
    return np.asarray(np.minimum(np.maximum(steps, round_), most))
