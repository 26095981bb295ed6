"""Random tools, triangles and moves: the engine on triangles against a far finer search that samples, looks closer and samples again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

from samples import block_with_pocket_shape, read
from trunnion import tolerance
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.part.shape.surfaces import surfaces_of
from trunnion.verify.contact import PartContact
from trunnion.verify.contact.facets import FacetContact
from trunnion.verify.contact.obstacles import Obstacles
from trunnion.verify.kernels import body, tool_motion
from trunnion.verify.kernels.contact import facets as kernel
from trunnion.verify.motion import moves_of
from verify_tools import FORMS, bull, flat, joined_supports_of, plain_depth, program_section

DEEP = 1.0
"""mm: what the engine need not tell apart."""


def poses(move, share):
    """Return tips and axes (k, 3) at shares (k,) of a move (start, end, axis, end axis, centre or None, turn), written anew."""
    start, end, axis, end_axis, centre, turn = move
    share = share[:, None]
    if turn:
        across = start - centre - ((start - centre) @ axis) * axis
        climb = ((end - start) @ axis) * axis
        tips = (
            start
            - across
            + np.cos(turn * share) * across
            + np.sin(turn * share) * np.cross(axis, across)
            + share * climb
        )
        return tips, np.broadcast_to(axis, tips.shape)
    angle = math.atan2(np.linalg.norm(np.cross(axis, end_axis)), axis @ end_axis)
    if angle < 1e-12:
        return start + share * (end - start), np.broadcast_to(axis, (len(share), 3))
    return (
        start + share * (end - start),
        (np.sin((1 - share) * angle) * axis + np.sin(share * angle) * end_axis) / math.sin(angle),
    )


def depths(part, move, share, points):
    """Return how deep points (k, 3) are in a part of a tool at shares (k,) of a move."""
    tips, axes = poses(move, share)
    seen = points - tips
    h = (seen * axes).sum(axis=1)
    return plain_depth(part, np.linalg.norm(seen - h[:, None] * axes, axis=1), h)


def sampled_depth(part, move, corners, rounds=9, grid=(11, 7, 7), kept=5):
    """Return the deepest that a part of a tool enters a triangle (3, 3), by samples that close in on the best few places."""
    shares = np.stack(
        np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in grid), indexing="ij"), axis=-1
    ).reshape(-1, 3)
    best, boxes, size = -np.inf, [np.array([[0.0, 1.0]] * 3)], 1.0
    for _ in range(rounds):
        places = np.vstack([box[:, 0] + shares * (box[:, 1] - box[:, 0]) for box in boxes])
        t, root, v = places[:, 0], np.sqrt(places[:, 1])[:, None], places[:, 2][:, None]
        depth = depths(
            part,
            move,
            t,
            (1 - root) * corners[0] + root * (1 - v) * corners[1] + root * v * corners[2],
        )
        best = max(best, float(depth.max()))
        size, boxes, middles = size * 0.4, [], []
        for k in np.argsort(-depth)[:200]:
            place = places[k].tolist()
            if all(any(abs(x - m) > size / 2 for x, m in zip(place, middle)) for middle in middles):
                boxes.append(
                    np.clip(np.column_stack([places[k] - size / 2, places[k] + size / 2]), 0.0, 1.0)
                )
                middles.append(boxes[-1].mean(axis=1).tolist())
            if len(boxes) == kept:
                break
    return best


def attained(moves, kind, move, place):
    """Return the deepest that a position (3,) is in the tool's closed bodies of a kind along a move."""
    best = -np.inf
    for piece in moves.bodies.piece[moves.bodies.piece[:, body.KIND] == kind]:
        low, high, run = 0.0, 1.0, piece[[body.CLOSED_FIRST, body.CLOSED_LAST]].astype(int)
        for _ in range(8):
            share = np.linspace(low, high, 41)
            tips, axes = poses(move, share)
            h = ((place - tips) * axes).sum(axis=1)
            rho = np.linalg.norm(place - tips - h[:, None] * axes, axis=1)
            depth = [
                body.depth_in_body(moves.bodies.arc, *run, r, z)[0]
                for r, z in zip(rho, h, strict=True)
            ]
            k = int(np.argmax(depth))
            best, low, high = max(best, depth[k]), share[max(k - 2, 0)], share[min(k + 2, 40)]
    return best


def moves_for(tool, move):
    start, end, axis, end_axis, centre, turn = move
    motion = Motion.LINE if not turn else Motion.ARC_CCW if turn > 0 else Motion.ARC_CW
    path = Toolpath(
        position=[start, end],
        axis=[axis, end_axis],
        motion=[Motion.RAPID, motion],
        centre=[[np.nan] * 3, [np.nan] * 3 if centre is None else centre],
        feed=[0.0, 1000.0],
        mark=[0, 0],
    )
    return moves_of([ProgramSection(operation="op", tool=tool, spindle=10000.0, path=path)])


def facets(triangles):
    return Facets.of_mesh(
        np.reshape(triangles, (-1, 3)),
        np.arange(3 * len(triangles)).reshape(-1, 3),
        np.arange(len(triangles)),
        np.arange(1, len(triangles) + 1),
    )


NEAR = st.tuples(*[st.integers(-300, 300).map(lambda n: n / 50)] * 3).map(np.array)
SMALL = st.tuples(*[st.integers(-100, 100).map(lambda n: n / 100)] * 3).map(np.array)


def unit(vector):
    return vector / np.linalg.norm(vector)


@st.composite
def ways(draw):
    """A move near the origin: a pose, a plunge, a line, a line on which the axis turns a little or much, an arc or a helix."""
    kind = draw(
        st.sampled_from(["pose", "plunge", "line", "turning", "turning far", "arc", "helix"])
    )
    start, axis = draw(NEAR), unit(np.array([0.0, 0.0, 1.0]) + 0.6 * draw(SMALL) + [0.0, 0.0, 0.01])
    if kind in ("arc", "helix"):
        across = np.cross(axis, unit(draw(SMALL) + [1.5, 0.0, 0.0])) * draw(st.floats(0.5, 8.0))
        turn = draw(st.floats(0.1, 6.0)) * draw(st.sampled_from([-1.0, 1.0]))
        end = start - across + math.cos(turn) * across + math.sin(turn) * np.cross(axis, across)
        return (
            start,
            end + axis * (draw(st.floats(-3.0, 3.0)) if kind == "helix" else 0.0),
            axis,
            axis,
            start - across,
            turn,
        )
    way = {"pose": 0.0 * axis, "plunge": -draw(st.floats(0.1, 6.0)) * axis}.get(
        kind, draw(st.sampled_from([0.3, 3.0])) * draw(SMALL)
    )
    turned = {"turning": 0.05, "turning far": 1.0}.get(kind, 0.0) * draw(SMALL)
    return start, start + way, axis, unit(axis + turned) if turned.any() else axis, None, 0.0


TRIANGLES = st.lists(
    st.tuples(NEAR, SMALL, SMALL, SMALL, st.sampled_from([0.5, 5.0, 30.0])), min_size=1, max_size=3
).map(
    lambda rows: np.array(
        [[1.5 * at + size * corner for corner in corners] for at, *corners, size in rows]
    )
)


LEAN = unit(np.array([0.3524537, 0.16609887, 0.92097098]))
AT_A_JOINT = (
    np.array([-4.78, 2.7, -5.94]),
    np.array([-5.33372261, 2.43905027, -7.38689203]),
    LEAN,
    LEAN,
    None,
    0.0,
)
"""Ends with the edge of a holder, where its cone goes over into its cylinder, in a triangle: the cone is nearer than the cylinder."""


@pytest.mark.examples(12)
@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(form=st.sampled_from(sorted(FORMS)), move=ways(), triangles=TRIANGLES)
@example(
    form="form",
    move=AT_A_JOINT,
    triangles=np.array([[[-13.68, -13.77, -4.11], [29.82, -5.67, 30.09], [29.52, 2.43, -4.11]]]),
)
def test_the_deepest_of_a_random_move_is_within_the_bound_of_a_far_finer_search(
    form, move, triangles
):
    tool, moves = FORMS[form], moves_for(FORMS[form], move)
    parts = joined_supports_of(tool)
    touch = FacetContact(facets(triangles)).along(moves, np.array([1]), threads=1)
    bound = tolerance.TURNING_BOUND if moves.turning()[1] else tolerance.CONTACT_BOUND
    for kind in (0, 1):
        deepest, measured = (
            max(sampled_depth(p, move, t) for p in parts if p[3] == kind for t in triangles),
            touch.depth[0, kind],
        )
        assert min(deepest, DEEP) <= max(measured, 0.0) + bound
        if measured > -np.inf:
            assert (
                min(measured, DEEP) <= attained(moves, kind, move, touch.position[0, kind]) + 1e-5
            )


def motion_row(moves):
    """Return the second of some moves as the kernels read it."""
    row = np.zeros(tool_motion.MOTION_COLUMNS)
    fields = ("start", "end", "start_axis", "end_axis", "centre", "sweep")
    tool_motion.fill_tool_motion(*(getattr(moves, name)[1] for name in fields), row)
    return row


@settings(deadline=None, max_examples=60, phases=[Phase.explicit, Phase.generate])
@given(
    form=st.sampled_from(sorted(FORMS)), move=ways(), triangles=TRIANGLES, room=st.integers(1, 3)
)
def test_a_search_without_room_for_its_open_tasks_errs_deep(form, move, triangles, room):
    moves = moves_for(FORMS[form], move)
    row = motion_row(moves)
    run = moves.bodies.piece[0, [body.CLOSED_FIRST, body.CLOSED_LAST]].astype(int)
    normal = np.cross(triangles[0][1] - triangles[0][0], triangles[0][2] - triangles[0][0])
    normal = normal / np.linalg.norm(normal) if normal.any() else np.array([0.0, 0.0, 1.0])
    deepest = []
    for rows in (room, kernel.TASKS):
        found = np.full(4, -np.inf)
        space = [
            np.zeros(n)
            for n in (
                kernel.TASK_COLUMNS,
                (2, tool_motion.END_COLUMNS),
                tool_motion.SPAN_COLUMNS,
                (6, 3),
                (3, 6),
                (3, 3),
            )
        ]
        space[2][[tool_motion.S_FROM, tool_motion.S_TO]] = -1.0
        kernel.triangle_contact(
            triangles[0].ravel(),
            normal,
            row,
            0.0,
            1.0,
            moves.bodies.arc,
            *run,
            1e-4,
            1e-4,
            np.inf,
            found,
            np.zeros((rows, kernel.TASK_COLUMNS)),
            *space,
        )
        deepest.append(max(found[0], 1e-4))
    assert deepest[0] >= deepest[1] - 1e-4


@settings(deadline=None, max_examples=25, phases=[Phase.explicit, Phase.generate])
@given(
    form=st.sampled_from(sorted(FORMS)),
    move=ways(),
    triangles=TRIANGLES,
    allowed=st.sampled_from([0.005, 0.02, 0.5]),
)
def test_a_move_is_clear_when_it_is_measured_no_deeper(form, move, triangles, allowed):
    engine, moves = FacetContact(facets(triangles)), moves_for(FORMS[form], move)
    depth = float(engine.along(moves, np.array([1]), threads=1).depth.max())
    if abs(depth - allowed) > tolerance.TURNING_BOUND:
        assert np.isnan(engine.stopped(moves, np.array([1]), allowed)[0, 0]) == (depth <= allowed)


@st.composite
def frames(draw):
    """A frame somewhere, turned any way."""
    z = unit(draw(SMALL) + [0.0, 0.0, 1e-3])
    x = np.cross(z, [0.3, -0.2, 0.9])
    return Frame(draw(NEAR) * 10.0, x, z)


@pytest.mark.examples(15)
@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(
    form=st.sampled_from(sorted(FORMS)),
    move=ways(),
    triangles=TRIANGLES,
    frame=frames(),
    other=frames(),
    allowed=st.sampled_from([0.005, 0.5]),
)
def test_moves_in_another_frame_meet_triangles_as_if_these_were_moved_there(
    form, move, triangles, frame, other, allowed
):
    """The setups of a part share the tree of the first one's triangles."""
    moves, rows = moves_for(FORMS[form], move), np.array([1])
    there = facets(triangles)
    home = FacetContact(there.moved(other, frame)).seen_from(frame, other)
    one, same = (e.along(moves, rows, threads=1) for e in (FacetContact(there), home))
    bound = tolerance.TURNING_BOUND if moves.turning()[1] else tolerance.CONTACT_BOUND
    for kind in (0, 1):
        depth = [max(min(p.depth[0, kind], DEEP), 0.0) for p in (one, same)]
        assert abs(depth[1] - depth[0]) <= bound + 1e-6
        if same.depth[0, kind] > bound + 1e-6:
            place = same.position[0, kind]
            assert min(same.depth[0, kind], DEEP) <= attained(moves, kind, move, place) + 1e-5
    assert set(same.face_move.ravel().tolist()) <= {-1, 1}
    assert (same.face_move[same.face_depth > -np.inf] == 1).all()
    pose, axis = np.array([[move[0]]]), np.array([[move[2]]])
    clear, still = [], (move[0], move[0], move[2], move[2], None, 0.0)
    for engine in (FacetContact(there), home):
        known = Obstacles.none(1)
        clear.append(
            [
                engine.any_clear(FORMS[form], pose, axis, np.ones((1, 1), bool), allowed, known)[0]
                for _ in range(2)
            ]
        )
        for point in known.position[0, : known.count[0]]:
            assert max(attained(moves, kind, still, point) for kind in (0, 1)) > allowed - 1e-5
    depth = FacetContact(there).along(moves_for(FORMS[form], still), rows, threads=1).depth.max()
    if abs(depth - allowed) > 2.0 * tolerance.CONTACT_BOUND:
        assert clear[0] == clear[1] == [depth <= allowed] * 2


POCKET = read(block_with_pocket_shape())
BOTH = PartContact(surfaces_of(POCKET, WORLD)), FacetContact(facets_of(POCKET, WORLD))


@settings(deadline=None, max_examples=25, phases=[Phase.explicit, Phase.generate])
@given(
    start=st.tuples(st.floats(12.0, 48.0), st.floats(8.0, 28.0), st.floats(7.9, 9.5)),
    way=SMALL,
    tool=st.sampled_from([flat(6.0)(), bull(6.0, 1.0)(), bull(6.0, 3.0)(flute=4.0)]),
)
def test_an_upright_tool_is_as_deep_in_triangles_as_in_closed_forms(start, way, tool):
    end = np.array(start) + 8.0 * way * [1.0, 1.0, 0.05] + [0.01, 0.0, 0.0]
    moves = moves_of([program_section(tool, [start, end])])
    strips, triangles = BOTH
    exact, found = (
        strips.along(moves).depth[1],
        np.maximum(triangles.along(moves, np.array([1]), threads=1).depth[0], 0.0),
    )
    bound = 2 * tolerance.CONTACT_BOUND + triangles.facets.bound
    assert np.abs(np.minimum(exact, DEEP) - np.minimum(found, DEEP)).max() <= bound


@pytest.mark.parametrize("turn", [0.5, 2.0, 3.3, -4.5257, 5.5, 6.2])
def test_no_point_of_an_arc_leaves_its_chord_by_more_than_its_bulge(turn):
    """Beyond half a turn too: a bound that stopped growing there ruled out triangles that a helix entered by 1.25 mm."""
    axis, centre, start = np.array([0.0, 0.0, 1.0]), np.zeros(3), np.array([3.3, 0.0, 4.0])
    end = np.array([3.3 * math.cos(turn), 3.3 * math.sin(turn), 2.0])
    move = (start, end, axis, axis, centre, turn)
    row = motion_row(moves_for(FORMS["barrel"], move))
    ends, span = np.zeros((2, tool_motion.END_COLUMNS)), np.zeros(tool_motion.SPAN_COLUMNS)
    tool_motion.fill_swept_segment(row, 0.0, 1.0, ends, span)
    tips = poses(move, np.linspace(0.0, 1.0, 721))[0]
    chord = end - start
    share = np.clip((tips - start) @ chord / (chord @ chord), 0.0, 1.0)
    off = np.linalg.norm(tips - start - share[:, None] * chord, axis=1)
    assert off.max() <= span[tool_motion.S_BULGE] + 1e-9
