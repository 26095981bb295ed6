"""Random panels with vertical walls: a plate with pockets of one or two levels on a grid, some open at the side, islands, low ribs."""

from __future__ import annotations

from random import Random
from typing import Any

import cadquery as cq

CORNERS = (5.0, 6.0, 8.0, 10.0)
"""mm: radii of upright corners; a shop's end mills finish them all."""
FILLETS = (0.0, 0.0, 2.0, 3.0)
"""mm: radii between floor and wall; none for half of the panels."""


def panel_shape(seed: int) -> Any:
    """Return the solid of a panel (OCP shape, mm, bottom at z 0, open upward) of 1 to 6 pockets."""
    draw = Random(f"panel {seed}")
    columns, rows = draw.randint(1, 3), draw.randint(1, 2)
    height, corner, fillet = (
        draw.choice((16.0, 20.0, 25.0, 32.0)),
        draw.choice(CORNERS),
        draw.choice(FILLETS),
    )
    wall, cell = draw.choice((3.0, 4.0, 6.0)), (draw.uniform(45.0, 70.0), draw.uniform(45.0, 70.0))
    length, width = columns * (cell[0] + wall) + wall, rows * (cell[1] + wall) + wall
    plate = (
        cq.Workplane("XY")
        .box(length, width, height, centered=False)
        .edges("|Z")
        .fillet(draw.choice((4.0, 8.0)))
    )
    for column in range(columns):
        for row in range(rows):
            low = wall + column * (cell[0] + wall), wall + row * (cell[1] + wall)
            opens = draw.random() < 0.2 and column == columns - 1
            plate = plate.cut(_pocket(draw, low, cell, height, corner, fillet, opens, wall))
    return plate.val().wrapped


def _pocket(
    draw: Random,
    low: tuple[float, float],
    size: tuple[float, float],
    height: float,
    corner: float,
    fillet: float,
    opens: bool,
    wall: float,
) -> cq.Workplane:
    """Return what is cut out of a cell: a rounded box, longer than its cell where it opens to the side, without its island."""
    floor = draw.choice((3.0, 4.0, 6.0))
    length = size[0] + (wall + corner if opens else 0.0)
    body = cq.Workplane("XY").box(length, size[1], height - floor + 1.0, centered=False)
    body = body.edges("|Z and <X" if opens else "|Z").fillet(corner)
    if fillet > 0.0:
        body = body.faces("<Z").edges("not >X" if opens else None).fillet(fillet)
    if not opens and draw.random() < 0.3:
        middle = size[0] / 2.0, size[1] / 2.0
        island = (
            cq.Workplane("XY")
            .center(*middle)
            .circle(draw.uniform(5.0, 8.0))
            .extrude(draw.uniform(0.4, 0.8) * (height - floor))
        )
        body = body.cut(island)
    return body.translate((*low, floor))
