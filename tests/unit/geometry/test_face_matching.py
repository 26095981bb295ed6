"""Which faces of a part are which of its revision."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from revised_panels import PanelDesign
from samples import dome_on_a_plate_shape, read, renumbered
from trunnion.geometry.face_matching import FaceMatch, matched_faces

BASE = PanelDesign()
SIDES = {(1, 0): "+x", (-1, 0): "-x", (0, 1): "+y", (0, -1): "-y"}


def graph_of(design: PanelDesign, suffix: str = "step"):
    return read(design.shape(), suffix).graph()


def matched(before: PanelDesign, after: PanelDesign) -> FaceMatch:
    return matched_faces(graph_of(before), graph_of(after))


def named_faces(design: PanelDesign) -> dict[str, int]:
    """Return the tags of floors, walls of pockets, the island and holes of a design by what they are, told by where they lie."""
    graph, found = graph_of(design), {}
    for row, kind in enumerate(graph.surface):
        x, y, z = graph.centre[row]
        nx, ny, nz = np.round(graph.normal[row], 3)
        inside = 10.5 < x < 159.5 and 10.5 < y < 89.5
        where = design.place(x)
        if kind == "plane" and inside and nz > 0.9 and z < 19.0:
            found[f"{where} {'floor' if abs(z - design.floor(where)) < 0.01 else 'island'}"] = row
        elif kind == "plane" and nz == 0.0 and (int(nx), int(ny)) in SIDES and where:
            if 9.5 < x < 159.5 and 9.5 < y < 90.5:
                found[f"{where} wall {SIDES[int(nx), int(ny)]}"] = row
        elif kind == "cylinder" and graph.radius[row] == pytest.approx(3.0) and nz == 0.0:
            at = np.round(graph.axis_point[row, :2], 3)
            if (at[0], at[1]) in design.holes:
                found[f"hole {at[0]:g} {at[1]:g}"] = row
    return {name: row + 1 for name, row in found.items()}


def random_design(seed: int) -> PanelDesign:
    """Return a panel with some of its sizes changed, features more and less."""
    dice = Random(seed)
    right_length = dice.choice((53.0, 49.0, 45.0))
    return PanelDesign(
        left_floor=dice.choice((4.0, 5.0, 8.0)),
        left_length=dice.choice((58.0, 55.0)),
        right_floor=dice.choice((4.0, 3.0, 6.5)),
        right_x=dice.choice((98.5, 100.0)),
        right_length=right_length,
        island=dice.random() < 0.6,
        third=dice.random() < 0.4,
        holes=tuple(h for h in ((145.0, 20.0), (145.0, 80.0), (120.0, 5.0)) if dice.random() < 0.7),
    )


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_a_part_is_found_again_whatever_its_faces_are_numbered(suffix) -> None:
    before, after = graph_of(BASE), read(renumbered(BASE.shape()), suffix).graph()
    match = matched_faces(before, after)
    assert match.same.all() and sorted(match.tags) == list(range(1, len(before) + 1))
    low, high = after.box_low[match.tags - 1], after.box_high[match.tags - 1]
    assert np.abs(low - before.box_low).max() < 0.02 and np.abs(high - before.box_high).max() < 0.02


def test_curved_faces_are_found_again() -> None:
    before, after = (
        read(s).graph() for s in (dome_on_a_plate_shape(), renumbered(dome_on_a_plate_shape()))
    )
    match = matched_faces(before, after)
    assert match.same.all()
    assert [before.surface[r] for r in range(len(before))] == [
        after.surface[t - 1] for t in match.tags
    ]


@pytest.mark.parametrize("seed", range(16))
def test_what_a_face_is_stays_the_same_in_random_revisions(seed) -> None:
    before, after = random_design(seed), random_design(seed + 100)
    match = matched(before, after)
    old, new = named_faces(before), named_faces(after)
    assert len(old) > 8
    wrong = {
        name: (tag, match.of(tag), new[name])
        for name, tag in old.items()
        if name in new and match.of(tag) != new[name]
    }
    assert not wrong
    gone = {name: match.of(tag) for name, tag in old.items() if name not in new}
    # A hole in place of another one between the same faces is taken for one that was moved.
    assert all(
        tag not in new.values() or name.startswith("hole") for name, tag in gone.items() if tag
    )
    there = match.tags[match.tags > 0]
    assert len(set(there.tolist())) == len(there)


def test_faces_that_are_gone_have_no_counterpart() -> None:
    match = matched(BASE, PanelDesign(island=False))
    island = named_faces(BASE)["left island"]
    assert match.of(island) == 0 and (match.tags == 0).sum() == 2
    assert match.all_of((island, 1, 999)) == (match.of(1),)


def test_a_part_elsewhere_has_nothing_in_common() -> None:
    from samples import moved

    match = matched_faces(graph_of(BASE), read(moved(BASE.shape(), (500.0, 300.0, 70.0))).graph())
    assert not match.same.any()
