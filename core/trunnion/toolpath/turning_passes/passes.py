"""Collects the moves of a turning operation, seen along its feed, into a toolpath."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.arc_fitting import arcs_through
from trunnion.geometry.plane.curve import segments_of
from trunnion.model.motion.toolpath import ACROSS, EMPTY, Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.spindle import limited_turns
from trunnion.plan.turning.view import PassView

ENTRY_SHARE = 0.5
"""Share of the feed at which a tool goes into material across its feed."""
FITTED = 1e-3
"""mm: how far an arc may be from the contour that it stands for."""


class TurningPath:
    """A turning path in the making, in the coordinates of a view; `here` is where the tool's point is, None before the first move."""

    def __init__(self, view: PassView, data: CuttingData, away: float, clearance: float) -> None:
        self.view = view
        self.data = data
        self.away = away
        self.clearance = clearance
        self.here: tuple[float, float] | None = None
        self._points: list[tuple[float, float]] = []
        self._motion: list[Motion] = []
        self._centre: list[tuple[float, float]] = []
        self._share: list[float] = []
        self._mark: list[Mark] = []

    def rapid(self, u: float, v: float) -> None:
        """Go at rapid; the first time from the setup's clearance height, down beside the work."""
        if self.here is None:
            r = float(self.view.back(np.array([[u, self.away]]))[0, 0])
            self._add((r, self.clearance), Motion.RAPID, 0.0, Mark.RETRACT)
            self.here = (u, self.away)
            self._add(self._real(u, self.away), Motion.RAPID, 0.0, Mark.RETRACT)
        if self.here != (u, v):
            self._add(self._real(u, v), Motion.RAPID, 0.0, Mark.RETRACT)
        self.here = (u, v)

    def feed(self, u: float, v: float, mark: Mark = Mark.CUT) -> None:
        """Go straight at the feed, at a share of it into material."""
        if self.here == (u, v):
            return
        share = ENTRY_SHARE if mark is Mark.ENTRY else 1.0
        self._add(self._real(u, v), Motion.LINE, share, mark)
        self.here = (u, v)

    def contour(self, way: Floats, mark: Mark = Mark.CUT) -> None:
        """Follow a way (k, 2), which begins where the tool is, in lines and arcs; at a share of the feed into material."""
        share = ENTRY_SHARE if mark is Mark.ENTRY else 1.0
        kept, bulges = arcs_through(self.view.back(way)[:, ::-1], FITTED, chords=True)
        pieces = segments_of(kept[:-1], kept[1:], bulges)
        for k, (z, r) in enumerate(kept[1:].tolist()):
            round_ = abs(float(bulges[k])) > tolerance.PARAMETRIC
            motion = (
                Motion.LINE if not round_ else Motion.ARC_CCW if bulges[k] > 0.0 else Motion.ARC_CW
            )
            centre = (
                (float(pieces.centre[k, 1]), float(pieces.centre[k, 0]))
                if round_
                else (np.nan, np.nan)
            )
            self._add((r, z), motion, share, mark, centre)
        self.here = (float(way[-1, 0]), float(way[-1, 1]))

    def _real(self, u: float, v: float) -> tuple[float, float]:
        r, z = self.view.back(np.array([[u, v]]))[0].tolist()
        return r, z

    def _add(
        self,
        point: tuple[float, float],
        motion: Motion,
        share: float,
        mark: Mark,
        centre: tuple[float, float] = (np.nan, np.nan),
    ) -> None:
        self._points.append(point)
        self._motion.append(motion)
        self._centre.append(centre)
        self._share.append(share)
        self._mark.append(mark)

    def made(self) -> Toolpath:
        """Return the path, which ends over the work at the setup's clearance height."""
        if self.here is None:
            return EMPTY
        self.rapid(self.here[0], self.away)
        self._add((self._points[-1][0], self.clearance), Motion.RAPID, 0.0, Mark.RETRACT)
        points, centre = np.array(self._points), np.array(self._centre)
        level, n = np.zeros(len(points)), len(points)
        turns = limited_turns(
            self.data.speed, 2.0 * np.abs(points[:, 0]), self.data.highest_spindle
        )
        return Toolpath(
            position=np.column_stack([points[:, 0], level, points[:, 1]]),
            axis=np.tile(ACROSS, (n, 1)),
            motion=np.array(self._motion),
            centre=np.column_stack(
                [centre[:, 0], np.where(np.isnan(centre[:, 0]), np.nan, 0.0), centre[:, 1]]
            ),
            feed=np.array(self._share) * self.data.feed_per_tooth * turns,
            mark=np.array(self._mark),
            work_turns=True,
        )
