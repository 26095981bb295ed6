"""Does anything enter what it must not? Cutter, shank and holder against the finished part, along every block.

Closed forms in plan and a bounded search over the profile (`kernels/contact.py`): a reported depth is attained, and the true one is at
most `tolerance.CONTACT_BOUND` deeper, plus `Surfaces.bound` where faces had to be opened into triangles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.part.surfaces import BX0, BY1, DX, DY, GUIDE, L_KIND, OX, OY, PROFILE, PW0, PW1, PZ0, PZ1, R_KIND, U0, U1, Surfaces
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact.grid import grid_of
from trunnion.verify.kernels import strips as kernel
from trunnion.verify.motion import Moves

CHUNK_WORK = 2000
"""Blocks between two looks at cancel; a chunk stays far below 0.2 s."""
GRID_PITCH = 10.0
"""mm, pitch of the grid that finds the faces near a block: about a cutter's radius."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Contact:
    """What was measured. n moves, f faces; column 0 is the fluted cutter, column 1 what is above it.

    depth (n, 2) mm, 0 when clear; face (n, 2) rows of the deepest face or -1; place (n, 2, 3) where, NaN when clear; face_depth (f, 2),
    face_move (f, 2) the move that is deepest in each face or -1.
    """

    depth: Floats
    face: Ints
    place: Floats
    face_depth: Floats
    face_move: Ints


class PartContact:
    """A part's faces made ready for many questions. `surfaces` must be in the frame of the moves."""

    def __init__(self, surfaces: Surfaces) -> None:
        self.surfaces = surfaces
        self._grid = grid_of(surfaces.strip[:, BX0:BY1 + 1], GRID_PITCH)

    def along(self, moves: Moves, progress: Progress = QUIET) -> Contact:
        """Return how deep every move of a program enters the part."""
        depth, which, where, face_depth, face_move = self._measure(moves.row, moves.tool, moves.pieces, moves.piece_start, progress)
        face, place = np.full((len(moves), 2), -1), np.full((len(moves), 2, 3), np.nan)
        for n, k in np.argwhere(which != -1):
            face[n, k], place[n, k] = self._place(moves.row[n], int(which[n, k]), float(where[n, k]))
        return Contact(depth=np.maximum(depth, 0.0), face=face, place=place, face_depth=np.maximum(face_depth, 0.0), face_move=face_move)

    def clear(self, rows: Floats, pieces: Floats, allowed: float) -> Bools:
        """Say for each move or pose (n, 15) of one tool whether none of its pieces enters the part deeper than allowed."""
        depth = self._measure(rows, np.zeros(len(rows), np.int64), pieces, np.array([0, len(pieces)]), QUIET, allowed)[0]
        return (depth[:, 0] <= allowed) & (depth[:, 1] <= allowed)

    def _measure(self, rows: Floats, tool: Ints, pieces: Floats, piece_start: Ints, progress: Progress,
                 settle: float = np.inf) -> tuple[Floats, Ints, Floats, Floats, Ints]:
        s, g = self.surfaces, self._grid
        n, bound = len(rows), tolerance.CONTACT_BOUND / 2
        depth, which, where = np.full((n, 2), -np.inf), np.full((n, 2), -1), np.zeros((n, 2))
        face_depth, face_move = np.full((len(s.tag), 2), -np.inf), np.full((len(s.tag), 2), -1)
        for first in range(0, n, CHUNK_WORK):
            progress.at(first / n, "Measuring gouges and collisions")
            kernel.contact_loop(first, min(first + CHUNK_WORK, n), rows, tool, pieces, piece_start, s.strip, s.strip_face, g.start, g.rows,
                                g.frame, g.shape, s.region_z, s.region_face, s.region_box, s.region_start, s.chords, bound, bound, settle,
                                depth, which, where, face_depth, face_move)
        return depth, which, where, face_depth, face_move

    def _place(self, move: Floats, which: int, u: float) -> tuple[int, Floats]:
        s = self.surfaces
        if which < -1:
            region = -2 - which
            return int(s.region_face[region]), np.array([move[kernel.X0], move[kernel.Y0], s.region_z[region]])
        points = guide_points(s.strip[which], u, np.linspace(0.0, 1.0, 65))
        distance = [kernel.point_distance(x, y, move) for x, y in points[:, :2]]
        return int(s.strip_face[which]), points[int(np.argmin(distance))]


def guide_points(strip: Floats, u: float, shares: Floats) -> Floats:
    """Return points (k, 3) of a strip at one profile parameter, at shares (k,) of the way from its left end to its right one."""
    low, high = _end(strip, L_KIND, u), _end(strip, R_KIND, u)
    s = low + shares * (high - low)
    if strip[PROFILE]:
        w, z = strip[PW0] + strip[PW1] * np.cos(u), strip[PZ0] + strip[PW1] * np.sin(u)
    else:
        share = (u - strip[U0]) / (strip[U1] - strip[U0]) if strip[U1] > strip[U0] else 0.0
        w, z = strip[PW0] + share * (strip[PW1] - strip[PW0]), strip[PZ0] + share * (strip[PZ1] - strip[PZ0])
    if strip[GUIDE]:
        x, y = strip[OX] + w * np.cos(s), strip[OY] + w * np.sin(s)
    else:
        x, y = strip[OX] - w * strip[DY] + s * strip[DX], strip[OY] + w * strip[DX] + s * strip[DY]
    return np.column_stack([x, y, np.full(len(s), z)])


def _end(strip: Floats, column: int, u: float) -> float:
    kind, a, b, c, sign = strip[column:column + 5]
    return float(a + b * (u - strip[U0]) if kind == 0.0 else a + sign * np.sqrt(max(b * b - (u - c) ** 2, 0.0)))
