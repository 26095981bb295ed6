"""Small panels of random sizes, the same for the same seed: closed, open, and slots right through."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import cadquery as cq

CORNERS, FILLETS = (5.0, 6.0, 8.0, 10.0, 12.0), (0.0, 0.0, 2.0, 3.0)


def random_panel(seed: int) -> Any:
    """Return a plate with one or two pockets; seeds that follow one another go round the kinds."""
    r = random.Random(seed)
    length, width, height = r.uniform(90.0, 140.0), r.uniform(64.0, 90.0), r.uniform(14.0, 40.0)
    plate = cq.Workplane("XY").box(length, width, height, centered=False)
    kinds = list(_KINDS.values())
    for cut in kinds[seed % len(kinds)](r, length, width, height):
        plate = plate.cut(cut)
    return plate.val().wrapped


def _one(r: random.Random, length: float, width: float, height: float) -> list[Any]:
    rim = r.uniform(3.0, 8.0)
    return [_pocket(r, rim, length - rim, rim, width - rim, height)]


def _two(r: random.Random, length: float, width: float, height: float) -> list[Any]:
    rim, middle = r.uniform(3.0, 8.0), r.uniform(0.4, 0.6) * length
    return [
        _pocket(r, rim, middle - 2.0, rim, width - rim, height),
        _pocket(r, middle + 2.0, length - rim, rim, width - rim, height),
    ]


def _opened(r: random.Random, length: float, width: float, height: float) -> list[Any]:
    wide = r.uniform(0.4, 0.8) * width
    box = (
        cq.Workplane("XY")
        .box(length, wide, height, centered=False)
        .edges("|Z and <X")
        .fillet(r.choice(CORNERS))
    )
    return [box.translate((r.uniform(10.0, 30.0), 0.5 * (width - wide), r.uniform(2.5, 6.0)))]


def _through(r: random.Random, length: float, width: float, height: float) -> list[Any]:
    wide = r.uniform(28.0, 0.7 * width)
    return [
        cq.Workplane("XY")
        .box(length + 2.0, wide, height, centered=False)
        .translate((-1.0, 0.5 * (width - wide), r.uniform(2.5, 6.0)))
    ]


def _pocket(r: random.Random, x0: float, x1: float, y0: float, y1: float, height: float) -> Any:
    fillet = r.choice(FILLETS)
    body = (
        cq.Workplane("XY")
        .box(x1 - x0, y1 - y0, height, centered=False)
        .edges("|Z")
        .fillet(r.choice(CORNERS))
    )
    body = body.faces("<Z").edges().fillet(fillet) if fillet else body
    return body.translate((x0, y0, r.uniform(2.5, 6.0)))


_KINDS: dict[str, Callable[[random.Random, float, float, float], list[Any]]] = {
    "one": _one,
    "two": _two,
    "opened": _opened,
    "through": _through,
}
