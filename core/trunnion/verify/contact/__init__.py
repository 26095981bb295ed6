"""Does anything enter what it must not? Cutter, shank and holder against the finished part and its fixtures, along every block."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.part.surfaces import Surfaces
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact.grid import Grid as Grid
from trunnion.verify.contact.grid import grid_of as grid_of
from trunnion.verify.contact.strips import StripContact
from trunnion.verify.contact.strips import guide_points as guide_points
from trunnion.verify.motion import Moves


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Contact:
    """What was measured. n moves, f faces; column 0 is what cuts, column 1 what does not (neck, shank, holder).

    depth (n, 2) mm, 0 when clear; face (n, 2) rows of the deepest face or -1; place (n, 2, 3) where, NaN when clear; face_depth (f, 2),
    face_move (f, 2) the move that is deepest in each face (of equal ones the first) or -1. fixture_depth (n,) how deep any part of the
    tool enters a fixture, 0 when clear; fixture (n,) its row or -1; fixture_place (n, 3), NaN when clear.
    """

    depth: Floats
    face: Ints
    place: Floats
    face_depth: Floats
    face_move: Ints
    fixture_depth: Floats
    fixture: Ints
    fixture_place: Floats


class PartContact:
    """A part's faces made ready for many questions. `surfaces` must be in the frame of the moves."""

    def __init__(self, surfaces: Surfaces) -> None:
        self.surfaces = surfaces
        self._strips = StripContact(surfaces)

    def along(self, moves: Moves, progress: Progress = QUIET, threads: int = 0) -> Contact:
        """Return how deep every move of a program enters the part, measured on `threads` threads (0: one a core)."""
        n = len(moves)
        touch = self._strips.along(moves, _all_upright(moves), progress, threads)
        return Contact(depth=np.maximum(touch.depth, 0.0), face=touch.face, place=touch.place,
                       face_depth=np.maximum(touch.face_depth, 0.0), face_move=touch.face_move, fixture_depth=np.zeros(n),
                       fixture=np.full(n, -1), fixture_place=np.full((n, 3), np.nan))

    def clear(self, moves: Moves, allowed: float) -> Bools:
        """Say for each move or pose (n,) whether nothing of its tool enters the part deeper than allowed."""
        return self._strips.clear(moves, _all_upright(moves), allowed)


def _all_upright(moves: Moves) -> Ints:
    leaning = np.flatnonzero(~moves.upright)
    if len(leaning):
        raise BadInput(f"contact of a leaning tool needs the part's facets: block {int(moves.block[leaning[0]])} leans")
    return np.arange(len(moves))
