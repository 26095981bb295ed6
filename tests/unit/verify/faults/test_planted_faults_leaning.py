"""Faults of leaning tools beside gouges: holder, rapid in stock, missing pass, wrong radius, swapped sign; each with its clean twin."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning import (
    FIVE_AXES,
    RIGHT,
    block_facets,
    lean,
    long_reaching,
    section_through,
    standing_out,
)
from trunnion import tolerance
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.pipeline.work_position import work_position_of
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.toolpath.motion.reorient import clearance_sphere, joined
from verify_tools import (
    BLANK,
    FLOOR,
    SETUP,
    TAGS,
    clean_plan,
    pocketing,
    program_section,
    proof,
    tool_of,
)

FACETS = block_facets()
BALL = long_reaching(tool_of("ball", diameter=6.0, corner_radius=3.0, flute_length=12.0))
BULL = long_reaching(tool_of("bull", diameter=6.0, corner_radius=2.0, flute_length=12.0))
LEAN = lean(15.0)


def judged(*sections, **choices):
    return proof(*sections, **{"machine": FIVE_AXES, "facets": FACETS, "bundles": "z", **choices})


def codes(verdict):
    return {f.code for f in verdict.findings if f.severity == "error"}


def depth_said(verdict):
    """Return the depth that the first rapid in stock is said to have."""
    text = next(f.text for f in verdict.findings if f.code == "verify.rapid-in-stock")
    return float(re.search(r"goes ([0-9.]+) mm into stock", text).group(1))


def along_wall(tool, axis, radius=None):
    """Return poses that finish the right wall 4 mm over the floor with a leaning tool, reckoned with another tool's form when given."""
    out = standing_out(radius or tool, np.array([axis]), (-1.0, 0.0, 0.0))[0]
    return [((RIGHT - out, -1.5, FLOOR + 4.0), axis), ((RIGHT - out, 1.5, FLOOR + 4.0), axis)]


@pytest.mark.parametrize(("stickout", "touches"), [(7.0, True), (60.0, False)])
def test_a_leaning_holder_that_touches_is_a_collision_by_contact_and_by_stock(stickout, touches):
    # Its nose, 7 mm up the axis, has a radius of 12: leaning it dips a millimetre below the rims beside the pocket.
    tool = replace(
        BALL, flute_length=6.0, neck_length=6.5, stickout=stickout, gauge_length=stickout + 60.0
    )
    verdict = judged(*clean_plan(), section_through(tool, "finish", along_wall(tool, LEAN)))
    assert codes(verdict) == ({"verify.collision", "verify.collision-stock"} if touches else set())


@pytest.mark.parametrize(("deep", "seen"), [(0.1, True), (-0.02, False)])
def test_a_leaning_rapid_through_a_tenth_of_stock_is_seen_by_stock(deep, seen):
    # Over the raw blank, whose top is at 20; the ball leans, so its lowest point is its radius under its centre.
    z = 20.0 - deep + BALL.radius - BALL.radius * LEAN[2]
    stops = [(-20.0, 0.0, 90.0), (-20.0, 0.0, z), (20.0, 0.0, z), (20.0, 0.0, 90.0)]
    path = Toolpath(
        position=stops,
        axis=[LEAN] * 4,
        motion=[Motion.RAPID] * 4,
        centre=np.full((4, 3), np.nan),
        feed=np.zeros(4),
        mark=[0] * 4,
    )
    fast = replace(section_through(BALL, "fast", along_wall(BALL, LEAN)), path=path)
    verdict = judged(fast, coverage=0.0)
    assert codes(verdict) == ({"verify.rapid-in-stock"} if seen else set())
    # The columns are half a millimetre apart: the deepest point of a ball may pass a quarter beside one, 0.25^2 / 2 r less deep.
    assert not seen or 0.088 < depth_said(verdict) <= 0.1


def finished_wall(tool=BULL, reckoned=None, axis=LEAN, skip=False):
    """Return a plan whose roughing leaves all walls, and whose leaning tool finishes a band of the right one."""
    face, pocket = clean_plan(pocket=pocketing(skip_walls=True))
    return (
        (face, pocket)
        if skip
        else (face, pocket, section_through(tool, "finish", along_wall(tool, axis, reckoned)))
    )


def wall(verdict):
    return next(f for f in verdict.faces if f.face == TAGS["wall"])


def test_a_missing_leaning_pass_is_seen_by_coverage():
    whole, without = (
        judged(*finished_wall(), spacing=0.5),
        judged(*finished_wall(skip=True), spacing=0.5),
    )
    assert wall(whole).finished > 0.0 and wall(without).finished == 0.0
    assert "verify.coverage" in codes(without) and wall(without).left_mean > wall(whole).left_mean


def test_a_leaning_tool_of_another_radius_than_reckoned_is_seen_by_contact_or_by_coverage():
    small, large = (
        long_reaching(tool_of("bull", diameter=d, corner_radius=2.0, flute_length=12.0))
        for d in (5.9, 6.1)
    )
    clean, gouged, short = (
        judged(*finished_wall(t, BULL), spacing=0.5) for t in (BULL, large, small)
    )
    out = (
        standing_out(large, np.array([LEAN]), (-1, 0, 0))[0]
        - standing_out(BULL, np.array([LEAN]), (-1, 0, 0))[0]
    )
    assert wall(clean).gouge < tolerance.CONTACT_BOUND < 0.02 < out
    assert wall(gouged).gouge == approx(out, abs=2 * tolerance.CONTACT_BOUND)
    assert "verify.gouge" in codes(gouged) and "verify.gouge" not in codes(short)
    assert wall(short).finished < wall(clean).finished


def test_a_swapped_sign_of_the_lean_is_seen_by_contact():
    # Leaning into the wall by the same angle, the shank goes through its edge.
    right = section_through(BULL, "finish", along_wall(BULL, LEAN))
    swapped = replace(right, path=replace(right.path, axis=right.path.axis * [-1.0, 1.0, 1.0]))
    assert codes(judged(*clean_plan(), right)) == set()
    assert "verify.gouge" in codes(judged(*clean_plan(), swapped))


def test_three_bundles_judge_a_leaning_program_as_one_does():
    section = section_through(BALL, "finish", along_wall(BALL, LEAN))
    one, three = (
        proof(*clean_plan(), section, machine=FIVE_AXES, facets=FACETS, bundles=b, cell=1.0)
        for b in ("z", "auto")
    )
    assert codes(one) == codes(three) == set()
    assert three.operations[1].removed == approx(one.operations[1].removed, rel=0.03)


@pytest.mark.parametrize(("height", "seen"), [(13.2, 0), (17.5, 1)])
def test_what_a_t_slot_cutter_leaves_over_its_slot_still_stands_for_a_rapid(height, seen):
    # The slot is 4 high, from 13 to 17, under the blank's top at 20: a flat cutter's shank rapids over it through what stands above.
    cutter = long_reaching(
        tool_of(
            "t-slot",
            diameter=16.0,
            corner_radius=0.5,
            flute_length=4.0,
            neck_diameter=6.0,
            shank_diameter=6.0,
        )
    )
    under = [(-50.0, 0.0, 60.0), (-50.0, 0.0, 13.0), (50.0, 0.0, 13.0), (50.0, 0.0, 60.0)]
    disc = replace(cutter, flute_length=3.0, neck_length=43.0, stickout=63.0, number=9)
    fast = [(-50.0, 0.0, 60.0), (-50.0, 0.0, height), (50.0, 0.0, height), (50.0, 0.0, 60.0)]
    verdict = proof(
        program_section(cutter, under, operation="under", rapid_to=1),
        program_section(disc, fast, operation="again", rapid_to=3),
        coverage=0.0,
        tolerance=1.0,
        cell=1.0,
    )
    assert len([f for f in verdict.findings if f.code == "verify.rapid-in-stock"]) == seen


def test_the_verdict_is_the_same_for_any_number_of_threads():
    sections = (
        *clean_plan(),
        section_through(
            BULL, "finish", [along_wall(BULL, LEAN)[0], (along_wall(BULL, LEAN)[1][0], lean(12.0))]
        ),
    )
    one, three = (judged(*sections, bundles="xyz", cell=1.0, threads=n) for n in (1, 3))
    assert one.operations == three.operations and one.findings == three.findings
    assert one.deviation.deviation.tobytes() == three.deviation.deviation.tobytes()
    assert [b.rate.tobytes() for b in one.blocks] == [b.rate.tobytes() for b in three.blocks]


def as_posted(*sections):
    """Return sections written for LinuxCNC, each led from where the one before has left the tool, and read back."""
    place = work_position_of(BLANK, SETUP, FIVE_AXES)
    changes = [
        not n or s.tool.number != sections[n - 1].tool.number for n, s in enumerate(sections)
    ]
    led = joined([s.path for s in sections], changes, clearance_sphere(BLANK, SETUP))
    program = Program(
        name="test",
        setup=SETUP,
        sections=tuple(replace(s, path=path) for s, path in zip(sections, led, strict=True)),
    )
    header = Header(name="test", part="test", part_digest="ab", plan_digest="cd")
    text = LinuxCncDialect().write([program], header, PostSettings(), {SETUP.name: place})
    return read_linuxcnc(text, [s.tool for s in sections], SETUP, place).sections


@pytest.mark.parametrize("deep", [0.0, 0.03])
def test_a_leaning_section_is_judged_from_its_text_as_from_its_path(deep):
    ball = replace(BALL, number=7)
    turning = [
        ((tip[0] + deep, *tip[1:]), axis)
        for tip, axis in (along_wall(ball, LEAN)[0], along_wall(ball, lean(25.0))[1])
    ]
    sections = (*clean_plan(), section_through(ball, "finish", turning))
    sections = [replace(s, tool=replace(s.tool, number=n)) for n, s in enumerate(sections, 1)]
    planned, posted = judged(*sections), judged(*as_posted(*sections))
    assert codes(planned) == codes(posted)
    assert posted.gouge == approx(planned.gouge, abs=2e-3)
    assert posted.rapids_in_stock == posted.collisions == 0
