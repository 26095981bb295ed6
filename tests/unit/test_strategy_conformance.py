"""What every registered strategy must meet, unasked: looked at on all operations of a small panel."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion import registry
from trunnion.model.toolpath import Motion
from trunnion.pipeline import Engine
from trunnion.pipeline.toolpaths import make_paths


@pytest.fixture(scope="module")
def programmed(sample_panel):
    """An engine and its session of the small panel, with toolpaths."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="toolpath")


def paths_by_strategy(session):
    operations = {o.id: o for o in session.process.operations}
    return [(operations[p.operation], p.path) for p in session.paths]


def test_the_small_panel_uses_every_plane_strategy_of_the_plan(programmed) -> None:
    used = {o.strategy for o in programmed[1].process.operations}
    plane = {name for name in registry.names("strategies") if name.startswith("plane.")}
    assert used >= plane - {"plane.corner"}


def test_every_operation_moves(programmed) -> None:
    assert [o.id for o, path in paths_by_strategy(programmed[1]) if len(path) == 0] == []


def test_every_path_starts_and_ends_at_the_clearance_height(programmed) -> None:
    clearance = programmed[1].setups[0].clearance
    for operation, path in paths_by_strategy(programmed[1]):
        assert path.motion[0] == Motion.RAPID, operation.id
        assert path.position[[0, -1], 2] == pytest.approx([clearance] * 2), operation.id


def test_a_rapid_never_moves_in_xy_and_z_at_once(programmed) -> None:
    for operation, path in paths_by_strategy(programmed[1]):
        steps = np.abs(path.position - path.starts())[path.motion == Motion.RAPID]
        assert not ((steps[:, :2].max(axis=1) > 1e-9) & (steps[:, 2] > 1e-9)).any(), operation.id


def test_arcs_keep_their_radius_from_start_to_end(programmed) -> None:
    for operation, path in paths_by_strategy(programmed[1]):
        arcs = path.motion >= Motion.ARC_CW
        at_start = np.linalg.norm((path.starts() - path.centre)[arcs, :2], axis=1)
        at_end = np.linalg.norm((path.position - path.centre)[arcs, :2], axis=1)
        assert at_end == pytest.approx(at_start, abs=1e-6), operation.id


def test_no_block_stands_still(programmed) -> None:
    for operation, path in paths_by_strategy(programmed[1]):
        assert (path.lengths()[1:] > 1e-4).all(), operation.id


def test_the_same_input_gives_the_same_bytes(programmed) -> None:
    engine, session = programmed
    from dataclasses import replace

    again = make_paths(replace(session, paths=()), engine.context, progress=_quiet())
    assert [p.path.position.tobytes() for p in again] == [
        p.path.position.tobytes() for p in session.paths
    ]
    assert [p.key for p in again] == [p.key for p in session.paths]


def _quiet():
    from trunnion.progress import QUIET

    return QUIET
