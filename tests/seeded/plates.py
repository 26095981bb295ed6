"""Random curved plates, from easy to nasty: a wavy, ball-shaped, saddle or tilted top with up to eight bosses, domes and dimples.

What is random is what a shop's drawings differ in: size, waves, count and sizes of the local features, roundings at their feet, where the
part lies and in which unit.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path
from random import Random
from typing import Any

import cadquery as cq

from seeded.parts import UNITS, Seeded, placed

Height = Callable[[float, float], float]
"""Height (mm) over shares of length and width."""
KINDS = ("boss", "dome", "dimple")
MOST_DRAWS = 10
"""Draws of a seed until its solid is valid: booleans fail, in errors of several kinds, where local features meet a wavy top badly."""
SHORT = 1e-3
"""mm: a plate shorter than drawn by more has lost its body in a boolean that failed without an error."""
FEET = (0.0, 0.0, 1.5, 2.5)
"""mm: radii where a boss or dome meets the plate."""


def plate(seed: int) -> Seeded:
    """Return the random curved plate of a seed: the first of its draws in whose file the kernel finds no fault."""
    for number in range(MOST_DRAWS):
        draw = Random(f"plate {seed}" + (f", draw {number + 1}" if number else ""))
        try:
            made = _drawn(seed, draw)
        except Exception as reason:
            del reason
            continue
        if _is_sound(made):
            return made
    raise ValueError(f"plate {seed}: {MOST_DRAWS} draws gave no valid solid")


def small_plate(seed: int) -> Any:
    """Return a wavy plate without local features, as small as one that takes seconds."""
    draw = Random(f"small plate {seed}")
    size = draw.uniform(24.0, 30.0), draw.uniform(18.0, 22.0)
    return _wavy(draw, *size, draw.uniform(8.0, 10.0)).val().wrapped


def _is_sound(made: Seeded) -> bool:
    """Return whether a part's file holds a solid without faults: some are valid only until they are written in inches."""
    with tempfile.TemporaryDirectory() as folder:
        read = cq.importers.importStep(str(made.written(Path(folder))))
    return all(solid.isValid() for solid in read.solids().vals())


def _drawn(seed: int, draw: Random) -> Seeded:
    columns, rows = draw.choice(((2, 2), (2, 2), (3, 2), (4, 2)))
    pitch = draw.uniform(24.0, 34.0)
    size = columns * pitch, rows * pitch
    height = draw.uniform(12.0, 24.0)
    body = draw.choice((_wavy, _wavy, _domed, _saddle, _tilted))(draw, *size, height)
    spots = [(pitch * (i + 0.5), pitch * (j + 0.5)) for i in range(columns) for j in range(rows)]
    counts = dict.fromkeys(KINDS, 0)
    radii = []
    for spot in draw.sample(spots, draw.randint(0, len(spots))):
        kind = draw.choice(KINDS)
        body, radius = _with_local(draw, kind, body, spot, height, pitch)
        counts[kind] += 1
        radii += [radius] if radius else []
    (solid,) = body.solids().vals()
    if solid.BoundingBox().xlen < size[0] - SHORT:
        raise ValueError(f"plate {seed}: the kernel kept a local feature alone")
    shape = placed(draw, solid)
    return Seeded(
        f"plate-{seed:02d}",
        shape.wrapped,
        draw.choice(UNITS),
        counts,
        smallest_radius=min(radii, default=0.0),
    )


def _surfaced(length: float, width: float, height: Height) -> cq.Workplane:
    """Return the plate under a height function of shares of its length and width, its top one B-spline face."""
    count = 11
    past = 0.02
    at = [-past + (1.0 + 2.0 * past) * k / (count - 1) for k in range(count)]
    rows = [[cq.Vector(length * u, width * v, height(u, v)) for v in at] for u in at]
    top = cq.Face.makeSplineApprox(rows, tol=1e-4)
    tall = max(p.z for row in rows for p in row) + 5.0
    block = cq.Workplane("XY").box(length, width, tall, centered=False)
    parts = block.split(cq.Workplane(top)).solids().vals()
    return cq.Workplane(min(parts, key=lambda s: s.Center().z))


def _wavy(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    deep, waves, rise = draw.uniform(0.5, 2.5), draw.uniform(0.5, 1.3), draw.uniform(0.0, 2.5)
    return _surfaced(
        length,
        width,
        lambda u, v: height - deep * (1.0 - cos(2.0 * pi * waves * u)) - rise * sin(0.5 * pi * v),
    )


def _saddle(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    a, b = draw.uniform(1.0, 4.0), draw.uniform(1.0, 4.0)
    return _surfaced(
        length, width, lambda u, v: height - a * (2 * u - 1) ** 2 - b * (1 - (2 * v - 1) ** 2)
    )


def _tilted(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    rise, bow = draw.uniform(1.0, 5.0), draw.uniform(0.5, 2.0)
    return _surfaced(length, width, lambda u, v: height - rise * v + bow * sin(pi * u))


def _domed(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    radius = draw.uniform(1.5, 4.0) * max(length, width)
    ball = cq.Workplane("XY").sphere(radius).translate((length / 2.0, width / 2.0, height - radius))
    return cq.Workplane("XY").box(length, width, height + 1.0, centered=False).intersect(ball)


def _with_local(
    draw: Random,
    kind: str,
    body: cq.Workplane,
    spot: tuple[float, float],
    height: float,
    pitch: float,
) -> tuple[cq.Workplane, float]:
    """Return the plate with a boss, a dome or a dimple on a spot, and the radius of its foot, 0 where it is sharp."""
    radius = draw.uniform(0.14, 0.24) * pitch
    if kind == "dimple":
        ball = draw.uniform(1.3, 2.2) * radius
        lift = (ball**2 - radius**2) ** 0.5
        at = (*spot, _top(body, spot) + lift)
        return body.cut(cq.Workplane("XY").sphere(ball).translate(at)), 0.0
    if kind == "boss":
        tall = _top(body, spot) + draw.uniform(2.0, 6.0)
        local = cq.Workplane("XY").circle(radius).extrude(tall, taper=draw.uniform(2.0, 10.0))
        local = local.translate((*spot, 0.0))
    else:
        ball = draw.uniform(1.1, 1.8) * radius
        low = _top(body, spot) - (ball**2 - radius**2) ** 0.5
        local = cq.Workplane("XY").sphere(ball).translate((*spot, low))
        inside = cq.Workplane("XY").box(
            4.0 * ball, 4.0 * ball, 2.0 * height, centered=(True, True, False)
        )
        local = local.intersect(inside.translate((*spot, 0.5 * height)))
    return _footed(draw, body, body.union(local))


def _footed(draw: Random, before: cq.Workplane, joined: cq.Workplane) -> tuple[cq.Workplane, float]:
    """Return a plate with a rounded foot at its new concave edges where the kernel can round them, and the radius."""
    foot = draw.choice(FEET)
    if foot:
        known = {_key(e) for e in before.edges().vals()}
        new = [e for e in joined.edges().vals() if _key(e) not in known and e.geomType() != "LINE"]
        foots = [e for e in new if e.Center().z < max(n.Center().z for n in new) - 0.5] or new[:1]
        try:
            rounded = cq.Workplane(joined.val().fillet(foot, foots))
            if rounded.val().isValid() and len(rounded.solids().vals()) == 1:
                return rounded, foot
        except Exception as reason:
            del reason
    return joined, 0.0


def _key(edge: Any) -> tuple[float, ...]:
    return tuple(round(c, 3) for c in edge.Center().toTuple()) + (round(edge.Length(), 3),)


def _top(body: cq.Workplane, spot: tuple[float, float]) -> float:
    """Return how high the plate is on a spot."""
    line = cq.Edge.makeLine(cq.Vector(*spot, -1.0), cq.Vector(*spot, 200.0))
    met = body.val().intersect(line)
    return float(met.BoundingBox().zmax)
