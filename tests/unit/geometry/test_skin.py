"""The skin of a part: how near it is to the faces, that it is closed, looks out, and is fine only where that was asked for."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest
from pytest import approx
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from long_mark import mostly_long
from parts import PARTS, needs_parts
from samples import ball_shape, block_with_pocket_shape, box_shape, read
from trunnion import tolerance
from trunnion.findings import Cancelled
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.read.part_file import read_part
from trunnion.part.shape.skin import skin_of
from trunnion.progress import Progress

CHORD = 5e-4


def unpaired(skin):
    """Return how many edges of a skin don't lie between two triangles, points that coincide taken as one."""
    n, same = len(skin.points), cKDTree(skin.points).query_pairs(1e-5, output_type="ndarray")
    one = connected_components(coo_array((np.ones(len(same)), same.T), (n, n)))[1][skin.triangles]
    pairs = np.sort(one[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return int((np.unique(pairs, axis=0, return_counts=True)[1] != 2).sum())


def across(skin):
    a, b, c = np.moveaxis(skin.points[skin.triangles], 1, 0)
    return np.cross(b - a, c - a)


def test_a_box_is_twelve_triangles_with_the_normals_of_its_sides():
    skin = skin_of(read(box_shape()), WORLD, CHORD)
    assert len(skin.triangles) == 12 and skin.bound == 0.0
    assert np.abs(skin.normals).max(axis=1) == approx(np.ones(len(skin.normals)))
    assert unpaired(skin) == 0


def test_a_ball_is_within_its_bound_everywhere_and_has_radial_normals_at_its_poles_too():
    skin = skin_of(read(ball_shape()), WORLD, CHORD)
    ball = skin.of((int(np.bincount(skin.face).argmax()),))
    round_ = np.unique(skin.triangles[ball])
    assert np.linalg.norm(skin.points[round_], axis=1) == approx(
        np.full(len(round_), 10.0), abs=1e-6
    )
    assert np.abs(skin.normals[round_] - skin.points[round_] / 10.0).max() < 2e-3
    shares = np.random.default_rng(0).dirichlet([1.0, 1.0, 1.0], 30)
    off = 10.0 - np.linalg.norm(
        np.einsum("sk,tkc->tsc", shares, skin.points[skin.triangles[ball]]), axis=2
    )
    assert off.min() > -1e-9 and CHORD / 3 < off.max() <= skin.bound < 1.1 * CHORD
    assert unpaired(skin) == 0
    assert (across(skin) * skin.normals[skin.triangles].mean(axis=1)).sum(axis=1).min() > 0.0


def test_only_the_faces_that_were_asked_for_are_fine_and_their_neighbours_meet_them():
    part = read(block_with_pocket_shape())
    curved = [tag for tag in part.tags if skin_of(part, WORLD, 0.01).of((tag,)).sum() > 20]
    assert curved
    some, every = skin_of(part, WORLD, CHORD, fine=curved[:1]), skin_of(part, WORLD, CHORD)
    assert some.of(tuple(curved[:1])).sum() == every.of(tuple(curved[:1])).sum()
    assert len(some.triangles) < len(every.triangles)
    assert some.bound < 1.1 * CHORD
    assert unpaired(some) == unpaired(every) == 0
    a, b, c = np.moveaxis(some.points[some.triangles], 1, 0)
    assert (a * np.cross(b, c)).sum() / 6.0 == approx(part.volume, rel=1e-4)


def vase_shape():
    """Return a hollow vase turned from curves: inside and outside have seams, and the outside's bottom a pole."""

    def turned(low, curve, high):
        profile = (
            cq.Workplane("XZ")
            .moveTo(0.0, low)
            .spline(curve, includeCurrent=True)
            .lineTo(0.0, high)
            .close()
        )
        return profile.revolve(360, (0, 0, 0), (0, 1, 0))

    body = turned(0.0, [(12.0, 3.0), (8.0, 15.0), (14.0, 30.0)], 30.0)
    return body.cut(turned(4.0, [(9.0, 7.0), (6.0, 15.0), (12.0, 31.0)], 31.0)).val().wrapped


@pytest.mark.parametrize("suffix", mostly_long(["step", "igs"], "step"))
def test_faces_that_meet_themselves_in_a_seam_are_closed_there(suffix):
    part = read(vase_shape(), suffix)
    skin = skin_of(part, WORLD, 0.01)
    assert unpaired(skin) == 0 and skin.bound < 1.1 * 0.01
    a, b, c = np.moveaxis(skin.points[skin.triangles], 1, 0)
    assert (a * np.cross(b, c)).sum() / 6.0 == approx(part.volume, rel=1e-3)


def test_a_skin_lies_in_the_frame_it_is_asked_for():
    part, frame = (
        read(block_with_pocket_shape()),
        Frame(np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])),
    )
    here, there = skin_of(part, WORLD, 0.01), skin_of(part, frame, 0.01)
    assert here.moved(WORLD, frame).points == approx(there.points)
    assert here.moved(WORLD, frame).normals == approx(there.normals)


def test_the_same_part_gives_the_same_bytes():
    first, second = (skin_of(read(ball_shape()), WORLD, 0.002) for _ in range(2))
    assert all(
        getattr(first, name).tobytes() == getattr(second, name).tobytes()
        for name in ("points", "normals", "triangles", "face")
    )


def test_it_stops_when_asked():
    with pytest.raises(Cancelled):
        skin_of(read(ball_shape()), WORLD, CHORD, Progress(cancelled=lambda: True))


@pytest.mark.parts
@needs_parts
@pytest.mark.parametrize("name", ["D1"])
def test_free_form_parts_are_closed_and_as_near_as_wanted(name):
    part = read_part(PARTS / "surface" / f"{name}.step")
    skin = skin_of(part, WORLD, 2e-3)
    assert skin.bound < 1.1 * 2e-3 < tolerance.CHORD
    assert unpaired(skin) == 0
    assert (across(skin) * skin.normals[skin.triangles].mean(axis=1)).sum(axis=1).min() > -1e-9
    assert np.linalg.norm(across(skin), axis=1).sum() / 2.0 == approx(part.area, rel=1e-4)


def test_near_a_box_is_what_reaches_into_it_in_plan():
    skin = skin_of(read(ball_shape()), WORLD, CHORD)
    low, high = skin.box()
    for corners in np.random.default_rng(5).uniform(low[:2], high[:2], (20, 2, 2)):
        from_, to = corners.min(axis=0), corners.max(axis=0)
        some = skin.points[skin.triangles][:, :, :2]
        kept = ((some >= from_).any(axis=1) & (some <= to).any(axis=1)).all(axis=1)
        near = skin.near(from_, to)
        assert np.array_equal(near.points[near.triangles], skin.points[skin.triangles[kept]])
        assert np.array_equal(near.face, skin.face[kept])
