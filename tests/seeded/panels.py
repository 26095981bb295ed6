"""Random panels with vertical walls, from easy to nasty: one to twelve pockets on a grid, closed, open, stepped, with islands and ribs.

What is random is what a shop's drawings differ in: sizes, depths, wall thickness, corner and foot radii, heights of ribs, sides that are
open, where the part lies and in which unit. A pocket is at most twelve corner radii deep, as a designer who knows end mills draws it.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

import cadquery as cq

from seeded.parts import UNITS, Seeded, placed

CORNERS = (3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.5)
"""mm: radii of upright corners."""
FOOT_SHARES = (0.0, 0.0, 0.25, 0.4, 0.5)
"""Radii between floor and wall, as shares of the corner's."""
WALLS = (2.0, 2.5, 3.0, 4.0, 6.0)
"""mm: thickness of walls between pockets."""
DEEPEST = 12.0
"""Corner radii that a pocket is deep at most."""
STEP_CORNERS = 2.2
"""Corner radii that the lower step of a pocket is wide at least: two of them have to fit side by side."""


@dataclass(frozen=True, slots=True)
class _Plan:
    """What all pockets of a panel share, mm."""

    columns: int
    rows: int
    cell: tuple[float, float]
    wall: float
    height: float
    corner: float
    foot: float

    @property
    def outline(self) -> tuple[float, float]:
        return (
            self.columns * (self.cell[0] + self.wall) + self.wall,
            self.rows * (self.cell[1] + self.wall) + self.wall,
        )


def panel(seed: int) -> Seeded:
    """Return the random panel of a seed."""
    draw = Random(f"panel {seed}")
    plan = _plan(draw)
    length, width = plan.outline
    plate = cq.Workplane("XY").box(length, width, plan.height, centered=False)
    plate = plate.edges("|Z").fillet(min(draw.choice((3.0, 5.0, 8.0)), plan.wall + plan.corner))
    counts = {"pocket": 0, "open_pocket": 0, "island": 0, "rib": 0}
    for column in range(plan.columns):
        for row in range(plan.rows):
            plate = plate.cut(_cell(draw, plan, column, row, counts))
    if plan.columns > 1 and draw.random() < 0.4:
        plate = plate.cut(_lowered_rib(draw, plan))
        counts["rib"] += 1
    radii = [plan.corner] + ([plan.foot] if plan.foot else [])
    shape = placed(draw, plate.solids().val())
    return Seeded(
        f"panel-{seed:02d}", shape.wrapped, draw.choice(UNITS), counts, smallest_radius=min(radii)
    )


def _plan(draw: Random) -> _Plan:
    corner = draw.choice(CORNERS)
    low = max(26.0, 4.5 * corner)
    return _Plan(
        columns=draw.randint(1, 4),
        rows=draw.randint(1, 3),
        cell=(draw.uniform(low, 2.4 * low), draw.uniform(low, 2.0 * low)),
        wall=draw.choice(WALLS),
        height=min(draw.choice((12.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0)), DEEPEST * corner),
        corner=corner,
        foot=corner * draw.choice(FOOT_SHARES),
    )


def _cell(draw: Random, plan: _Plan, column: int, row: int, counts: dict[str, int]) -> cq.Workplane:
    """Return what is cut out of one cell of the grid, counting what it is."""
    floor = draw.uniform(2.0, min(8.0, 0.4 * plan.height))
    depth = plan.height - floor
    opens = column == plan.columns - 1 and draw.random() < 0.2
    body = _rounded(plan, (*plan.cell, depth), opens)
    if opens:
        counts["open_pocket"] += 1
    else:
        counts["pocket"] += 1
        kind = draw.random()
        room = min(plan.cell) - 2.0 * plan.corner
        if kind < 0.2 and room > 30.0:
            body = body.cut(_island(draw, plan, depth))
            counts["island"] += 1
        elif kind < 0.4 and depth > 10.0:
            across = max(0.4 * plan.cell[0], STEP_CORNERS * plan.corner)
            step = _rounded(plan, (across, plan.cell[1], depth), False)
            high = draw.uniform(0.3, 0.6) * depth
            body = (
                _rounded(plan, (*plan.cell, depth - high), False)
                .translate((0, 0, high))
                .union(step)
            )
    x = plan.wall + column * (plan.cell[0] + plan.wall)
    y = plan.wall + row * (plan.cell[1] + plan.wall)
    return body.translate((x, y, floor))


def _rounded(plan: _Plan, size: tuple[float, float, float], opens: bool) -> cq.Workplane:
    """Return a box from z 0 up past the panel's top, its corners and foot rounded; longer where it opens to the side."""
    length = size[0] + (plan.wall + plan.corner if opens else 0.0)
    body = cq.Workplane("XY").box(length, size[1], size[2] + 1.0, centered=False)
    body = body.edges("|Z and <X" if opens else "|Z").fillet(plan.corner)
    if plan.foot > 0.0:
        body = body.faces("<Z").edges("not >X" if opens else None).fillet(plan.foot)
    return body


def _island(draw: Random, plan: _Plan, depth: float) -> cq.Workplane:
    """Return an island in the middle of a cell, round or a rounded block, lower than the panel."""
    middle, tall = (0.5 * plan.cell[0], 0.5 * plan.cell[1]), draw.uniform(0.4, 0.85) * depth
    sheet = cq.Workplane("XY").center(*middle)
    if draw.random() < 0.6:
        return sheet.circle(draw.uniform(4.0, 7.0)).extrude(tall)
    return (
        sheet.rect(draw.uniform(8.0, 13.0), draw.uniform(8.0, 13.0))
        .extrude(tall)
        .edges("|Z")
        .fillet(2.5)
    )


def _lowered_rib(draw: Random, plan: _Plan) -> cq.Workplane:
    """Return what lowers the wall between the first two columns, in its middle row, below the panel's top.

    It takes the fillets of higher steps beside the wall along: no drawing leaves lips of them that run out to nothing.
    """
    deep = draw.uniform(0.15, 0.45) * plan.height
    row = plan.rows // 2
    y = plan.wall + row * (plan.cell[1] + plan.wall) + plan.corner
    beside = plan.foot + 0.01
    size = plan.wall + 2.0 * beside, plan.cell[1] - 2.0 * plan.corner, deep + 1.0
    box = cq.Workplane("XY").box(*size, centered=False)
    return box.translate((plan.wall + plan.cell[0] - beside, y, plan.height - deep))
