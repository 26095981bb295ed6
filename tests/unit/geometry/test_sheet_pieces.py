"""Large sheets in pieces: each within the limit, connected, nothing lost, along faces' borders as far as there are any."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surface_forms import cylinder, joined, plane
from trunnion.geometry.sheet.pieces import in_pieces
from trunnion.geometry.sheet.sheet import Sheet, sheet_of

ROW = joined(*(plane(6.0, 4.0, 7, tag=k + 1, start=6.0 * k) for k in range(8)))


def in_mm2(sheet: Sheet):
    return sheet.area()


@pytest.mark.parametrize("most", [200.0, 100.0, 60.0, 25.0])
def test_pieces_of_many_faces_are_whole_faces(most: float) -> None:
    sheet = sheet_of(ROW, tuple(range(1, 9)))
    pieces = in_pieces(sheet, in_mm2, most)
    tags = [set(p.face.tolist()) for p in pieces]
    assert sorted(t for each in tags for t in each) == list(range(1, 9))
    assert all(p.area().sum() <= most and len(p.components()) == 1 for p in pieces)
    # Neighbours in a row lie together.
    assert all(max(t) - min(t) == len(t) - 1 for t in tags)


@pytest.mark.parametrize("most", [20.0, 7.0, 3.0])
@pytest.mark.parametrize("skin", [plane(9.0, 5.0, 8), cylinder()])
def test_a_face_that_is_too_large_is_cut_straight_across(skin, most: float) -> None:
    sheet = sheet_of(skin, (1,))
    whole = sheet.area().sum()
    pieces = in_pieces(sheet, in_mm2, most)
    assert all(p.area().sum() <= most and len(p.components()) == 1 for p in pieces)
    assert sum(p.area().sum() for p in pieces) == pytest.approx(whole, rel=1e-3)
    # Cut in halves, and these again: there are no more pieces than that takes.
    assert len(pieces) <= 2 ** int(np.ceil(np.log2(whole / most)) + 1)


def test_what_is_within_the_limit_stays_as_it_is() -> None:
    sheet = sheet_of(ROW, (1, 2))
    assert in_pieces(sheet, in_mm2, 48.0 + 1e-6) == [sheet]


def test_pieces_are_the_same_every_time() -> None:
    sheet = sheet_of(ROW, tuple(range(1, 9)))
    one, two = (in_pieces(sheet, in_mm2, 11.0) for _ in range(2))
    assert all(
        np.array_equal(a.points, b.points) and np.array_equal(a.triangles, b.triangles)
        for a, b in zip(one, two, strict=True)
    )


def test_faces_that_share_a_corner_alone_are_parted_there():
    skin = joined(plane(4.0, 4.0, 5, tag=1), plane(4.0, 4.0, 5, tag=2, start=4.0))
    upper = skin.face == 2
    moved = skin.points.copy()
    rows = np.unique(skin.triangles[upper])
    moved[rows, 1] += 4.0
    sheet = sheet_of(replace(skin, points=moved), (1, 2))
    assert len(sheet.components()) == 1
    pieces = in_pieces(sheet, in_mm2, 20.0)
    assert sorted(p.face.tolist()[0] for p in pieces) == [1, 2]
    assert all(len(set(p.face.tolist())) == 1 for p in pieces)


def test_faces_about_one_middle_are_parted():
    sheet = sheet_of(ROW, (1, 2, 3))
    one = replace(sheet, face=np.where(sheet.face == 2, 2, 1))
    pieces = in_pieces(one, in_mm2, 50.0)
    assert sum(p.area().sum() for p in pieces) == pytest.approx(72.0) and len(pieces) == 3
