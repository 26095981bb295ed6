"""Positions as whole numbers of the last written decimal: what is equal in the text is equal here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.cycle import Cycle
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.post.settings import PostSettings
from trunnion.units import MM_PER_INCH


@dataclass(frozen=True, slots=True, kw_only=True)
class TickScale:
    """How lengths in mm become written numbers: `unit` mm of one written unit, `decimals` of a length, `feed_decimals` of a feed.

    `point` is what a whole number ends with, for controls that count one without in their least increment; `sign` is "+" where all
    numbers have a sign.
    """

    sign: ClassVar[str] = ""

    unit: float
    decimals: int
    feed_decimals: int
    point: str = ""

    @classmethod
    def of(
        cls, settings: PostSettings, extra_inch: int, feed_decimals: int, point: str = ""
    ) -> TickScale:
        """Return the scale that the settings ask for."""
        inch = settings.units == "inch"
        extra = extra_inch if inch else 0
        return cls(
            unit=MM_PER_INCH if inch else 1.0,
            decimals=settings.decimals + extra,
            feed_decimals=feed_decimals + extra,
            point=point,
        )

    def ticks(self, lengths: Floats) -> Ints:
        """Return lengths in mm as whole numbers of the last decimal."""
        return np.rint(np.asarray(lengths) * (10.0**self.decimals / self.unit)).astype(np.int64)

    def text(self, ticks: int) -> str:
        """Return the number that some ticks stand for, without trailing zeros.

        >>> Scale(unit=1.0, decimals=4, feed_decimals=1).text(-125000)
        '-12.5'
        """
        whole, rest = divmod(abs(ticks), 10**self.decimals)
        sign = "-" if ticks < 0 else ""
        if not rest:
            return f"{sign}{whole}{self.point}"
        return f"{sign}{whole}.{rest:0{self.decimals}d}".rstrip("0")

    def texts(self, ticks: Ints, before: str = "") -> list[str]:
        """Return the numbers that ticks (n,) stand for as `text` writes each, with `before` in front of them.

        >>> Scale(unit=1.0, decimals=4, feed_decimals=1).texts(np.array([-125000, 0]), " X")
        [' X-12.5', ' X0']
        """
        if not self.decimals:
            return [before + self.text(v) for v in ticks.tolist()]
        form = f"{before}%{self.sign}.{self.decimals}f\n" * len(ticks)
        full = (form % tuple((ticks / 10.0**self.decimals).tolist())).split("\n")
        cut = [text.rstrip("0") for text in full[:-1]]
        return [text[:-1] + self.point if text[-1] == "." else text for text in cut]

    def feed(self, feed: float) -> str:
        """Return a feed in mm/min as it is written; never zero."""
        return self.pointed(shortened(feed / self.unit, self.feed_decimals))

    def pointed(self, text: str) -> str:
        """Return a written number, with the point that a whole one needs."""
        return text if "." in text else text + self.point


def shortened(value: float, decimals: int) -> str:
    """Return a number above zero with some decimals, without trailing zeros; never zero.

    >>> shortened(0.2, 6), shortened(1e-9, 3)
    ('0.2', '0.001')
    """
    text = f"{max(value, 10.0**-decimals):.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenCycle:
    """A drilling cycle along z of a written path: its rows `first` to `last`, and Z of its retract plane, bottom and end in ticks."""

    first: int
    last: int
    cycle: Cycle
    retract: int
    bottom: int
    end: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WrittenPath:
    """A toolpath in ticks, row by row, without the blocks that rounding makes vanish.

    point (m, 3), centre (m, 3) and motion (m,) of the blocks kept; feed (m,) mm/min; more (m, c) what else is written of each, in whole
    numbers of its own; dwell (m,) s at the end of each; cycles by the rows that are kept. A full turn ends exactly where it starts; an arc
    so short that rounding would turn it round is a line.
    """

    point: Ints
    centre: Ints
    motion: Ints
    feed: Floats
    more: Ints
    dwell: Floats
    cycles: tuple[WrittenCycle, ...] = ()

    def in_mm(self, scale: TickScale) -> Toolpath:
        """Return the path that the written numbers say, of an upright tool."""
        mm = scale.unit / 10.0**scale.decimals
        arcs = (self.motion >= Motion.ARC_CW)[:, None]
        return Toolpath(
            position=np.asarray(self.point * mm),
            axis=np.tile([0.0, 0.0, 1.0], (len(self.motion), 1)),
            motion=self.motion,
            centre=np.where(arcs, self.centre * mm, np.nan),
            feed=self.feed,
            mark=np.zeros(len(self.motion), np.int64),
        )

    def blocks(self, rows: slice) -> Iterator[tuple[list[int], list[int], int, float]]:
        """Yield end point, centre, motion and feed of each of some rows."""
        return zip(
            self.point[rows].tolist(),
            self.centre[rows].tolist(),
            self.motion[rows].tolist(),
            self.feed[rows].tolist(),
            strict=True,
        )


def upright(path: Toolpath, operation: str) -> Toolpath:
    """Return a path whose tool axis is z all along; raise `Refused` for another."""
    tilted = np.flatnonzero(path.axis[:, 2] < np.cos(tolerance.ANGLE))
    if len(tilted):
        raise Refused(
            f"operation {operation}, block {tilted[0] + 1}: a tilted tool axis; this dialect has three axes"
        )
    return path


def written(
    path: Toolpath, scale: TickScale, operation: str, more: Ints | None = None
) -> WrittenPath:
    """Return a path as it will be written, arcs across z; raise `Refused` for an arc that no control takes.

    A block is kept where its point or one of the further numbers `more` (n, c) changes.
    """
    more = np.zeros((len(path), 0), np.int64) if more is None else more
    point, motion = scale.ticks(path.position), np.array(path.motion)
    arcs = np.flatnonzero(motion >= Motion.ARC_CW)
    centre = np.zeros_like(point)
    centre[arcs] = scale.ticks(path.centre[arcs])
    _refuse_bad_arcs(path, arcs, operation)
    full = arcs[np.abs(path.sweeps()[arcs]) >= 2 * np.pi]
    for row in full:
        point[row, :2] = point[row - 1, :2]
    motion[_turned_round(path, point, centre, arcs)] = Motion.LINE
    nearly = _nearly_full(path, point, centre, motion)
    for row in nearly:
        point[row, :2] = point[row - 1, :2]
    kept = np.ones(len(motion), dtype=bool)
    if len(motion):
        kept[1:] = (
            (motion[1:] >= Motion.ARC_CW)
            | (point[1:] != point[:-1]).any(axis=1)
            | (more[1:] != more[:-1]).any(axis=1)
        )
    rows = np.flatnonzero(kept)
    return WrittenPath(
        point=point[kept],
        centre=centre[kept],
        motion=motion[kept],
        feed=path.feed[kept],
        more=more[kept],
        dwell=np.add.reduceat(path.dwells(), rows) if len(rows) else np.zeros(0),
        cycles=tuple(_written_cycles(path, scale, rows)),
    )


def _written_cycles(path: Toolpath, scale: TickScale, rows: Ints) -> Iterator[WrittenCycle]:
    """Yield the cycles of a path by their positions among the rows that are kept; without those that rounding left no motion."""
    for block in path.cycles:
        first, last = np.searchsorted(rows, [block.first, block.last + 1]).tolist()
        end, cycle = float(path.position[block.last, 2]), block.cycle
        retract = end - cycle.lift
        heights = scale.ticks(np.array([retract, retract - cycle.depth, end])).tolist()
        if heights[1] < heights[0] and first < last:
            yield WrittenCycle(
                first=first,
                last=last - 1,
                cycle=cycle,
                retract=heights[0],
                bottom=heights[1],
                end=heights[2],
            )


def _refuse_bad_arcs(path: Toolpath, arcs: Ints, operation: str) -> None:
    start, end, centre = path.starts()[arcs, :2], path.position[arcs, :2], path.centre[arcs, :2]
    apart = np.abs(np.linalg.norm(start - centre, axis=1) - np.linalg.norm(end - centre, axis=1))
    bad = np.flatnonzero(apart > tolerance.ARC_RADIUS)
    if len(bad):
        raise Refused(
            f"operation {operation}, block {arcs[bad[0]] + 1}: the arc's ends lie at radii {apart[bad[0]]:.4f} mm apart"
        )


def _written_sweeps(point: Ints, centre: Ints, motion: Ints, arcs: Ints) -> Floats:
    """Return the turn (k,) in radians, 0 to a full turn, that the written numbers say."""
    a, b = (
        (point[arcs - 1, :2] - centre[arcs, :2]).astype(float),
        (point[arcs, :2] - centre[arcs, :2]).astype(float),
    )
    turn = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
    turn = np.mod(np.where(motion[arcs] == Motion.ARC_CCW, turn, -turn), 2 * np.pi)
    same = (point[arcs - 1, :2] == point[arcs, :2]).all(axis=1)
    return np.where(same, 2 * np.pi, turn)


def _turned_round(path: Toolpath, point: Ints, centre: Ints, arcs: Ints) -> Ints:
    sweeps = _written_sweeps(point, centre, path.motion, arcs)
    return arcs[sweeps - np.abs(path.sweeps()[arcs]) > np.pi]


def _nearly_full(path: Toolpath, point: Ints, centre: Ints, motion: Ints) -> Ints:
    arcs = np.flatnonzero(motion >= Motion.ARC_CW)
    sweeps = _written_sweeps(point, centre, motion, arcs)
    return arcs[np.abs(path.sweeps()[arcs]) - sweeps > np.pi]
