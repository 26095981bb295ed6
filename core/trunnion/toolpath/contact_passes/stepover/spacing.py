"""How far apart passes in parallel planes, upright or level, may lie over a drive's faces so that scallops stay as low as wanted.

Along the face it is the stepover of `stepovers`, square to the feed; planes are nearer to each other the more the face leans across them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of, unit
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.toolpath.contact_passes.passes import UPRIGHT
from trunnion.toolpath.contact_passes.stepover.metric import stepover_measure

FINENESS = 0.25
"""Of the nearest two passes' distance: width of the strips that distances are found for."""
MOST_STRIPS = 200_000
AIM = 0.95
"""Of the scallop height: what planes are laid for where a face bends, since moves leave their path by a chord error there."""
CLOSEST = 2.76
"""Heights: how near tips need to come at most. In a hollow whose radius is larger by e a tip goes e for each radian that its contact does;
between passes d apart e (1 - cos(d / 2 e)) stays, which is no more than 0.3623 d for any e."""
SPECK = (0.05, 0.001)
"""mm2, and share of the whole: so much of an area, whichever is less, binds no passes. One triangle whose corners' normals are off would
lay them ten times as near all over it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetSlopes:
    """Triangles of a drive's faces in the cutting frame: row (m,) of the skin's, unit normals of their middles (m, 3), areas (m,), where
    the cutter's tip is when it touches their corners (m, 3, 3), and two edges of each (m, 2, 3) with the turn of the normal along them."""

    row: Ints
    normal: Floats
    area: Floats
    tips: Floats
    edges: Floats
    turns: Floats

    def some(self, which: Bools) -> FacetSlopes:
        """Return some of the positions."""
        return FacetSlopes(**{f.name: getattr(self, f.name)[which] for f in fields(self)})

    def along(self, direction: Floats) -> tuple[Floats, Floats]:
        """Return how the normal turns and how the tip moves for each mm that the contact goes along unit tangents (m, 3), each (m, 3)."""
        a, b = self.edges[:, 0], self.edges[:, 1]
        aa, ab, bb = (a * a).sum(axis=1), (a * b).sum(axis=1), (b * b).sum(axis=1)
        wa, wb = (direction * a).sum(axis=1), (direction * b).sum(axis=1)
        size = np.maximum(aa * bb - ab * ab, np.finfo(float).tiny)
        first, second = ((bb * wa - ab * wb) / size)[:, None], ((aa * wb - ab * wa) / size)[:, None]
        moves = self.tips[:, 1:] - self.tips[:, :1]
        return first * self.turns[:, 0] + second * self.turns[:, 1], first * moves[
            :, 0
        ] + second * moves[:, 1]


def slopes_of(drive: SurfaceDrive, tool: Tool, least: float = 0.0) -> FacetSlopes:
    """Return the triangles of the faces to be finished that an upright cutter can come to from above: those that look upwards, their
    normals' part along z above `least`."""
    skin = drive.skin
    row = np.flatnonzero(skin.of(drive.faces))
    points, normals = skin.points[skin.triangles[row]], skin.normals[skin.triangles[row]]
    flat = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    size = np.linalg.norm(flat, axis=1)
    seen = (size > 0.0) & (normals[:, :, 2].min(axis=1) > least)
    row, points, normals, size = row[seen], points[seen], normals[seen], size[seen]
    contact = (points + drive.allowance * normals).reshape(-1, 3)
    tips = tip_at(
        tool, contact, normals.reshape(-1, 3), np.broadcast_to(UPRIGHT, contact.shape)
    ).reshape(-1, 3, 3)
    return FacetSlopes(
        row=row,
        normal=unit(normals.sum(axis=1)),
        area=0.5 * size,
        tips=tips,
        edges=points[:, 1:] - points[:, :1],
        turns=normals[:, 1:] - normals[:, :1],
    )


def tip_spacing(slopes: FacetSlopes, tool: Tool, height: float, across: Floats) -> Floats:
    """Return how far apart (m,) passes in planes across a unit direction (3,) may lie at each triangle, measured between tips."""
    lean = slopes.normal @ across
    # Along the face, square to the feed: what is left of the direction in the tangent plane.
    share = np.sqrt(np.maximum(1.0 - lean * lean, np.finfo(float).tiny))
    direction = (across - lean[:, None] * slopes.normal) / share[:, None]
    turn, move = slopes.along(direction)
    bend = (turn * direction).sum(axis=1, keepdims=True)
    bends = np.abs(slopes.turns).max(axis=(1, 2), initial=0.0) > tolerance.ANGLE
    passes = stepover_measure(tool, height)(
        np.zeros_like(direction), slopes.normal, direction, slopes.normal + bend * direction
    )
    stepover = np.where(bends, math.sqrt(AIM), 1.0) / passes
    # Tips are nearer to each other than contacts in a hollow, and wider apart on a hill.
    advance = (move @ across) / share
    # What is rounder than the cutter by more than the height is left to a smaller one, wherever passes lie.
    fits = advance * tool.corner_radius > -height
    found = share * np.where(fits, np.maximum(stepover * advance, CLOSEST * height), stepover)
    return _without_specks(found, slopes.area)


def _without_specks(spacing: Floats, area: Floats) -> Floats:
    """Return the spacing (m,) with that of the triangles that bind most, as many as make a speck, no less than the next one's."""
    order = np.argsort(spacing, kind="stable")
    most, share = SPECK
    rest = np.cumsum(area[order]) > min(most, share * float(area.sum()))
    if not rest.any():
        return spacing
    return np.maximum(spacing, spacing[order[np.argmax(rest)]])


def level_spacing(slopes: FacetSlopes, tool: Tool, height: float) -> Floats:
    """Return how far apart (m,) level passes may lie at each triangle, measured between tips; infinite beside an upright wall.

    The flank of the upper pass and the end of the lower one leave a step as well, of the drop between them times how much the wall leans:
    whatever is larger of the two holds, and a flat end leaves nothing else.
    """
    lean = np.maximum(slopes.normal[:, 2], 0.0)
    step = np.divide(height, lean, out=np.full(lean.shape, np.inf), where=lean > 0.0)
    return (
        step
        if tool.corner_radius <= 0.0
        else np.maximum(step, tip_spacing(slopes, tool, height, UPRIGHT))
    )


def marched(low: Floats, high: Floats, spacing: Floats, begin: float, end: float) -> Floats:
    """Return positions (p,) from `begin` to `end`, each as far from the one before as is allowed by all that lies between the two: things
    from low to high (m,) with a spacing (m,) each."""
    width = max(FINENESS * float(spacing.min()), (end - begin) / MOST_STRIPS)
    count = int((end - begin) / width) + 1
    begins, ends = (
        np.clip(((v - begin) / width).astype(np.int64), 0, count - 1) for v in (low, high)
    )
    allowed = least_over(begins, ends, spacing, count)
    at = [begin]
    while at[-1] < end:
        here, step = at[-1], math.inf
        first, ahead = int((here - begin) / width), 0.0
        while first < len(allowed) and ahead < step:
            step = min(step, float(allowed[first]))
            first += 1
            ahead = begin + first * width - here
        at.append(min(here + min(step, end - here), end))
    return np.array(at)


def least_over(first: Ints, last: Ints, values: Floats, count: int) -> Floats:
    """Return over each of `count` strips the least of the values (m,) of what lies over strips from first to last (m,); infinite over none.

    Each is put down on two runs of strips, as long as a power of two, that cover its own; runs then hand on to their halves.
    """
    power = np.frexp(last - first + 1)[1] - 1
    out = np.full(count, np.inf)
    for k in range(int(power.max(initial=0)), -1, -1):
        some = power == k
        np.minimum.at(out, first[some], values[some])
        np.minimum.at(out, last[some] - (1 << k) + 1, values[some])
        if k:
            half = 1 << (k - 1)
            out[half:] = np.minimum(out[half:], out[:-half])
    return out


def strips_over(low: Floats, high: Floats, begin: float, width: float) -> tuple[Ints, Ints]:
    """Return the strips of a width from `begin` on that things from low to high (m,) lie over, (k,), and the row (k,) of each thing."""
    first, last = (((v - begin) / width).astype(np.int64) for v in (low, high))
    row, number = items_of(last - first + 1)
    return first[row] + number, row
