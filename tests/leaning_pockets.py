"""Small blocks with pockets whose walls lean or whose floors are curved, built by cadquery for tests."""

from __future__ import annotations

import math
from functools import cache
from random import Random
from typing import Any

import cadquery as cq

BLOCK = (66.0, 54.0, 20.0)
"""Sizes of the blocks, mm; a corner is at the origin."""
FOOT = (36.0, 28.0)
"""Sizes of a pocket at its floor, mm; it lies in the block's middle."""


def block() -> Any:
    """Return the block without a pocket."""
    return cq.Workplane("XY").box(*BLOCK, centered=False)


def upright_space(corner: float) -> Any:
    """Return the space over a pocket's foot, with round corners, as high as the block."""
    at = (BLOCK[0] / 2, BLOCK[1] / 2, 0.0)
    sketch = cq.Workplane("XY", origin=at).sketch().rect(*FOOT).vertices().fillet(corner)
    return sketch.finalize().extrude(BLOCK[2])


@cache
def leaning_block(
    lean: float = 5.0, depth: float = 12.0, corner: float = 9.0, fillet: float = 4.0
) -> Any:
    """Return a block with a pocket whose four walls lean away by `lean` degrees, its corners cones; fillets (0: none) at their foot."""
    at = (BLOCK[0] / 2, BLOCK[1] / 2, BLOCK[2] - depth)
    sketch = cq.Workplane("XY", origin=at).sketch().rect(*FOOT).vertices().fillet(corner)
    space = sketch.finalize().extrude(depth, taper=-lean)
    if fillet > 0.0:
        space = space.faces("<Z").edges().fillet(fillet)
    return block().cut(space).val().wrapped


def mixed_space(lean: float, over: float, depth: float, corner: float) -> Any:
    """Return the space of the pocket of `mixed_block`."""
    low = BLOCK[2] - depth
    x0, x1 = 0.5 * (BLOCK[0] - FOOT[0]), 0.5 * (BLOCK[0] + FOOT[0])
    away, hang = (depth * math.tan(math.radians(a)) for a in (lean, over))
    profile = [(x0, low), (x1, low), (x1 - hang, BLOCK[2]), (x0 - away, BLOCK[2])]
    at = (0.0, 0.5 * (BLOCK[1] + FOOT[1]), 0.0)
    space = cq.Workplane("XZ", origin=at).polyline(profile).close().extrude(FOOT[1])
    between = cq.selectors.BoxSelector((0, 0, low + 1.0), (*BLOCK[:2], BLOCK[2] - 1.0))
    return space.edges(between).fillet(corner)


@cache
def mixed_block(
    lean: float = 6.0,
    over: float = 5.0,
    depth: float = 12.0,
    corner: float = 8.0,
    fillet: float = 0.0,
) -> Any:
    """Return a block with a pocket of a wall that leans over its floor (at high x), one that leans away (low x), and two upright ones;
    fillets (0: none) at their foot."""
    space = mixed_space(lean, over, depth, corner)
    if fillet > 0.0:
        space = space.faces("<Z").edges().fillet(fillet)
    return block().cut(space).val().wrapped


@cache
def stepped_block(long: float = 110.0, depth: float = 12.0, lower: float = 4.0) -> Any:
    """Return a block with a long pocket whose wall at high x leans over; its last 70 mm along y are deeper by `lower`."""
    profile = [(15.0, 20.0), (45.0, 20.0), (44.0, 20.0 + depth), (15.0, 20.0 + depth)]
    deep = [(15.0, 20.0 - lower), (45.0 + lower / depth, 20.0 - lower), *profile[1:]]
    whole, end = (
        cq.Workplane("XZ", origin=(0.0, 15.0 + long, 0.0)).polyline(p).close().extrude(length)
        for p, length in ((profile, long), (deep, 70.0))
    )
    solid = cq.Workplane("XY").box(60.0, long + 30.0, 20.0 + depth, centered=False)
    return solid.cut(whole.union(end)).val().wrapped


def bowl_space(radius: float, depth: float, corner: float) -> Any:
    """Return the space of the pocket of `bowl_block` without a fillet."""
    at = (BLOCK[0] / 2, BLOCK[1], BLOCK[2] - depth + radius)
    round_ = cq.Workplane("XZ", origin=at).circle(radius).extrude(BLOCK[1])
    return upright_space(corner).intersect(round_)


@cache
def bowl_block(
    radius: float = 160.0, depth: float = 9.0, corner: float = 8.0, fillet: float = 3.0
) -> Any:
    """Return a block with a pocket of upright walls over a floor that is part of a cylinder along y, lowest in the middle."""
    space = bowl_space(radius, depth, corner)
    if fillet > 0.0:
        space = space.faces("<Z").edges().fillet(fillet)
    return block().cut(space).val().wrapped


@cache
def bowl_beside_overhang_block(rib: float = 1.5) -> Any:
    """Return a block with the pocket of `mixed_block` and, behind its wall that leans over, that of `bowl_block` without a fillet; the rib
    between them is `rib` mm thick at its foot."""
    past = FOOT[0] + rib
    solid = cq.Workplane("XY").box(BLOCK[0] + past, *BLOCK[1:], centered=False)
    bowl = bowl_space(160.0, 9.0, 8.0).translate((past, 0.0, 0.0))
    return solid.cut(mixed_space(6.0, 5.0, 12.0, 8.0)).cut(bowl).val().wrapped


@cache
def hill_block(radius: float = 60.0, depth: float = 7.0, corner: float = 8.0) -> Any:
    """Return a block with a pocket of upright walls over a floor that is part of a cylinder along y, highest in the middle: walls at both
    ends of it stand on floor that falls towards them."""
    top = BLOCK[2] - depth
    drum = cq.Workplane("XZ", origin=(BLOCK[0] / 2, BLOCK[1], top - radius)).circle(radius)
    space = upright_space(corner).translate((0, 0, top - 6.0)).cut(drum.extrude(BLOCK[1]))
    return block().cut(space).val().wrapped


def random_block(seed: int) -> Any:
    """Return the block of a seed with a pocket that leans away, of random lean, depth, corner and fillet."""
    draw = Random(f"leaning {seed}")
    corner = draw.choice((6.0, 8.0, 10.0))
    return leaning_block(
        draw.uniform(2.0, 14.0),
        draw.uniform(6.0, 15.0),
        corner,
        draw.choice((0.0, 1.0, 2.0, 3.0, 4.0)),
    )


@cache
def ribbed_block(lean: float = 5.0, depth: float = 12.0, lower: float = 4.0) -> Any:
    """Return a block with two rows of two pockets whose walls lean away; between the rows, along both, a rib that is lower."""
    wide, deep, apart = 60.0, 36.0, 6.0
    size = (2.0 * wide + apart + 30.0, 2.0 * deep + apart + 30.0, BLOCK[2])
    solid = cq.Workplane("XY").box(*size, centered=False)
    for i in (0, 1):
        for j in (0, 1):
            at = (15.0 + (i + 0.5) * wide + i * apart, 15.0 + (j + 0.5) * deep + j * apart)
            sketch = cq.Workplane("XY", origin=(*at, BLOCK[2] - depth)).sketch().rect(wide, deep)
            solid = solid.cut(sketch.vertices().fillet(8.0).finalize().extrude(depth, taper=-lean))
    middle = (15.0, 15.0 + deep - 1.0, BLOCK[2] - lower)
    slot = cq.Workplane("XY").box(2.0 * wide + apart, apart + 2.0, lower, centered=False)
    return solid.cut(slot.translate(middle)).val().wrapped
