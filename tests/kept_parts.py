"""A small panel whose features keep material on purpose: two pockets with walls in common behind a low rib, and an island in one."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.allowances import with_feature_allowance

LENGTH, WIDTH, HIGH = 130.0, 80.0, 20.0
FLOOR, RIB, ISLAND = 5.0, 13.0, 15.0
"""mm: heights of the pockets' floors, the rib's top and the island's."""
WALL_KEPT, FLOOR_KEPT = 0.3, 0.2


def ribbed_shape() -> Any:
    """Return the solid (cadquery): a low rib across a pocket, an island right of it."""
    import cadquery as cq

    def block(long: float, wide: float, high: float, x: float, radius: float) -> Any:
        made = cq.Workplane().box(long, wide, high, centered=(True, True, False))
        if radius:
            made = made.edges("|Z").fillet(radius)
        return made.translate((x, 0.0, FLOOR))

    shape = cq.Workplane().box(LENGTH, WIDTH, HIGH, centered=(True, True, False))
    shape = shape.edges("|Z").fillet(8.0)
    shape = shape.cut(block(LENGTH - 16.0, WIDTH - 16.0, HIGH, 0.0, 8.0))
    shape = shape.union(block(4.0, WIDTH - 15.0, RIB - FLOOR, -12.0, 0.0))
    return shape.union(block(16.0, 16.0, ISLAND - FLOOR, 26.0, 4.0))


def ribbed_file(file: Path) -> Path:
    """Write the part and return the file."""
    import cadquery as cq

    cq.exporters.export(ribbed_shape(), str(file))
    return file


@cache
def recognised() -> tuple[Engine, Session]:
    """Return an engine and the session of the part with its features."""
    engine = Engine()
    with TemporaryDirectory() as folder:
        session = engine.open(ribbed_file(Path(folder) / "ribbed.step"))
    session = replace(session, choices={"recognize.family": "panel", "repair.rounds": 0})
    return engine, engine.run(session, until="recognize")


def pocket_with_island(session: Session) -> str:
    """Return the id of the pocket that the island stands in."""
    island = next(f for f in session.recognition if f.kind == "island")
    return str(island.attributes.get("in", island.sizes.get("in")))


@cache
def kept() -> tuple[Engine, Session]:
    """Return an engine and the proven session in which the pocket with the island and the outline keep material."""
    engine, session = recognised()
    pocket = pocket_with_island(session)
    session = with_feature_allowance(
        session, [pocket], wall_allowance=WALL_KEPT, floor_allowance=FLOOR_KEPT
    )
    session = with_feature_allowance(session, ["profile-01"], wall_allowance=WALL_KEPT)
    return engine, engine.run(session, until="verify")


@cache
def plain() -> tuple[Engine, Session]:
    """Return an engine and the proven session of the part that keeps nothing."""
    engine, session = recognised()
    return engine, engine.run(session, until="verify")
