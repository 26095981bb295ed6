"""What every machine of the catalogues must do, whoever brought it: ours, and those of packages."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from leaning_paths import standing
from own_packages import with_own_packages
from programs import BULL_10, FLAT_16, S1, program_1
from subjects import is_one_line
from trunnion import registry
from trunnion.findings import Refused
from trunnion.model.motion.listing import listing
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.shop import load_shop
from trunnion.shop.kinematics import (
    NO_WORK_POSITIONS,
    POLE,
    axes_of,
    pole_of,
    poses_of,
    rotary_solutions,
    words_of,
)

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
GAUGE = 120.0
"""mm from tip to spindle face of the tool in these tests."""


@cache
def machines():
    """Return the machines of the catalogues, those of packages among them."""
    with with_own_packages():
        return load_shop().machines


by_name = pytest.mark.parametrize("name", machines())


@pytest.fixture
def machine(name):
    return machines()[name]


def angles_within(machine, count=40):
    """Return angles (count, a) in rad within the travel of a machine's rotary axes, the same each time."""
    low, high = (np.radians([getattr(a, end) for a in machine.rotary]) for end in ("low", "high"))
    turn = np.minimum(high, np.pi) - np.maximum(low, -np.pi)
    share = np.random.default_rng(1).random((count, len(low)))
    return np.maximum(low, -np.pi) + share * turn


@by_name
def test_it_has_words_for_a_person(name, machine):
    assert machine.name == name and is_one_line(machine.title)


@by_name
def test_its_linear_axes_are_x_y_and_z_with_room_to_move(name, machine):
    linear = [a for a in machine.axes if a.kind == "linear"]
    assert sorted(a.name for a in linear) == ["X", "Y", "Z"]
    assert all(100.0 <= a.high - a.low <= 2e4 for a in linear)


@by_name
def test_its_axes_have_letters_of_their_own(name, machine):
    letters = [a.name for a in machine.axes]
    assert len(set(letters)) == len(letters)
    assert {a.name for a in machine.rotary} <= {"A", "B", "C"}


@by_name
def test_its_speeds_are_sane(name, machine):
    for axis in machine.axes:
        assert axis.rapid > 0.0 and axis.acceleration > 0.0
    linear = [a for a in machine.axes if a.kind == "linear"]
    assert 0.0 < machine.feed_max <= max(a.rapid for a in linear) * len(linear)
    assert 0.0 <= machine.tool_change_s < 120.0


@by_name
def test_its_spindle_has_power_wherever_it_turns(name, machine):
    assert 0.0 <= machine.spindle_low < machine.spindle_high
    for spindle in np.linspace(max(machine.spindle_low, 1.0), machine.spindle_high, 20):
        assert 0.0 < machine.power_at(float(spindle)) <= max(kw for _, kw in machine.power)


@by_name
def test_its_magazine_takes_a_plans_tools(name, machine):
    assert machine.tool_places >= 10


@by_name
def test_an_upright_tool_is_where_its_words_say(name, machine):
    tips = np.array([[0.0, 0.0, 0.0], [10.0, -20.0, 5.0]])
    upright = np.zeros((2, len(machine.rotary)))
    assert words_of(standing(machine), tips, upright, GAUGE) == pytest.approx(tips, abs=1e-9)


@by_name
def test_axis_words_lead_to_a_pose_and_back(name, machine):
    place, angle = standing(machine), angles_within(machine)
    tips = np.random.default_rng(2).uniform(-50.0, 50.0, (len(angle), 3))
    words = words_of(place, tips, angle, GAUGE)
    again, axes = poses_of(place, words, angle, GAUGE)
    assert again == pytest.approx(tips, abs=1e-7)
    assert np.linalg.norm(axes, axis=1) == pytest.approx(1.0)


@by_name
def test_a_direction_leads_to_angles_that_hold_it(name, machine):
    place, angle = standing(machine), angles_within(machine)
    axes = axes_of(place, angle)
    if not machine.rotary:
        assert axes == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(axes), 1)))
        return
    stands, _, held = rotary_solutions(machine, axes)
    assert held.all()
    for way in (0, 1):
        assert axes_of(place, stands[:, way]) == pytest.approx(axes, abs=1e-6)


@by_name
def test_at_the_pole_a_free_axis_may_stand_anywhere(name, machine):
    if not machine.rotary:
        return
    place, random = standing(machine), np.random.default_rng(4)
    around = random.uniform(-np.pi, np.pi, 200)
    lean = np.where(np.arange(200) % 2, 0.99, 0.01) * POLE
    across = np.linalg.svd(pole_of(machine)[None])[2][1:]
    axes = np.sqrt(1.0 - lean**2)[:, None] * pole_of(machine) + lean[:, None] * (
        np.column_stack([np.cos(around), np.sin(around)]) @ across
    )
    stands, free, held = rotary_solutions(machine, axes)
    assert free.any(axis=2)[held].all()
    for way in (0, 1):
        anyhow = np.where(
            free[:, way], random.uniform(-np.pi, np.pi, free[:, way].shape), stands[:, way]
        )
        off = np.linalg.norm(axes_of(place, anyhow) - axes, axis=1)
        assert off[held].max(initial=0.0) <= 1.01 * POLE


@by_name
def test_a_straight_program_is_posted_and_read_back(name, machine):
    setup = replace(S1, machine=name)
    program = replace(program_1(), setup=setup)
    places = {setup.name: standing(machine)} if machine.rotary else NO_WORK_POSITIONS
    written = []
    for known in registry.names("dialects"):
        dialect = registry.get("dialects", known)()
        try:
            text = dialect.write([program], HEADER, PostSettings(), places)
        except Refused as refused:
            assert machine.rotary and machine.title in str(refused)
            continue
        written.append(known)
        (again,) = dialect.read(text, (FLAT_16, BULL_10), [setup], places)
        assert listing(again, marks=False) == listing(program, marks=False), known
        assert re.search(rf"MACHINE {re.escape(name)}\b", text), known
    assert machine.control in written
