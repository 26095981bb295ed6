"""Which places a cutter reaches at all: upright on three axes, leaning where the machine turns."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from leaning_tools import EVERY_FORM, contact_of
from trunnion.findings import BadCall, Cancelled
from trunnion.part.shape.facets import Facets
from trunnion.progress import Progress
from trunnion.shop.machines import load_machines
from trunnion.verify.contact import Obstacles, PartContact
from trunnion.verify.finish.accessibility import Accessibility
from trunnion.verify.finish.coverage import Samples
from trunnion.verify.finish.tilted_poses import leaning_axes, touching_tips
from trunnion.verify.machine.kinematics import can_hold
from verify_tools import MACHINE

TRUNNION = load_machines(None)["Trunnion 650"]
# A block that hangs in the air: its underside shows to nothing that comes from above.
BLOCK = contact_of(((-10.0, -10.0, 50.0), (10.0, 10.0, 60.0)))
# The same with a plate under its left half: of the underside a leaning cutter gets at the right half alone.
OVER = contact_of(
    ((-10.0, -10.0, 50.0), (10.0, 10.0, 60.0)), ((-90.0, -90.0, 40.0), (0.0, 90.0, 46.0))
)
CLAMP = Facets.of_mesh(np.eye(3), np.array([[0, 1, 2]]), np.zeros(1, np.int64), np.array([1]))
PLACES = Samples(
    face=np.zeros(3, np.int64),
    point=np.array([[0.0, 0.0, 50.0], [0.0, 0.0, 60.0], [10.0, 0.0, 55.0]]),
    normal=np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    area=np.ones(3),
)


@pytest.mark.parametrize(
    ("machine", "expected"), [(MACHINE, [False, True, True]), (TRUNNION, [True, True, True])]
)
def test_an_underside_is_reached_by_a_machine_that_leans(machine, expected):
    reach = Accessibility(BLOCK, [EVERY_FORM["bull"]], 0.01, machine)
    assert reach.reached(PLACES, np.arange(3)).tolist() == expected


def test_a_place_between_two_plates_stays_unreached_whatever_leans():
    slit = contact_of(
        ((-90.0, -90.0, 50.0), (90.0, 90.0, 60.0)), ((-90.0, -90.0, 44.0), (90.0, 90.0, 46.0))
    )
    assert (
        not Accessibility(slit, [EVERY_FORM["ball"]], 0.01, TRUNNION)
        .reached(PLACES, np.array([0]))
        .any()
    )


def test_a_trunnion_table_holds_what_its_limits_allow():
    def leaning(degrees, about):
        lean, turn = math.radians(degrees), math.radians(about)
        return [math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean)]

    # A goes from -120 to 30, and C comes round to any side.
    assert can_hold(np.array([leaning(90, a) for a in (0, 100, 250)]), TRUNNION).all()
    assert can_hold(np.array([leaning(a, 40) for a in (0, 119, 121, 180)]), TRUNNION).tolist() == [
        True,
        True,
        False,
        False,
    ]
    assert can_hold(np.array([leaning(0, 0), leaning(5, 0)]), MACHINE).tolist() == [True, False]


@pytest.mark.parametrize("form", ["flat", "bull", "ball"])
def test_a_leaning_cutter_touches_the_place_with_its_own_surface(form):
    tool, normal = EVERY_FORM[form], np.array([[0.0, 0.6, 0.8]])
    for axis in leaning_axes(normal):
        tips, possible = touching_tips(tool, np.zeros((1, 3)), normal, axis)
        h = float(-tips[0] @ axis[0])
        rho = float(np.linalg.norm(-tips[0] - h * axis[0]))
        out = max(rho - tool.radius + tool.corner_radius, 0.0)
        if possible[0] and h <= tool.corner_radius:
            assert math.hypot(out, tool.corner_radius - h) == approx(tool.corner_radius, abs=1e-9)
        elif possible[0]:
            assert rho == approx(tool.radius, abs=1e-9)


def test_the_search_tells_how_far_it_is_and_stops_when_asked():
    told = []

    def report(share, text):
        told.append((share, text))

    places = Samples(
        face=np.zeros(40, np.int64),
        point=np.tile([0.0, 0.0, 50.0], (40, 1)),
        normal=np.tile([0.0, 0.0, -1.0], (40, 1)),
        area=np.ones(40),
    )
    slit = contact_of(
        ((-90.0, -90.0, 50.0), (90.0, 90.0, 60.0)), ((-90.0, -90.0, 44.0), (90.0, 90.0, 46.0))
    )
    reach = Accessibility(
        slit, [EVERY_FORM["ball"], EVERY_FORM["bull"], EVERY_FORM["flat"]], 0.01, TRUNNION
    )
    assert not reach.reached(places, np.arange(40), Progress(report)).any()
    shares = [share for share, _ in told]
    assert shares == sorted(shares) and shares[-1] > 0.8
    assert {text for _, text in told} == {
        f"Looking for {kind}cutters that reach what is left" for kind in ("", "leaning ")
    }
    looks = iter(range(len(told)))
    with pytest.raises(Cancelled):
        reach.reached(
            places, np.arange(40), Progress(cancelled=lambda: next(looks) > len(told) // 2)
        )


def test_any_number_of_threads_finds_the_same():
    places = Samples(
        face=np.zeros(60, np.int64),
        point=np.column_stack([np.linspace(-9.0, 9.0, 60), np.zeros(60), np.full(60, 50.0)]),
        normal=np.tile([0.0, 0.0, -1.0], (60, 1)),
        area=np.ones(60),
    )
    found = [
        Accessibility(OVER, [EVERY_FORM["ball"]], 0.01, TRUNNION, threads).reached(
            places, np.arange(60)
        )
        for threads in (1, 2, 5)
    ]
    assert found[0].any() and not found[0].all()
    assert all(np.array_equal(found[0], other) for other in found[1:])


def test_looking_for_clear_poses_is_done_without_fixtures():
    held = PartContact(BLOCK.surfaces, CLAMP, fixtures=(CLAMP,))
    with pytest.raises(BadCall, match="without fixtures"):
        held.any_clear(
            EVERY_FORM["ball"],
            np.zeros((1, 1, 3)),
            np.eye(3)[None, 2:],
            np.ones((1, 1), bool),
            0.01,
            Obstacles.none(1),
        )
