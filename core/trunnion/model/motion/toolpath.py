"""Toolpaths as arrays, never objects a block. Everybody reads this one vocabulary of motion: posts, proof, playback, listing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, floats, ints
from trunnion.model.motion.cycle import Cycle, expanded
from trunnion.settings import added

_SAME_AXIS = 1e-9
"""Two axes that differ by less are written the same."""


ACROSS = (0.0, 1.0, 0.0)
"""The axis of a path of turning work: across the plane of its motions."""


class Motion(IntEnum):
    """How a block moves from the end of the block before it."""

    RAPID = 0
    LINE = 1
    """Straight with the tip; where the axis differs from the block before, it turns on the way at an even rate in their common plane."""
    ARC_CW = 2
    """About the axis, which keeps still, clockwise seen along it towards the tip (G2 in G17 if that is z); a helix when it climbs."""
    ARC_CCW = 3


class Mark(IntEnum):
    """What a block is for."""

    CUT = 0
    ENTRY = 1
    """Ramp, helix or plunge into material."""
    LEAD = 2
    """Tangential lead-in or lead-out."""
    LINK = 3
    """Feed move between passes that stays down."""
    RETRACT = 4
    """Moves away from and towards the work, above it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CycleBlock:
    """A drilling cycle of a path as one block: the rows `first` to `last` are the plain motions that it stands for."""

    first: int
    last: int
    cycle: Cycle


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Toolpath:
    """The motions of one operation, in the setup frame.

    position (n, 3) mm: the tip at the end of each block; block 0 is a rapid, its start is wherever the tool was.
    axis (n, 3) unit: the tool axis at the end of each block, from tip to spindle. motion (n,), mark (n,): `Motion`, `Mark`.
    centre (n, 3): centre of an arc (its position along the axis doesn't matter), NaN otherwise. An arc turns less than a full turn unless
    it ends beside its centre where it starts: then one full turn. feed (n,) mm/min, 0 for rapids. dwell (n,) s that the tool stands at the
    end of each block, None where it never does. cycles: which rows are drilling cycles; who knows none reads their motions. work_turns: the
    work turns about the setup's z and the tool stands still; its point moves in the plane y = 0 with x its distance from the work's axis,
    and the axis is +y, about which arcs go.
    """

    position: Floats
    axis: Floats
    motion: Ints
    centre: Floats
    feed: Floats
    mark: Ints
    dwell: Floats | None = added(None, written=False)
    cycles: tuple[CycleBlock, ...] = added((), written=False)
    work_turns: bool = added(False, written=False)

    def __post_init__(self) -> None:
        n = len(np.asarray(self.motion))
        object.__setattr__(self, "position", floats(self.position, (n, 3), "toolpath position"))
        object.__setattr__(self, "axis", floats(self.axis, (n, 3), "toolpath axis"))
        object.__setattr__(self, "motion", ints(self.motion, (n,), "toolpath motion"))
        object.__setattr__(
            self, "centre", floats(self.centre, (n, 3), "toolpath centre", may_be_nan=True)
        )
        object.__setattr__(self, "feed", floats(self.feed, (n,), "toolpath feed"))
        object.__setattr__(self, "mark", ints(self.mark, (n,), "toolpath mark"))
        if n and self.motion[0] != Motion.RAPID:
            raise ValueError("toolpath: its first block must be a rapid")
        arcs = self.motion >= Motion.ARC_CW
        if not np.isfinite(self.centre[arcs]).all():
            raise ValueError("toolpath: every arc needs a centre")
        turns = np.abs(self.axis[1:] - self.axis[:-1]).max(axis=1, initial=0.0) > _SAME_AXIS
        if n and (turns & arcs[1:]).any():
            raise ValueError("toolpath: an arc can't turn the tool axis; write it as lines")
        if (self.feed[self.motion != Motion.RAPID] <= 0.0).any():
            raise ValueError("toolpath: every feed move needs a feed above zero")
        self._check_dwell()
        if self.work_turns:
            self._check_turning()
        for block in self.cycles:
            self._check_cycle(block)

    def _check_dwell(self) -> None:
        if self.dwell is None:
            return
        dwell = floats(self.dwell, (len(self),), "toolpath dwell")
        if (dwell < 0.0).any():
            raise ValueError("toolpath: no dwell is below zero")
        object.__setattr__(self, "dwell", dwell if dwell.any() else None)

    def _check_turning(self) -> None:
        if (
            (self.axis != ACROSS).any()
            or self.position[:, 1].any()
            or self.centre[arcs_of(self), 1].any()
        ):
            raise ValueError("toolpath: turning goes in the plane y = 0, about the axis +y")
        if self.cycles:
            raise ValueError("toolpath: no drilling cycle while the work turns")

    def _check_cycle(self, block: CycleBlock) -> None:
        """Raise `ValueError` unless the rows of a cycle are what it expands to."""
        if not 0 < block.first <= block.last < len(self):
            raise ValueError(f"toolpath: no blocks {block.first} to {block.last} for a cycle")
        rows, axis = slice(block.first, block.last + 1), self.axis[block.last]
        top = self.position[block.last] - block.cycle.lift * axis
        plain = expanded(block.cycle, self.position[block.first - 1], top, axis)
        feeds = self.feed[rows][~plain.rapid] if len(plain) == len(self.motion[rows]) else None
        if (
            feeds is None
            or (self.motion[rows] != np.where(plain.rapid, Motion.RAPID, Motion.LINE)).any()
            or np.abs(self.position[rows] - plain.position).max() > tolerance.COINCIDENT
            or np.abs(self.axis[rows] - axis).max() > _SAME_AXIS
            or (self.dwells()[rows] != plain.dwell).any()
            or (feeds != feeds[0]).any()
        ):
            raise ValueError(
                f"toolpath: blocks {block.first} to {block.last} are not the motions of their cycle"
            )

    def __len__(self) -> int:
        return len(self.motion)

    def dwells(self) -> Floats:
        """Return how long the tool stands at the end of each block (n,), s."""
        return np.zeros(len(self)) if self.dwell is None else self.dwell

    def dwell_of(self, rows: Ints) -> Floats | None:
        """Return the dwell of blocks in pieces, `rows` (m,) the block that each is of, in order: the tool stands after the last one."""
        if self.dwell is None:
            return None
        last = np.append(np.diff(rows) != 0, True)
        return np.where(last, self.dwell[rows], 0.0)

    def starts(self) -> Floats:
        """Return where each block starts (n, 3); the first block starts where it ends."""
        return np.vstack([self.position[:1], self.position[:-1]]) if len(self) else self.position

    def sweeps(self) -> Floats:
        """Return the signed angle in radians that each arc turns (n,), anticlockwise positive, 0 for lines and rapids."""
        out = np.zeros(len(self))
        rows = np.flatnonzero(self.motion >= Motion.ARC_CW)
        if len(rows):
            a, b, axis = *self._radii(rows), self.axis[rows]
            turn = np.arctan2((np.cross(a, b) * axis).sum(axis=1), (a * b).sum(axis=1))
            sign = np.where(self.motion[rows] == Motion.ARC_CCW, 1.0, -1.0)
            turn = sign * np.mod(sign * turn, 2 * np.pi)
            closed = np.linalg.norm(a - b, axis=1) < 1e-9
            out[rows] = np.where(closed, sign * 2 * np.pi, turn)
        return out

    def lengths(self) -> Floats:
        """Return the length of each block (n,) in mm; the first block, whose start is unknown, counts 0."""
        start, sweep = self.starts(), self.sweeps()
        run = np.linalg.norm(self.position - start, axis=1)
        rows = np.flatnonzero(self.motion >= Motion.ARC_CW)
        if len(rows):
            radius = np.linalg.norm(self._radii(rows)[0], axis=1)
            climb = ((self.position[rows] - start[rows]) * self.axis[rows]).sum(axis=1)
            run[rows] = np.hypot(radius * np.abs(sweep[rows]), climb)
        return run

    def _radii(self, rows: Ints) -> tuple[Floats, Floats]:
        """Return from centre to start and to end of arcs (k, 3), across their axis."""
        axis, centre = self.axis[rows], self.centre[rows]
        start, end = self.starts()[rows] - centre, self.position[rows] - centre
        return start - (start * axis).sum(axis=1, keepdims=True) * axis, end - (end * axis).sum(
            axis=1, keepdims=True
        ) * axis

    @staticmethod
    def join(paths: list[Toolpath]) -> Toolpath:
        """Return the paths one after the other."""
        if not paths:
            return EMPTY
        if len({p.work_turns for p in paths}) > 1:
            raise ValueError("toolpath: the work turns all along a path or not at all")
        before = np.cumsum([0, *(len(p) for p in paths)]).tolist()
        return Toolpath(
            work_turns=paths[0].work_turns,
            dwell=np.concatenate([p.dwells() for p in paths]),
            cycles=tuple(
                replace(block, first=block.first + n, last=block.last + n)
                for p, n in zip(paths, before, strict=False)
                for block in p.cycles
            ),
            **{
                n: np.concatenate([getattr(p, n) for p in paths])
                for n in ("position", "axis", "motion", "centre", "feed", "mark")
            },
        )


def arcs_of(path: Toolpath) -> Ints:
    """Return the rows (k,) of a path's arcs."""
    return np.flatnonzero(path.motion >= Motion.ARC_CW)


EMPTY = Toolpath(
    position=np.zeros((0, 3)),
    axis=np.zeros((0, 3)),
    motion=np.zeros(0, int),
    centre=np.zeros((0, 3)),
    feed=np.zeros(0),
    mark=np.zeros(0, int),
)
"""No motion at all."""
