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
from verify_tools import FORMS, plain_depth, program_section, supports_of

NUMBER = st.integers(-1000, 1000).map(lambda n: n / 50)


def sampled_depth(strip, move, part, rounds=10, grid=(9, 15, 9), kept=6):
    """Return the deepest that a part of a tool enters a strip, by samples of move, guide and profile that close in on the best places."""
    best, boxes = -np.inf, [np.array([[0.0, 1.0]] * 3)]
    shares = np.stack(np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in grid), indexing="ij"), axis=-1).reshape(-1, 3)
    size = np.ones(3)
    for _ in range(rounds):
        places = np.vstack([box[:, 0] + shares * (box[:, 1] - box[:, 0]) for box in boxes])
        depth = _depths(strip, move, part, *places.T)
        best = max(best, float(depth.max()))
        size = size * 0.35
        boxes = []
        for k in np.argsort(-depth)[:200]:
            if all((np.abs(places[k] - box.mean(axis=1)) > size).any() for box in boxes):
                boxes.append(np.clip(np.column_stack([places[k] - size / 2, places[k] + size / 2]), 0.0, 1.0))
            if len(boxes) == kept:
                break
    return best


def _depths(strip, move, part, t, s, u):
    x, y, z = surface_points(strip, s, u)
    tip = move[kernel.Z_START] + t * (move[kernel.Z_END] - move[kernel.Z_START])
    if move[kernel.KIND] == 0.0:
        px, py = move[kernel.X0] + t * (move[kernel.X1] - move[kernel.X0]), move[kernel.Y0] + t * (move[kernel.Y1] - move[kernel.Y0])
    else:
        angle = move[kernel.START_ANGLE] + t * move[kernel.SWEEP]
        px, py = move[kernel.CX] + move[kernel.RADIUS] * np.cos(angle), move[kernel.CY] + move[kernel.RADIUS] * np.sin(angle)
    # Upright, a move is one body, swept from its lowest to its highest place.
    upright = move[kernel.KIND] == 0.0 and move[kernel.X0] == move[kernel.X1] and move[kernel.Y0] == move[kernel.Y1]
    ends = move[[kernel.Z_START, kernel.Z_END]]
    tip, rise = (ends.min(), np.ptp(ends)) if upright else (tip, 0.0)
    return plain_depth(part, np.hypot(x - px, y - py), z - tip, rise)


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


@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(strip=strips(), form=st.sampled_from(sorted(FORMS)), path=paths())
def test_the_deepest_of_a_random_block_is_within_the_bound_of_a_far_finer_search(strip, form, path):
    moves = moves_of([program_section(FORMS[form], [path[0], path[1:]])])
    empty = np.zeros((0, STRIP_COLUMNS))
    contact = PartContact(surfaces_from([Face(1, strip[None], empty, np.zeros((0, 4)))])).along(moves)
    parts = supports_of(FORMS[form])
    for kind in (0, 1):
        measured = contact.depth[1, kind]
        expected = _deepest(strip, moves.row[1], [part for part in parts if part[3] == kind], measured)
        assert measured == approx(expected, abs=tolerance.CONTACT_BOUND)


def _deepest(strip, move, parts, measured):
    """Return the reference, searched once more and far closer where the quick search stays below what was measured."""
    quick = max([0.0, *(sampled_depth(strip, move, p) for p in parts)])
    if quick >= measured - tolerance.CONTACT_BOUND:
        return quick
    return max(sampled_depth(strip, move, p, rounds=14, grid=(31, 51, 31), kept=20) for p in parts)
