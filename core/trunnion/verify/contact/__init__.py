"""Contact of cutter, shank and holder with the finished part and its fixtures, along every block.

An upright tool against faces of closed form is measured in closed form (`strips.py`); free-form faces, and every face while the tool leans
or turns, by triangles and bounds (`facets.py`); fixtures are triangles from the start.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadCall, BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.tool import Tool
from trunnion.part.shape.facets import Facets
from trunnion.part.shape.surfaces import Surfaces
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact.facets import FacetContact
from trunnion.verify.contact.grid import Grid as Grid
from trunnion.verify.contact.grid import grid_of as grid_of
from trunnion.verify.contact.obstacles import Obstacles as Obstacles
from trunnion.verify.contact.penetration import Penetration
from trunnion.verify.contact.strips import StripContact
from trunnion.verify.contact.strips import guide_points as guide_points
from trunnion.verify.motion import Moves, poses_of, upright_axes

LEANING_COST = 50.0
"""What a leaning move costs against an upright one, about: only for the share of progress."""

POSES = 1024
"""Upright poses tried between two looks at cancel."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Contact:
    """What was measured. n moves, f faces; column 0 is what cuts, column 1 what does not (neck, shank, holder).

    depth (n, 2) mm, 0 when clear; face (n, 2) rows of the deepest face or -1; position (n, 2, 3) where, NaN when clear; face_depth (f, 2),
    face_move (f, 2) the move that is deepest in each face (of equal ones the first) or -1. fixture_depth (n,) how deep any part of the
    tool enters a fixture, 0 when clear; fixture (n,) its row or -1; fixture_position (n, 3), NaN when clear.
    """

    depth: Floats
    face: Ints
    position: Floats
    face_depth: Floats
    face_move: Ints
    fixture_depth: Floats
    fixture: Ints
    fixture_position: Floats


class PartContact:
    """A part's faces and its fixtures made ready for many questions, all in the frame of the moves.

    `facets` are the same faces as triangles: `BadInput` when they lack a face without closed form; unless they are whole, tools that lean
    are refused. `fixtures` are closed meshes, a row each.
    """

    def __init__(
        self, surfaces: Surfaces, facets: Facets | None = None, fixtures: Sequence[Facets] = ()
    ) -> None:
        self.surfaces = surfaces
        missing = np.setdiff1d(surfaces.free, [] if facets is None else facets.face)
        if len(missing):
            raise BadInput(
                f"face {int(surfaces.tag[missing[0]])} has no closed form: its contact needs the part's facets"
            )
        self._strips = StripContact(surfaces)
        self._every: FacetContact | None = None
        self._free: FacetContact | None = None
        if facets is not None and facets.whole:
            self._every = FacetContact(facets, surfaces.free)
        if facets is not None and len(surfaces.free):
            self._free = (
                self._every.of_leading()
                if self._every is not None
                else FacetContact(facets.of_faces(surfaces.free))
            )
        self._fixtures = FacetContact(_joined(fixtures)) if fixtures else None

    def with_fixtures(self, fixtures: Sequence[Facets]) -> PartContact:
        """Return the same part as fixtures hold it, in the same memory."""
        held = copy(self)
        held._fixtures = FacetContact(_joined(fixtures)) if fixtures else None
        return held

    def seen_from(self, surfaces: Surfaces, frame: Frame, other: Frame) -> PartContact:
        """Return the part, given in a frame, for moves in another one, without fixtures: its triangles stay where they are, `surfaces` are
        its faces as the moves see them."""
        seen = copy(self)
        seen.surfaces, seen._strips, seen._fixtures = surfaces, StripContact(surfaces), None
        seen._every = self._every.seen_from(frame, other) if self._every is not None else None
        seen._free = self._free.seen_from(frame, other) if self._free is not None else None
        return seen

    def ready(self, progress: Progress = NO_PROGRESS) -> None:
        """Build the trees over triangles, which else the first question does."""
        for engine in (self._every, self._free, self._fixtures):
            if engine is not None:
                engine.ready(progress)

    def along(self, moves: Moves, progress: Progress = NO_PROGRESS, threads: int = 0) -> Contact:
        """Return how deep every move of a program enters part and fixtures, measured on `threads` threads (0: one a core)."""
        found, rows = Penetration.none(len(moves), len(self.surfaces.tag)), np.arange(len(moves))
        engines = [*self._engines(moves), *([(self._fixtures, rows)] if self._fixtures else [])]
        cost = np.cumsum(
            [
                0.0,
                *(
                    len(some) * (1.0 if engine is self._strips else LEANING_COST)
                    for engine, some in engines
                ),
            ]
        )
        fixed = Penetration.none(len(moves), 0)
        for k, (engine, some) in enumerate(engines):
            penetration = engine.along(
                moves,
                some,
                progress.part(cost[k] / max(cost[-1], 1.0), cost[k + 1] / max(cost[-1], 1.0)),
                threads,
            )
            if engine is self._fixtures:
                fixed = penetration
            else:
                found.take(penetration, some)
        kind = np.argmax(fixed.depth, axis=1)
        return Contact(
            depth=np.maximum(found.depth, 0.0),
            face=found.face,
            position=found.position,
            face_depth=np.maximum(found.face_depth, 0.0),
            face_move=found.face_move,
            fixture_depth=np.maximum(fixed.depth[rows, kind], 0.0),
            fixture=fixed.face[rows, kind],
            fixture_position=fixed.position[rows, kind],
        )

    def clear(self, moves: Moves, allowed: float) -> Bools:
        """Return for each move or pose (n,) whether nothing of its tool enters part or fixtures deeper than allowed."""
        return np.isnan(self.stopped(moves, allowed)[:, 0])

    def stopped(self, moves: Moves, allowed: float) -> Floats:
        """Return a position (n, 3) of part or fixtures, on it, where something of the tool of each move or pose is deeper than allowed, or
        beside the deepest such position; NaN where there is none."""
        position = np.full((len(moves), 3), np.nan)
        engines = self._engines(moves) + (
            [(self._fixtures, np.arange(len(moves)))] if self._fixtures else []
        )
        for engine, rows in engines:
            still = rows[np.isnan(position[rows, 0])]
            position[still] = engine.stopped(moves, still, allowed)
        return position

    def any_clear(
        self,
        tool: Tool,
        tips: Floats,
        axes: Floats,
        wanted: Bools,
        allowed: float,
        obstacles: Obstacles,
        progress: Progress = NO_PROGRESS,
        text: str = "",
        threads: int = 0,
    ) -> Bools:
        """Return for k positions whether one of the poses (k, a, 3) of a tool that are wanted (k, a) is clear as `clear` has it.

        Much quicker where most poses are stopped: `obstacles`, those of the k positions, remembers by what, for the next tool too. The part
        must have no fixtures, and poses that lean need its facets.
        """
        if self._fixtures is not None:
            raise BadCall("poses are looked for without fixtures")
        upright = upright_axes(axes)
        leaning, found = wanted & ~upright, np.zeros(len(tips), bool)
        if leaning.any():
            if self._every is None:
                raise BadInput("contact of a leaning tool needs the part's facets")
            found |= self._every.any_clear(
                tool, tips, axes, leaning, allowed, obstacles, progress, text, threads
            )
        row, pose = np.nonzero(wanted & upright & ~found[:, None])
        for first in range(0, len(row), POSES):
            progress.check()
            some = np.arange(first, min(first + POSES, len(row)))
            some = some[~found[row[some]]]
            some = some[
                ~obstacles.stop(
                    tool,
                    tips[row[some], pose[some]],
                    axes[row[some], pose[some]],
                    row[some],
                    allowed,
                )
            ]
            if len(some):
                progress.check()
                position = self.stopped(
                    poses_of(tool, tips[row[some], pose[some]], axes[row[some], pose[some]]),
                    allowed,
                )
                progress.check()
                obstacles.add(position, row[some])
                found[row[some[np.isnan(position[:, 0])]]] = True
        return found

    def _engines(self, moves: Moves) -> list[tuple[StripContact | FacetContact, Ints]]:
        """Return what measures which rows of the moves against the part."""
        upright, leaning = np.flatnonzero(moves.upright), np.flatnonzero(~moves.upright)
        engines: list[tuple[StripContact | FacetContact, Ints]] = [(self._strips, upright)]
        if self._free is not None:
            engines.append((self._free, upright))
        if len(leaning):
            if self._every is None:
                raise BadInput(
                    f"contact of a leaning tool needs the part's facets: block {int(moves.block[leaning[0]])} leans"
                )
            engines.append((self._every, leaning))
        return engines


def _joined(fixtures: Sequence[Facets]) -> Facets:
    """Return fixtures as one mesh whose faces are the fixtures."""
    first = np.cumsum([0, *(len(f.points) for f in fixtures)])
    return Facets(
        tag=np.arange(len(fixtures)),
        points=np.vstack([f.points for f in fixtures]),
        triangles=np.vstack([f.triangles + k for f, k in zip(fixtures, first, strict=False)]),
        face=np.repeat(np.arange(len(fixtures)), [len(f.triangles) for f in fixtures]),
        bound=max(f.bound for f in fixtures),
    )
