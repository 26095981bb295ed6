"""The proof of a round insert in a locked spindle: what it takes, how thick its chip is, which drive bears it, and what it must not do."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from gap_turning import BUTTON_12, SETTINGS, drive, gap_data, ground
from own_shop import own_shop
from programs import S1
from shaped_parts import cylinder
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Revolved
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.model.verdict import Outcome
from trunnion.plan.turning.gap_drive import GapPass
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.turning.interrupted import interrupted
from trunnion.verify.judge.load import insert_chip
from trunnion.verify.judge.overload import allowed_load
from trunnion.verify.judge.verdict import prove
from trunnion.verify.settings import ProofSettings

RADIUS, DEPTH, FEED, SPEED = 60.0, 0.3, 0.5, 8.0
MACHINE = own_shop().machine("Mill-turn 1250")
TITANIUM = own_shop().material("Ti-6Al-4V")
ROWS = 12
SETTING = replace(SETTINGS, margin=2.0)


@pytest.fixture(scope="module")
def drum():
    return cylinder(RADIUS, 30.0)


def blank() -> Revolved:
    """Return the drum with 0.3 mm more outside."""
    outline = np.array([[0.0, 0.0], [60.3, 0.0], [60.3, 30.0], [0.0, 30.0]])
    return Revolved(frame=WORLD, outline=outline, material="Ti-6Al-4V", density=4.4)


def turned(deeper: float = 0.0) -> ProgramSection:
    """Return the section that turns two gaps of the drum's outside, `deeper` mm into it."""
    passes = tuple(
        GapPass(along=8.0 + FEED * k, lift=5.0, gaps=((-1.2, 0.8), (1.4, 3.6))) for k in range(ROWS)
    )
    made = replace(drive(*passes, on=ground(RADIUS - deeper)), clearance=30.0)
    data = gap_data(SPEED, FEED, DEPTH)
    path = interrupted(made, BUTTON_12, data, None, S1, SETTING, NO_PROGRESS).path
    return ProgramSection(
        operation="gaps",
        tool=BUTTON_12,
        spindle=0.0,
        path=path,
        width=FEED,
        depth=DEPTH,
        feed=data.feed,
    )


def judged(drum, section, machine=MACHINE):
    """Return the verdict on a section; coverage is not its subject."""
    program = Program(name="test", setup=replace(S1, machine=machine.name), sections=(section,))
    return prove(
        [program],
        drum,
        blank(),
        (BUTTON_12,),
        [machine],
        ProofSettings(cell=0.5, spacing=2.0, coverage=0.0),
        material=TITANIUM,
    )


def codes(verdict) -> set[str]:
    return {f.code for f in verdict.findings}


def test_gaps_are_turned_to_size_without_a_word(drum):
    verdict = judged(drum, turned())
    (proven,) = verdict.operations
    assert proven.outcome is Outcome.PASSED and proven.gouge < 0.005
    assert not codes(verdict) & {
        "verify.locked-insert",
        "verify.power",
        "verify.load",
        "verify.air",
    }
    # The rows' gaps without their ends, as wide as the insert's chord at that depth beyond the outer rows.
    ends = SETTING.motion.end(SPEED, 5.0)
    length = RADIUS * (2.0 + 2.2) - 4.0 * ends
    wide = FEED * (ROWS - 1)
    segment = BUTTON_12.radius**2 * (
        math.acos(1.0 - DEPTH / 6.0) - math.sin(2.0 * math.acos(1.0 - DEPTH / 6.0)) / 2.0
    )
    least, most = DEPTH * wide * length, (DEPTH * wide + segment) * (length + 4.0 * ends)
    assert least < proven.removed < most


def test_the_chip_is_the_area_over_the_edge_in_contact():
    thick = insert_chip(np.array([0.15]), np.array([6.0]), np.array([0.3]))
    assert thick == approx([0.15 / (6.0 * math.acos(0.95))])
    assert insert_chip(np.zeros(1), np.array([6.0]), np.zeros(1)) == approx([0.0])


def test_a_first_cut_may_be_as_thick_as_the_depth():
    allowed = allowed_load(turned(), TITANIUM)
    assert allowed.chip == DEPTH
    # Area of the insert's segment, times the speed of the ground.
    contact = math.acos(1.0 - DEPTH / 6.0)
    assert allowed.rate == approx(36.0 * (contact - 0.5 * math.sin(2.0 * contact)) * SPEED)


def test_deeper_passes_are_a_gouge(drum):
    assert "verify.gouge" in codes(judged(drum, turned(0.05)))


def test_a_table_that_is_too_weak_is_an_error(drum):
    weak = replace(MACHINE.work_spindle, power=((2.0, 1e-4), (350.0, 1e-3)))
    found = judged(drum, turned(), replace(MACHINE, work_spindle=weak)).findings
    text = next(f.text for f in found if f.code == "verify.power")
    assert "of the table at 21 1/min" in text


@pytest.mark.parametrize("way", ["back", "along"])
def test_a_cut_that_turns_back_or_does_not_turn_is_an_error(drum, way):
    section = turned()
    path = section.path
    if way == "back":
        # From its last block to its first: the same places, the other way round.
        fed = path.motion == Motion.LINE
        path = replace(
            path,
            position=path.position[::-1].copy(),
            axis=path.axis[::-1].copy(),
            motion=np.where(np.roll(fed[::-1], 1), Motion.LINE, Motion.RAPID),
            feed=np.where(np.roll(fed[::-1], 1), 8000.0, 0.0),
            mark=path.mark[::-1].copy(),
        )
    else:
        axis = np.tile([1.0, 0.0, 0.0], (5, 1))
        heights = np.array([30.0, 3.0, 0.0, 0.0, 30.0]) + RADIUS
        path = replace(
            path,
            position=np.column_stack([heights, np.zeros(5), [8.0, 8.0, 8.0, 20.0, 20.0]]),
            axis=axis,
            motion=np.array([0, 0, 1, 1, 0]),
            centre=np.full((5, 3), np.nan),
            feed=np.array([0.0, 0.0, 500.0, 500.0, 0.0]),
            mark=path.mark[:5],
        )
    verdict = judged(drum, replace(section, path=path))
    assert "verify.locked-insert" in codes(verdict)
    assert verdict.outcome is Outcome.FAILED


def test_an_insert_that_turns_with_its_spindle_is_an_error(drum):
    assert "verify.spindle" in codes(judged(drum, replace(turned(), spindle=500.0)))
