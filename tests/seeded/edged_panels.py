"""Random blocks that are cut from above and on their edges: pockets, slots that run out at both ends, and blind holes there.

What opens at an edge stays under the pockets on top and off the neighbouring edges; a pocket is at most four corner radii deep there.
"""

from __future__ import annotations

from random import Random

import cadquery as cq

from seeded.parts import UNITS, Seeded, placed

CORNERS = (4.0, 5.0, 6.0, 8.0)
"""mm: radii of upright corners, as the setup that cuts them sees these."""
HOLES = (5.0, 6.0, 8.0, 10.0)
"""mm: diameters that drills have."""
WALL = 5.0
"""mm that stays between two features at least."""
DEEPEST = 4.0
"""Corner radii that a pocket at an edge is deep at most."""


def edged_panel(seed: int) -> Seeded:
    """Return the random block of a seed."""
    draw = Random(f"edged {seed}")
    size = draw.uniform(90.0, 180.0), draw.uniform(80.0, 130.0), draw.uniform(36.0, 60.0)
    corner, deep = draw.choice(CORNERS), draw.uniform(0.2, 0.35) * size[2]
    block = cq.Workplane().box(*size, centered=False)
    block = block.cut(_top(draw, size, corner, deep))
    counts = {"pocket": 1, "open_pocket": 0, "hole": 0}
    turns = [t for t in (0, 1, 2, 3) if draw.random() < 0.6] or [draw.randrange(4)]
    for turn in turns:
        kind = draw.choice(("pocket", "pocket", "open_pocket", "hole"))
        along, across = (size[0], size[1]) if turn % 2 == 0 else (size[1], size[0])
        tool = _at_edge(draw, kind, along, 0.2 * across, size[2] - deep, corner)
        block = block.cut(_placed_at(tool, turn, size))
        counts[kind] += 1
    shape = placed(draw, block.solids().val())
    return Seeded(
        f"edged-{seed:02d}", shape.wrapped, draw.choice(UNITS), counts, smallest_radius=corner
    )


def _top(
    draw: Random, size: tuple[float, float, float], corner: float, deep: float
) -> cq.Workplane:
    """Return the pocket on top: larger than any at an edge, so that it says where up is."""
    length, width = (draw.uniform(0.6, 0.8) * s for s in size[:2])
    box = cq.Workplane().box(length, width, deep + 1.0, centered=(True, True, False))
    return (
        box.edges("|Z")
        .fillet(max(corner, 6.0))
        .translate((0.5 * size[0], 0.5 * size[1], size[2] - deep))
    )


def _at_edge(
    draw: Random, kind: str, along: float, most: float, height: float, corner: float
) -> cq.Workplane:
    """Return what is cut out at the front edge of a block, y into it: x from 0 to `along`, at most `most` deep, under a height."""
    deep = min(draw.uniform(0.5, 1.0) * most, DEEPEST * corner)
    tall = min(draw.uniform(2.5, 4.0) * corner, height - 2.0 * WALL)
    z = 0.5 * height
    if kind == "hole":
        x = draw.uniform(0.3, 0.7) * along
        hole = cq.Workplane("XZ").circle(0.5 * draw.choice(HOLES)).extrude(-deep)
        return hole.translate((x, 0.0, z))
    if kind == "open_pocket":
        slot = cq.Workplane().box(along + 2.0, deep + 1.0, tall, centered=(False, False, True))
        return slot.translate((-1.0, -1.0, z))
    wide = draw.uniform(0.3, 0.45) * along
    box = cq.Workplane().box(wide, deep + 1.0, tall, centered=(True, False, True))
    rounded = box.edges("|Y").fillet(min(corner, 0.4 * tall))
    return rounded.translate((0.5 * along, -1.0, z))


def _placed_at(tool: cq.Workplane, turn: int, size: tuple[float, float, float]) -> cq.Workplane:
    """Return a tool of the front edge at another one, so many right angles further round."""
    corners = ((0.0, 0.0), (size[0], 0.0), (size[0], size[1]), (0.0, size[1]))
    x, y = corners[turn]
    return tool.rotate((0, 0, 0), (0, 0, 1), 90.0 * turn).translate((x, y, 0.0))
