"""What an engine of contact measures, and how the measures of several engines or threads become one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Penetration:
    """How deep some moves enter faces. k moves, f faces; column 0 is what cuts, column 1 what does not.

    depth (k, 2) mm, -inf when clear; face (k, 2) rows of the deepest face or -1; position (k, 2, 3) where, NaN when clear; face_depth (f,
    2), face_move (f, 2) the row of the move that is deepest in each face (of equal ones the first), or -1.
    """

    depth: Floats
    face: Ints
    position: Floats
    face_depth: Floats
    face_move: Ints

    @staticmethod
    def none(k: int, f: int) -> Penetration:
        """Return what k moves that touch none of f faces measure."""
        return Penetration(
            depth=np.full((k, 2), -np.inf),
            face=np.full((k, 2), -1),
            position=np.full((k, 2, 3), np.nan),
            face_depth=np.full((f, 2), -np.inf),
            face_move=np.full((f, 2), -1),
        )

    def take(self, other: Penetration, rows: Ints) -> None:
        """Take in what another engine measured for the moves of some rows (k,) on the same faces."""
        deeper = other.depth > self.depth[rows]
        at, kind = rows[np.nonzero(deeper)[0]], np.nonzero(deeper)[1]
        self.depth[at, kind], self.face[at, kind], self.position[at, kind] = (
            other.depth[deeper],
            other.face[deeper],
            other.position[deeper],
        )
        deepen(self.face_depth, self.face_move, other.face_depth, other.face_move)

    def deeper_than(self, allowed: float) -> Floats:
        """Return where each move is deepest (k, 3), NaN where that is not deeper than allowed."""
        kind = np.argmax(self.depth, axis=1)
        rows = np.arange(len(kind))
        return np.where(
            (self.depth[rows, kind] > allowed)[:, None], self.position[rows, kind], np.nan
        )


def deepen(face_depth: Floats, face_move: Ints, depth: Floats, move: Ints) -> None:
    """Raise the depths of faces (f, 2), and their moves, to those of another share of the work.

    Of equal depths the first move counts, so that it does not matter in which order the shares come.
    """
    better = (depth > face_depth) | ((depth == face_depth) & (move < face_move))
    face_depth[better], face_move[better] = depth[better], move[better]
