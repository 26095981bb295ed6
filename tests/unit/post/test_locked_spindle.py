"""Texts of turning inserts in a locked spindle: the word that locks it, the same motions when read again, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from gap_turning import BUTTON_12, SETTINGS, drive, gap_data, two_gaps
from leaning_paths import HEADER
from programs import FLAT_16, S1, program_1, section
from trunnion.findings import BadInput, Refused
from trunnion.model.motion.program import Program
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.fanuc import FanucDialect
from trunnion.post.dialects.heidenhain import HeidenhainDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.dialects.sinumerik import SinumerikDialect
from trunnion.post.settings import PostSettings
from trunnion.progress import NO_PROGRESS
from trunnion.shop import load_shop
from trunnion.shop.kinematics import WorkPosition
from trunnion.toolpath.turning.interrupted import interrupted

TOOLS = (FLAT_16, BUTTON_12)
PLACES = {
    "S1": WorkPosition(
        machine=load_shop().machine("Mill-turn 1250"),
        foot=np.zeros(3),
        centre=np.array([0.0, 0.0, 50.0]),
        radius=300.0,
    )
}


def turned(spindle: float = 0.0) -> Program:
    """Return a program that mills, then turns two gaps."""
    path = interrupted(
        drive(two_gaps(20.0), two_gaps(20.5)),
        BUTTON_12,
        gap_data(),
        None,
        S1,
        SETTINGS,
        NO_PROGRESS,
    ).path
    return Program(
        name="B1.S1",
        setup=S1,
        sections=(program_1().sections[0], section("gaps", BUTTON_12, path, spindle)),
    )


@pytest.mark.parametrize(
    ("dialect", "word"),
    [
        (SinumerikDialect(), "M19"),
        (FanucDialect(), "M19"),
        (AptDialect(), "SPINDL/LOCK"),
    ],
)
def test_the_spindle_is_locked_and_the_same_is_read_again(dialect, word):
    made = turned()
    text = dialect.write([made], HEADER, PostSettings(), PLACES)
    assert text.count(word) == 1
    (again,) = dialect.read(text, TOOLS, [S1], PLACES)
    gaps = again.sections[1]
    assert gaps.tool == BUTTON_12 and gaps.spindle == 0.0
    assert again.sections[0].spindle == made.sections[0].spindle
    # The same tips and directions, but for what is written in other pieces.
    wanted, read = made.sections[1].path, gaps.path
    near = np.linalg.norm(read.position[:, None] - wanted.position[None, 5:-5:40], axis=2).min(
        axis=0
    )
    assert near.max() < 0.1
    away = np.abs(np.hypot(read.position[:, 0], read.position[:, 1]) - 200.0)
    assert away.min() < 0.01


@pytest.mark.parametrize("dialect", [LinuxCncDialect(), HeidenhainDialect()])
def test_a_control_without_a_word_for_it_refuses(dialect):
    with pytest.raises(Refused, match="no word for a locked spindle"):
        dialect.write([turned()], HEADER, PostSettings(), PLACES)


def test_an_insert_in_a_turning_spindle_is_not_written():
    with pytest.raises(Refused, match="turning insert in a locked spindle"):
        SinumerikDialect().write([turned(500.0)], HEADER, PostSettings(), PLACES)


def without(word: str, instead: str, dialect=None) -> str:
    dialect = dialect or SinumerikDialect()
    text = dialect.write([turned()], HEADER, PostSettings(), PLACES).replace(word, instead)
    with pytest.raises(BadInput) as refused:
        dialect.read(text, TOOLS, [S1], PLACES)
    return str(refused.value)


def test_an_insert_that_would_cut_in_a_turning_spindle_is_refused():
    assert "cuts in a locked spindle; put M19 first" in without("M19", "S500 M3")
    assert "needs SPINDL/LOCK before it" in without(
        "SPINDL/LOCK", "SPINDL/RPM,500,CLW", AptDialect()
    )


def test_an_insert_that_would_cut_while_the_spindle_is_free_is_refused():
    assert "cuts in a locked spindle; put M19 first" in without("M19", "M5")


def test_a_mill_in_a_locked_spindle_is_refused():
    speed = f"S{program_1().sections[0].spindle:.0f} M3"
    assert "in a locked spindle; give S and M3 first" in without(speed, "M19")


def test_the_speed_must_be_given_again_after_the_spindle_was_locked():
    assert "without a spindle speed" in without("M19", "M19\nM3")
