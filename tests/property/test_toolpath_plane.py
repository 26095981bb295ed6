"""Whatever the pocket: passes stay in the room of the axis, nothing of the wanted area is forgotten, arcs are true, rapids are safe."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from milling import SETUP, Milled, box_blank, closed_pocket, cutting, mill
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.floor import FloorSettings, floor
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.plane.wall import WallSettings, wall
from trunnion.toolpath.stock.heightfield import PlanningStock

FEW = settings(deadline=None, max_examples=12, derandomize=True)
BLANK = box_blank((-5, -5, -30), (75, 55, 0))
STOCK = PlanningStock.of(BLANK, SETUP)


@st.composite
def pockets(draw: st.DrawFn) -> Region:
    """An L, T or box of two overlapping rectangles, its corners rounded, often with a round or square island."""
    corner = draw(st.floats(3.0, 9.0))
    first = Region.rectangle(0, 0, draw(st.floats(30, 70)), draw(st.floats(25, 50)))
    x, y = draw(st.floats(0, 30)), draw(st.floats(0, 20))
    second = Region.rectangle(
        x, y, min(x + draw(st.floats(25, 60)), 70), min(y + draw(st.floats(25, 45)), 50)
    )
    plan = first.union(second).opened(corner)
    if draw(st.booleans()):
        at = (draw(st.floats(15, 40)), draw(st.floats(12, 30)))
        plan = plan.minus(Region.circle(at, draw(st.floats(2, 8))))
    return plan


cutters = st.sampled_from([(8.0, 0.0), (8.0, 2.0), (12.0, 0.0), (16.0, 3.0)])


def lowered(path: Toolpath) -> np.ndarray:
    """Return the places (k, 2) on feed moves below the blank's top, arcs included."""
    from trunnion.toolpath.stock.heightfield import chords

    starts, ends, _, _ = chords(path)
    below = np.minimum(starts[:, 2], ends[:, 2]) < -1e-6
    return np.vstack([starts[below, :2], ends[below, :2]])


@pytest.mark.examples(4)
@FEW
@given(pockets(), cutters, st.floats(2.0, 12.0))
def test_roughing_stays_in_its_room_clears_it_and_never_crosses_material_at_rapid(
    plan: Region, cutter: tuple[float, float], width: float
) -> None:
    tool = mill(*cutter)
    room = plan.offset(-tool.radius - 0.3)
    assume(bool(room))
    drive = closed_pocket(plan, 8.0, cutter[1], wall_allowance=0.3, floor_allowance=0.3)
    path = rough(drive, tool, cutting(5.0, width), STOCK, SETUP, RoughSettings(), NO_PROGRESS).path
    assert room.signed_distance(lowered(path)).min() > -2e-3
    milled = Milled((-5, -5), (75, 55), 0.0, cell=1.0).cut(path, tool)
    flat = room.offset(tool.radius - tool.corner_radius - 0.05)
    inside = flat.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert (
        milled.height[inside].max(initial=-8.0) < -7.7 + (0.3 if tool.corner_radius else 0.0) + 1e-6
    )
    assert milled.crashes == []


@pytest.mark.examples(5)
@FEW
@given(pockets(), cutters)
def test_floor_and_wall_stay_in_their_room(plan: Region, cutter: tuple[float, float]) -> None:
    tool = mill(*cutter)
    room = plan.offset(-tool.radius)
    assume(bool(plan.offset(-tool.radius - 0.5)))
    drive = closed_pocket(plan, 8.0, cutter[1])
    for strategy, chosen in ((floor, FloorSettings()), (wall, WallSettings())):
        path = strategy(drive, tool, cutting(5.0, 4.0), STOCK, SETUP, chosen, NO_PROGRESS).path
        assert room.signed_distance(lowered(path)).min() > -2e-3


@FEW
@given(pockets(), cutters)
def test_arcs_keep_their_radius_and_no_block_goes_nowhere(
    plan: Region, cutter: tuple[float, float]
) -> None:
    tool = mill(*cutter)
    assume(bool(plan.offset(-tool.radius - 0.3)))
    drive = closed_pocket(plan, 8.0, cutter[1], wall_allowance=0.3)
    path = rough(drive, tool, cutting(5.0, 4.0), STOCK, SETUP, RoughSettings(), NO_PROGRESS).path
    arcs = path.motion >= Motion.ARC_CW
    radii = [
        np.linalg.norm(p[arcs, :2] - path.centre[arcs, :2], axis=1)
        for p in (path.starts(), path.position)
    ]
    assert np.abs(radii[0] - radii[1]).max(initial=0.0) < 1e-6
    assert path.lengths()[1:].min() >= 1e-4
    assert np.abs(path.sweeps()).max() < 3.6
