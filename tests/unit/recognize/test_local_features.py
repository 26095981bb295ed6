"""Local features: what is proposed on parts whose blades, bosses and hollows are known, and why."""

from __future__ import annotations

import json

import cadquery as cq
import numpy as np
import pytest

from long_mark import mostly_long
from parts import PARTS, needs_parts
from samples import read
from scoring import faces_by_kind
from seeded.blades import fan, split_fan
from seeded.parts import Seeded
from seeded.plates import plate
from trunnion.part.read.part_file import read_part
from trunnion.recognize.surface import SurfaceFamily
from trunnion.recognize.surface.local import natural_break
from trunnion.recognize.surface.settings import SurfaceSettings
from trunnion.settings import choose

BASE = 6
"""Faces of a seeded plate without local features: its top, its bottom and four sides."""


def recognised(part, **words):
    words = {f"recognize.surface.{name}": value for name, value in words.items()}
    return SurfaceFamily().recognize(part.graph(), part, choose(SurfaceSettings, words))


def local_of(found) -> set[int]:
    return {t for f in found if f.attributes["local"] for t in f.tags}


def told(found) -> str:
    (finding,) = [f for f in found.findings if f.code == "surface.local"]
    return finding.text


def in_file(made: Seeded, suffix: str = "step"):
    return read(made.shape, suffix, made.unit)


def pieces(graph, tags: set[int]) -> int:
    """Return in how many connected pieces some faces are."""
    remaining, count = set(tags), 0
    while remaining:
        waiting, count = [remaining.pop()], count + 1
        while waiting:
            near = {r + 1 for r in graph.neighbours(waiting.pop() - 1)} & remaining
            remaining -= near
            waiting += near
    return count


@pytest.mark.parametrize("seed", mostly_long(range(16), 1, 6))
def test_all_that_stands_on_a_plate_is_proposed_and_nothing_else(seed: int) -> None:
    made = plate(seed)
    part = in_file(made, "igs" if seed % 3 == 2 else "step")
    local = local_of(recognised(part))
    assert pieces(part.graph(), local) == sum(made.counts.values())
    assert len(part.tags) - len(local) == BASE


@pytest.mark.parametrize("seed", mostly_long(range(8), 4))
def test_the_splitters_of_a_fan_are_proposed_and_nothing_else(seed: int) -> None:
    made = split_fan(seed)
    part = in_file(made, "igs" if seed % 3 == 1 else "step")
    local = local_of(recognised(part))
    assert pieces(part.graph(), local) == made.counts["splitter"]
    assert len(local) >= 5 * made.counts["splitter"]
    if not made.smallest_radius:
        assert len(local) == 5 * made.counts["splitter"]
        assert len(part.tags) - len(local) == 5 * made.counts["blade"] + 3


@pytest.mark.parametrize("seed", mostly_long(range(3)))
def test_equal_blades_are_what_a_fan_is_and_none_is_proposed(seed: int) -> None:
    found = recognised(in_file(fan(seed)))
    assert not local_of(found)
    assert told(found).startswith("no local feature is proposed: ")


def beam_with_a_boss():
    """Return a beam 80 by 8 by 8 mm with a boss 8 by 4 by 8 mm on it: two sides of the boss are as large as the beam's ends."""
    beam = cq.Workplane("XY").box(80.0, 8.0, 8.0, centered=(True, True, False))
    boss = cq.Workplane("XY").box(8.0, 4.0, 16.0, centered=(True, True, False))
    return read(beam.union(boss).val().wrapped)


@pytest.mark.parametrize("grouping", ["invariant", "aligned"])
def test_the_faces_of_one_boss_are_judged_together_and_equal_ones_elsewhere_are_not_taken_along(
    grouping: str,
) -> None:
    part = beam_with_a_boss()
    found = recognised(part, grouping=grouping)
    boss = {int(r) + 1 for r in np.flatnonzero(part.graph().box_high[:, 2] > 8.1)}
    assert local_of(found) == boss and len(boss) == 5
    ends = [f for f in found if f.sizes["diameter"] == pytest.approx(np.hypot(8.0, 8.0))]
    assert sorted((len(f.tags), f.attributes["local"]) for f in ends) == [(2, False), (2, True)]


def test_a_post_that_holds_two_plates_together_is_no_local_feature() -> None:
    plate = cq.Workplane("XY").box(30.0, 30.0, 6.0)
    post = cq.Workplane("XY").circle(6.0).extrude(30.0)
    spool = plate.translate((0, 0, 3)).union(post).union(plate.translate((0, 0, 29)))
    found = recognised(read(spool.val().wrapped))
    assert not local_of(found)
    assert told(found) == (
        "no local feature is proposed: connected faces measure 23.3 to 42.8 mm, and what is smaller by a gap is more than 33 % of the "
        "area or holds the rest together"
    )


def test_a_finding_names_the_gap() -> None:
    assert told(recognised(beam_with_a_boss())) == (
        "sizes of connected faces jump from 12.0 to 80.8 mm: everything below is proposed as local, 5 faces in 1 cluster, "
        "8 % of the area"
    )


def test_a_person_s_own_threshold_goes_over_the_gap() -> None:
    found = recognised(beam_with_a_boss(), local_ratio=0.12)
    assert {f.sizes["size_ratio"] < 0.12 for f in found if f.attributes["local"]} == {True}
    assert not any(f.sizes["size_ratio"] < 0.12 for f in found if not f.attributes["local"])
    assert [f for f in found.findings if f.code == "surface.local"] == []
    assert local_of(found) < local_of(recognised(beam_with_a_boss()))


@pytest.mark.parametrize(
    ("size", "area", "above"),
    [
        # The blades' gap is the wider one in area, but all blades are more than a third.
        ([60.0, 45.0, 45.0, 22.0], [30.0, 28.0, 28.0, 14.0], 3),
        # 2 mm is the wider gap, but hardly any area: what is a third of the rest goes with it.
        ([60.0, 45.0, 22.0, 2.0], [30.0, 57.0, 12.9, 0.1], 2),
        ([113.0, 14.4, 9.0, 5.0], [97.0, 1.0, 1.0, 1.0], 1),
        ([50.0, 41.0, 33.0], [40.0, 35.0, 25.0], 3),
        ([50.0], [1.0], 1),
    ],
)
def test_sizes_break_where_their_classes_differ_most(size, area, above: int) -> None:
    assert natural_break(np.array(size), np.array(area)) == above


GROUPINGS = (("aligned", "features"), ("invariant", "features_by_invariant_size"))


@needs_parts
@pytest.mark.parametrize(
    "name",
    mostly_long(
        [f"D{n}.{suffix}" for n in (1, 2, 3) for suffix in ("step", "igs")], "D1.step", "D2.igs"
    ),
)
def test_local_features_are_those_of_the_truth(name: str) -> None:
    truth = json.loads((PARTS / "surface" / f"{name[:2]}.truth.json").read_text())
    number = "step_face" if name.endswith("step") else "iges_face"
    by_place = {tuple(f["at"]): f[number] for f in truth["faces"]}
    part = read_part(PARTS / "surface" / name)
    for grouping, key in GROUPINGS:
        wanted = truth[key] if grouping == "aligned" else truth[key]["features"]
        assert local_of(recognised(part, grouping=grouping)) == {
            by_place[tuple(q["at"])] for f in wanted if f["local"] for q in f["faces"]
        }


@needs_parts
@pytest.mark.long
@pytest.mark.parametrize("name", ["C1", "C3", "C4"])
def test_on_wheels_the_splitters_are_proposed_and_nothing_else(name: str) -> None:
    file = PARTS / "impeller" / f"{name}.step"
    assert local_of(recognised(read_part(file))) == faces_by_kind("impeller", name, file).get(
        "splitter", set()
    )


@needs_parts
@pytest.mark.long
def test_nothing_is_proposed_on_a_wheel_with_equal_blades_whose_surfaces_leave_gaps() -> None:
    assert not local_of(recognised(read_part(PARTS / "public" / "impeller" / "impeller.igs")))
