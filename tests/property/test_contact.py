"""Random tools, faces and moves: the contact engine against a far finer search that samples, looks closer and samples again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from pytest import approx

from trunnion import tolerance
from trunnion.part.shape import surfaces
from trunnion.part.shape.surfaces import (
    STRIP_COLUMNS,
    ContactFace,
    Guide,
    Profile,
    TrimEdge,
    circle_edges,
    level_face,
    line_edges,
    strip_row,
    surfaces_from,
)
from trunnion.verify.contact import PartContact, grid_of
from trunnion.verify.contact.strips import StripContact
from trunnion.verify.kernels.contact import strips as kernel
from trunnion.verify.motion import moves_of, poses_of
from verify_tools import (
    FORMS,
    block_with_pocket,
    plain_depth,
    program_section,
    rounded,
    supports_of,
)

NUMBER = st.integers(-1000, 1000).map(lambda n: n / 50)


def sampled_depth(strip, move, part, rounds=9, grid=41, kept=6):
    """Return the deepest that a part of a tool enters a strip, by samples of move and profile that close in on the best places."""
    boxes = [np.array([[0.0, 1.0]] * 2)]
    shares = np.stack(
        np.meshgrid(*[np.linspace(0.0, 1.0, grid)] * 2, indexing="ij"), axis=-1
    ).reshape(-1, 2)
    size, best = 1.0, (-np.inf, np.zeros(2))
    for _ in range(rounds):
        places = np.vstack([box[:, 0] + shares * (box[:, 1] - box[:, 0]) for box in boxes])
        depth = _depths(strip, move, part, *places.T)
        best = max(best, (float(depth.max()), places[np.argmax(depth)]), key=lambda found: found[0])
        size *= 0.3
        boxes, middles = [], []
        for k in np.argsort(-depth)[:200]:
            place = places[k].tolist()
            if all(any(abs(x - m) > size / 2 for x, m in zip(place, middle)) for middle in middles):
                boxes.append(
                    np.clip(np.column_stack([places[k] - size / 2, places[k] + size / 2]), 0.0, 1.0)
                )
                middles.append(boxes[-1].mean(axis=1).tolist())
            if len(boxes) == kept:
                break
    return _climbed(strip, move, part, *best)


def _climbed(strip, move, part, best, place):
    """Return the deepest that is found by walking uphill from a place: a narrow ridge may lie between all samples."""
    random, step, failed = np.random.default_rng(0), 0.1, 0
    while step > 1e-9:
        places = np.clip(place + step * random.normal(size=(400, 2)), 0.0, 1.0)
        depth = _depths(strip, move, part, *places.T)
        if depth.max() > best:
            best, place, failed = float(depth.max()), places[np.argmax(depth)], 0
        else:
            failed += 1
        if failed == 2:
            step, failed = step * 0.5, 0
    return best


def _depths(strip, move, part, t, u):
    px, py, tip, rise = _tips(move, t)
    rho, z = nearest_of_guide(strip, px, py, u)
    return plain_depth(part, rho, z - tip, rise)


def _tips(move, t):
    """Return the tips (n,) of a move at shares (n,) of it: x, y, z, and how far they are swept upwards."""
    tip = move[kernel.Z_START] + t * (move[kernel.Z_END] - move[kernel.Z_START])
    if move[kernel.KIND] == 0.0:
        px, py = (
            move[kernel.X0] + t * (move[kernel.X1] - move[kernel.X0]),
            move[kernel.Y0] + t * (move[kernel.Y1] - move[kernel.Y0]),
        )
    else:
        angle = move[kernel.START_ANGLE] + t * move[kernel.SWEEP]
        px, py = (
            move[kernel.CX] + move[kernel.RADIUS] * np.cos(angle),
            move[kernel.CY] + move[kernel.RADIUS] * np.sin(angle),
        )
    # Upright, a move is one body, swept from its lowest to its highest place.
    upright = (
        move[kernel.KIND] == 0.0
        and move[kernel.X0] == move[kernel.X1]
        and move[kernel.Y0] == move[kernel.Y1]
    )
    ends = move[[kernel.Z_START, kernel.Z_END]]
    return px, py, *((ends.min(), np.ptp(ends)) if upright else (tip, 0.0))


def nearest_of_guide(strip, px, py, share):
    """Return how far points (n,) in plan are from a strip's guide at shares (n,) of its profile, and the height there."""
    u = strip[surfaces.U0] + share * (strip[surfaces.U1] - strip[surfaces.U0])
    left = strip[surfaces.LA] + strip[surfaces.LB] * (u - strip[surfaces.U0])
    right = strip[surfaces.RA] + strip[surfaces.RB] * (u - strip[surfaces.U0])
    if strip[surfaces.PROFILE]:
        w, z = (
            strip[surfaces.PW0] + strip[surfaces.PW1] * np.cos(u),
            strip[surfaces.PZ0] + strip[surfaces.PW1] * np.sin(u),
        )
    else:
        w = strip[surfaces.PW0] + share * (strip[surfaces.PW1] - strip[surfaces.PW0])
        z = strip[surfaces.PZ0] + share * (strip[surfaces.PZ1] - strip[surfaces.PZ0])
    x, y = px - strip[surfaces.OX], py - strip[surfaces.OY]
    if strip[surfaces.GUIDE]:
        middle, half = 0.5 * (left + right), np.maximum(0.5 * (right - left), 0.0)
        off = np.clip(
            np.remainder(np.arctan2(y, x) - middle + math.pi, math.tau) - math.pi, -half, half
        )
        return np.hypot(x - w * np.cos(middle + off), y - w * np.sin(middle + off)), z
    along = np.clip(x * strip[surfaces.DX] + y * strip[surfaces.DY], left, right)
    return np.hypot(
        x + w * strip[surfaces.DY] - along * strip[surfaces.DX],
        y - w * strip[surfaces.DX] - along * strip[surfaces.DY],
    ), z


@st.composite
def strips(draw):
    """A strip near the origin: any guide, any profile, ends that may lean."""
    turning = draw(st.booleans())
    low = draw(st.floats(-3.0, 3.0)) if turning else draw(st.floats(-20.0, 0.0))
    high = low + (draw(st.floats(0.2, 6.0)) if turning else draw(st.floats(0.5, 30.0)))
    angle = draw(st.floats(0.0, 6.28))
    guide = (
        Guide(1, draw(NUMBER), draw(NUMBER))
        if turning
        else Guide(0, draw(NUMBER), draw(NUMBER), math.cos(angle), math.sin(angle))
    )
    w, z = (draw(st.floats(8.0, 15.0)) if turning else 0.0), draw(st.floats(-2.0, 6.0))
    if draw(st.booleans()):
        quarter = draw(st.integers(0, 3)) * math.pi / 2
        profile, u0, u1 = (
            Profile(w, z, radius=draw(st.floats(0.5, 6.0))),
            quarter + 0.05,
            quarter + draw(st.floats(0.3, 1.5)),
        )
    else:
        lean = draw(st.sampled_from([0.0, 0.3, 1.0, -0.7]))
        profile, u0, u1 = (
            Profile(w, z, math.sin(lean), math.cos(lean)),
            0.0,
            draw(st.floats(0.2, 6.0)),
        )
    lean = draw(st.sampled_from([0.0, 0.0, 0.05]))
    left, right = TrimEdge(low, u0, low + lean, u1), TrimEdge(high, u0, high - lean, u1)
    row = strip_row(guide, profile, u0, u1, left, right)
    # As the rows of a part's surfaces are: the kernels are not compiled for another kind of array.
    row.setflags(write=False)
    return row


@st.composite
def paths(draw):
    """One rapid above and one block: a line or an arc, level, upright or climbing."""
    # No text says a height finer than this.
    start = [draw(NUMBER), draw(NUMBER), round(draw(st.floats(-2.0, 3.0)), 6)]
    z = start[2] + draw(st.sampled_from([0.0, 0.0, -1.5, 0.7]))
    if draw(st.booleans()):
        end = (
            [start[0], start[1], z]
            if draw(st.integers(0, 4)) == 0
            else [draw(NUMBER), draw(NUMBER), z]
        )
        return start, end, None
    centre, turn = [draw(NUMBER), draw(NUMBER)], draw(st.floats(0.2, 6.2))
    away = np.array(start[:2]) - centre
    if np.hypot(*away) < 0.5:
        centre[0] += 2.0
        away = np.array(start[:2]) - centre
    c, s = math.cos(turn), math.sin(turn)
    return (
        start,
        [centre[0] + c * away[0] - s * away[1], centre[1] + s * away[0] + c * away[1], z],
        centre,
    )


@pytest.mark.examples(12)
@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(strip=strips(), form=st.sampled_from(sorted(FORMS)), path=paths())
def test_the_deepest_of_a_random_block_is_within_the_bound_of_a_far_finer_search(strip, form, path):
    moves = moves_of([program_section(FORMS[form], [path[0], path[1:]])])
    empty = np.zeros((0, STRIP_COLUMNS))
    contact = PartContact(
        surfaces_from([ContactFace(1, strip[None], empty, np.zeros((0, 4)))])
    ).along(moves)
    parts = supports_of(FORMS[form])
    for kind in (0, 1):
        measured = contact.depth[1, kind]
        expected = _deepest(
            strip, moves.row[1], [part for part in parts if part[3] == kind], measured
        )
        assert measured == approx(expected, abs=tolerance.CONTACT_BOUND)


@pytest.mark.examples(15)
@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(
    form=st.sampled_from(sorted(FORMS)),
    path=paths(),
    z=st.floats(-2.0, 40.0),
    looks_down=st.booleans(),
)
def test_the_deepest_in_a_level_face_with_a_hole_is_within_the_bound_of_a_far_finer_search(
    form, path, z, looks_down
):
    moves = moves_of([program_section(FORMS[form], [path[0], path[1:]])])
    rings = [
        line_edges(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]))
        for (x0, y0), (x1, y1) in (FACE, HOLE)
    ]
    contact = PartContact(
        surfaces_from([level_face(1, z, rings[0] + rings[1], -1.0 if looks_down else 1.0)])
    ).along(moves)
    for kind in (0, 1):
        expected = max(
            [
                0.0,
                *(
                    _level_depth(z, moves.row[1], part)
                    for part in supports_of(FORMS[form])
                    if part[3] == kind
                ),
            ]
        )
        assert contact.depth[1, kind] == approx(expected, abs=tolerance.CONTACT_BOUND)


FACE, HOLE = ((-12.0, -9.0), (14.0, 11.0)), ((-3.0, -4.0), (6.0, 5.0))


def _level_depth(z, move, part):
    """Return the deepest that a part of a tool enters the level face, by samples of the move that close in on the best places."""
    spans, best = [(0.0, 1.0)], -np.inf
    for _ in range(5):
        t = np.concatenate([np.linspace(a, b, 2001) for a, b in spans])
        px, py, tip, rise = _tips(move, t)
        depth = plain_depth(part, _level_distance(px, py), z - tip, rise)
        best, step = max(best, float(depth.max())), (spans[0][1] - spans[0][0]) / 2000.0
        spans = [
            (max(t[k] - 2.0 * step, 0.0), min(t[k] + 2.0 * step, 1.0))
            for k in np.argsort(-depth)[:5]
        ]
    return best


def _level_distance(x, y):
    """Return how far points (n,) in plan are from the face; 0 on it."""
    (x0, y0), (x1, y1) = FACE
    out = np.hypot(
        np.maximum(np.maximum(x0 - x, x - x1), 0.0), np.maximum(np.maximum(y0 - y, y - y1), 0.0)
    )
    (x0, y0), (x1, y1) = HOLE
    return np.maximum(out, np.minimum(np.minimum(x - x0, x1 - x), np.minimum(y - y0, y1 - y)))


def _deepest(strip, move, parts, measured):
    """Return the reference, searched once more and far closer where the quick search stays below what was measured."""
    quick = max([0.0, *(sampled_depth(strip, move, p) for p in parts)])
    if quick >= measured - tolerance.CONTACT_BOUND:
        return quick
    return max(quick, *(sampled_depth(strip, move, p, rounds=14, grid=201, kept=20) for p in parts))


@pytest.mark.examples(8)
@settings(deadline=None, max_examples=25, phases=[Phase.explicit, Phase.generate])
@given(form=st.sampled_from(sorted(FORMS)), seed=st.integers(0, 2**32 - 1))
def test_cells_that_are_passed_over_hide_no_contact(form, seed):
    random = np.random.default_rng(seed)
    stops = random.uniform([-40.0, -28.0, -5.0], [40.0, 28.0, 20.0], (12, 3))
    stops[::3, 2] = stops[1::3, 2]
    moves = moves_of([program_section(FORMS[form], [tuple(s) for s in stops])])
    engine, rows = StripContact(block_with_pocket()), np.arange(len(moves))
    found = engine.along(moves, rows, threads=1)
    # Cells that reach from the deepest to the highest are passed over for their place in plan alone; of one cell nothing is.
    engine._cell_z = np.tile([-np.inf, np.inf], (len(engine._cell_z), 1))
    higher = engine.along(moves, rows, threads=1)
    engine._grid = grid_of(engine.surfaces.strip[:, surfaces.BX0 : surfaces.BY1 + 1], 1000.0)
    every = engine.along(moves, rows, threads=1)
    for other in (higher, every):
        assert np.array_equal(found.depth, other.depth) and np.array_equal(
            found.face_depth, other.face_depth
        )


def from_rounded(x, y, half_x, half_y, radius):
    """Return how far points (n,) are outside of a rectangle about the origin with rounded corners; negative inside."""
    dx, dy = np.abs(x) - half_x + radius, np.abs(y) - half_y + radius
    return (
        np.hypot(np.maximum(dx, 0.0), np.maximum(dy, 0.0))
        + np.minimum(np.maximum(dx, dy), 0.0)
        - radius
    )


@st.composite
def curved_outlines(draw):
    """Edges of a level face and how far points are from it: a disc, a ring, or a rounded rectangle with or without a rounded opening."""
    size = 10.0 ** draw(st.floats(-1.0, 2.7))
    if draw(st.booleans()):
        hole = size * draw(st.sampled_from([0.0, 0.1, 0.7, 0.999]))
        turn = draw(st.floats(0.0, 1.5))
        edges = circle_edges(0.0, 0.0, size, turn, turn + math.tau)
        edges += circle_edges(0.0, 0.0, hole, turn, turn + math.tau) if hole else []
        return (
            edges,
            [size, hole] if hole else [size],
            lambda x, y: np.maximum(np.hypot(x, y) - size, hole - np.hypot(x, y)),
        )
    half, inner = (
        np.array([size, size * draw(st.floats(0.3, 3.0))]),
        draw(st.sampled_from([0.0, 0.4])),
    )
    corner = float(half.min()) * draw(st.sampled_from([0.01, 0.3, 0.99]))
    edges = rounded(-half, half, corner) + (
        rounded(-inner * half, inner * half, inner * corner) if inner else []
    )
    return (
        edges,
        [],
        lambda x, y: np.maximum(
            from_rounded(x, y, *half, corner),
            -from_rounded(x, y, *(inner * half), inner * corner) if inner else -np.inf,
        ),
    )


@settings(deadline=None, max_examples=150, phases=[Phase.explicit, Phase.generate])
@given(
    outline=curved_outlines(),
    form=st.sampled_from(sorted(FORMS)),
    plunge=st.floats(0.002, 2.0),
    seed=st.integers(0, 2**32 - 1),
)
def test_an_axis_beside_the_arc_of_a_level_face_is_as_deep_as_its_distance_makes_it(
    outline, form, plunge, seed
):
    edges, circles, away = outline
    tips = np.column_stack(
        [_beside_edges(edges, circles, np.random.default_rng(seed), 60), np.full(60, -plunge)]
    )
    depth = (
        PartContact(surfaces_from([level_face(1, 0.0, edges)]))
        .along(poses_of(FORMS[form], tips))
        .depth
    )
    for kind in (0, 1):
        expected = np.max(
            [
                plain_depth(part, np.maximum(away(*tips[:, :2].T), 0.0), np.full(60, plunge))
                for part in supports_of(FORMS[form])
                if part[3] == kind
            ],
            axis=0,
        )
        told = expected > tolerance.CONTACT_BOUND / 2
        assert (depth[told, kind] >= expected[told] - 1e-6).all()
        assert (depth[:, kind] <= np.maximum(expected, 0.0) + tolerance.CONTACT_BOUND).all()


def _beside_edges(edges, circles, random, count):
    """Return plan places (count, 2): about arcs between their chords and beyond the arcs, on their chords, and anywhere in the face."""
    arcs = [e for e in edges if e.radius]
    found = []
    for k in range(count):
        e = arcs[random.integers(len(arcs))]
        a, b = (math.atan2(u - e.uc, s - e.sc) for s, u in ((e.s0, e.u0), (e.s1, e.u1)))
        angle = a + math.remainder(b - a, math.tau) * random.uniform()
        if k % 5 == 0:
            share = random.uniform()
            found.append((e.s0 + share * (e.s1 - e.s0), e.u0 + share * (e.u1 - e.u0)))
            continue
        r = e.radius + random.choice([1e-9, 0.01, 0.06, 0.5]) * random.uniform(-1.0, 1.0)
        found.append((e.sc + r * math.cos(angle), e.uc + r * math.sin(angle)))
    return np.array(found)


@settings(deadline=None, max_examples=30, phases=[Phase.explicit, Phase.generate])
@given(strip=strips(), form=st.sampled_from(sorted(FORMS)), path=paths(), room=st.integers(1, 4))
def test_a_search_without_room_for_its_open_intervals_errs_deep(strip, form, path, room):
    move = moves_of([program_section(FORMS[form], [path[0], path[1:]])])
    row, guide = move.row[1].copy(), np.zeros(kernel.MOVE_COLUMNS)
    row[kernel.Z_END] = row[kernel.Z_START]
    for piece in move.bodies.piece:

        def searched(rows, row=row, piece=piece):
            return kernel.strip_depth(
                strip,
                row,
                row[kernel.Z_START],
                0.0,
                move.bodies.arc,
                piece,
                1e-5,
                1e-5,
                guide,
                np.zeros((rows, 2)),
            )[0]

        assert max(searched(room), 1e-5) >= searched(400) - 1e-5
