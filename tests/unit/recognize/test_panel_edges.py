"""What opens at a panel's edges: pockets and tunnels seen along it, whatever way the part lies."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import leaning_pockets
from blockparts import BlockPart
from samples import read
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.feature import FaceRole, Feature
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.panel.suitability import suitability
from trunnion.recognize.surface import SurfaceFamily
from trunnion.settings import choose

X, Y = (0.0, 20.0, 45.0, 55.0, 75.0, 100.0), (0.0, 15.0, 30.0, 45.0, 70.0)
Z = (0.0, 6.0, 14.0, 22.0, 30.0)
ASKEW = Frame(np.array([7.0, -3.0, 11.0]), np.array([0.6, 0.8, 0.0]), np.array([0.0, 0.0, 1.0]))
LYING = Frame(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]))


def recognized(part: BlockPart, **words: float):
    return PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, words), NO_PROGRESS
    )


def block(*taken, placed=WORLD) -> BlockPart:
    """Return a block with a pocket on top, which says where up is, and further cells taken."""
    full = np.ones((5, 4, 4), dtype=bool)
    for cells in ((2, 1, 3), *taken):
        full[cells] = False
    return BlockPart((X, Y, Z), full, placed)


def at_edges(found):
    return [f for f in found if "direction" in f.attributes]


def outward(found, feature, placed):
    """Return a feature's direction as the blocks have it."""
    out = found.frame.world_direction(np.array(feature.attributes["direction"]))
    return placed.local_direction(out)


@pytest.mark.parametrize("placed", [WORLD, ASKEW, LYING])
@pytest.mark.parametrize(
    ("cell", "direction", "depth"),
    [
        ((0, 1, 1), (-1.0, 0.0, 0.0), 20.0),
        ((4, 1, 1), (1.0, 0.0, 0.0), 25.0),
        ((1, 0, 1), (0.0, -1.0, 0.0), 15.0),
        ((1, 3, 1), (0.0, 1.0, 0.0), 25.0),
    ],
)
def test_a_recess_in_an_edge_is_a_pocket_that_opens_there(cell, direction, depth, placed):
    found = recognized(block(cell, placed=placed))
    (pocket,) = at_edges(found)
    assert pocket.kind == "pocket" and found.unexplained == ()
    assert outward(found, pocket, placed) == pytest.approx(direction)
    assert len(pocket.with_role("floor")) == 1 and len(pocket.with_role("wall")) == 4
    assert pocket.sizes["depth"] == depth
    assert pocket.sizes["top_z"] - pocket.sizes["floor_z"] == pytest.approx(depth)


def test_heights_at_an_edge_are_told_along_its_direction():
    (pocket,) = at_edges(recognized(block((1, 0, 1))))
    # The blocks' x, y and z are the panel's or run against them; y begins at the edge itself.
    y = pocket.attributes["direction"][1]
    assert y != 0.0
    low, high = (-15.0, 0.0) if y < 0.0 else (55.0, 70.0)
    assert (pocket.sizes["floor_z"], pocket.sizes["top_z"]) == (low, high)


def test_a_slot_along_an_edge_is_an_open_pocket():
    full = np.ones((5, 4, 4), dtype=bool)
    full[1:4, 1:3, 3] = False
    full[:, 3, 1] = False
    found = recognized(BlockPart(((0.0, 5.0, 50.0, 55.0, 100.0, 105.0), Y, Z), full))
    (slot,) = at_edges(found)
    assert slot.kind == "open_pocket" and found.unexplained == ()
    assert outward(found, slot, WORLD) == pytest.approx((0.0, 1.0, 0.0))


def test_a_tunnel_goes_through_and_is_reached_from_one_end():
    found = recognized(block((slice(None), 1, 1)))
    (tunnel,) = at_edges(found)
    assert tunnel.kind == "pocket" and found.unexplained == ()
    assert not tunnel.with_role("floor") and tunnel.attributes["through"]
    assert abs(tunnel.attributes["direction"][0]) == 1.0


def test_a_tunnel_with_a_web_in_it_is_a_pocket_from_either_end():
    ends = at_edges(recognized(block((slice(0, 2), 1, 1), (slice(3, 5), 1, 1))))
    assert sorted(f.attributes["direction"][0] for f in ends) == [-1.0, 1.0]
    assert all(len(f.with_role("floor")) == 1 for f in ends)


def test_tunnels_that_cross_have_all_their_faces():
    found = recognized(block((slice(None), 2, 1), (1, slice(None), 1)))
    assert found.unexplained == ()
    assert {abs(f.attributes["direction"][0]) for f in at_edges(found)} == {0.0, 1.0}


def test_pockets_at_edges_whose_walls_lie_in_one_plane_keep_their_own():
    found = recognized(block((0, 1, 1), (slice(1, 4), 3, 1)))
    pockets = at_edges(found)
    assert [len(p.tags) for p in pockets] == [5, 5] and found.unexplained == ()
    assert set(pockets[0].tags).isdisjoint(pockets[1].tags)


def test_a_recess_in_the_wall_of_a_pocket_is_seen_from_no_edge():
    assert at_edges(recognized(block((2, 1, slice(1, None)), (1, 1, 1)))) == []


def test_what_lies_behind_a_rim_is_seen_from_no_edge():
    """The ends of a low rib between leaning pockets: a level view sees them over the pockets, were it not for the rim before these."""
    part = read(leaning_pockets.ribbed_block())
    found = PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, {}), NO_PROGRESS
    )
    assert at_edges(found) == []


@pytest.mark.parametrize("placed", [WORLD, ASKEW, LYING])
def test_faces_that_a_person_puts_into_a_pocket_at_an_edge_say_what_recognition_says(placed):
    part = block((0, 1, 1), (1, 3, 1), placed=placed)
    found, graph = recognized(part), part.graph()
    for feature in found.of_kind("pocket"):
        bare = Feature(
            id=feature.id,
            kind=feature.kind,
            faces=tuple(FaceRole(role="face", face=t) for t in feature.tags),
        )
        made = PanelFamily().described(bare, found, graph, choose(PanelFamily.settings, {}))
        assert {(f.role, f.face) for f in made.faces} == {(f.role, f.face) for f in feature.faces}
        assert dict(made.attributes) == dict(feature.attributes)
        assert dict(made.sizes) == dict(feature.sizes)


@settings(max_examples=25, deadline=None)
@given(
    side=st.sampled_from(["-x", "+x", "-y", "+y"]),
    cuts=st.lists(st.floats(0.1, 0.9), min_size=2, max_size=2, unique_by=lambda v: round(v, 1)),
    depth=st.floats(0.05, 0.4),
)
def test_a_recess_anywhere_in_an_edge_is_the_pocket_that_it_is(side, cuts, depth):
    axis, sign = "xy".index(side[1]), 1.0 if side[0] == "+" else -1.0
    size = np.array([100.0, 70.0, 30.0])
    low, high = sorted(cuts)
    breaks = [[0.0, *(float(v) * size[a] for v in (low, high)), float(size[a])] for a in range(3)]
    inner = float(size[axis]) * (1.0 - depth if sign > 0.0 else depth)
    breaks[axis] = [0.0, inner, float(size[axis])]
    full = np.ones([len(b) - 1 for b in breaks], dtype=bool)
    cell = [1, 1, 1]
    cell[axis] = 1 if sign > 0.0 else 0
    full[tuple(cell)] = False
    part = BlockPart(tuple(tuple(b) for b in breaks), full)
    found = PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, {}), NO_PROGRESS
    )
    assert found.unexplained == ()
    (pocket,) = [f for f in found if f.kind == "pocket"]
    out = found.frame.world_direction(np.array(pocket.attributes.get("direction", (0, 0, 1))))
    assert out[axis] == pytest.approx(sign)
    assert pocket.sizes["depth"] == pytest.approx(depth * size[axis], abs=1e-3)


def test_walls_of_a_tunnel_that_lean_say_neither_where_up_is_nor_that_a_part_is_curved():
    profile = [(1.0, 1.0), (9.0, 3.0), (2.0, 9.0)]
    tool = cq.Workplane("XZ").polyline(profile).close().extrude(-10.0)
    cube = cq.Workplane().box(10, 10, 10, centered=False).cut(tool)
    part = read(cube.val().wrapped)
    graph = part.graph()
    panel, curved = suitability(graph), SurfaceFamily().suits(graph)
    assert panel.score > curved.score and panel.score == pytest.approx(1.0)
    found = PanelFamily().recognize(graph, part, choose(PanelFamily.settings, {}), NO_PROGRESS)
    assert np.abs(found.frame.z).max() == pytest.approx(1.0) and found.unexplained == ()
    (tunnel,) = found.of_kind("pocket")
    assert len(tunnel.tags) == 3
