"""From passes to toolpaths: leads that touch, ways that stay down or go over, and an order that saves air."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from surface_drives import DATA, driven, grid, joined
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.tolerance import FINISH_GOUGE
from trunnion.toolpath.contact_passes.linking.leads import LEAD_CHORD
from trunnion.toolpath.contact_passes.linking.link_passes import linked
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from verify_tools import bull

BALL = bull(6.0, 3.0)()
MANNER = LinkParameters(stepover=0.5, lead_radius=1.0)


def straight(start, end, axis=UPRIGHT, normal=UPRIGHT, closed=False):
    tips = np.array([start, end], dtype=float)
    return Pass(tip=tips, axis=np.tile(axis, (2, 1)), normal=np.tile(normal, (2, 1)), closed=closed)


def level_drive():
    return driven(grid(lambda x, y: 0.0 * x, n=4))


def made(passes, manner=MANNER, drive=None):
    drive, setup, stock = drive or level_drive()
    return linked(passes, drive, BALL, DATA, stock, setup, manner), drive, setup


def deepest_feed(path, drive) -> float:
    """Return how far in mm moves at feed come below the dropped cutter, by places close together on each."""
    fed = np.flatnonzero(path.motion[1:] != Motion.RAPID)
    share = np.linspace(0.0, 1.0, 200)[:, None, None]
    on = path.position[fed] + share * (path.position[fed + 1] - path.position[fed])
    floor = drive.skin.drop.drop(on.reshape(-1, 3)[:, :2], lower_side(BALL), -9.0)
    return float((floor - on.reshape(-1, 3)[:, 2]).max())


def test_a_path_begins_and_ends_at_clearance_and_comes_in_on_a_quarter_circle() -> None:
    path, _, setup = made([straight((5, 10, 0), (25, 10, 0))])
    assert path.position[0] == pytest.approx([4.0, 10.0, setup.clearance])
    assert path.motion[[0, -1]].tolist() == [Motion.RAPID] * 2
    assert path.position[-1] == pytest.approx([26.0, 10.0, setup.clearance])
    leads = path.position[path.mark == Mark.LEAD]
    ahead = leads[leads[:, 0] < 5.0]
    # A circle of 1 mm about (5, 10, 1) that ends level, at the pass.
    assert np.hypot(ahead[:, 0] - 5.0, ahead[:, 2] - 1.0) == pytest.approx(np.ones(len(ahead)))
    middle = 0.5 * (ahead[1:] + ahead[:-1])
    assert np.hypot(middle[:, 0] - 5.0, middle[:, 2] - 1.0).min() > 1.0 - LEAD_CHORD
    cut = path.position[path.mark == Mark.CUT]
    assert cut[-1] == pytest.approx([25.0, 10.0, 0.0])


@pytest.mark.parametrize(("radius", "most"), [(0.3, 4), (1.0, 8), (10.0, 16)])
def test_small_leads_are_of_few_chords(radius, most) -> None:
    path, *_ = made([straight((12, 15, 0), (18, 15, 0))], replace(MANNER, lead_radius=radius))
    lead = path.position[(path.mark == Mark.LEAD) & (path.position[:, 0] > 18.0)]
    assert len(lead) == most
    assert lead[-1] == pytest.approx([18.0 + radius, 15.0, radius])
    between = 0.5 * (lead[1:] + lead[:-1]) - [18.0, 15.0, radius]
    assert np.linalg.norm(between, axis=1).min() >= radius - max(LEAD_CHORD, 0.0013 * radius)


def test_only_leads_that_touch_something_are_shorter() -> None:
    """Whatever of a leaning tool's way lies beyond x = 18.5 is not clear."""
    lean = np.array([math.sin(0.1), 0.0, math.cos(0.1)])
    ends = (12.0, 18.0, 18.5)
    passes = [straight((6, 5 + 8 * k, 0), (x, 5 + 8 * k, 0), axis=lean) for k, x in enumerate(ends)]

    def query(tip, axis, *, start_tip=None, start_axis=None):
        assert np.abs(tip - start_tip).max() < 1.0
        return np.maximum(tip[:, 0], start_tip[:, 0]) <= 18.5

    path, *_ = made(passes, replace(MANNER, query=query))
    for k, radius in enumerate((1.0, 0.4, 0.0)):
        beside = np.abs(path.position[:, 1] - 5.0 - 8.0 * k) < 1e-9
        lead = path.position[beside & (path.mark == Mark.LEAD) & (path.position[:, 0] > 11.0)]
        assert lead[:, 0].max(initial=ends[k]) == pytest.approx(ends[k] + radius)
        first = path.position[beside & (path.mark == Mark.LEAD)][0]
        assert first[0] == pytest.approx(5.0)


def test_a_pass_that_begins_nearby_is_reached_over_the_surface() -> None:
    path, *_ = made([straight((5, 10, 0), (25, 10, 0)), straight((25, 10.5, 0), (5, 10.5, 0))])
    assert (path.motion == Motion.RAPID).sum() == 3
    assert path.position[path.mark == Mark.LINK][:, 2].max() == pytest.approx(0.0)


def test_a_far_pass_is_reached_above_the_stock() -> None:
    path, drive, _ = made([straight((5, 5, 0), (25, 5, 0)), straight((5, 20, 0), (25, 20, 0))])
    over = path.position[1:-1][path.motion[1:-1] == Motion.RAPID]
    assert over[:, 2].min() == pytest.approx(drive.high[2] + MANNER.safety)


def test_a_link_over_a_ridge_is_lifted_and_one_over_a_dip_is_not_lowered() -> None:
    ridge = driven(grid(lambda x, y: np.maximum(0.0, 1.0 - np.abs(y - 15.0)), n=60))
    wide = LinkParameters(stepover=3.0)
    path, drive, _ = made(
        [straight((5, 11, 0), (15, 11, 0)), straight((15, 19, 0), (5, 19, 0))], wide, ridge
    )
    way = path.position[path.mark == Mark.LINK]
    floor = drive.skin.drop.drop(way[:, :2], lower_side(BALL), -9.0)
    assert way[:, 2].max() == pytest.approx(1.0, abs=1e-2) and (way[:, 2] >= floor - 1e-9).all()
    dip = driven(grid(lambda x, y: -2.0 * np.exp(-0.5 * (y - 15.0) ** 2), n=60))
    path, *_ = made(
        [straight((5, 11, 0), (15, 11, 0)), straight((15, 19, 0), (5, 19, 0))], wide, dip
    )
    assert path.position[path.mark == Mark.LINK][:, 2].min() == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("arcs", [True, False])
def test_no_way_between_passes_enters_the_part_by_what_these_may_leave_their_curves(arcs) -> None:
    """Passes at a coarse scallop have chords of more than the limit of gouges."""
    plateau = driven(grid(lambda x, y: np.where(np.abs(y - 15.0) < 4.0, 0.03, 0.0), n=60))
    side = np.array([0.0, -1.0, 0.0])
    passes = [
        straight((5, 5, 0), (15, 5, 0), normal=side),
        straight((15, 25, 0), (5, 25, 0), normal=-side),
    ]
    manner = LinkParameters(stepover=20.0, lead_radius=1.0, chord=0.05, arcs=arcs)
    path, drive, _ = made(passes, manner, plateau)
    assert deepest_feed(path, drive) <= FINISH_GOUGE


def test_a_rising_link_between_leads_does_not_cut_the_rim_of_what_it_goes_over() -> None:
    """The rim lies between two of the positions that leads are tested at; the chord is over what it goes to by then."""
    rim = driven(grid(lambda x, y: np.where(y > 13.2, 1.0, -3.0), n=60))
    out, back = np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0])
    passes = [
        straight((5, 6, -0.8), (15, 6, -0.8), normal=back),
        straight((15, 26, 4.0), (5, 26, 4.0), normal=out),
    ]
    manner = LinkParameters(stepover=20.0, lead_radius=1.0, arcs=True)
    path, drive, _ = made(passes, manner, rim)
    assert deepest_feed(path, drive) <= FINISH_GOUGE


def test_leads_never_come_below_the_dropped_cutter() -> None:
    drive = driven(grid(lambda x, y: 0.05 * (x - 15.0) ** 2))
    x = np.linspace(8.0, 22.0, 40)
    tip = np.column_stack(
        [
            x,
            np.full(40, 15.0),
            drive[0].skin.drop.drop(
                np.column_stack([x, np.full(40, 15.0)]), lower_side(BALL), -9.0
            ),
        ]
    )
    path, drive, _ = made(
        [Pass(tip=tip, axis=np.tile(UPRIGHT, (40, 1)), normal=np.tile(UPRIGHT, (40, 1)))],
        LinkParameters(stepover=1.0, lead_radius=5.0),
        drive,
    )
    leads = path.position[path.mark == Mark.LEAD]
    assert (leads[:, 2] >= drive.skin.drop.drop(leads[:, :2], lower_side(BALL), -9.0) - 1e-9).all()


def test_nearest_passes_come_first_and_may_be_turned_round() -> None:
    passes = [
        straight((0, 0, 0), (10, 0, 0)),
        straight((0, 2, 0), (10, 2, 0)),
        straight((0, 0.5, 0), (10, 0.5, 0)),
    ]
    path, *_ = made(passes, LinkParameters(stepover=0.5, order="nearest", reversing=True))
    ends = path.position[path.mark == Mark.CUT]
    # A pass's first tip is the end of the way to it.
    assert ends[:, :2].tolist() == [[10.0, 0.0], [0.0, 0.5], [10.0, 2.0]]


def test_a_closed_pass_begins_where_it_is_nearest_to_the_one_before() -> None:
    turn = np.linspace(0.0, 2 * math.pi, 41)
    circle = np.column_stack([15 + 5 * np.cos(turn), 15 + 5 * np.sin(turn), 0 * turn])
    loop = Pass(
        tip=circle, axis=np.tile(UPRIGHT, (41, 1)), normal=np.tile(UPRIGHT, (41, 1)), closed=True
    )
    path, *_ = made([straight((2, 15, 0), (9.5, 15, 0)), loop])
    cuts = path.position[path.mark == Mark.CUT]
    assert cuts[-1] == pytest.approx([10.0, 15.0, 0.0], abs=1e-6)


def test_a_leaning_tool_leaves_along_its_axis_and_turns_only_at_clearance() -> None:
    lean = math.radians(30.0)
    one = np.array([math.sin(lean), 0.0, math.cos(lean)])
    passes = [
        straight((5, 5, 0), (25, 5, 0), axis=one),
        straight((25, 20, 0), (5, 20, 0), axis=one * [-1, 1, 1]),
    ]
    path, _, setup = made(passes)
    turns = np.flatnonzero(np.abs(np.diff(path.axis, axis=0)).max(axis=1) > 1e-9) + 1
    assert len(turns) == 1 and path.motion[turns[0]] == Motion.RAPID
    assert path.position[turns[0] - 1 : turns[0] + 1, 2].min() >= setup.clearance
    # The first lead-out ends 1 mm ahead and above; from there straight along the axis.
    off = path.position[turns[0] - 1] - [26.0, 5.0, 1.0]
    assert off / np.linalg.norm(off) == pytest.approx(one)


def test_a_tool_that_lies_flat_leaves_past_the_side_of_the_blank_and_turns_upright_above() -> None:
    flat = np.array([1.0, 0.0, 0.0])
    path, drive, setup = made(
        [straight((20, 5, 10), (20, 25, 10), axis=flat), straight((22, 25, 10), (22, 5, 10))]
    )
    lying = path.axis[:, 0] > 0.5
    rising = lying & (path.position[:, 2] > 12.0)
    assert (path.position[rising, 0] > drive.high[0] + BALL.holder.radius).all()
    assert path.position[lying][-1, 2] >= setup.clearance


def test_a_pass_that_begins_by_turning_about_its_tip_has_leads_along_its_way() -> None:
    turning = straight((5, 10, 0), (25, 10, 0))
    standing = Pass(
        tip=np.vstack([turning.tip[:1], turning.tip]),
        axis=np.tile(UPRIGHT, (3, 1)),
        normal=np.tile(UPRIGHT, (3, 1)),
    )
    assert made([standing])[0].position[0] == pytest.approx(made([turning])[0].position[0])
    # One that only turns is come to and left along its axis.
    spot = Pass(
        tip=np.tile(turning.tip[:1], (2, 1)),
        axis=np.tile(UPRIGHT, (2, 1)),
        normal=np.tile(UPRIGHT, (2, 1)),
    )
    assert made([spot])[0].position[0, :2] == pytest.approx([5.0, 10.0])


def test_off_a_pass_that_ends_at_a_steep_wall_the_tool_is_fed_up_past_what_stands_there() -> None:
    wall = grid(lambda x, y: np.clip(40.0 * (x - 15.0), 0.0, 12.0), n=120)
    path, drive, _ = made([straight((5, 10, 0), (11.9, 10, 0))], drive=driven(wall, top=13.0))
    up = path.position[-2:]
    assert up[0, 2] == pytest.approx(drive.high[2])
    assert path.motion[-2:].tolist() == [Motion.LINE, Motion.RAPID]
    level, _, _ = made([straight((5, 10, 0), (11.9, 10, 0))])
    assert level.position[-2, 2] == pytest.approx(MANNER.lead_radius)


@pytest.mark.parametrize("at_end", [True, False])
def test_a_lead_does_not_take_the_shank_onto_a_step_beside_the_pass(at_end) -> None:
    """A floor 16.5 mm below a step, the shank 16 mm over the tip: the pass ends 0.25 mm before the step comes under the shank."""
    slim = replace(
        bull(2.0, 1.0)(flute=3.0),
        neck_diameter=1.9,
        neck_length=16.0,
        shank_diameter=4.0,
        stickout=30.0,
    )
    skin = joined(
        grid(lambda x, y: 0.0 * x, n=8, high=(20.0, 30.0)),
        grid(lambda x, y: 0.0 * x + 16.5, n=8, low=(22.0, 0.0)),
    )
    drive, setup, stock = driven(skin, top=17.0)
    pass_ends = [(5.0, 15.0, 0.0), (19.75, 15.0, 0.0)]
    one = straight(*(pass_ends if at_end else pass_ends[::-1]))
    path = linked([one], drive, slim, DATA, stock, setup, MANNER)
    share = np.linspace(0.0, 1.0, 50)[:, None, None]
    starts = path.starts()
    on = (starts + share * (path.position - starts)).reshape(-1, 3)
    under = (np.abs(on[:, 0] - 22.0) < 2.0) | (on[:, 0] > 22.0)
    assert (on[under, 2] + 16.0 > 16.5 - 0.001).all()
    # At the other end there is space for the circle.
    assert path.position[:, 0].min() == pytest.approx(4.0)
