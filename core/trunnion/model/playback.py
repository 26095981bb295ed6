"""What a playback shows: where the tool stands at any moment of a whole plan, and the stock at one of them.

A *position* counts blocks over all programs of a plan: 12.25 means that twelve blocks are done and a quarter of the thirteenth.
Everything is in the part's coordinates, so that a window draws it without knowing setups.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.tool import Tool

CHORD_ANGLE = math.radians(6.0)
"""One chord of an arc drawn as lines turns this much at most."""
_STRAIGHT = 1e-9
"""Two unit axes whose cross product is shorter than this are the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Passage:
    """The blocks of one operation: its id, setup and tool, the posted file they stand in (`S1.nc`, empty when nothing is posted)."""

    operation: str
    setup: str
    tool: Tool
    file: str = ""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Timeline:
    """All n blocks of a plan in the order they are cut.

    key: digest of what is played. passages: one for each operation; first (s + 1,): the block each begins with, and n.
    tip (n, 3) mm and axis (n, 3) unit: the tool at the end of each block. centre (n, 3) of arcs, NaN otherwise; sweep (n,) the signed
    angle an arc turns about the axis, rad. rapid (n,), mark (n,): `Mark`. line (n,): the line of the posted text, counted from 1; 0
    without one. time (n + 1,) s: when each block begins, and the end.
    """

    key: str
    passages: tuple[Passage, ...]
    first: Ints
    tip: Floats
    axis: Floats
    centre: Floats
    sweep: Floats
    rapid: Bools
    mark: Ints
    line: Ints
    time: Floats

    def __len__(self) -> int:
        return len(self.sweep)

    @property
    def seconds(self) -> float:
        """How long the whole plan takes at the machine."""
        return float(self.time[-1])

    def block(self, position: float) -> int:
        """Return the block that is on its way at a position, or has just ended there."""
        return min(max(math.ceil(position) - 1, 0), max(len(self) - 1, 0))

    def row(self, position: float) -> int:
        """Return the row of the passage that a position is in."""
        return int(np.searchsorted(self.first, self.block(position), side="right")) - 1

    def passage(self, position: float) -> Passage:
        """Return the passage that a position is in."""
        return self.passages[self.row(position)]

    def seconds_at(self, position: float) -> float:
        """Return the time at the machine when a position is reached."""
        return float(np.interp(position, np.arange(len(self) + 1), self.time))

    def position_at(self, seconds: float) -> float:
        """Return the position after a time at the machine; blocks that take no time are done at once."""
        done = int(np.searchsorted(self.time, seconds, side="right")) - 1
        if done >= len(self):
            return float(len(self))
        span = self.time[done + 1] - self.time[done]
        return max(done, 0) + (
            float((seconds - self.time[done]) / span) if span > 0.0 and done >= 0 else 0.0
        )

    def position_of(self, file: str, line: int) -> float | None:
        """Return the position at which the first block at or after a line of a posted file is done; None when no such block follows."""
        for k, passage in enumerate(self.passages):
            lines = self.line[self.first[k] : self.first[k + 1]]
            found = np.flatnonzero((lines >= line) & (passage.file == file))
            if len(found):
                return float(self.first[k] + found[0] + 1)
        return None

    def pose(self, position: float) -> tuple[Floats, Floats]:
        """Return tip (3,) and axis (3,) of the tool at a position."""
        block = self.block(position)
        tips, axes = self.poses(np.array([block]), np.array([min(max(position - block, 0.0), 1.0)]))
        return tips[0], axes[0]

    def poses(self, block: Ints, share: Floats) -> tuple[Floats, Floats]:
        """Return tips (k, 3) and axes (k, 3) of the tool when a share (k,) of blocks (k,) is done."""
        before = np.where(np.isin(block, self.first), block, block - 1)
        start, end, part = self.tip[before], self.tip[block], share[:, None]
        axis = turned_axes(self.axis[before], self.axis[block], share)
        tips = start + part * (end - start)
        arc = np.flatnonzero(self.sweep[block] != 0.0)
        if len(arc):
            about, centre = self.axis[block[arc]], self.centre[block[arc]]
            arm = start[arc] - centre
            arm -= (arm * about).sum(axis=1, keepdims=True) * about
            climb = ((end[arc] - start[arc]) * about).sum(axis=1, keepdims=True) * about
            angle = (self.sweep[block[arc]] * share[arc])[:, None]
            tips[arc] = (
                start[arc]
                - arm
                + np.cos(angle) * arm
                + np.sin(angle) * np.cross(about, arm)
                + part[arc] * climb
            )
        return tips, axis

    def run(self, passage: int) -> tuple[Floats, Floats]:
        """Return the way of the tip in a passage with its arcs opened into chords: points (k, 3) and their positions (k,)."""
        blocks = np.arange(self.first[passage], self.first[passage + 1])
        pieces = np.maximum(1, np.ceil(np.abs(self.sweep[blocks]) / CHORD_ANGLE)).astype(int)
        of, number = items_of(pieces)
        block, share = blocks[of], (number + 1) / pieces[of]
        return self.poses(block, share)[0], block + share


def turned_axes(start: Floats, end: Floats, share: Floats) -> Floats:
    """Return axes (k, 3) between unit axes (k, 3): turned at an even rate in the plane of both, by a share (k,) of the way."""
    across = np.cross(start, end)
    sine = np.linalg.norm(across, axis=1)
    turns = sine > _STRAIGHT
    if not turns.any():
        return end.copy()
    angle = np.arctan2(sine, (start * end).sum(axis=1)) * share
    about = across / np.where(turns, sine, 1.0)[:, None]
    turned = np.cos(angle)[:, None] * start + np.sin(angle)[:, None] * np.cross(about, start)
    return np.where(turns[:, None], turned, end)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Moment:
    """The stock at a position of a timeline, and the tool there.

    points (v, 3) float32 mm and triangles (t, 3) int32: the stock's surface, outward; fresh (t,): cut, no surface of the blank any more.
    tip (3,), axis (3,); operation, line as the timeline has them; removed mm3 since the beginning; time s.
    """

    position: float
    points: np.ndarray
    triangles: np.ndarray
    fresh: Bools
    tip: Floats
    axis: Floats
    operation: str
    line: int
    removed: float
    time: float
