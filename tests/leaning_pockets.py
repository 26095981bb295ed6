"""Small blocks with pockets whose walls lean or whose floors are curved, built by cadquery for tests."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import cadquery as cq

BLOCK = (100.0, 80.0, 26.0)
"""Sizes of the blocks, mm; a corner is at the origin."""
FOOT = (56.0, 40.0)
"""Sizes of a pocket at its floor, mm; it lies in the block's middle."""


def block() -> Any:
    """Return the block without a pocket."""
    return cq.Workplane("XY").box(*BLOCK, centered=False)


def tapered_pocket(
    lean: float, depth: float, corner: float, fillet: float, foot: tuple[float, float] = FOOT
) -> Any:
    """Return the space of a pocket whose four walls lean away by `lean` degrees (over the floor where negative), its corners cones."""
    low = BLOCK[2] - depth
    sketch = cq.Workplane("XY", origin=(BLOCK[0] / 2, BLOCK[1] / 2, low)).sketch()
    base = sketch.rect(*foot).vertices().fillet(corner).finalize()
    space = base.extrude(depth, taper=-lean)
    return space.faces("<Z").edges().fillet(fillet) if fillet > 0.0 else space


@cache
def leaning_block(
    lean: float = 5.0, depth: float = 20.0, corner: float = 9.0, fillet: float = 4.0
) -> Any:
    """Return a block with a pocket of four walls that lean away, floor fillets at their foot."""
    return block().cut(tapered_pocket(lean, depth, corner, fillet)).val().wrapped


@cache
def mixed_block(lean: float = 6.0, over: float = 5.0, depth: float = 18.0, corner: float = 8.0) -> Any:
    """Return a block with a pocket of a wall that leans over its floor (at high x), one that leans away (at low x), and two upright ones."""
    low = BLOCK[2] - depth
    x0, x1 = 0.5 * (BLOCK[0] - FOOT[0]), 0.5 * (BLOCK[0] + FOOT[0])
    away, hang = depth * math.tan(math.radians(lean)), depth * math.tan(math.radians(over))
    profile = [(x0, low), (x1, low), (x1 - hang, BLOCK[2]), (x0 - away, BLOCK[2])]
    space = (
        cq.Workplane("XZ", origin=(0.0, 0.5 * (BLOCK[1] + FOOT[1]), 0.0))
        .polyline(profile)
        .close()
        .extrude(FOOT[1])
    )
    edges = space.faces("<X or >X").edges("not(#Z)")
    del edges
    upright = space.edges(cq.selectors.BoxSelector((0, 0, low + 1.0), (100, 80, BLOCK[2] - 1.0)))
    space = upright.fillet(corner)
    return block().cut(space).val().wrapped


@cache
def bowl_block(radius: float = 160.0, depth: float = 14.0, corner: float = 8.0, fillet: float = 3.0) -> Any:
    """Return a block with a pocket of upright walls over a floor that is part of a cylinder along y, lowest in the middle."""
    space = (
        cq.Workplane("XY", origin=(BLOCK[0] / 2, BLOCK[1] / 2, 0.0))
        .sketch()
        .rect(*FOOT)
        .vertices()
        .fillet(corner)
        .finalize()
        .extrude(BLOCK[2])
    )
    centre = BLOCK[2] - depth + radius
    round_ = (
        cq.Workplane("XZ", origin=(BLOCK[0] / 2, BLOCK[1], 0.0))
        .center(0.0, centre)
        .circle(radius)
        .extrude(BLOCK[1])
    )
    space = space.intersect(round_)
    if fillet > 0.0:
        floor = space.faces("<Z")
        space = floor.edges().fillet(fillet)
    return block().cut(space).val().wrapped
