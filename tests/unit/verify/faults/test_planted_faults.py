"""Faults planted in a clean plan, each with its clean twin and with the engine that must see it."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from pytest import approx

from trunnion import tolerance
from trunnion.findings import Cancelled
from trunnion.model.verdict import Outcome
from trunnion.progress import Progress
from verify_tools import (
    CORNER,
    FACING,
    FILLET,
    FLOOR,
    POCKET_HIGH,
    POCKET_LOW,
    POCKETING,
    TAGS,
    TOP,
    bull,
    clean_plan,
    facing,
    flat,
    pocketing,
    program_section,
    proof,
)

RIGHT = POCKET_HIGH[0]
DIAGONAL = math.sqrt(0.5)
SHARP = bull(6.0, 0.5)(flute=12.0, number=3)


def codes(verdict):
    return {f.code for f in verdict.findings if f.severity == "error"}


def face(verdict, kind):
    return next(f for f in verdict.faces if f.face == TAGS[kind])


def excursion(kind, depth):
    """Return a feed move of the pocket's last tool that goes `depth` into one place of the finished pocket."""
    r, along = POCKETING.radius, 1.5
    if kind == "floor":
        return [(4.0, 1.0, FLOOR - depth), (6.0, 2.0, FLOOR - depth)]
    if kind == "wall":
        return [(RIGHT - r + depth, -along, FLOOR + 4.0), (RIGHT - r + depth, along, FLOOR + 4.0)]
    if kind == "edge":
        # The cutter's corner, radius 2, meets the pocket's upper rim from below at 45 degrees.
        off = (2.0 - depth) * DIAGONAL
        return [
            (RIGHT - 1.0 - off, -along, TOP - 2.0 + off),
            (RIGHT - 1.0 - off, along, TOP - 2.0 + off),
        ]
    # A corner of 0.5 reaches into the fillet of 2: its centre moves along the fillet's own diagonal.
    off = FILLET - (FILLET - 0.5 + depth) * DIAGONAL
    return [
        (RIGHT - off - 2.5, -along, FLOOR + off - 0.5),
        (RIGHT - off - 2.5, along, FLOOR + off - 0.5),
    ]


@pytest.mark.parametrize("kind", ["floor", "wall", "fillet", "edge"])
def test_a_gouge_of_50_micrometres_fails_by_contact_at_its_face(kind):
    tool = SHARP if kind == "fillet" else POCKETING
    verdict = proof(
        *clean_plan(),
        program_section(tool, [(4.0, 0.0, 30.0), *excursion(kind, 0.05), (4.0, 0.0, 30.0)]),
    )
    assert verdict.outcome is Outcome.FAILED
    assert "verify.gouge" in codes(verdict)
    assert face(verdict, "wall" if kind == "edge" else kind).gouge == approx(
        0.05, abs=tolerance.CONTACT_BOUND
    )


@pytest.mark.parametrize("kind", ["floor", "wall", "fillet", "edge"])
def test_a_gouge_of_5_micrometres_is_measured_within_the_bound_and_passes(kind):
    tool = SHARP if kind == "fillet" else POCKETING
    verdict = proof(
        *clean_plan(),
        program_section(tool, [(4.0, 0.0, 30.0), *excursion(kind, 0.005), (4.0, 0.0, 30.0)]),
    )
    assert face(verdict, "wall" if kind == "edge" else kind).gouge == approx(
        0.005, abs=tolerance.CONTACT_BOUND
    )
    assert verdict.outcome is Outcome.PASSED


@pytest.mark.parametrize("kind", ["floor", "wall", "fillet", "edge"])
def test_the_clean_twin_touches_and_does_not_gouge(kind):
    tool = SHARP if kind == "fillet" else POCKETING
    verdict = proof(
        *clean_plan(),
        program_section(tool, [(4.0, 0.0, 30.0), *excursion(kind, 0.0), (4.0, 0.0, 30.0)]),
    )
    assert verdict.outcome is Outcome.PASSED
    assert verdict.gouge < tolerance.CONTACT_BOUND


def test_the_clean_plan_passes_and_finishes_everything():
    verdict = proof(*clean_plan())
    assert verdict.outcome is Outcome.PASSED
    assert verdict.coverage == approx(1.0)
    assert not verdict.findings


def test_a_holder_that_touches_the_rim_is_a_collision_by_contact_and_by_stock():
    # Pocket 10 deep, stickout 9: the nose goes 1 mm below the top.
    verdict = proof(*clean_plan(tool=bull(6.0, 2.0)(flute=6.0, number=2)))
    assert {"verify.collision", "verify.collision-stock"} <= codes(verdict)
    assert verdict.collisions > 0


def test_a_holder_that_stays_one_millimetre_above_the_rim_is_clean():
    assert proof(*clean_plan(tool=bull(6.0, 2.0)(flute=8.0, number=2))).collisions == 0


def test_a_rapid_through_a_tenth_of_stock_is_seen_by_stock():
    verdict = proof(*clean_plan(pocket=pocketing(approach=TOP - 0.1)))
    assert codes(verdict) == {"verify.rapid-in-stock"}
    assert verdict.rapids_in_stock == 1
    assert "0.100 mm" in verdict.findings[0].text


def test_a_rapid_down_to_the_stock_is_clean():
    assert proof(*clean_plan(pocket=pocketing(approach=TOP))).rapids_in_stock == 0


@pytest.mark.parametrize(("into", "seen"), [(0.1, 1), (0.0, 0)])
def test_a_rapid_along_a_wall_is_seen_when_it_enters_it_between_two_columns(into, seen):
    # The walls stand at x = 23, between the columns at 22.75 and 23.25: no column's centre is inside the strip that is entered.
    x = RIGHT - POCKETING.radius + into
    section = program_section(
        POCKETING,
        [
            (x - 3, 0.0, 30.0),
            (x - 3, -1.0, 12.0),
            (x, -1.0, 12.0),
            (x, 1.0, 12.0),
            (x - 3, 1.0, 12.0),
            (x - 3, 1.0, 30.0),
        ],
        rapid_to=5,
    )
    assert min(proof(*clean_plan(), section).rapids_in_stock, 1) == seen


@pytest.mark.parametrize(
    ("thick", "height", "seen"), [(0.3, 12.0, 1), (0.3, TOP + 0.1, 0), (-0.3, 12.0, 0)]
)
def test_a_rapid_through_a_fin_that_stands_between_two_columns_is_seen(thick, height, seen):
    # Two passes with a fin about x = 0 between them, where the columns stand at -0.25 and 0.25; below 0 the passes overlap.
    tool, away = flat(6.0)(flute=20.0, number=4), 3.0 + thick / 2
    slots = [
        stop
        for x in (-away, away)
        for stop in ((x, -30.0, 30.0), (x, -30.0, 11.0), (x, 30.0, 11.0), (x, 30.0, 30.0))
    ]
    across = program_section(
        tool,
        [(-away, 0.0, 30.0), (-away, 0.0, height), (away, 0.0, height), (away, 0.0, 30.0)],
        rapid_to=3,
    )
    assert (
        proof(
            program_section(FACING, facing(), rapid_to=1), program_section(tool, slots), across
        ).rapids_in_stock
        == seen
    )


def test_a_rapid_down_a_slope_is_seen_where_it_is_lowest_over_a_fin():
    tool = flat(6.0)(flute=20.0, number=4)
    slots = [
        stop
        for x in (-3.15, 3.15)
        for stop in ((x, -30.0, 30.0), (x, -30.0, 11.0), (x, 30.0, 11.0), (x, 30.0, 30.0))
    ]
    # Where its axis passes the fin the tip is 2 mm above the top, and when it leaves the fin 1 mm below.
    down = program_section(
        tool, [(-6.0, 0.0, 26.0), (3.15, 0.0, 16.85), (3.15, 0.0, 30.0)], rapid_to=2
    )
    assert (
        proof(
            program_section(FACING, facing(), rapid_to=1), program_section(tool, slots), down
        ).rapids_in_stock
        == 1
    )


@pytest.mark.parametrize(("number", "seen"), [(1, 1), (5, 0)])
def test_a_rapid_from_where_the_section_before_has_left_the_same_tool_is_judged_all_the_way(
    number, seen
):
    # From one side of the block to the other at half its height; another tool comes from its change.
    left = program_section(FACING, [*facing(), (-45.0, 0.0, 30.0), (-45.0, 0.0, 9.0)], rapid_to=1)
    right = program_section(
        flat(16.0)(number=number),
        [(45.0, 0.0, 9.0), (45.0, 0.0, 30.0)],
        operation="next",
        rapid_to=1,
    )
    assert proof(left, right).rapids_in_stock == seen


def test_a_missing_pass_is_seen_by_coverage():
    verdict = proof(*clean_plan(pocket=pocketing(skip_walls=True)))
    assert codes(verdict) == {"verify.coverage"}
    assert face(verdict, "wall").left_max == approx(1.5)
    assert face(verdict, "wall").finished == 0.0
    assert verdict.gouge == 0.0


def test_a_wrong_tool_radius_is_seen_by_contact():
    verdict = proof(*clean_plan(tool=bull(6.1, 2.0)(flute=8.0, number=2)))
    assert "verify.gouge" in codes(verdict)
    assert face(verdict, "wall").gouge == approx(0.05, abs=tolerance.CONTACT_BOUND)


def test_a_tool_smaller_than_programmed_is_seen_by_coverage():
    verdict = proof(*clean_plan(tool=bull(5.9, 2.0)(flute=8.0, number=2)))
    assert codes(verdict) == {"verify.coverage"}
    assert face(verdict, "wall").left_mean == approx(0.05)


def test_a_swapped_axis_sign_is_seen_by_contact_and_by_coverage():
    face_section, pocket = clean_plan()
    flip = [-1.0, 1.0, 1.0]
    path = replace(
        pocket.path,
        position=pocket.path.position * flip,
        centre=pocket.path.centre * flip,
        motion=[{2: 3, 3: 2}.get(int(m), int(m)) for m in pocket.path.motion],
    )
    verdict = proof(face_section, replace(pocket, path=path))
    assert {"verify.gouge", "verify.coverage"} <= codes(verdict)
    # The pocket lies 5 mm right of the middle; mirrored, its cutter runs through 10 mm of part: its own radius is the depth.
    assert verdict.gouge == approx(POCKETING.radius, abs=tolerance.CONTACT_BOUND)


def test_an_empty_plan_covers_nothing_and_fails():
    verdict = proof()
    assert (verdict.outcome, verdict.coverage) == (Outcome.FAILED, 0.0)


def test_a_level_below_the_machine_is_refused_in_words():
    section = program_section(FACING, [(-400.0, 0.0, 30.0), (400.0, 0.0, 30.0)], rapid_to=1)
    assert "verify.travel" in codes(proof(*clean_plan(), section))


def test_a_fillet_is_unreachable_for_a_larger_corner_radius():
    verdict = proof(clean_plan()[0], tools=(bull(8.0, 3.0)(flute=12.0),))
    assert not face(verdict, "fillet").reachable
    assert face(verdict, "top").reachable
    assert verdict.coverage < verdict.reachable


def test_a_corner_smaller_than_every_cutter_is_unreachable():
    verdict = proof(clean_plan()[0], tools=(flat(2 * CORNER + 2.0)(flute=12.0),))
    assert not face(verdict, "corner").reachable
    assert face(verdict, "top").reachable


def test_the_proof_stops_when_asked_to():
    with pytest.raises(Cancelled):
        proof(*clean_plan(), progress=Progress(cancelled=lambda: True))


def test_the_same_plan_gives_the_same_verdict_twice():
    first, second = proof(*clean_plan()), proof(*clean_plan())
    assert first.operations == second.operations
    assert first.deviation.deviation.tobytes() == second.deviation.deviation.tobytes()


def test_facing_alone_reaches_only_the_top():
    verdict = proof(program_section(FACING, facing(), rapid_to=1))
    assert [f.face for f in verdict.faces if f.finished > 0.0] == [TAGS["top"]]
    assert POCKET_LOW[0] < 0.0 < verdict.coverage < 1.0
