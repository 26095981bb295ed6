"""Discs for the family of `tests/families`: a plate turned round, bevelled, with a closed slot in one end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cadquery as cq

DIAMETER, HEIGHT, BEVEL = 60.0, 12.0, 2.0
SLOT_LENGTH, SLOT_WIDTH, SLOT_DEPTH = 34.0, 16.0, 5.0


def turned_disc_shape() -> Any:
    """Return the disc: its axis is z, its bottom at 0, the slot along x in the middle of its top."""
    disc = (
        cq.Workplane("XY").circle(DIAMETER / 2).extrude(HEIGHT).faces(">Z").edges().chamfer(BEVEL)
    )
    slot = cq.Workplane("XY", origin=(0, 0, HEIGHT)).slot2D(SLOT_LENGTH, SLOT_WIDTH)
    return disc.cut(slot.extrude(-SLOT_DEPTH)).val().wrapped


def turned_disc(folder: Path) -> Path:
    """Write the disc as STEP into a folder and return the file."""
    from trunnion.part.write import write_step

    write_step(turned_disc_shape(), folder / "disc.step")
    return folder / "disc.step"
