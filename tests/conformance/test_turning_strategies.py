"""What every registered strategy that turns the work must do, whoever wrote it, on a ring between flanges."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from own_packages import with_own_packages
from subjects import TURNING, check_settings
from trunnion import registry
from trunnion.findings import Cancelled
from trunnion.model.motion.toolpath import Motion
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import checked, choose
from trunnion.toolpath.contract import Planned
from turned_rings import RING, SETUP, WORK, blank_of, data_of, turning_tool

by_name = pytest.mark.parametrize("name", TURNING)
OFF = 0.5
"""mm beyond the ring on all sides: what a finishing pass takes."""
PROUD = RING + [
    (-OFF, 0.0),
    *[(OFF, 0.0)] * 2,
    (OFF, OFF),
    (OFF, -OFF),
    (OFF, 0.0),
    (OFF, OFF),
    (-OFF, OFF),
]


@cache
def planned(name: str) -> tuple[Planned, ...]:
    """Return what a strategy plans for each of the ring's tools."""
    return tuple(made(name, *work) for work in WORK)


def made(name, side, tool, lowest, progress=NO_PROGRESS) -> Planned:
    with with_own_packages():
        strategy = registry.get("strategies", name)
    words = {"turn.side": side, "turn.lowest": lowest, "turn.floor": min(lowest, 8.0)}
    settings = checked(choose(strategy.settings, words))
    drive = RevolvedDrive(part=RING, to_cut=100.0)
    return strategy(
        drive, turning_tool(tool), data_of(), blank_of(PROUD), SETUP, settings, progress
    )


def paths(name):
    return [p.path for p in planned(name) if len(p.path)]


@by_name
def test_its_settings_say_what_they_are(name):
    with with_own_packages():
        check_settings(registry.get("strategies", name).settings)


@by_name
def test_it_moves_in_its_plane(name):
    assert paths(name)
    for path in paths(name):
        assert path.work_turns and np.isfinite(path.position).all()
        assert (path.position[:, 0] > 0.0).all()


@by_name
def test_it_begins_and_ends_at_the_clearance_height_with_rapids(name):
    for path in paths(name):
        assert path.position[0, 2] == path.position[-1, 2] == SETUP.clearance
        assert path.motion[0] == path.motion[-1] == Motion.RAPID


@by_name
def test_its_rapids_never_go_in_x_and_z_at_once(name):
    for path in paths(name):
        step = np.abs(np.diff(path.position[:, [0, 2]], axis=0))
        rapid = path.motion[1:] == Motion.RAPID
        assert (step[rapid].min(axis=1) < 1e-9).all()


@by_name
def test_arcs_keep_their_radius_from_start_to_end(name):
    for path in paths(name):
        arc = path.motion >= Motion.ARC_CW
        start = np.linalg.norm(path.starts()[arc] - path.centre[arc], axis=1)
        end = np.linalg.norm(path.position[arc] - path.centre[arc], axis=1)
        assert np.allclose(start, end, atol=1e-6)


@by_name
def test_no_block_stands_still(name):
    for path in paths(name):
        assert (path.lengths()[1:] > 1e-6).all()


@by_name
def test_the_same_input_gives_the_same_bytes(name):
    again = made(name, *WORK[0])
    assert again.path.position.tobytes() == planned(name)[0].path.position.tobytes()


@by_name
def test_it_stops_when_it_is_asked_to(name):
    with pytest.raises(Cancelled):
        made(name, *WORK[1], progress=Progress(cancelled=lambda: True))
