"""A block with a pocket that has a pit in one wall, for the tests of what cuts it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import cadquery as cq

from trunnion.model.session import Session
from trunnion.pipeline import Engine

FLOOR, POCKET = 4.0, (70.0, 44.0, 26.0)
"""mm: height of the pocket's floor, and length, width and depth of the pocket."""


def pitted_shape(pit: Any) -> Any:
    """Return the block, its pocket open upwards and its middle at the origin, with what is taken out of a wall."""
    size = [v + 2.0 * 12.0 for v in POCKET[:2]]
    block = cq.Workplane().box(*size, FLOOR + POCKET[2], centered=(True, True, False))
    hollow = cq.Workplane(origin=(0, 0, FLOOR)).box(*POCKET, centered=(True, True, False))
    return block.cut(hollow.edges("|Z").fillet(8.0)).cut(pit)


def pit_in_wall(
    length: float = 40.0,
    depth: float = 3.0,
    low: float = 10.0,
    high: float = 18.0,
    corner: float = 3.0,
) -> Any:
    """Return what a pit between two heights takes out of the wall at the back; `corner` is the radius at its ends."""
    deep = depth + 20.0
    back = 0.5 * POCKET[1] + depth
    box = cq.Workplane(origin=(0.0, back - 0.5 * deep, low)).box(
        length, deep, high - low, centered=(True, True, False)
    )
    return box.edges("|Z").fillet(corner) if corner else box


def opened(shape: Any) -> tuple[Engine, Session]:
    """Return an engine and a session with a shape, taken for a panel."""
    engine = Engine()
    with TemporaryDirectory() as folder:
        file = Path(folder) / "pitted.step"
        cq.exporters.export(shape, str(file))
        session = engine.open(file)
    return engine, engine.with_choices(session, {"recognize.family": "panel"})


@cache
def pitted_block() -> tuple[Engine, Session]:
    """Return an engine and the session of the block with a pit, up to its toolpaths."""
    engine, session = opened(pitted_shape(pit_in_wall()))
    return engine, engine.run(session, until="toolpath")
