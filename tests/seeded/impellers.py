"""Random impellers with truth by construction: counts, rows of splitters, wrap, thickness, bolt circles, and what files do to them.

Blades are ruled from below the hub to above the shroud, cut off by the shroud's envelope and at the outlet radius, and stand on a turned
hub: in sharp roots and with square noses, or with root fillets and round noses, as `rounded_wheels` makes them. What is random of a file:
turned to a skew axis, mirrored, in inches, hub cut in sectors, walls in two pieces.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, radians, sin
from pathlib import Path
from random import Random
from typing import Any

import cadquery as cq

from seeded.rounded_wheels import WheelForm, rounded_wheel

MOST_DRAWS = 10
"""Draws of a seed until the kernel rounds all roots."""
ROOM, NARROWEST = 3.0, 2.8
"""Channels of wheels with root fillets are as wide as so many radii of these, and so many mm: the smallest cutter goes through."""
TALLEST, TIGHTEST = 18.0, 1.12
"""mm: height of blades, and radius of root fillets, that the smallest cutter reaches down and goes into."""
STATIONS = 9
"""Points along a blade's curves."""
BELOW, ABOVE = -0.35, 1.2
"""Where the rulings begin and end, in shares of the way from hub to shroud."""
Meridian = Callable[[float], tuple[float, float]]


@dataclass(frozen=True, slots=True, kw_only=True)
class SeededImpeller:
    """A random wheel: its solid (OCP, mm), the unit of its file, and its truth: counts by kind, how many faces each wall has, the sense in
    which it turns about the direction to its inlet, diameters of outlet and bore, radius of the root fillets (0: sharp roots)."""

    name: str
    shape: Any
    unit: str
    counts: dict[str, int]
    wall_faces: int
    turns: float
    outlet_diameter: float
    bore_diameter: float
    fillet: float = 0.0

    def written(self, folder: Path) -> Path:
        """Return its STEP file in a folder."""
        from trunnion.part.write import write_step

        path = folder / f"{self.name}.step"
        write_step(self.shape, path, unit=self.unit)
        return path


def impeller(seed: int, *, rounded: bool = False) -> SeededImpeller:
    """Return the random impeller of a seed; rounded ones have root fillets and the size of a hand."""
    return _rounded(seed) if rounded else _sharp(seed)


def _rounded(seed: int) -> SeededImpeller:
    """Return the wheel with root fillets of a seed: the first of its draws that the kernel makes."""
    for number in range(MOST_DRAWS):
        draw = Random(f"rounded impeller {seed}, draw {number}")
        form = _form(draw)
        holes = draw.choice((0, form.count + draw.randint(1, 4)))
        wheel = rounded_wheel(form)
        if wheel is None:
            continue
        if holes:
            wheel = wheel.cut(*_bolts(holes, 0.62 * form.radius, 0.03 * form.radius, form.back))
        if len(wheel.Solids()) == 1 and wheel.isValid():
            return _delivered(f"impeller{seed}", draw, wheel, form, holes)
    raise ValueError(f"seed {seed}: {MOST_DRAWS} draws gave no valid solid")


def _form(draw: Random) -> WheelForm:
    """Return what a wheel with root fillets is made of: as many blades as leave room for these between them."""
    radius = draw.uniform(30.0, 60.0)
    height, outlet = radius * draw.uniform(0.55, 0.8), radius * draw.uniform(0.09, 0.14)
    inner, eye = radius * draw.uniform(0.2, 0.26), radius * draw.uniform(0.5, 0.6)
    eye = min(eye, inner + TALLEST)
    rows = draw.choice((0, 1, 1, 2))
    form = WheelForm(
        radius=radius,
        height=height,
        back=-radius * draw.uniform(0.06, 0.1),
        bore=inner * draw.uniform(0.35, 0.6),
        hub_points=((inner, height), (inner * 1.05, 0.12 * height), (radius * 1.02, 0.0)),
        shroud_points=(
            (eye, height),
            (eye * 1.04, outlet + 0.15 * height),
            (radius * 1.02, outlet),
        ),
        starts=(
            draw.uniform(0.08, 0.12),
            *sorted(draw.uniform(0.3, 0.5) + 0.18 * k for k in range(rows)),
        ),
        count=draw.randint(5, 11),
        wrap=radians(draw.uniform(25.0, 55.0)) * draw.choice((1.0, -1.0)),
        thick=radius * draw.uniform(0.018, 0.026),
        pieces=draw.choice((1, 1, 2)),
        fillet=max(TIGHTEST, radius * draw.uniform(0.02, 0.035)),
        joined=draw.random() < 0.5,
    )
    while form.least_room() < max(ROOM * form.fillet, NARROWEST):
        fewer = form.starts[:-1] if form.count <= 5 and len(form.starts) > 1 else form.starts
        form = replace(form, starts=fewer, count=max(form.count - 1, 4))
    return form


def _delivered(
    name: str, draw: Random, wheel: cq.Shape, form: WheelForm, holes: int
) -> SeededImpeller:
    """Return a wheel with root fillets as its file comes, and its truth."""
    wheel, mirrored = _laid(draw, wheel)
    rows = len(form.starts) - 1
    return SeededImpeller(
        name=name,
        shape=wheel.Solids()[0].wrapped,
        unit=draw.choice(("mm", "mm", "inch")),
        counts=_counts(form.count, rows, holes),
        wall_faces=form.pieces,
        turns=-math.copysign(1.0, form.wrap) * (-1.0 if mirrored else 1.0),
        outlet_diameter=2.0 * form.radius,
        bore_diameter=2.0 * form.bore,
        fillet=form.fillet,
    )


def _laid(draw: Random, wheel: cq.Shape) -> tuple[cq.Shape, bool]:
    """Return a wheel where a designer left it, and whether it is mirrored."""
    mirrored = draw.random() < 0.5
    if mirrored:
        wheel = wheel.mirror("XZ")
    axis = [draw.gauss(0.0, 1.0) for _ in range(3)]
    if draw.random() < 0.7:
        wheel = wheel.rotate(cq.Vector(), cq.Vector(*axis), draw.uniform(0.0, 360.0))
        wheel = wheel.translate(cq.Vector(*(draw.uniform(-200.0, 200.0) for _ in range(3))))
    return wheel, mirrored


def _counts(blades: int, rows: int, holes: int) -> dict[str, int]:
    counts = {
        "blade": blades,
        "splitter": blades * rows,
        "hub": 1,
        "bore": 1,
        "plane": 2,
        "profile": 1,
        "hole": holes,
    }
    return {k: n for k, n in counts.items() if n}


def _sharp(seed: int) -> SeededImpeller:
    draw = Random(f"impeller {seed}")
    radius = draw.uniform(30.0, 90.0)
    count, rows = draw.randint(5, 11), draw.choice((0, 1, 1, 2))
    height, outlet = radius * draw.uniform(0.55, 0.8), radius * draw.uniform(0.09, 0.14)
    inner, eye = radius * draw.uniform(0.2, 0.26), radius * draw.uniform(0.5, 0.6)
    hub = _meridian((inner, height), (inner * 1.05, 0.12 * height), (radius * 1.02, 0.0))
    shroud = _meridian((eye, height), (eye * 1.04, outlet + 0.15 * height), (radius * 1.02, outlet))
    wrap, sense = radians(draw.uniform(25.0, 55.0)), draw.choice((1.0, -1.0))
    thick = radius * draw.uniform(0.018, 0.026)
    pieces, sectors = draw.choice((1, 1, 2)), draw.choice((1, 1, 2, count))
    starts = [
        draw.uniform(0.06, 0.1),
        *sorted(draw.uniform(0.3, 0.5) + 0.18 * k for k in range(rows)),
    ]
    envelope = _turned([(0.0, height + 1.0), *_curve(shroud, radius), (radius, -1.0), (0.0, -1.0)])
    back = -radius * draw.uniform(0.06, 0.1)
    body = _hub([(0.0, height), *_curve(hub, radius), (radius, back), (0.0, back)], sectors)
    places = [(0, 0.0)]
    places += [(row, row / (rows + 1.0)) for row in range(1, rows + 1)]
    tools = []
    for row, share in places:
        one = _blade(hub, shroud, starts[row], wrap * sense, thick, pieces).intersect(envelope)
        turn = 360.0 / count
        tools += [one.rotate(*AXIS, turn * (k + share)) for k in range(count)]
    wheel = body.fuse(*tools)
    bore = inner * draw.uniform(0.35, 0.6)
    wheel = wheel.cut(cq.Solid.makeCylinder(bore, 4.0 * radius, cq.Vector(0, 0, -2.0 * radius)))
    holes = draw.choice((0, count + draw.randint(1, 4)))
    if holes:
        wheel = wheel.cut(*_bolts(holes, 0.62 * radius, 0.03 * radius, back))
    if len(wheel.Solids()) != 1 or not wheel.isValid():
        raise ValueError(f"seed {seed}: no valid solid")
    wheel, mirrored = _laid(draw, wheel)
    return SeededImpeller(
        name=f"impeller{seed}",
        shape=wheel.Solids()[0].wrapped,
        unit=draw.choice(("mm", "mm", "inch")),
        counts=_counts(count, rows, holes),
        wall_faces=pieces,
        turns=-sense * (-1.0 if mirrored else 1.0),
        outlet_diameter=2.0 * radius,
        bore_diameter=2.0 * bore,
    )


def small_impeller(*, holes: int = 0, diameter: float = 5.0, between: float = 0.0) -> Any:
    """Return the solid (OCP, mm) of a small open wheel that is quickly planned: six low blades with sharp roots, its axis z, and so many
    blind holes of a diameter (mm) in its back, with as many of another one between them where that is given."""
    radius, count = 20.0, 6
    height, outlet = 0.65 * radius, 0.14 * radius
    hub = _meridian((0.26 * radius, height), (0.28 * radius, 0.12 * height), (1.02 * radius, 0.0))
    shroud = _meridian(
        (0.6 * radius, height), (0.62 * radius, outlet + 0.15 * height), (1.02 * radius, outlet)
    )
    envelope = _turned([(0.0, height + 1.0), *_curve(shroud, radius), (radius, -1.0), (0.0, -1.0)])
    body = _hub([(0.0, height), *_curve(hub, radius), (radius, -3.0), (0.0, -3.0)], 1)
    one = _blade(hub, shroud, 0.1, radians(30.0), 0.04 * radius, 1).intersect(envelope)
    wheel = body.fuse(*(one.rotate(*AXIS, 360.0 * k / count) for k in range(count)))
    bore = cq.Solid.makeCylinder(2.5, 4.0 * radius, cq.Vector(0, 0, -2.0 * radius))
    bolts = _bolts(holes, 0.62 * radius, 0.5 * diameter, -3.0)
    if between:
        others = _bolts(holes, 0.62 * radius, 0.5 * between, -3.0)
        bolts = [*bolts, *(b.rotate(*AXIS, 180.0 / holes) for b in others)]
    return wheel.cut(bore, *bolts).Solids()[0].wrapped


AXIS = (cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))


def _meridian(
    first: tuple[float, float], middle: tuple[float, float], last: tuple[float, float]
) -> Meridian:
    """Return a curve of the second degree from s = 0 to 1 that leaves its first point towards the middle one."""

    def at(s: float) -> tuple[float, float]:
        a, b, c = (1.0 - s) ** 2, 2.0 * s * (1.0 - s), s * s
        return (
            a * first[0] + b * middle[0] + c * last[0],
            a * first[1] + b * middle[1] + c * last[1],
        )

    return at


def _curve(meridian: Meridian, radius: float) -> list[Any]:
    return ["spline", meridian, radius]


def _turned(words: list[Any], degrees: float = 360.0) -> cq.Shape:
    """Return the solid that an outline sweeps: points, and in between a spline that follows a meridian out to a radius."""
    sheet, (start, kind, meridian, radius, *rest) = cq.Workplane("XZ"), words
    assert kind == "spline"
    points = [meridian(k / 24.0) for k in range(25)]
    last = next(k for k, p in enumerate(points) if p[0] >= radius)
    (r0, z0), (r1, z1) = points[last - 1], points[last]
    share = (radius - r0) / (r1 - r0)
    points = [*points[:last], (radius, z0 + share * (z1 - z0))]
    first = points[0]
    sheet = sheet.moveTo(*start).lineTo(first[0], start[1])
    if abs(first[1] - start[1]) > 1e-9:
        sheet = sheet.lineTo(*first)
    sheet = sheet.spline(points[1:], includeCurrent=True)
    for point in rest:
        sheet = sheet.lineTo(*point)
    return sheet.close().revolve(degrees, (0, 0, 0), (0, 1, 0)).val()


def _hub(words: list[Any], sectors: int) -> cq.Shape:
    """Return the hub's solid, its faces cut in sectors."""
    if sectors == 1:
        return _turned(words)
    one = _turned(words, 360.0 / sectors)
    parts = [one.rotate(*AXIS, 360.0 * k / sectors) for k in range(sectors)]
    return parts[0].fuse(*parts[1:])


def _blade(
    hub: Meridian, shroud: Meridian, start: float, wrap: float, thick: float, pieces: int
) -> cq.Shape:
    """Return a blade's solid: two ruled walls in pieces, closed below the hub, above the shroud, at its start and beyond the outlet."""

    def point(s: float, span: float, side: float) -> cq.Vector:
        (r0, z0), (r1, z1) = hub(s), shroud(s)
        r, z = r0 + span * (r1 - r0), z0 + span * (z1 - z0)
        angle = wrap * s + side * 0.5 * thick / max(r, 0.3 * r1)
        return cq.Vector(r * cos(angle), r * sin(angle), z)

    def rail(low: float, high: float, span: float, side: float) -> cq.Edge:
        steps = [low + (high - low) * k / (STATIONS - 1) for k in range(STATIONS)]
        return cq.Edge.makeSpline([point(s, span, side) for s in steps])

    ends = [start + (1.0 - start) * k / pieces for k in range(pieces + 1)]
    faces = []
    for low, high in pairwise(ends):
        rails = {
            (span, side): rail(low, high, span, side)
            for span in (BELOW, ABOVE)
            for side in (1.0, -1.0)
        }
        faces += [cq.Face.makeRuledSurface(rails[BELOW, s], rails[ABOVE, s]) for s in (1.0, -1.0)]
        faces += [
            cq.Face.makeRuledSurface(rails[span, 1.0], rails[span, -1.0]) for span in (BELOW, ABOVE)
        ]
    for s in (start, 1.0):
        lines = [
            cq.Edge.makeLine(point(s, BELOW, side), point(s, ABOVE, side)) for side in (1.0, -1.0)
        ]
        faces.append(cq.Face.makeRuledSurface(*lines))
    shell = cq.Shell.makeShell(faces)
    return cq.Solid.makeSolid(shell).fix()


def _bolts(count: int, radius: float, bolt: float, back: float) -> list[cq.Shape]:
    """Return blind holes from the back, evenly on a circle."""
    return [
        cq.Solid.makeCylinder(
            bolt,
            0.6 * abs(back),
            cq.Vector(
                radius * cos(radians(360.0 * k / count)),
                radius * sin(radians(360.0 * k / count)),
                back,
            ),
        )
        for k in range(count)
    ]
