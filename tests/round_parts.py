"""Small wheels and shells of seeded random sizes, turned and moved at random: kinds of part that are told from flat ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cadquery as cq
import numpy as np


@dataclass(frozen=True)
class Round:
    """A shape with the number of things that stand evenly about its axis."""

    shape: Any
    count: int


def wheel(seed: int, hub: float = 1.05, twist: float | None = None) -> Round:
    """Return a wheel with 5 to 11 blades on a hub whose radius is a share `hub` of theirs, turned by `twist` degrees over their height."""
    pick = np.random.default_rng(seed)
    count, radius = int(pick.integers(5, 12)), float(pick.uniform(25.0, 60.0))
    height, lean = (
        radius * float(pick.uniform(0.5, 0.7)),
        float(pick.uniform(25.0, 40.0)) if twist is None else twist,
    )
    blade = cq.Workplane("XY").center(0.6 * radius, 0.0).rect(0.8 * radius, 0.04 * radius)
    one = blade.twistExtrude(height, lean) if lean else blade.extrude(height)
    disc = cq.Workplane("XY").circle(hub * radius).extrude(-0.1 * radius)
    body = disc.union(cq.Workplane("XY").circle(0.25 * radius).extrude(1.1 * height))
    for k in range(count):
        body = body.union(one.rotate((0, 0, 0), (0, 0, 1), 360.0 * k / count))
    bore = cq.Workplane("XY").circle(0.1 * radius).extrude(4.0 * radius, both=True)
    return Round(placed(body.cut(bore).val().wrapped, pick), count)


def shell(seed: int) -> Round:
    """Return a thin shell of revolution, cylinder or cone, with a flange, a bolt circle and 0 to 5 bosses with holes."""
    pick = np.random.default_rng(seed)
    radius, wall = float(pick.uniform(60.0, 120.0)), float(pick.uniform(2.0, 4.0))
    height, top = radius * float(pick.uniform(0.8, 1.4)), radius * float(pick.uniform(0.8, 1.0))
    outline = [
        (radius, 0),
        (radius + 20, 0),
        (radius + 20, 6),
        (radius + wall, 6),
        (top + wall, height),
        (top, height),
    ]
    body = cq.Workplane("XZ").polyline(outline).close().revolve(360, (0, 0, 0), (0, 1, 0))
    count = int(pick.integers(0, 6))
    for k in range(count):
        at = 0.5 * (radius + top)
        around = 360.0 * (k + float(pick.uniform(0.0, 0.5))) / count
        for size, into in ((9.0, False), (4.0, True)):
            pin = cq.Workplane("YZ").center(0, 0.5 * height).circle(size).extrude(at + 15.0)
            inside = cq.Workplane("XY").circle(at - 8.0).extrude(height)
            pin = (pin if into else pin.cut(inside)).rotate((0, 0, 0), (0, 0, 1), around)
            body = body.cut(pin) if into else body.union(pin)
    hollow = (
        cq.Workplane("XZ")
        .polyline([(0, 0), (radius, 0), (top, height), (0, height)])
        .close()
        .revolve(360, (0, 0, 0), (0, 1, 0))
    )
    holes = cq.Workplane("XY").polarArray(radius + 12.0, 0.0, 360.0, 12).circle(3.0).extrude(6.0)
    return Round(placed(body.cut(hollow).cut(holes).val().wrapped, pick), count)


def gear(seed: int) -> Round:
    """Return a flat wheel with upright teeth and a bore."""
    pick = np.random.default_rng(seed)
    count, radius = int(pick.integers(8, 16)), float(pick.uniform(20.0, 60.0))
    tooth = (
        cq.Workplane("XY")
        .center(radius, 0.0)
        .rect(0.3 * radius, 0.2 * radius)
        .extrude(0.3 * radius)
    )
    body = cq.Workplane("XY").circle(radius).extrude(0.3 * radius)
    for k in range(count):
        body = body.union(tooth.rotate((0, 0, 0), (0, 0, 1), 360.0 * k / count))
    return Round(
        placed(body.faces(">Z").workplane(origin=(0, 0, 0)).hole(0.4 * radius).val().wrapped, pick),
        count,
    )


def drilled_ring(seed: int) -> Round:
    """Return a flat ring, as thick as wide, with a circle of holes."""
    pick = np.random.default_rng(seed)
    count, radius = int(pick.integers(6, 20)), float(pick.uniform(30.0, 80.0))
    ring = cq.Workplane("XY").circle(radius).circle(0.7 * radius).extrude(0.3 * radius)
    holes = (
        cq.Workplane("XY")
        .polarArray(0.85 * radius, 0.0, 360.0, count)
        .circle(0.04 * radius)
        .extrude(radius)
    )
    return Round(placed(ring.cut(holes).val().wrapped, pick), count)


def shaft(seed: int) -> Round:
    """Return a stepped shaft."""
    pick = np.random.default_rng(seed)
    body, at = cq.Workplane("XY"), 0.0
    for length, radius in zip(pick.uniform(10.0, 40.0, 4), pick.uniform(8.0, 25.0, 4), strict=True):
        body = body.union(
            cq.Workplane("XY").workplane(offset=at).circle(float(radius)).extrude(float(length))
        )
        at += float(length)
    return Round(placed(body.val().wrapped, pick), 0)


def placed(shape: Any, pick: np.random.Generator) -> Any:
    """Return a shape turned about a random axis and moved by up to 500 mm."""
    axis: Sequence[float] = pick.normal(size=3).tolist()
    turned = cq.Shape.cast(shape).rotate(
        cq.Vector(0, 0, 0), cq.Vector(*axis), float(pick.uniform(0.0, 360.0))
    )
    return turned.translate(cq.Vector(*pick.uniform(-500.0, 500.0, 3).tolist())).wrapped
