"""Random tools, faces and moves: the contact engine against a far finer search that samples, looks closer and samples again."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from pytest import approx

from trunnion import tolerance
from trunnion.part import surfaces
from trunnion.part.surfaces import STRIP_COLUMNS, Edge, Face, Guide, Profile, strip_row, surfaces_from
from trunnion.verify.contact import PartContact
from trunnion.verify.kernels import strips as kernel
from trunnion.verify.motion import moves_of
from verify_tools import bull, flat, program_section

NUMBER = st.integers(-1000, 1000).map(lambda n: n / 50)


def sampled_depth(strip, move, piece, rounds=10, grid=(9, 15, 9), kept=6):
    """Return the deepest that a piece enters a strip along a move, by samples of (t, s, u) that close in on the best few places."""
    best, boxes = -np.inf, [np.array([[0.0, 1.0]] * 3)]
    shares = np.stack(np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in grid), indexing="ij"), axis=-1).reshape(-1, 3)
    size = np.ones(3)
    for _ in range(rounds):
        places = np.vstack([box[:, 0] + shares * (box[:, 1] - box[:, 0]) for box in boxes])
        depth = _depths(strip, move, piece, *places.T)
        best = max(best, float(depth.max()))
        size = size * 0.35
        boxes = []
        for k in np.argsort(-depth)[:200]:
            if all((np.abs(places[k] - box.mean(axis=1)) > size).any() for box in boxes):
                boxes.append(np.clip(np.column_stack([places[k] - size / 2, places[k] + size / 2]), 0.0, 1.0))
            if len(boxes) == kept:
                break
    return best


def _depths(strip, move, piece, t, s, u):
    x, y, z = surface_points(strip, s, u)
    tip = move[kernel.Z_START] + t * (move[kernel.Z_END] - move[kernel.Z_START])
    if move[kernel.KIND] == 0.0:
        px, py = move[kernel.X0] + t * (move[kernel.X1] - move[kernel.X0]), move[kernel.Y0] + t * (move[kernel.Y1] - move[kernel.Y0])
    else:
        angle = move[kernel.START_ANGLE] + t * move[kernel.SWEEP]
        px, py = move[kernel.CX] + move[kernel.RADIUS] * np.cos(angle), move[kernel.CY] + move[kernel.RADIUS] * np.sin(angle)
    rho, h = np.hypot(x - px, y - py), z - tip
    return np.where((h >= piece[3]) & (h <= piece[4]), plain_depth(piece, rho, h), -np.inf)


def surface_points(strip, s, u):
    """Return points of a strip whose ends lean in a straight line, at shares of the way along guide and profile."""
    angle = strip[surfaces.U0] + u * (strip[surfaces.U1] - strip[surfaces.U0])
    left = strip[surfaces.LA] + strip[surfaces.LB] * (angle - strip[surfaces.U0])
    right = strip[surfaces.RA] + strip[surfaces.RB] * (angle - strip[surfaces.U0])
    along = left + s * (right - left)
    if strip[surfaces.PROFILE]:
        w, z = strip[surfaces.PW0] + strip[surfaces.PW1] * np.cos(angle), strip[surfaces.PZ0] + strip[surfaces.PW1] * np.sin(angle)
    else:
        w = strip[surfaces.PW0] + u * (strip[surfaces.PW1] - strip[surfaces.PW0])
        z = strip[surfaces.PZ0] + u * (strip[surfaces.PZ1] - strip[surfaces.PZ0])
    if strip[surfaces.GUIDE]:
        return strip[surfaces.OX] + w * np.cos(along), strip[surfaces.OY] + w * np.sin(along), z
    return (strip[surfaces.OX] - w * strip[surfaces.DY] + along * strip[surfaces.DX],
            strip[surfaces.OY] + w * strip[surfaces.DX] + along * strip[surfaces.DY], z)


def plain_depth(piece, rho, h):
    """Return the depth in a piece, written anew: the distance to the nearest side of a convex body."""
    if piece[0] == 0.0:
        radius, corner = piece[1], piece[2]
        out = np.hypot(np.maximum(rho - radius + corner, 0.0), np.maximum(corner - h, 0.0))
        core = np.minimum(np.maximum(rho - radius + corner, corner - h), 0.0)
        return corner - out - core
    _, r0, r1, z0, z1, low, high = piece
    length = math.hypot(r1 - r0, z1 - z0)
    side = ((z1 - z0) * (r0 - rho) + (r1 - r0) * (h - z0)) / length
    side = np.minimum(side, max(r0, r1) - rho)
    side = np.minimum(side, h - z0) if low else side
    return np.minimum(side, z1 - h) if high else side


@st.composite
def strips(draw):
    """A strip near the origin: any guide, any profile, ends that may lean."""
    turning = draw(st.booleans())
    low = draw(st.floats(-3.0, 3.0)) if turning else draw(st.floats(-20.0, 0.0))
    high = low + (draw(st.floats(0.2, 6.0)) if turning else draw(st.floats(0.5, 30.0)))
    angle = draw(st.floats(0.0, 6.28))
    guide = Guide(1, draw(NUMBER), draw(NUMBER)) if turning else Guide(0, draw(NUMBER), draw(NUMBER), math.cos(angle), math.sin(angle))
    w, z = (draw(st.floats(8.0, 15.0)) if turning else 0.0), draw(st.floats(-2.0, 6.0))
    if draw(st.booleans()):
        quarter = draw(st.integers(0, 3)) * math.pi / 2
        profile, u0, u1 = Profile(w, z, radius=draw(st.floats(0.5, 6.0))), quarter + 0.05, quarter + draw(st.floats(0.3, 1.5))
    else:
        lean = draw(st.sampled_from([0.0, 0.3, 1.0, -0.7]))
        profile, u0, u1 = Profile(w, z, math.sin(lean), math.cos(lean)), 0.0, draw(st.floats(0.2, 6.0))
    lean = draw(st.sampled_from([0.0, 0.0, 0.05]))
    left, right = Edge(low, u0, low + lean, u1), Edge(high, u0, high - lean, u1)
    return strip_row(guide, profile, u0, u1, left, right)


@st.composite
def tools(draw):
    """A flat or bull cutter with a neck, a thicker shank and a conical holder, short enough to touch with all of it."""
    make = bull(10.0, draw(st.sampled_from([0.5, 2.0, 5.0]))) if draw(st.booleans()) else flat(draw(st.sampled_from([6.0, 12.0])))
    return make(flute=draw(st.sampled_from([2.0, 8.0, 30.0])))


@st.composite
def paths(draw):
    """One rapid above and one block: a line or an arc, level, upright or climbing."""
    start = [draw(NUMBER), draw(NUMBER), draw(st.floats(-2.0, 3.0))]
    z = start[2] + draw(st.sampled_from([0.0, 0.0, -1.5, 0.7]))
    if draw(st.booleans()):
        end = [start[0], start[1], z] if draw(st.integers(0, 4)) == 0 else [draw(NUMBER), draw(NUMBER), z]
        return start, end, None
    centre, turn = [draw(NUMBER), draw(NUMBER)], draw(st.floats(0.2, 6.2))
    away = np.array(start[:2]) - centre
    if np.hypot(*away) < 0.5:
        centre[0] += 2.0
        away = np.array(start[:2]) - centre
    c, s = math.cos(turn), math.sin(turn)
    return start, [centre[0] + c * away[0] - s * away[1], centre[1] + s * away[0] + c * away[1], z], centre


@settings(deadline=None, max_examples=30, phases=[Phase.explicit, Phase.generate])
@given(strip=strips(), tool=tools(), path=paths())
def test_the_deepest_of_a_random_block_is_within_the_bound_of_a_far_finer_search(strip, tool, path):
    moves = moves_of([program_section(tool, [path[0], path[1:]])])
    empty = np.zeros((0, STRIP_COLUMNS))
    contact = PartContact(surfaces_from([Face(1, strip[None], empty, np.zeros((0, 4)))])).along(moves)
    pieces = moves.pieces
    cutter, above = contact.depth[1]
    assert cutter == approx(_deepest(strip, moves.row[1], pieces[:1], cutter), abs=tolerance.CONTACT_BOUND)
    # What is above the flutes counts in its swept body on an upright move, which may be deeper than it is at any moment.
    if path[0][:2] != path[1][:2]:
        assert above == approx(_deepest(strip, moves.row[1], pieces[1:], above), abs=tolerance.CONTACT_BOUND)


def _deepest(strip, move, pieces, measured):
    """Return the reference, searched once more and far closer where the quick search stays below what was measured."""
    quick = max([0.0, *(sampled_depth(strip, move, p) for p in pieces)])
    if quick >= measured - tolerance.CONTACT_BOUND:
        return quick
    return max(sampled_depth(strip, move, p, rounds=14, grid=(31, 51, 31), kept=20) for p in pieces)
