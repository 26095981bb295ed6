"""Clearance and axis-limit queries for tilted tools.

The contact engine of the proof (`verify.contact`) measures poses and moves before they are planned. It is built at the first query: most
operations have no tilted tool.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, items_of
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.geometry.sphere import angle_between
from trunnion.model.fixture import Fixture
from trunnion.model.material import Machine
from trunnion.model.tool import Tool
from trunnion.part.shape.facets import Facets
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.toolpath.contact_passes.axis_search import thickened
from trunnion.toolpath.contact_passes.contacts import slerp

if TYPE_CHECKING:
    from trunnion.part.part import Part
    from trunnion.verify.contact import PartContact
    from trunnion.verify.motion import Moves

BATCH = 1024
"""Moves between two looks at cancel."""
HELD = math.radians(2.0)
"""Largest turn between two axes of a move that the machine is asked to hold."""
CHUNK = 128
"""Moves that one thread queries before it looks for more."""


class PartClearance:
    """A part and its fixtures as they stand in a cutting frame that itself stands in a setup's frame.

    `skin` is the part's in the cutting frame. What cuts may touch the part (`tolerance.FINISH_GOUGE`); neck, shank and holder
    are thicker by `tolerance.HOLDER_ROOM`. `progress` is looked at for cancel during a query.
    """

    def __init__(
        self,
        part: Part,
        skin: Skin,
        cutting: Frame,
        setup: Frame,
        machine: Machine,
        fixtures: Sequence[Fixture] = (),
        progress: Progress = NO_PROGRESS,
    ) -> None:
        self._part, self._skin, self._cutting, self._setup = part, skin, cutting, setup
        self._machine, self._fixtures, self.progress = machine, tuple(fixtures), progress

    def __call__(self, tool: Tool) -> ToolClearanceQuery:
        """Return the clearance query of a tool."""
        return ToolClearanceQuery(self, thickened(tool, tolerance.HOLDER_CLEARANCE))

    def ready(self) -> None:
        """Build what the first query would: a copy of this process has it then, and shares its memory."""
        self._contact.ready(self.progress)

    def holds(self, axis: Floats) -> Bools:
        """Return which tool axes (k, 3), in the cutting frame, the machine can hold within the limits of its rotary axes."""
        from trunnion.verify.machine.kinematics import can_hold

        return can_hold(
            self._setup.local_direction(self._cutting.world_direction(axis)), self._machine
        )

    def clear(self, moves: Moves) -> Bools:
        """Return which moves (k,) enter nothing deeper than a finishing cutter may."""
        clear = np.zeros(len(moves), dtype=bool)
        for start in range(0, len(moves), BATCH):
            self.progress.check()
            some = moves.some(slice(start, start + BATCH))
            clear[start : start + BATCH] = self._queried(some)
        return clear

    def _queried(self, moves: Moves) -> Bools:
        clear, contact = np.zeros(len(moves), dtype=bool), self._contact

        def work(first: int, last: int) -> None:
            clear[first:last] = contact.clear(
                moves.some(slice(first, last)), tolerance.FINISH_GOUGE
            )

        in_parallel(work, len(moves), CHUNK, NO_PROGRESS, "Looking for room for a leaning tool")
        return clear

    @cached_property
    def _contact(self) -> PartContact:
        from trunnion.part.shape.surfaces import surfaces_of
        from trunnion.verify.contact import PartContact
        from trunnion.verify.judge.sides import fixture_facets

        surfaces = surfaces_of(self._part, self._cutting)
        skin = self._skin
        facets = Facets(
            tag=surfaces.tag,
            points=skin.points,
            triangles=skin.triangles,
            face=np.searchsorted(surfaces.tag, skin.face),
            bound=skin.bound,
        )
        return PartContact(
            surfaces, facets, [fixture_facets(f, self._cutting) for f in self._fixtures]
        )


class ToolClearanceQuery:
    """Clearance query of one tool; a pose that the machine can't hold is not clear."""

    def __init__(self, around: PartClearance, tool: Tool) -> None:
        self._around, self._tool = around, tool

    def __call__(
        self,
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> Bools:
        """Return which poses are clear: tips (k, 3) mm with unit axes (k, 3), or moves from others to these."""
        from trunnion.verify.kernels.contact.strips import X0, Y0, Z_START
        from trunnion.verify.motion import poses_of

        tip, axis = (np.asarray(v, dtype=np.float64).reshape(-1, 3) for v in (tip, axis))
        clear = self._around.holds(axis)
        if start_tip is not None and start_axis is not None:
            clear &= self._is_held_between(start_axis, axis)
        rows = np.flatnonzero(clear)
        moves = poses_of(self._tool, tip[rows], axis[rows])
        if start_tip is not None:
            begin = poses_of(
                self._tool, start_tip[rows], (axis if start_axis is None else start_axis)[rows]
            )
            row = moves.row.copy()
            row[:, [X0, Y0, Z_START]] = begin.start
            moves = replace(
                moves,
                start=begin.start,
                start_axis=begin.start_axis,
                upright=moves.upright & begin.upright,
                row=row,
                length=np.linalg.norm(moves.end - begin.start, axis=1),
            )
        clear[rows] = self._around.clear(moves)
        return clear

    def _is_held_between(self, start: Floats, end: Floats) -> Bools:
        """Return between which axes (k, 3) the machine can hold all on the even turn: it may lean further than both."""
        turn = angle_between(start, end)
        held = np.ones(len(end), dtype=bool)
        between = np.maximum(np.ceil(turn / HELD), 1.0).astype(np.int64) - 1
        way, number = items_of(between)
        number = number + 1
        if len(way):
            axes = slerp(start[way], end[way], number / (between[way] + 1.0))
            held[way[~self._around.holds(axes)]] = False
        return held
