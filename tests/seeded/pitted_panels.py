"""Random blocks with a pocket whose walls have pits in them: recesses under material, which a T-slot cutter may get into, or not."""

from __future__ import annotations

from random import Random
from typing import Any

import cadquery as cq

from seeded.parts import UNITS, Seeded, placed

RIM, FLOOR = 4.0, 1.0
"""mm of material over a pit, and from the pocket's floor up to one, at least."""
DEPTHS = (1.0, 5.0)
"""mm that pits go into their wall; the wall is twice as thick."""


def pitted_panel(seed: int) -> Seeded:
    """Return the random block of a seed."""
    draw = Random(f"pitted {seed}")
    pocket = draw.uniform(70.0, 140.0), draw.uniform(50.0, 90.0)
    deep, wall, under = draw.uniform(14.0, 32.0), 2.0 * DEPTHS[1], draw.uniform(4.0, 8.0)
    corner = draw.choice((6.0, 8.0, 10.0))
    size = pocket[0] + 2.0 * wall, pocket[1] + 2.0 * wall, deep + under
    block = cq.Workplane().box(*size, centered=(True, True, False))
    hollow = cq.Workplane(origin=(0, 0, under)).box(
        *pocket, deep + 1.0, centered=(True, True, False)
    )
    block = block.cut(hollow.edges("|Z").fillet(corner))
    turns = [t for t in range(4) if draw.random() < 0.5] or [draw.randrange(4)]
    for turn in turns:
        along, across = pocket if turn % 2 == 0 else pocket[::-1]
        block = block.cut(_pit(draw, along - 2.0 * corner, across, deep, under, turn))
    shape = placed(draw, block.solids().val())
    counts = {"pocket": 1, "pit": len(turns)}
    return Seeded(f"pitted-{seed:02d}", shape.wrapped, draw.choice(UNITS), counts, corner)


def _pit(draw: Random, straight: float, across: float, deep: float, under: float, turn: int) -> Any:
    """Return what a pit takes out of the wall that is so many right angles round from the front; `straight` mm of it are straight."""
    depth = draw.uniform(*DEPTHS)
    length = draw.uniform(0.4, 0.9) * straight
    room = deep - RIM - FLOOR
    height = draw.uniform(0.4, 1.0) * room
    low = under + FLOOR + draw.uniform(0.0, room - height)
    wide = depth + 0.25 * across
    box = cq.Workplane(origin=(0.0, -0.5 * across - depth, low)).box(
        length, wide, height, centered=(True, False, False)
    )
    ends = draw.choice((0.0, 2.0, 4.0, 8.0))
    rounded = box.edges("|Z").fillet(min(ends, 0.4 * length, 0.4 * wide)) if ends else box
    shift = draw.uniform(-0.5, 0.5) * (straight - length)
    return rounded.translate((shift, 0.0, 0.0)).rotate((0, 0, 0), (0, 0, 1), 90.0 * turn)
