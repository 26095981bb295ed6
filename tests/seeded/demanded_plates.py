"""Random plates with holes that a drawing demands fits and threads of: through and blind, countersunk, from above or below.

Demands go by diameter, as a drawing's notes do. The part that a shop gets is a project, in which a person has typed them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians, tan
from pathlib import Path
from random import Random
from typing import Any

import cadquery as cq

from seeded.parts import UNITS, Seeded, placed
from trunnion.plan.holes.demand import fit_demand, thread_demand
from trunnion.plan.holes.settings import HoleDemand

THREADS = {
    "M4": 3.3,
    "M5": 4.2,
    "M6": 5.0,
    "M8": 6.8,
    "M8x1": 7.0,
    "M10": 8.5,
    "M12": 10.2,
    "M12x1.5": 10.5,
    "M16": 14.0,
    "M20": 17.5,
    "M24": 21.0,
    "M27x2": 25.0,
    "1/4-20 UNC": 5.1,
    "3/8-24 UNF": 8.5,
}
"""Threads, and the diameters in mm of their bores in usual tables of tap drills (ISO 2306)."""
FITS = (
    "H7",
    "H7",
    "H7",
    "H8",
    "H6",
    "F7",
    "K7",
    "M7",
    "N7",
    "P7",
    "JS7",
    "H11",
    "+0.03/0",
    "-0.01/-0.03",
)
BORES = (4.0, 5.0, 6.0, 7.5, 8.0, 9.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 25.0, 11.3, 12.7)
"""mm: diameters of bores with a fit; most are round numbers."""
MATERIALS = ("EN AW-7075", "EN AW-7075", "Ti-6Al-4V", "Inconel 718", "C45")
SPACING = 36.0
"""mm between the middles of neighbouring holes."""
FLOOR = 3.0
"""mm of material under a blind hole at least."""
POINT = 140.0
"""Degrees at the end of blind holes that a drill made."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bore:
    """Holes of one diameter (mm) with what is demanded of them."""

    diameter: float
    demand: HoleDemand
    through: bool
    depth: float
    """mm of its full diameter."""
    flat: bool
    """Whether a blind one has a flat floor in the place of a drill's cone."""
    sink: float
    """Diameter (mm) of the countersink at its mouth, 0 for none."""


@dataclass(frozen=True, slots=True)
class DemandedPlate(Seeded):
    """A plate with its bores."""

    bores: tuple[Bore, ...]
    material: str

    def written(self, folder: Path) -> Path:
        """Return a project in a folder in which the demands stand."""
        from trunnion.pipeline import Engine
        from trunnion.pipeline.planning.hole_demands import with_hole_demand

        engine = Engine()
        session = engine.open(Seeded.written(self, folder))
        session = replace(session, choices={"blank.material": self.material})
        session = engine.run(session, until="recognize")
        for bore in self.bores:
            ids = [
                f.id
                for f in session.recognition
                if f.kind == "hole" and abs(f.sizes["diameter"] - bore.diameter) < 1e-3
            ]
            session = with_hole_demand(engine, session, ids, bore.demand)
        path = folder / f"{self.name}.trunnion"
        engine.save(session, path)
        return path


def demanded_plate(seed: int) -> DemandedPlate:
    """Return the random plate of a seed."""
    draw = Random(f"demanded {seed}")
    columns, rows = draw.choice(((2, 2), (3, 2), (4, 2), (3, 3)))
    thick = draw.choice((12.0, 16.0, 20.0, 25.0, 32.0, 40.0))
    size = (columns + 1) * SPACING, (rows + 1) * SPACING
    solid = cq.Workplane().box(*size, thick, centered=False)
    bores = _bores(draw, thick)
    under = draw.random() < 0.3
    for k in range(columns * rows):
        bore = bores[k % len(bores)]
        at = (SPACING * (1 + k % columns), SPACING * (1 + k // columns))
        cut = _hole(bore, thick)
        # Some of the blind ones open at the underside.
        if under and not bore.through and k % 2:
            cut = cut.rotate((0, 0, 0.5 * thick), (1, 0, 0.5 * thick), 180.0)
        solid = solid.cut(cut.translate((*at, 0.0)))
    shape = placed(draw, solid.solids().val())
    return DemandedPlate(
        f"demanded-{seed:02d}",
        shape.wrapped,
        draw.choice(UNITS),
        {"hole": columns * rows},
        min(0.5 * b.diameter for b in bores),
        tuple(bores),
        draw.choice(MATERIALS),
    )


def _bores(draw: Random, thick: float) -> Sequence[Bore]:
    """Return two to four bores of different diameters."""
    found: dict[float, Bore] = {}
    for _ in range(draw.randint(2, 4)):
        open_below = draw.random() < 0.5
        if draw.random() < 0.55:
            name = draw.choice(sorted(THREADS))
            diameter = THREADS[name]
            depth = min(draw.uniform(2.2, 3.6) * diameter, _room(diameter, thick))
            wanted = 0.0 if draw.random() < 0.3 else round(draw.uniform(0.4, 0.6) * depth, 1)
            demand = thread_demand(name, wanted)
        else:
            diameter = draw.choice(BORES)
            depth = min(draw.uniform(1.0, 2.5) * diameter, _room(diameter, thick))
            demand = fit_demand(draw.choice(FITS))
        found[diameter] = Bore(
            diameter=diameter,
            demand=demand,
            through=open_below or depth < diameter,
            depth=round(depth, 1),
            flat=draw.random() < 0.2,
            sink=round(1.3 * diameter, 1) if diameter < 16.0 and draw.random() < 0.3 else 0.0,
        )
    return list(found.values())


def _room(diameter: float, thick: float) -> float:
    """Return how deep in mm a blind hole with a drill's cone may be in a plate."""
    return thick - FLOOR - 0.5 * diameter / tan(radians(0.5 * POINT))


def _hole(bore: Bore, thick: float) -> Any:
    """Return what a bore takes out of a plate from its top, its axis along z through the origin."""
    radius, down = 0.5 * bore.diameter, cq.Vector(0, 0, -1)
    depth = thick + 1.0 if bore.through else bore.depth
    made = cq.Workplane(
        cq.Solid.makeCylinder(radius, depth + 1.0, cq.Vector(0, 0, thick + 1.0), down)
    )
    if not (bore.through or bore.flat):
        tip = radius / tan(radians(0.5 * POINT))
        end = cq.Vector(0, 0, thick - bore.depth)
        made = made.union(cq.Workplane(cq.Solid.makeCone(radius, 0.0, tip, end, down)))
    if bore.sink:
        deep = 0.5 * bore.sink - radius
        cone = cq.Solid.makeCone(0.5 * bore.sink, radius, deep, cq.Vector(0, 0, thick), down)
        made = made.union(cq.Workplane(cone))
    return made
