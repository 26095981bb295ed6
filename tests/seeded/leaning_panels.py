"""Random panels of which no two pockets are alike: upright and stepped ones, walls that lean away or over, curved floors, holes, chamfers.

They are small, of one to six pockets on a grid: what is random is which kinds stand beside each other, how far walls lean, how floors are
curved, corner and foot radii, what holes go through, where the part lies and in which unit. No two pockets break into each other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from random import Random

import cadquery as cq
from OCP.StdFail import StdFail_NotDone

from seeded.parts import UNITS, Seeded, placed

CORNERS = (5.0, 6.0, 8.0, 10.0)
"""mm: radii of corners between walls, at their foot."""
FEET = (0.0, 1.0, 2.0, 3.0, 4.0)
"""mm: radii between floor and wall; no more than half the corner's."""
WALLS = (3.0, 4.0, 6.0)
"""mm: thickness of walls between pockets at the panel's top."""
HEIGHTS = (12.0, 16.0, 20.0, 25.0, 32.0)
"""mm: heights of panels."""
AWAY, OVER = (2.0, 12.0), (1.0, 6.0)
"""degrees that walls lean away from and over a floor."""
HOLES = (5.0, 6.0, 6.6, 8.0, 9.0, 10.0)
"""mm: diameters of holes."""
CHAMFERS = (0.0, 0.0, 0.0, 1.0, 1.5, 2.0)
"""mm: widths of the chamfer round the panel's top."""


@dataclass(frozen=True, slots=True)
class _Cell:
    """What a pocket is cut from, mm: sizes at the panel's top, depth, corner and foot radius."""

    length: float
    width: float
    depth: float
    corner: float
    foot: float


def leaning_panel(seed: int) -> Seeded:
    """Return the random panel of a seed."""
    draw = Random(f"leaning panel {seed}")
    columns, rows = draw.randint(1, 3), draw.randint(1, 2)
    corner, wall, height = draw.choice(CORNERS), draw.choice(WALLS), draw.choice(HEIGHTS)
    height = min(height, 4.0 * corner)
    cell = draw.uniform(44.0, 80.0), draw.uniform(40.0, 64.0)
    length, width = (
        n * (size + wall) + wall for n, size in zip((columns, rows), cell, strict=True)
    )
    plate = cq.Workplane("XY").box(length, width, height, centered=False)
    plate = plate.edges("|Z").fillet(draw.choice((3.0, 5.0, 8.0)))
    chamfer = draw.choice(CHAMFERS)
    if chamfer:
        plate = plate.faces(">Z").edges().chamfer(min(chamfer, 0.4 * wall))
    counts: dict[str, int] = {}
    for column in range(columns):
        for row in range(rows):
            depth = height - draw.uniform(2.5, min(8.0, 0.4 * height))
            foot = min(draw.choice(FEET), 0.5 * corner, 0.4 * depth)
            own = _Cell(*cell, depth, corner, foot)
            kind = draw.choice(tuple(_KINDS))
            at = wall + column * (cell[0] + wall), wall + row * (cell[1] + wall)
            plate = plate.cut(_KINDS[kind](draw, own).translate((*at, height - depth)))
            counts[kind] = counts.get(kind, 0) + 1
            if draw.random() < 0.4:
                # Beside the step of a floor that has one.
                share = 0.25 if kind == "stepped" else 0.5
                where = at[0] + share * cell[0], at[1] + 0.5 * cell[1]
                plate = plate.cut(_hole(draw, where, height))
                counts["hole"] = counts.get("hole", 0) + 1
    shape = placed(draw, plate.solids().val())
    feet = [corner, *(f for f in (own.foot,) if f)]
    return Seeded(
        f"leaning-{seed:02d}",
        shape.wrapped,
        draw.choice(UNITS),
        _truth(counts),
        smallest_radius=min(feet),
    )


def _truth(kinds: Mapping[str, int]) -> dict[str, int]:
    """Return how many features of each kind a panel with pockets of some kinds has."""
    holes = kinds.get("hole", 0)
    return {"pocket": sum(kinds.values()) - holes, "hole": holes}


def _upright(draw: Random, cell: _Cell) -> cq.Workplane:
    """Return a box from z 0 as high as the pocket is deep, its corners and foot rounded."""
    body = cq.Workplane("XY").box(cell.length, cell.width, cell.depth, centered=False)
    return _with_foot(body.edges("|Z").fillet(cell.corner), cell.foot)


def _stepped(draw: Random, cell: _Cell) -> cq.Workplane:
    """Return the same with one part of its floor higher than the other."""
    across = max(draw.uniform(0.4, 0.6) * cell.length, 2.2 * cell.corner)
    high = draw.uniform(0.3, 0.6) * cell.depth
    upper = _upright(draw, replace(cell, depth=cell.depth - high)).translate((0, 0, high))
    return upper.union(_upright(draw, replace(cell, length=across)))


def _away(draw: Random, cell: _Cell) -> cq.Workplane:
    """Return a body whose four sides lean away from its foot; in its corners are cones."""
    most = math.degrees(math.atan(0.16 * min(cell.length, cell.width) / cell.depth))
    lean = min(draw.uniform(*AWAY), most)
    grown = 2.0 * cell.depth * math.tan(math.radians(lean))
    sketch = cq.Workplane("XY").center(0.5 * cell.length, 0.5 * cell.width).sketch()
    foot = sketch.rect(cell.length - grown, cell.width - grown).vertices().fillet(cell.corner)
    return _with_foot(foot.finalize().extrude(cell.depth, taper=-lean), cell.foot)


def _over(draw: Random, cell: _Cell) -> cq.Workplane:
    """Return a body with a side that leans over its foot (at high x), one that leans away (low x), and two upright ones."""
    away, over = (cell.depth * math.tan(math.radians(draw.uniform(*lean))) for lean in (AWAY, OVER))
    profile = [(away, 0.0), (cell.length, 0.0), (cell.length - over, cell.depth), (0.0, cell.depth)]
    body = (
        cq.Workplane("XZ", origin=(0, cell.width, 0)).polyline(profile).close().extrude(cell.width)
    )
    between = cq.selectors.BoxSelector(
        (-1, -1, 0.2 * cell.depth), (cell.length + 1, cell.width + 1, 0.8 * cell.depth)
    )
    return body.edges(between).fillet(cell.corner)


def _curved(draw: Random, cell: _Cell) -> cq.Workplane:
    """Return a body of upright sides whose foot is part of a cylinder along y, lowest or highest in the middle."""
    rise = draw.uniform(0.1, 0.35) * cell.depth
    half = 0.5 * cell.length
    radius = (half**2 + rise**2) / (2.0 * rise)
    body = cq.Workplane("XY").box(cell.length, cell.width, cell.depth, centered=False)
    body = body.edges("|Z").fillet(cell.corner)
    hollow = draw.random() < 0.6
    middle = radius if hollow else rise - radius
    drum = cq.Workplane("XZ", origin=(half, cell.width, middle)).circle(radius).extrude(cell.width)
    if not hollow:
        return _with_foot(body.cut(drum), 0.0)
    above = cq.Workplane("XY").box(cell.length, cell.width, cell.depth, centered=False)
    above = above.translate((0, 0, radius))
    return _with_foot(body.intersect(drum.union(above)), cell.foot)


def _with_foot(body: cq.Workplane, radius: float) -> cq.Workplane:
    """Return a body with a fillet round its foot, as sharp as it is where the modeller makes none."""
    if radius <= 0.0:
        return body
    try:
        return body.faces("<Z").edges().fillet(radius)
    except StdFail_NotDone:
        return body


def _hole(draw: Random, at: tuple[float, float], height: float) -> cq.Workplane:
    """Return a hole right through a floor."""
    return cq.Workplane("XY").center(*at).circle(0.5 * draw.choice(HOLES)).extrude(height)


_KINDS: dict[str, Callable[[Random, _Cell], cq.Workplane]] = {
    "upright": _upright,
    "stepped": _stepped,
    "away": _away,
    "over": _over,
    "curved": _curved,
}
