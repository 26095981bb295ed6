"""Prisms that the package in `tests/faulty` crashes at, and the environment of processes that find it."""

from __future__ import annotations

import os
from pathlib import Path

import cadquery as cq

FOLDER = Path(__file__).resolve().parent / "faulty"
SIDES = {"crash": 5, "memory": 7, "sleep": 9}
"""Sides of the prisms by what happens to who looks at them, as in the package."""


def prism(fault: str, file: Path) -> Path:
    """Write the prism at which a fault happens as STEP and return the file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    solid = cq.Workplane("XY").polygon(SIDES[fault], 40.0).extrude(10.0)
    cq.exporters.export(solid, str(file))
    return file


def python_path() -> str:
    """Return the `PYTHONPATH` of processes that find the package."""
    return os.pathsep.join([str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])])
