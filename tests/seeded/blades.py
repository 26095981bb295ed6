"""Random five-axis parts: a twisted blade that stands in a trough, and fans of blades that stand out from a hub, some with splitters.

What is random is what drawings differ in: count, chord, thickness, height, lean, twist and bow of blades, root fillets, and the sizes of
what carries them. Both are milled in one setup on a machine with rotary axes: roots and gaps are wide enough for balls of a catalogue.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, hypot, radians, sin, tan
from random import Random

import cadquery as cq

from seeded.parts import Seeded, placed

STATIONS = 7
"""Points on each side of a section."""
MOST_DRAWS = 10
"""Draws of a seed until its solid is valid: the kernel can't round every root."""
ON = 2e-2
"""mm: how near an edge lies to what a blade stands on to be its root."""
Spot = tuple[float, float]
"""A point of a section's plane."""
Drawn = tuple[cq.Workplane, float, Mapping[str, int]]
"""A drawn part, the radius of its roots (mm, 0 where they are sharp), and how many features of each kind it has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A section of a blade: chord, thickness and camber (mm), angle of the chord (degrees), and where its middle lies (mm)."""

    chord: float
    thickness: float
    camber: float
    angle: float
    middle: Spot

    def drawn(self, sheet: cq.Workplane) -> cq.Workplane:
        """Return a sheet with the section on it: two curved sides and two round edges."""
        thick = 0.5 * self.thickness
        half = 0.5 * self.chord - thick
        places = [-half + 2.0 * half * k / (STATIONS - 1) for k in range(STATIONS)]
        sides = [
            [self._placed(x, self.camber * (1.0 - (x / half) ** 2) + side) for x in places]
            for side in (thick, -thick)
        ]
        upper, lower = sides[0], sides[1][::-1]
        sheet = sheet.moveTo(*upper[0]).spline(upper[1:], includeCurrent=True)
        sheet = sheet.threePointArc(self._placed(half + thick, 0.0), lower[0])
        sheet = sheet.spline(lower[1:], includeCurrent=True)
        return sheet.threePointArc(self._placed(-half - thick, 0.0), upper[0]).close()

    def _placed(self, x: float, y: float) -> Spot:
        angle = radians(self.angle)
        return (
            self.middle[0] + x * cos(angle) - y * sin(angle),
            self.middle[1] + x * sin(angle) + y * cos(angle),
        )


def blade(seed: int) -> Seeded:
    """Return a block with a round trough and a leaning, twisted blade that stands in it, higher than the trough is deep."""
    return _first_valid(f"blade {seed}", _blade_drawn, f"blade-{seed:02d}")


def fan(seed: int) -> Seeded:
    """Return a hub from which five to seven blades stand out all round, steeply pitched."""
    return _first_valid(f"fan {seed}", _fan_drawn, f"fan-{seed:02d}")


def split_fan(seed: int) -> Seeded:
    """Return a hub with blades and splitters in every gap or in every other one, roots sharp or rounded, lying anywhere."""
    return _first_valid(f"split fan {seed}", _split_fan_drawn, f"split-fan-{seed:02d}")


def _first_valid(name: str, drawn: Callable[[Random], Drawn], file: str) -> Seeded:
    for number in range(MOST_DRAWS):
        try:
            shape, foot, counts = drawn(Random(f"{name}, draw {number}"))
        except Exception as reason:
            del reason
            continue
        if shape.val().isValid() and len(shape.solids().vals()) == 1:
            return Seeded(file, shape.solids().val().wrapped, "mm", counts, smallest_radius=foot)
    raise ValueError(f"{name}: {MOST_DRAWS} draws gave no valid solid")


def _blade_drawn(draw: Random) -> Drawn:
    chord, height = draw.uniform(22.0, 26.0), draw.uniform(16.0, 19.0)
    thickness, camber = draw.uniform(3.0, 3.6), draw.uniform(1.0, 2.0)
    lean, twist = draw.uniform(6.0, 12.0), draw.uniform(10.0, 20.0)
    foot, base = draw.choice((2.5, 2.5, 2.2)), 7.0
    radius, deep = draw.uniform(21.0, 24.0), draw.uniform(0.6, 0.75) * height
    block = cq.Workplane("XY").box(
        chord + 24.0, 2.1 * radius, base + deep, centered=(True, True, False)
    )
    channel = cq.Workplane("YZ").center(0, radius).circle(radius).extrude(100.0, both=True)
    levels = [-2.0 + (height + 2.0) * k / 4 for k in range(5)]
    loft = _lofted(
        "XY",
        levels,
        [
            Section(
                chord=chord,
                thickness=thickness,
                camber=camber,
                angle=twist * z / height,
                middle=(0.0, (z - 0.5 * height) * tan(radians(lean))),
            )
            for z in levels
        ],
    )
    part = block.translate((0, 0, -base)).cut(channel).union(loft)
    return (
        _footed(part, foot, lambda p: abs(hypot(p.y, p.z - radius) - radius), 0.4 * chord + 4.0),
        foot,
        {"blade": 1},
    )


def _fan_drawn(draw: Random) -> Drawn:
    count = draw.choice((5, 6, 6, 7))
    hub = (1.9 + 0.1 * draw.random()) * count + 2.5
    radius, chord = hub + draw.uniform(14.0, 17.0), draw.uniform(14.0, 16.0)
    height, foot = chord + 7.0, 2.0
    pitch, twist = draw.uniform(62.0, 70.0), draw.uniform(4.0, 10.0)
    thickness, camber = draw.uniform(3.0, 3.4), draw.uniform(0.4, 1.0)
    section = Section(
        chord=chord, thickness=thickness, camber=camber, angle=pitch, middle=(0.0, 0.5 * height)
    )
    one = _stood_out(section, hub, radius, height, twist)
    part = cq.Workplane("XY").circle(hub).extrude(height)
    for k in range(count):
        part = part.union(one.rotate((0, 0, 0), (0, 0, 1), 360.0 * k / count))
    return _on_hub(part, hub, radius, foot), foot, {"blade": count}


def _split_fan_drawn(draw: Random) -> Drawn:
    count, every = draw.choice(((4, 1), (5, 1), (6, 1), (7, 1), (6, 2), (8, 2)))
    hub, chord = draw.uniform(3.2, 3.8) * count, draw.uniform(15.0, 18.0)
    span, height = draw.uniform(1.0, 1.3) * chord, chord + 7.0
    smaller, foot = draw.uniform(0.4, 0.65), draw.choice((0.0, 0.0, 1.0))
    blade = Section(
        chord=chord,
        thickness=draw.uniform(2.0, 2.6),
        camber=draw.uniform(0.4, 1.0),
        angle=draw.uniform(66.0, 76.0),
        middle=(0.0, 0.5 * height),
    )
    splitter = replace(
        blade,
        chord=smaller * chord,
        middle=(0.0, 0.5 * height + draw.uniform(-0.5, 0.5) * (1.0 - smaller) * chord),
    )
    twist, turn = draw.uniform(0.0, 8.0), 360.0 / count
    large = _stood_out(blade, hub, hub + span, height, twist)
    small = _stood_out(splitter, hub, hub + smaller * span, height, twist)
    part = cq.Workplane("XY").circle(hub).extrude(height)
    for k in range(count):
        part = part.union(large.rotate((0, 0, 0), (0, 0, 1), turn * k))
        if k % every == 0:
            part = part.union(small.rotate((0, 0, 0), (0, 0, 1), turn * (k + 0.5)))
    part = _on_hub(part, hub, hub + span, foot) if foot else part
    return (
        cq.Workplane(placed(draw, part.solids().val())),
        foot,
        {"blade": count, "splitter": count // every},
    )


def _stood_out(
    section: Section, hub: float, radius: float, height: float, twist: float
) -> cq.Workplane:
    """Return a blade along x from inside a hub out to a radius (mm), its section turned back by `twist` (degrees) on the way."""
    away = [hub - 5.0, 0.5 * (hub + radius), radius + 3.0]
    sections = [
        replace(section, angle=section.angle - twist * (r - hub) / (radius - hub)) for r in away
    ]
    within = cq.Workplane("XY").circle(radius).extrude(height)
    return _lofted("YZ", away, sections).intersect(within)


def _on_hub(part: cq.Workplane, hub: float, radius: float, foot: float) -> cq.Workplane:
    return _footed(part, foot, lambda p: abs(hypot(p.x, p.y) - hub), radius)


def _lofted(plane: str, levels: Sequence[float], sections: Sequence[Section]) -> cq.Workplane:
    """Return the solid through sections at levels along a plane's normal."""
    sheet, before = cq.Workplane(plane), 0.0
    for level, section in zip(levels, sections, strict=True):
        sheet = section.drawn(sheet.workplane(offset=level - before))
        before = level
    return sheet.loft(ruled=False, combine=True)


def _footed(
    part: cq.Workplane, foot: float, off: Callable[[cq.Vector], float], within: float
) -> cq.Workplane:
    """Return a part with its roots rounded: curved edges on what the blades stand on, as far as `off` says, and within a radius in plan;
    as it is where the kernel can't."""
    roots = [
        e
        for e in part.edges().vals()
        if e.geomType() == "BSPLINE"
        and all(off(p) < ON and hypot(p.x, p.y) < within for p in e.positions((0.0, 0.3, 0.6, 1.0)))
    ]
    return cq.Workplane(part.val().fillet(foot, roots))
