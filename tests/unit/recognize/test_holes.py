"""Holes from the face graph alone: every sort, joined faces, crossings, what is left of cut ones, and what is no hole."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt
from typing import Any

import cadquery as cq
import numpy as np
import pytest
from pytest import approx

import samples
from drilled_parts import (
    HEIGHT,
    MIDDLE,
    UP,
    block,
    box,
    cone,
    counterbored,
    countersunk,
    cylinder,
    drilled,
    flat_hole,
    graph_of,
    halved,
    holes_in,
    pointed,
    sizes_in,
    through,
)
from trunnion.findings import Cancelled
from trunnion.geometry.frame import WORLD
from trunnion.progress import Progress
from trunnion.recognize.holes.features import hole_feature
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.holes.sizes import diameter, hole_sizes

SORTS: dict[str, tuple[cq.Workplane, dict[str, Any], list[str]]] = {
    "through": (through(8), {"diameter": 8, "depth": 20, "through": True}, ["side"]),
    "blind": (
        flat_hole(8, 9),
        {"diameter": 8, "depth": 9, "through": False},
        ["side", "bottom"],
    ),
    "pointed": (
        pointed(8, 9),
        {"diameter": 8, "depth": 9, "through": False, "point_angle": 118},
        ["side", "bottom"],
    ),
    "with a ball at its end": (
        flat_hole(8, 9).union(cq.Workplane("XY").sphere(4).translate((0, 0, -9))),
        {"diameter": 8, "depth": 9, "through": False, "bottom_radius": 4},
        ["side", "bottom"],
    ),
    "counterbored": (
        counterbored(through(8), 14, 6),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "counterbore_diameter": 14,
            "counterbore_depth": 6,
        },
        ["counterbore_side", "counterbore_floor", "side"],
    ),
    "blind counterbored": (
        counterbored(pointed(8, 13), 14, 6),
        {
            "diameter": 8,
            "depth": 13,
            "through": False,
            "counterbore_diameter": 14,
            "counterbore_depth": 6,
            "point_angle": 118,
        },
        ["counterbore_side", "counterbore_floor", "side", "bottom"],
    ),
    "countersunk": (
        countersunk(through(8), 16, 8, 100),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "countersink_diameter": 16,
            "countersink_angle": 100,
        },
        ["countersink", "side"],
    ),
    "stepped": (
        counterbored(counterbored(through(6), 10, 14), 16, 6),
        {
            "diameter": 6,
            "depth": 20,
            "through": True,
            "counterbore_diameter": 16,
            "counterbore_depth": 6,
            "diameters": (16, 10, 6),
            "step_depths": (6, 14, 20),
        },
        ["counterbore_side", "counterbore_floor", "counterbore_side", "counterbore_floor", "side"],
    ),
    "with a conical shoulder": (
        counterbored(through(6), 10, 10).union(cone(6, 10, 2, (0, 0, -12))),
        {
            "diameter": 6,
            "depth": 20,
            "through": True,
            "counterbore_diameter": 10,
            "counterbore_depth": 10,
            "shoulder_angle": 90,
        },
        ["counterbore_side", "counterbore_floor", "side"],
    ),
    "countersunk in its counterbore": (
        counterbored(through(8), 20, 6).union(cone(8, 10, 1, (0, 0, -7))),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "counterbore_diameter": 20,
            "counterbore_depth": 6,
            "countersink_diameter": 10,
            "countersink_angle": 90,
        },
        ["counterbore_side", "counterbore_floor", "countersink", "side"],
    ),
    "with both edges broken": (
        through(8).union(cone(8, 10, 1, (0, 0, -1))).union(cone(12, 8, 2, (0, 0, -20))),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "countersink_diameter": 12,
            "countersink_angle": 90,
            "back_countersink_diameter": 10,
            "back_countersink_angle": 90,
        },
        ["countersink", "side", "countersink"],
    ),
    "counterbored from below": (
        through(8).union(cylinder(14, 6, (0, 0, -20))),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "counterbore_diameter": 14,
            "counterbore_depth": 6,
        },
        ["counterbore_side", "counterbore_floor", "side"],
    ),
    "with a groove inside": (
        through(8).union(cylinder(10, 2, (0, 0, -8))),
        {
            "diameter": 8,
            "depth": 20,
            "through": True,
            "diameters": (8, 10, 8),
            "step_depths": (6, 8, 20),
        },
        ["side"] * 5,
    ),
    "with an undercut at its bottom": (
        flat_hole(8, 12).union(cylinder(11, 2, (0, 0, -12))),
        {"diameter": 8, "depth": 12, "through": False},
        ["side", "side", "side", "bottom"],
    ),
    "tapered": (
        cone(6, 8, 20, (0, 0, -20)),
        {"diameter": 6, "depth": 20, "through": True, "taper_angle": 5.725},
        ["side"],
    ),
    "a countersink alone": (
        cone(0, 6, 3, (0, 0, -3)),
        {"diameter": 6, "depth": 3, "through": False, "point_angle": 90},
        ["bottom"],
    ),
}
"""What is cut from the top of the block, its sizes and the roles of its faces from the mouth down."""


def plain(sizes: Mapping[str, Any]) -> dict[str, Any]:
    """Return sizes to a micrometre, without where the hole is."""
    return {
        k: np.round(np.array(v, dtype=float), 3).tolist()
        for k, v in sizes.items()
        if k not in ("x", "y", "top_z")
    }


@pytest.mark.parametrize("sort", SORTS)
def test_a_hole_is_found_with_its_sizes_and_roles(sort: str) -> None:
    cutter, sizes, roles = SORTS[sort]
    (hole,) = holes_in(drilled(cutter))
    feature = hole_feature(hole, "hole-01", WORLD)
    assert plain(feature.sizes) == plain(sizes)
    assert [f.role for f in feature.faces] == roles


@pytest.mark.parametrize("sort", SORTS)
def test_faces_in_two_halves_are_one_hole(sort: str) -> None:
    cutter, sizes, roles = SORTS[sort]
    (hole,) = holes_in(halved(drilled(cutter)))
    assert plain(hole_sizes(hole)) == plain(sizes)
    assert len(hole.faces) == 2 * len(roles)


def all_sorts() -> Any:
    """Return a plate with one hole of every sort."""
    plate = box((200, 170, HEIGHT))
    for n, (cutter, *_) in enumerate(SORTS.values()):
        plate = plate.cut(cutter.translate((25 + 45 * (n % 4), 20 + 40 * (n // 4), HEIGHT)))
    return plate.val().wrapped


@pytest.mark.parametrize(
    ("suffix", "unit", "moved"),
    [
        ("step", "mm", "not"),
        ("igs", "mm", "turned"),
        ("step", "mm", "mirrored"),
        ("step", "inch", "far"),
        ("igs", "inch", "turned"),
    ],
)
def test_holes_are_found_wherever_the_part_lies(suffix: str, unit: str, moved: str) -> None:
    shape, up = all_sorts(), UP
    if moved == "turned":
        shape = samples.turned(shape, (1, 2, 2), 71.0, about=(10, 20, 30))
        up = np.array(samples.turned_direction((0, 0, 1), (1, 2, 2), 71.0))
    elif moved == "mirrored":
        shape, up = samples.mirrored(shape, "XY"), -UP
    elif moved == "far":
        shape = samples.moved(shape, (6000, -7000, 4000))
    found = find_holes(samples.read(shape, suffix, unit).graph(), 30.0, up)
    below = plain(SORTS["counterbored from below"][1])
    sizes = sorted((plain(hole_sizes(h)) for h in found), key=str)
    assert sizes == sorted((plain(s) for _, s, _ in SORTS.values()), key=str)
    looks_down = [plain(hole_sizes(h)) for h in found if h.direction @ up < -0.999]
    assert all(h.direction @ up == approx(1.0) or h.direction @ up == approx(-1.0) for h in found)
    assert below in looks_down and len(looks_down) == 2


# Where a hole opens


def test_the_mouth_is_where_the_highest_rim_is() -> None:
    lower = drilled(through(8)).cut(box((20, 40, 10), (0, 0, 10)))
    (hole,) = holes_in(lower)
    assert hole.mouth == approx([20, 20, 20]) and hole_sizes(hole)["depth"] == approx(20)


@pytest.mark.parametrize("angle", [1e-4, 0.01, 0.03, 0.049, 0.06])
def test_a_part_that_leans_a_little_has_the_same_sizes(angle: float) -> None:
    shape = drilled(flat_hole(10.0, 3.0)).val().wrapped
    up = np.array(samples.turned_direction((0, 0, 1), (0, 1, 0), angle))
    (found,) = find_holes(graph_of(samples.turned(shape, (0, 1, 0), angle)), 30.0, up)
    assert hole_sizes(found) == {"diameter": 10.0, "depth": 3.0, "through": False}


def test_an_inclined_hole_reaches_from_rim_to_rim() -> None:
    along = np.array([1.0, 0.0, 1.0]) / sqrt(2.0)
    (hole,) = holes_in(block().cut(cylinder(8, 80, np.array([30, 20, 10]) - 40 * along, along)))
    # The block is 20 mm thick: 20 / cos 45 along the axis, and its rims slope by 8 tan 45.
    assert hole_sizes(hole)["depth"] == approx(20 * sqrt(2) + 8)
    assert hole.direction == approx(along) and hole.through


def test_a_radial_hole_reaches_to_the_crest_of_the_round_wall() -> None:
    pipe = cq.Workplane("XY").circle(30).circle(24).extrude(40)
    one, other = holes_in(pipe.cut(cylinder(8, 80, (-40, 0, 20), (1, 0, 0))))
    for hole in (one, other):
        assert hole_sizes(hole)["depth"] == approx(30 - sqrt(24**2 - 4**2), abs=1e-3)
        outward = hole.mouth - np.array([0, 0, 20])
        assert hole.direction == approx(outward / np.linalg.norm(outward))


def test_a_hole_in_the_floor_of_a_slot_or_of_a_pocket_with_a_fillet_begins_there() -> None:
    slot = cq.Workplane("XY").slot2D(24, 10).extrude(30).translate((25, 20, 10))
    pocket = cylinder(20, 30, (30, 20, 10)).faces("<Z").edges().fillet(2)
    for shape, at in ((block().cut(slot), (18, 20)), (block().cut(pocket), (30, 20))):
        (sizes,) = sizes_in(shape.cut(cylinder(5, 40, (*at, -5))))
        assert plain(sizes) == plain({"diameter": 5, "depth": 10, "through": True})


def test_a_hole_in_a_boss_keeps_the_boss_out() -> None:
    shape = block().union(cylinder(12, 10, (20, 20, 20)))
    assert holes_in(shape) == ()
    (hole,) = holes_in(shape.cut(cylinder(5, 50, (20, 20, -5))))
    assert len(hole.faces) == 1 and hole_sizes(hole)["depth"] == approx(30)


def test_a_small_hole_beside_the_middle_of_a_counterbore_opens_in_its_floor() -> None:
    shape = drilled(counterbored(through(6), 24, 6)).cut(cylinder(4, 40, (28, 20, -5)))
    wide, small = sorted(holes_in(shape), key=lambda h: -len(h.faces))
    assert plain(hole_sizes(small)) == plain({"diameter": 4, "depth": 14, "through": True})
    assert set(small.opens_in) <= set(wide.faces) and small.crosses == ()


def test_coaxial_holes_in_two_walls_are_two() -> None:
    fork = box((60, 40, 10)).union(box((60, 40, 10), (0, 0, 30))).union(box((10, 40, 40)))
    found = sizes_in(fork.cut(cylinder(8, 60, (40, 20, -5))))
    assert [plain(s) for s in found] == 2 * [plain({"diameter": 8, "depth": 10, "through": True})]


# Holes that cross


@pytest.mark.parametrize("across", [8, 5])
def test_crossing_holes_are_one_each(across: float) -> None:
    one, other = (
        cylinder(8, 70, (-5, 20, 10), (1, 0, 0)),
        cylinder(across, 50, (30, -5, 10), (0, 1, 0)),
    )
    found = holes_in(block().cut(one).cut(other))
    sizes = sorted((plain(hole_sizes(h)) for h in found), key=lambda s: -s["depth"])
    assert sizes == [
        plain({"diameter": 8, "depth": 60, "through": True}),
        plain({"diameter": across, "depth": 40, "through": True}),
    ]
    assert all(set(h.crosses) <= set(o.faces) for h, o in zip(found, found[::-1], strict=True))


def test_a_hole_that_ends_in_another_is_drilled_from_outside() -> None:
    shape = block().cut(cylinder(8, 70, (-5, 20, 10), (1, 0, 0))).cut(cylinder(5, 30, (30, 20, 10)))
    for up in (UP, -UP):
        small = min(find_holes(graph_of(shape), 30.0, up), key=diameter)
        assert small.through and small.direction == approx([0, 0, 1])
        assert hole_sizes(small)["depth"] == approx(10 - sqrt(4**2 - 2.5**2), abs=1e-3)


def test_a_blind_hole_that_ends_beyond_another_is_one() -> None:
    shape = block().cut(cylinder(8, 70, (-5, 20, 10), (1, 0, 0))).cut(cylinder(5, 30, (30, 20, 3)))
    sizes = [plain(s) for s in sizes_in(shape)]
    assert len(sizes) == 2 and plain({"diameter": 5, "depth": 17, "through": False}) in sizes


# Holes that other faces cut


@pytest.mark.parametrize(("y", "there"), [(1.5, True), (0.0, False), (-1.5, False)])
def test_a_hole_at_the_edge_counts_when_more_than_half_of_it_is_there(
    y: float, there: bool
) -> None:
    found = holes_in(drilled(through(12), (20, y)))
    assert bool(found) is there
    assert all("open_side" in hole_feature(h, "", WORLD).attributes for h in found)


def test_keyways_leave_one_hole() -> None:
    for broad, faces in ((12, 1), (24, 2)):
        shape = drilled(through(16), (30, 20)).cut(box((5, broad, 30), (27.5, 20 - broad + 12, -5)))
        (hole,) = holes_in(shape)
        assert len(hole.faces) == faces and hole_sizes(hole)["diameter"] == approx(16)


def test_a_counterbore_that_runs_out_of_a_side_stays_with_its_hole() -> None:
    (sizes,) = sizes_in(drilled(counterbored(through(6), 12, 6), (4.5, 20)))
    assert sizes["counterbore_diameter"] == approx(12) and sizes["counterbore_depth"] == approx(6)


# What is no hole


def ring_groove() -> cq.Workplane:
    return flat_hole(24, 8).cut(cylinder(12, 30, (0, 0, -20)))


def crossed_by_webs() -> cq.Workplane:
    return (
        flat_hole(24, 8).cut(box((60, 4, 60), (-30, -2, -30))).cut(box((4, 60, 60), (-2, -30, -30)))
    )


def rounded_pocket(length: float, width: float, radius: float) -> cq.Workplane:
    pocket = box((length, width, 30), (-length / 2, -width / 2, -10))
    return pocket.edges("|Z").fillet(radius)


@pytest.mark.parametrize(
    "cutter",
    [
        flat_hole(34, 8),
        flat_hole(20, 8).faces("<Z").edges().fillet(2),
        ring_groove(),
        crossed_by_webs(),
        cq.Workplane("XY").slot2D(24, 10).extrude(30).translate((0, 0, -10)),
        cq.Workplane("XY").slot2D(24, 10).extrude(60).translate((0, 0, -30)),
        rounded_pocket(24, 20, 6),
        rounded_pocket(24, 20, 6).faces("<Z").edges().fillet(2),
        flat_hole(12, 8).union(flat_hole(12, 8).translate((9, 0, 0))),
        cone(14, 16, 8, (0, 0, -8)),
        cq.Workplane("XY").sphere(6).translate((0, 0, 2)),
        cylinder(8, 10, (0, 0, -15)),
    ],
    ids=[
        "wider than the largest hole",
        "round with a floor fillet",
        "a ring around an island",
        "crossed by webs",
        "slot",
        "slot right through",
        "pocket with round corners",
        "pocket with fillets",
        "two overlapping recesses with one floor",
        "recess with leaning walls and a level floor",
        "dimple",
        "void inside",
    ],
)
def test_other_hollows_are_no_holes(cutter: cq.Workplane) -> None:
    assert holes_in(drilled(cutter)) == ()


def test_the_largest_diameter_is_a_choice() -> None:
    shape = drilled(counterbored(through(12), 24, 6))
    assert len(holes_in(shape, 24.0)[0].faces) == 3
    (hole,) = holes_in(shape, 20.0)
    assert hole.mouth == approx([*MIDDLE, 14]) and len(hole.faces) == 1
    assert holes_in(shape, 10.0) == ()


def test_cancelling_stops_the_search() -> None:
    with pytest.raises(Cancelled):
        find_holes(graph_of(drilled(through(8))), 30.0, UP, Progress(cancelled=lambda: True))
