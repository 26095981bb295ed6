"""Closed forms: a body of revolution that stands upright, against faces that are strips and level regions (`part/shape/surfaces.py`).

Closed forms in plan and a bounded search over the profile (`kernels/contact/strips.py`): a reported depth is attained, and the true one is
at most `tolerance.CONTACT_BOUND` deeper. A move along its own axis counts as one body, swept from its lowest to its highest position.
"""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.part.shape.surfaces import (
    BX0,
    BY1,
    BZ0,
    BZ1,
    DX,
    DY,
    GUIDE,
    L_KIND,
    OX,
    OY,
    PROFILE,
    PW0,
    PW1,
    PZ0,
    PZ1,
    R_KIND,
    U0,
    U1,
    Surfaces,
)
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.verify.contact.grid import Grid, grid_of
from trunnion.verify.contact.penetration import Penetration, deepen
from trunnion.verify.kernels.contact import strips as kernel
from trunnion.verify.motion import Moves

CHUNK = 500
"""Moves between two looks at cancel; a chunk stays far below 0.2 s."""
GRID_PITCH = 10.0
"""mm, pitch of the grid that finds the faces near a move: about a cutter's radius."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Measured:
    """What the kernel fills for k moves and f faces."""

    depth: Floats
    which: Ints
    where: Floats
    face_depth: Floats
    face_move: Ints

    @staticmethod
    def empty(k: int, f: int) -> _Measured:
        return _Measured(
            depth=np.full((k, 2), -np.inf),
            which=np.full((k, 2), -1),
            where=np.zeros((k, 2)),
            face_depth=np.full((f, 2), -np.inf),
            face_move=np.full((f, 2), -1),
        )


class StripContact:
    """Trimmed faces made ready for upright moves. `surfaces` must be in the frame of the moves."""

    def __init__(self, surfaces: Surfaces) -> None:
        self.surfaces = surfaces
        self._grid = grid_of(surfaces.strip[:, BX0 : BY1 + 1], GRID_PITCH)
        self._cell_z = _heights(self._grid, surfaces.strip[:, [BZ0, BZ1]])

    def along(
        self, moves: Moves, rows: Ints, progress: Progress = NO_PROGRESS, threads: int = 0
    ) -> Penetration:
        """Return how deep the moves of some rows (k,) enter the faces; they must stand upright."""
        found = self._measure(moves, rows, progress, threads)
        return progress.aside(lambda _: self._penetration(moves, rows, found))

    def stopped(self, moves: Moves, rows: Ints, allowed: float) -> Floats:
        """Return a position (k, 3) of the faces about where the tool enters them deeper than allowed, for the moves of some rows (k,),
        which must stand upright; NaN where it doesn't."""
        return self._penetration(
            moves, rows, self._measure(moves, rows, NO_PROGRESS, 1, allowed)
        ).deeper_than(allowed)

    def _penetration(self, moves: Moves, rows: Ints, found: _Measured) -> Penetration:
        s, face, position = (
            self.surfaces,
            np.full((len(rows), 2), -1),
            np.full((len(rows), 2, 3), np.nan),
        )
        kernel.contact_points(
            rows,
            moves.row,
            found.which,
            found.where,
            s.strip,
            s.strip_face,
            s.region_z,
            s.region_face,
            face,
            position,
        )
        return Penetration(
            depth=found.depth,
            face=face,
            position=position,
            face_depth=found.face_depth,
            face_move=found.face_move,
        )

    def _measure(
        self, moves: Moves, rows: Ints, progress: Progress, threads: int, settle: float = np.inf
    ) -> _Measured:
        s, g, bodies, bound = self.surfaces, self._grid, moves.bodies, tolerance.CONTACT_BOUND / 2
        found, merging = _Measured.empty(len(rows), len(s.tag)), Lock()

        def work(first: int, last: int) -> None:
            face_depth, face_move = (
                np.full_like(found.face_depth, -np.inf),
                np.full_like(found.face_move, -1),
            )
            kernel.strip_contact_loop(
                first,
                last,
                rows,
                moves.row,
                moves.tool,
                bodies.arc,
                bodies.piece,
                bodies.start,
                s.strip,
                s.strip_face,
                g.start,
                g.rows,
                self._cell_z,
                g.frame,
                g.shape,
                s.region_z,
                s.region_face,
                s.region_box,
                s.region_start,
                s.outline,
                bound,
                bound,
                settle,
                found.depth,
                found.which,
                found.where,
                face_depth,
                face_move,
            )
            with merging:
                deepen(found.face_depth, found.face_move, face_depth, face_move)

        in_parallel(work, len(rows), CHUNK, progress, "Measuring gouges and collisions", threads)
        return found


def _heights(grid: Grid, z: Floats) -> Floats:
    """Return how low and how high (cells, 2) what is listed by each cell reaches, z (n, 2) what each row does; empty cells nowhere."""
    out = np.tile([np.inf, -np.inf], (len(grid.start) - 1, 1))
    cell = np.repeat(np.arange(len(out)), np.diff(grid.start))
    np.minimum.at(out[:, 0], cell, z[grid.rows, 0])
    np.maximum.at(out[:, 1], cell, z[grid.rows, 1])
    return out


def guide_points(strip: Floats, u: float, shares: Floats) -> Floats:
    """Return points (k, 3) of a strip at one profile parameter, at shares (k,) of the way from its left end to its right one."""
    low, high = _end(strip, L_KIND, u), _end(strip, R_KIND, u)
    s = low + shares * (high - low)
    if strip[PROFILE]:
        w, z = strip[PW0] + strip[PW1] * np.cos(u), strip[PZ0] + strip[PW1] * np.sin(u)
    else:
        share = (u - strip[U0]) / (strip[U1] - strip[U0]) if strip[U1] > strip[U0] else 0.0
        w, z = (
            strip[PW0] + share * (strip[PW1] - strip[PW0]),
            strip[PZ0] + share * (strip[PZ1] - strip[PZ0]),
        )
    if strip[GUIDE]:
        x, y = strip[OX] + w * np.cos(s), strip[OY] + w * np.sin(s)
    else:
        x, y = strip[OX] - w * strip[DY] + s * strip[DX], strip[OY] + w * strip[DX] + s * strip[DY]
    return np.column_stack([x, y, np.full(len(s), z)])


def _end(strip: Floats, column: int, u: float) -> float:
    kind, a, b, c, sign = strip[column : column + 5]
    return float(
        a + b * (u - strip[U0])
        if kind == 0.0
        else a + sign * np.sqrt(max(b * b - (u - c) ** 2, 0.0))
    )
