"""Cutting frames: where a tool that comes from a direction sees the part, and the setup's own ones turned there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.setup import Setup

Direction = tuple[float, float, float]
UPRIGHT: Direction = (0.0, 0.0, 1.0)
"""The direction of a tool that comes along the setup's z."""


def is_upright(direction: Direction) -> bool:
    """Return whether a direction is the setup's z."""
    return direction[2] > np.cos(tolerance.ANGLE)


def cutting_frame(frame: Frame, direction: Direction) -> Frame:
    """Return a setup's frame as a tool from a direction (3,) in it sees it: z is that direction, the origin stays."""
    if is_upright(direction):
        return frame
    z = frame.world_direction(np.asarray(direction, dtype=np.float64))
    return Frame(frame.origin, frame.x if abs(frame.x @ z) < abs(frame.y @ z) else frame.y, z)


def cutting_setup(setup: Setup, direction: Direction, blank: Blank) -> Setup:
    """Return a setup as a tool from a direction (3,) in its frame sees it: the frame's z is that direction, its origin stays.

    The clearance is as far above blank and fixtures as the setup's own is. Upright it is the setup itself.
    """
    if is_upright(direction):
        return setup
    frame = cutting_frame(setup.frame, direction)
    above = setup.clearance - setup.top(blank)
    turned = replace(setup, frame=frame)
    return replace(turned, clearance=turned.top(blank) + above)
