"""Where the rotary axes stand as a section begins: what the text says is what the machine is proven to do."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from leaning_paths import HEADER, lean, path_of, program, standing
from own_shop import own_shop
from programs import FLAT_16, S1
from trunnion import registry
from trunnion.findings import Refused
from trunnion.model.material import leaning_axis
from trunnion.post.settings import PostSettings
from trunnion.shop.rotary_angles import followed
from trunnion.verify.machine.kinematics import axis_positions
from trunnion.verify.motion import moves_of

SHOP = own_shop()
HEAD = SHOP.machine("Universal 1250")
MACHINES = [m for m in SHOP.machines.values() if m.rotary]
DIALECTS = ("sinumerik", "heidenhain")


def drilled(*directions):
    """Return one path a direction: down along it and out again, as a positioned hole is cut."""
    return [
        path_of((60.0 * axis, axis), (50.0 * axis, axis), (60.0 * axis, axis))
        for axis in directions
    ]


def proven_angles(name, machine, paths):
    """Return the rotary angles (k, a) in rad of the posted text as the proof has them, with the section of each pose, and the sections."""
    place, made = standing(machine), program(*paths)
    dialect = registry.get("dialects", name)()
    text = dialect.write([made], HEADER, PostSettings(), {"S1": place})
    (read,) = dialect.read(text, (FLAT_16,), [S1], {"S1": place})
    moves = moves_of(read.sections)
    found = axis_positions(moves, machine, place.foot)
    return found.rotary, moves.section[found.move], read.sections


@pytest.mark.parametrize("name", DIALECTS)
def test_a_head_stays_on_its_side_however_the_table_is_wound(name):
    """Holes all round, an upright one between: a table wound up by turns would be nearer to the other side of the head."""
    around = [lean(90.0, 40.0 * k) for k in range(30)] + [lean(0.0), lean(90.0, 250.0)]
    angles, _, _ = proven_angles(name, HEAD, drilled(*around))
    leaning = angles[:, leaning_axis(HEAD)]
    assert leaning.min() > -1e-9 and leaning.max() == pytest.approx(math.pi / 2.0)


@pytest.mark.parametrize("name", DIALECTS)
def test_a_text_that_says_the_other_side_is_proven_there(name):
    place, made = standing(HEAD), program(*drilled(lean(40.0, 30.0)))
    dialect = registry.get("dialects", name)()
    text = dialect.write([made], HEADER, PostSettings(), {"S1": place})
    sides = {"sinumerik": ("0,0,0,1,0,1)", "0,0,0,-1,0,1)"), "heidenhain": ("SEQ+", "SEQ-")}[name]
    for k, side in enumerate((text, text.replace(*sides))):
        assert sides[k] in side
        (read,) = dialect.read(side, (FLAT_16,), [S1], {"S1": place})
        found = axis_positions(moves_of(read.sections), HEAD, place.foot)
        turned = found.rotary[-1, leaning_axis(HEAD)]
        assert turned == pytest.approx(math.radians((40.0, -40.0)[k]), abs=1e-5)


def test_a_side_that_is_not_said_is_the_controls_choice():
    place, made = standing(HEAD), program(*drilled(lean(40.0, 30.0)))
    dialect = registry.get("dialects", "sinumerik")()
    text = dialect.write([made], HEADER, PostSettings(), {"S1": place})
    (read,) = dialect.read(
        text.replace("0,0,0,1,0,1)", "0,0,0,0,0,1)"), (FLAT_16,), [S1], {"S1": place}
    )
    assert not any(s.stances for s in read.sections)


directions = st.tuples(st.floats(1.0, 100.0), st.floats(0.0, 360.0))


@pytest.mark.examples(25)
@settings(deadline=None)
# At the end of an axis a written angle may be a hair beyond it: it is still within, not a whole turn away.
@example("sinumerik", SHOP.machine("Trunnion 650"), [(30.0, 218.0)], [(1.0, 0.0), (1.0, 0.0)])
@given(
    st.sampled_from(DIALECTS),
    st.sampled_from(MACHINES),
    st.lists(directions, min_size=1, max_size=6),
    st.lists(directions, min_size=2, max_size=5),
)
def test_sections_begin_where_the_post_has_the_axes_stand(name, machine, holes, sweep):
    """In tilted planes the tool leans to the side that the post has chosen, whatever way it came there."""
    axes = [lean(*d) for d in sweep]
    turning = path_of(*[((70.0 * a).tolist(), a) for a in axes])
    paths = [*drilled(*[lean(*d) for d in holes]), turning]
    place = standing(machine)
    wanted = []
    for k, path in enumerate(paths):
        try:
            wanted.append(followed(path.axis, place, None, 1e-6, f"op-{k}")[0])
        except Refused:
            # What a machine can't hold is another test's subject.
            return
    angles, section, sections = proven_angles(name, machine, paths)
    k = leaning_axis(machine)
    ends = np.flatnonzero(np.diff(section, append=len(sections)))
    for pose in ends[: len(paths) - 1]:
        at = int(sections[section[pose]].operation.split("-")[1]) - 1
        if abs(math.sin(wanted[at][k])) > 1e-3:
            assert np.sign(angles[pose, k]) == np.sign(wanted[at][k])


@pytest.mark.parametrize("machine", MACHINES, ids=lambda m: m.name)
@pytest.mark.parametrize("name", DIALECTS)
def test_between_operations_the_tool_goes_round_all_that_stands_on_the_table(name, machine):
    """From one side of the part to the other a straight way would lead through it."""
    place = standing(machine)
    paths = drilled(lean(80.0, 0.0), lean(80.0, 170.0), lean(10.0, 350.0), lean(85.0, 90.0))
    made, dialect = program(*paths), registry.get("dialects", name)()
    text = dialect.write([made], HEADER, PostSettings(), {"S1": place})
    (read,) = dialect.read(text, (FLAT_16,), [S1], {"S1": place})
    moves = moves_of(read.sections)
    turning = np.flatnonzero(moves.rapid & moves.turning())
    assert len(turning) > 10
    for share in np.linspace(0.0, 1.0, 11):
        tip = (1.0 - share) * moves.start[turning] + share * moves.end[turning]
        away = np.linalg.norm(tip - place.centre, axis=1)
        assert away.min() > 0.99 * place.radius
