"""The drive geometry of finishing beside slicing at every layer, on a panel with leaning walls: the comparison of the drive geometry paper.

Guide lines come from the boundaries of faces; what is roughed of pockets whose walls lean is sliced at every layer.
"""

from __future__ import annotations

import tempfile
import time
import tracemalloc
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from seeded.leaning_panels import leaning_panel
from trunnion.model.session import Session
from trunnion.pipeline import Engine

SEED, QUICK_SEED = 500, 503
"""Random panels that no test holds."""
ROUGHING = "plane.rough"


def drive_geometry(quick: bool) -> Iterator[dict[str, Any]]:
    """Yield the CPU time and the peak memory of guide lines of all operations but roughing, as shares of those of roughing's layers."""
    seed = QUICK_SEED if quick else SEED
    with tempfile.TemporaryDirectory() as folder:
        part = leaning_panel(seed).written(Path(folder))
        (lines, layers), (lines_mb, layers_mb) = measured(part)
    words = {"part": f"leaning panel {seed}", "ratio_to": "slicing at every layer"}
    yield {
        "name": "drive geometry",
        "seconds": lines,
        "ratio": lines / layers,
        "goal": "<= 0.2",
        **words,
    }
    yield {
        "name": "drive geometry, memory",
        "seconds": lines,
        "ratio": lines_mb / layers_mb,
        "goal": "<= 0.5",
        **words,
    }


def measured(part: Path) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the CPU seconds, and the peak memory in MB, of the guide lines of all operations but roughing, and of roughing's; each from a
    part that nothing was asked of before."""
    return (
        (_seconds(part, roughing=False), _seconds(part, roughing=True)),
        (_peak(part, roughing=False), _peak(part, roughing=True)),
    )


def _seconds(part: Path, *, roughing: bool) -> float:
    engine, session, ids = _operations(part, roughing)
    began = time.process_time()
    for id in ids:
        engine.guides(session, id)
    return time.process_time() - began


def _peak(part: Path, *, roughing: bool) -> float:
    engine, session, ids = _operations(part, roughing)
    tracemalloc.start()
    try:
        for id in ids:
            engine.guides(session, id)
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


def _operations(part: Path, roughing: bool) -> tuple[Engine, Session, list[str]]:
    """Return an engine with a part as read, its planned session, and the ids of its operations, those that rough or the others."""
    planner = Engine()
    planned = planner.run(planner.open(part), until="optimize")
    assert planned.process is not None
    engine = Engine()
    engine.open(part)
    ids = [o.id for o in planned.process.operations if (o.strategy == ROUGHING) is roughing]
    return engine, planned, ids
