"""Random curved plates: a plate with a wavy, spherical or tilted top that carries up to three bosses, domes or dimples."""

from __future__ import annotations

from math import cos, pi, sin
from random import Random
from typing import Any

import cadquery as cq


def plate_shape(seed: int) -> Any:
    """Return the solid of a curved plate (OCP shape, mm, bottom at z 0, curved face upward)."""
    draw = Random(f"plate {seed}")
    length, width, height = (
        draw.uniform(40.0, 70.0),
        draw.uniform(40.0, 60.0),
        draw.uniform(14.0, 22.0),
    )
    body = (
        _wavy(draw, length, width, height)
        if draw.random() < 0.5
        else _domed(draw, length, width, height)
    )
    places = [(x, y) for x in (0.25, 0.75) for y in (0.28, 0.72)]
    for x, y in draw.sample(places, draw.randint(0, 3)):
        body = _with_local(draw, body, x * length, y * width, height)
    return body.val().wrapped


def _wavy(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    """Return a plate whose top follows a wave along x and rises a little along y."""
    deep, waves, rise = draw.uniform(0.5, 2.0), draw.uniform(0.5, 1.2), draw.uniform(0.0, 2.0)
    count = 9
    rows = [
        [
            cq.Vector(
                length * i / (count - 1),
                width * j / (count - 1),
                height
                - deep * (1.0 - cos(2.0 * pi * waves * i / (count - 1)))
                - rise * sin(pi * j / (count - 1) / 2.0),
            )
            for j in range(count)
        ]
        for i in range(count)
    ]
    top = cq.Face.makeSplineApprox(rows, tol=1e-4)
    block = cq.Workplane("XY").box(length, width, height + 5.0, centered=False)
    parts = cq.Workplane(block.val()).split(cq.Workplane(top)).solids().vals()
    return cq.Workplane(min(parts, key=lambda s: s.Center().z))


def _domed(draw: Random, length: float, width: float, height: float) -> cq.Workplane:
    """Return a plate whose top is part of a large ball."""
    radius = draw.uniform(1.5, 4.0) * max(length, width)
    ball = cq.Workplane("XY").sphere(radius).translate((length / 2.0, width / 2.0, height - radius))
    return cq.Workplane("XY").box(length, width, height + 1.0, centered=False).intersect(ball)


def _with_local(
    draw: Random, body: cq.Workplane, x: float, y: float, height: float
) -> cq.Workplane:
    """Return the plate with a boss, a dome or a dimple at a place, its foot or rim rounded where the kernel can."""
    kind, radius = draw.choice(("boss", "dome", "dimple")), draw.uniform(4.0, 6.5)
    if kind == "boss":
        cone = (
            cq.Workplane("XY")
            .circle(radius)
            .extrude(height + draw.uniform(2.0, 4.0), taper=draw.uniform(3.0, 10.0))
        )
        return body.union(cone.translate((x, y, 0)))
    sphere = cq.Workplane("XY").sphere(1.6 * radius)
    if kind == "dome":
        return body.union(sphere.translate((x, y, height - radius)))
    return body.cut(sphere.translate((x, y, height + 0.8 * radius)))
