"""Areas that an operation avoids: what its cutter can't come to is left out, and its tip stays outside, on boxes worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from clamps import clamp
from surface_forms import plane
from trunnion import tolerance
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.geometry.surface.drop_surface import tops_over
from trunnion.model.keep_out import KeepOutBox, plan_boxes
from trunnion.model.setup import Setup
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.fixtures import off_boxes as off_boxes_on_faces
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive
from trunnion.plan.prismatic.keep_out import PlanBoxes, off_boxes
from trunnion.settings import digest
from trunnion.toolpath.motion.fixture_links import FixtureSurface
from verify_tools import flat

SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=40.0, machine="")
D20 = flat(20.0)()
ROOM = Region.rectangle(0.0, 0.0, 120.0, 80.0)
"""A pocket's walls."""


def box(x0, y0, x1, y1, top=-15.0):
    return KeepOutBox(low=(x0, y0), high=(x1, y1), top=top)


def drive(top=0.0, bottom=-20.0):
    level = DriveLevel(top=top, bottom=bottom, wanted=ROOM, boundary=ROOM)
    floor = Floor(z=bottom, region=ROOM, fillet=0.0, face=7)
    return PlaneDrive(feature="pocket-03", kind="floor", levels=(level,), floors=(floor,))


def tips_in(boxes, z=-20.0):
    """Return how many tips 0.5 mm apart the cutter's envelope lets into boxes, and how far from all boxes it is kept at most."""
    out = PlanBoxes(tuple(boxes)).keeps_out(D20, z, ROOM)
    free = ROOM.minus(out).offset(-D20.radius)
    grid = np.stack(np.meshgrid(np.arange(10.25, 110), np.arange(10.25, 70)), -1).reshape(-1, 2)
    inside = tops_over(grid, plan_boxes(boxes)) > z
    lost = grid[~inside & ~free.contains(grid)]
    gap = np.array(
        [np.hypot(*np.maximum(np.maximum(b.low - lost, lost - b.high), 0.0).T) for b in boxes]
    )
    return int((inside & free.contains(grid)).sum()), float(gap.min(axis=0).max(initial=0.0))


@pytest.mark.parametrize(
    ("boxes", "beyond"),
    [
        # Beside a wall, over its whole length: as exactly as regions are.
        ([box(-5.0, -5.0, 25.0, 85.0)], 0.01),
        ([box(-5.0, -5.0, 12.0, 85.0), box(11.0, -5.0, 25.0, 85.0)], 0.01),
        # In the middle, wide: what is 0.71 radii inside it is kept out of, which shows 0.29 radii beside it.
        ([box(40.0, 20.0, 90.0, 60.0)], 0.3 * 10.0),
        # Narrow: its middle line is kept out of.
        ([box(60.0, 20.0, 62.0, 60.0)], 10.0),
    ],
)
def test_the_tip_stays_out_of_boxes(boxes, beyond):
    met, far = tips_in(boxes)
    assert met == 0 and far <= beyond


def test_what_the_cutter_covers_from_outside_is_still_cut():
    kept, (finding,) = off_boxes(drive(), D20, SETUP, [box(-5.0, -5.0, 25.0, 85.0)])
    upper, lower = kept.levels
    assert (upper.bottom, lower.top, lower.bottom) == (-15.0, -15.0, -20.0)
    assert upper.wanted.area == ROOM.area
    # Tips from x = 25 on cover what is past x = 15, but for the rounding in two corners there; as much in the pocket's own corners was none
    # that the cutter comes to, and is not taken off.
    lost = ROOM.area - lower.wanted.area
    assert lost == approx(15.0 * 80.0, abs=0.1)
    assert kept.floors[0].region.area == approx(lower.wanted.area)
    assert finding.code == "operation.left-out"
    assert f"{lost:.0f} mm2 in plan of pocket-03 at x 12.5" in finding.text
    assert "flat 20 would collide there" in finding.text


def test_over_a_box_and_far_from_it_nothing_changes():
    for far in (box(-5.0, -5.0, 25.0, 85.0, top=-20.0), box(200.0, 0.0, 220.0, 80.0)):
        kept, found = off_boxes(drive(), D20, SETUP, [far])
        assert found == () and len(kept.levels) == 1 and kept.levels[0].wanted.area == ROOM.area


def test_of_a_face_what_is_cut_from_inside_a_box_is_left_out():
    # Two triangles: the box lies between their corners and middles.
    skin = plane(80.0, 60.0)
    kept, tags, lost = off_boxes_on_faces(skin, (1,), D20, [box(8.0, 38.0, 22.0, 52.0, 5.0)], 0.01)
    middles = kept.points[kept.triangles[kept.of(tags)]].mean(axis=1)
    assert lost.area == approx(80.0 * 60.0 - kept.areas(kept.of(tags)).sum())
    assert 14.0 * 14.0 < lost.area < 22.0 * 22.0 and lost.at == approx([15.0, 45.0, 0.0], abs=1.0)
    assert not ((abs(middles[:, 0] - 15.0) < 6.9) & (abs(middles[:, 1] - 45.0) < 6.9)).any()


def test_no_tip_is_dropped_into_a_box():
    boxes = [box(30.0, 20.0, 50.0, 40.0, 5.0)]
    kept, _, _ = off_boxes_on_faces(plane(80.0, 60.0), (1,), D20, boxes, 0.01)
    tips = np.array([[40.0, 30.0], [29.0, 30.0], [31.0, 21.0]])
    assert kept.drop.drop(tips, lower_side(D20), -9.0) == approx([5.0, 0.0, 5.0])


def test_a_box_beside_or_below_a_face_leaves_it_whole():
    for other in (box(90.0, 20.0, 95.0, 40.0, 5.0), box(30.0, 20.0, 50.0, 40.0, -1.0)):
        skin, tags, lost = off_boxes_on_faces(plane(80.0, 60.0), (1,), D20, [other], 0.01)
        assert tags == (1,) and lost is None and skin.areas().sum() == approx(4800.0)


def test_links_go_over_boxes_with_the_tip_alone():
    avoiding = replace(SETUP, avoid=(box(30.0, 20.0, 50.0, 40.0),))
    over = FixtureSurface.of(avoiding)
    a, b, c = np.array([20.0, 30.0]), np.array([60.0, 30.0]), np.array([20.0, 60.0])
    assert over.lowest_tip(D20, a, b) == -15.0
    assert over.lowest_tip(D20, a, c) == over.lowest_tip(D20, a, a) == -math.inf
    both = replace(avoiding, fixtures=(clamp((90, 0, -20), (99, 9, -10)),))
    beside = np.array([95.0, 5.0])
    assert FixtureSurface.of(both).lowest_tip(D20, beside, beside) == approx(
        -10.0 + tolerance.FIXTURE_CLEARANCE
    )
    assert FixtureSurface.of(both).lowest_tip(D20, a, b) == -15.0


def test_a_setup_in_which_nothing_is_avoided_has_the_digest_that_it_had():
    plain = {f: getattr(SETUP, f) for f in ("name", "frame", "work_offset", "clearance", "machine")}
    before = {"": "Setup", **plain, "fixtures": ()}
    assert digest(SETUP) == digest(before)
    assert digest(replace(SETUP, avoid=(box(0.0, 0.0, 1.0, 1.0),))) != digest(SETUP)


def test_a_box_without_area_is_refused():
    with pytest.raises(ValueError, match="it is empty"):
        box(3.0, 0.0, 3.0, 5.0)
