"""Where tabs stand along an outline, and what of the blank they hold the part to.

A tab stands on a straight piece of the outline, as far from its ends as the lifted cutter leaves material there, so in no corner. Behind it
the part is solid as deep as the tab is wide, at the heights of the tab, so no hole and no thin web is there; its wall stands three times as
tall as the tab, so no open pocket is there. In front of it are the channel around the part and the frame of the blank. Of all such
positions those are taken that are spread most evenly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.tabs import Tab
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings

STEP = 1.0
"""mm between positions along the outline that are tried, and between the points that are looked at behind them."""
AHEAD = 3.0
"""mm between the points that are looked at in front of them: the channel and the frame are wider."""
SAME = 6
"""Decimals of a distance in mm to which two ways to spread tabs are equally good; the one that begins first is taken."""
TALL = 3.0
"""Heights of a tab that the wall over it stands at least, where the part is so tall: over a lower one a floor no thicker than the tab
bends."""
WALL = 1.0
"""mm behind the wall that are looked at over a tab: thin walls hold as long as they stand."""


@settings("profile.tabs")
class TabSettings:
    """Tabs that hold a panel in the frame of its blank while its outline is cut."""

    count: int = setting(
        0,
        unit="",
        low=0,
        high=200,
        label="Number of tabs",
        help="Of panels alone: how many tabs hold the part in the frame of its blank when its outline is cut, spread evenly over "
        "straight, sturdy pieces of it; they are cut off by hand afterwards. 0: none, or as the distance says. They need "
        "a blank that is wider than the part and the channel around it (blank.side).",
    )
    distance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Distance of tabs",
        help="Largest distance of tabs along the outline: as many as that needs, no fewer than their number says. 0: that number.",
    )
    width: float = setting(
        8.0,
        unit="mm",
        low=0.5,
        high=200.0,
        label="Width of tabs",
        help="Width of a tab along the outline where it is narrowest; round cutters leave it wider at the part. 8 mm is shop practice, no "
        "standard's figure.",
    )
    height: float = setting(
        1.5,
        unit="mm",
        low=0.1,
        high=100.0,
        label="Height of tabs",
        help="How thick a tab is, from the part's bottom up. 1.5 mm is shop practice, no standard's figure.",
    )
    ramp_angle: float = setting(
        20.0,
        unit="deg",
        low=1.0,
        high=60.0,
        label="Ramps at tabs",
        help="Slope at which cutters rise over a tab and come down behind it, down no faster than they plunge.",
    )
    frame: float = setting(
        5.0,
        unit="mm",
        low=0.5,
        high=500.0,
        label="Frame at tabs",
        help="Least width of the blank's frame that a tab ends in, beyond the channel around the part.",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class TabForm:
    """What tabs of an outline have in common: width, height and slope of the ramps (radians) of each, the channel that they bridge, the
    frame they end in, and the radius of the largest cutter that is lifted over them; mm. `bottom` is the height they stand on, `top` that
    of the part."""

    width: float
    height: float
    ramp: float
    channel: float
    frame: float
    radius: float
    bottom: float
    top: float

    def at(self, middle: Floats, outwards: Floats) -> Tab:
        """Return the tab at a position (2,) of the outline, in a direction (2,)."""
        return Tab(
            middle=(float(middle[0]), float(middle[1])),
            direction=math.atan2(outwards[1], outwards[0]),
            width=self.width,
            reach=self.channel,
            bottom=self.bottom,
            top=self.bottom + self.height,
            ramp=self.ramp,
        )

    @property
    def half_length(self) -> float:
        """How far from a tab's middle the outline has to be straight, mm."""
        return self.at(np.zeros(2), np.array([1.0, 0.0])).half_length(self.radius, self.bottom)


def spread_tabs(
    outline: Curve,
    around: Region,
    blank: Region,
    section: Callable[[float], Region],
    form: TabForm,
    count: int,
    progress: Progress = NO_PROGRESS,
) -> tuple[Tab, ...]:
    """Return at most `count` tabs along a closed outline, in its direction, as evenly as they can be spread.

    `around` is the plan area of all outlines, `blank` that of the blank, `section` returns the part's at a height. No two are closer than
    a tab's width, with what a cutter leaves of them at the wall. Fewer, or none, where no more positions are good.
    """
    positions, middles, outwards = _straight(outline, form)
    good = _held(middles, outwards, around, blank, section, form, progress)
    positions, middles, outwards = positions[good], middles[good], outwards[good]
    apart = 2.0 * form.half_length + form.width
    rows = _spread(positions, middles, outline.length, apart, count, progress)
    return tuple(form.at(middles[k], outwards[k]) for k in rows)


def frame_behind(tabs: Sequence[Tab], outline: Region, blank: Region) -> Region:
    """Return the plan area of the blank that tabs hold a part to: what is left of it around the channel, the pieces that a tab ends in.

    Pieces that no tab ends in are none of it: nothing would hold them, so they are cut to chips.
    """
    if not tabs:
        return EMPTY_REGION
    outside = _outside_channel(outline, blank, max(t.reach for t in tabs))
    ends = np.concatenate([t.world(np.array([[0.0, t.reach + 2.0 * tolerance.SEW]])) for t in tabs])
    held = [piece for piece in outside.split() if piece.contains(ends).any()]
    return Region(tuple(p for piece in held for p in piece.pieces))


def _outside_channel(outline: Region, blank: Region, channel: float) -> Region:
    """Return the plan area of a blank outside of the channel around a part, the pieces alone that go out to the blank's rim: what is
    enclosed in a bay of the outline is held by nothing."""
    inner = blank.offset(-tolerance.SEW)
    outside = blank.minus(outline.offset(channel)).split()
    return Region(tuple(p for piece in outside if piece.minus(inner) for p in piece.pieces))


def _straight(outline: Curve, form: TabForm) -> tuple[Floats, Floats, Floats]:
    """Return positions (k,) along an outline that are in the middle of pieces straight enough, the points (k, 2) there, and the directions
    (k, 2) off the part."""
    half = form.half_length
    anticlockwise = outline if outline.area > 0.0 else outline.reversed()
    found = []
    for first, length in _lines(anticlockwise):
        if length >= 2.0 * half:
            number = int((length - 2.0 * half) / STEP) + 1
            found.append(first + np.linspace(half, length - half, number))
    positions = np.concatenate(found) if found else np.empty(0)
    positions = positions % outline.length
    ends = [anticlockwise.at(float(s)) for s in positions]
    middles = np.array([p for p, _ in ends]).reshape(-1, 2)
    tangent = np.array([t for _, t in ends]).reshape(-1, 2)
    # The part is on the left of an anticlockwise outline.
    return positions, middles, np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)


def _lines(outline: Curve) -> list[tuple[float, float]]:
    """Return where the straight pieces of a closed outline begin, and how long they are: lines that go on in one direction are one."""
    seg = outline.segments()
    rows = np.arange(len(seg))
    direction = seg.directions(rows, np.zeros(len(seg)))
    line = seg.sweep == 0.0
    angle = np.abs(
        np.arctan2(
            direction[:, 0] * np.roll(direction, 1, 0)[:, 1]
            - direction[:, 1] * np.roll(direction, 1, 0)[:, 0],
            (direction * np.roll(direction, 1, 0)).sum(axis=1),
        )
    )
    goes_on = line & np.roll(line, 1) & (angle < tolerance.ANGLE)
    starts = np.cumsum(seg.length) - seg.length
    pieces: list[tuple[float, float]] = []
    # From a vertex where a piece begins, once round.
    first = int(np.argmin(goes_on))
    for k in np.roll(rows, -first):
        if goes_on[k] and pieces:
            pieces[-1] = (pieces[-1][0], pieces[-1][1] + float(seg.length[k]))
        elif line[k]:
            pieces.append((float(starts[k]), float(seg.length[k])))
    return pieces


def _held(
    middles: Floats,
    outwards: Floats,
    around: Region,
    blank: Region,
    section: Callable[[float], Region],
    form: TabForm,
    progress: Progress,
) -> Bools:
    """Return which positions (k, 2) have sturdy material behind them, and the channel and the frame in front."""
    if not len(middles):
        return np.zeros(0, bool)
    tab = form.at(np.zeros(2), np.array([1.0, 0.0]))
    half, off = form.half_length, tolerance.OFF_PLANE
    good = np.ones(len(middles), bool)

    def keep(
        area: Region, first: float, last: float, inside: float = 0.0, step: float = STEP
    ) -> None:
        """Keep the positions where all points between two distances outwards are at least so far inside an area."""
        rows = np.flatnonzero(good)
        progress.check()
        if not len(rows):
            return
        across = np.linspace(-half, half, math.ceil(2.0 * half / step) + 1)
        deep = np.linspace(first, last, math.ceil(abs(last - first) / step) + 1)
        u, v = (a.ravel() for a in np.meshgrid(across, deep, indexing="ij"))
        tangent = np.stack([-outwards[rows, 1], outwards[rows, 0]], axis=1)
        points = (
            middles[rows, None] + u[:, None] * tangent[:, None] + v[:, None] * outwards[rows, None]
        )
        depth = area.signed_distance(points.reshape(-1, 2)).reshape(len(rows), -1)
        good[rows] = (depth >= inside).all(axis=1)

    beyond = form.channel + form.frame
    frame = _outside_channel(around, blank, form.channel)
    keep(blank.minus(around), off, form.channel, step=AHEAD)
    keep(frame, form.channel, beyond, -tolerance.SEW, AHEAD)
    highest = max(form.top - off, tab.bottom + off)
    for z in np.unique(
        np.minimum([tab.bottom + off, tab.bottom + 0.5 * tab.height, tab.top], highest)
    ):
        keep(section(float(z)), -off, -form.width)
    for z in np.unique(np.minimum([tab.bottom + n * tab.height for n in (2.0, TALL)], highest)):
        keep(section(float(z)), -off, -WALL)
    return good


def _spread(
    positions: Floats,
    middles: Floats,
    length: float,
    apart: float,
    count: int,
    progress: Progress,
) -> list[int]:
    """Return the rows of positions (k,) along a closed outline that are spread most evenly, none closer than `apart` mm in plan or along
    it: for each first one the good positions that lie next to even distances, and of all these the ones that lie next at the worst.

    Where so many don't go, the largest number below that does.
    """
    order = np.argsort(positions, kind="stable")
    # Once more before and behind, so that the nearest one is found across the curve's start.
    known = np.concatenate([positions[order] + turn * length for turn in (-1.0, 0.0, 1.0)])
    for number in range(min(count, len(positions), int(length / apart)), 0, -1):
        progress.check()
        wanted = (positions[order][:, None] + np.arange(number) * length / number) % length
        after = np.clip(np.searchsorted(known, wanted), 1, len(known) - 1)
        before = after - 1
        nearest = np.where(wanted - known[before] <= known[after] - wanted, before, after)
        worst = np.abs(known[nearest] - wanted).max(axis=1)
        found = nearest % len(positions)
        gaps = (np.roll(positions[order][found], -1, axis=1) - positions[order][found]) % length
        if number > 1:
            worst[gaps.min(axis=1) < apart] = np.inf
        for row in np.argsort(worst.round(SAME), kind="stable"):
            if worst[row] == np.inf:
                break
            rows = order[np.sort(found[row])]
            if _are_apart(middles[rows], apart):
                return [int(k) for k in rows]
    return []


def _are_apart(points: Floats, apart: float) -> bool:
    """Return whether no two of some points (k, 2) are closer than `apart` mm."""
    rows, others = np.triu_indices(len(points), 1)
    return bool((np.hypot(*(points[rows] - points[others]).T) >= apart).all())
