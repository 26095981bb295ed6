"""Links of a leaning tool between passes, its axis turning on the way: over the surface, off one lead and onto the next one, or low through
the air.

Passes of a leaning tool hardly ever begin with the axis that the one before ended with. All ways are straight for the tip and even for the
axis, and each is asked for between all passes at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sphere import angle_between
from trunnion.model.motion.toolpath import Mark
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.linking.leads import Leads
from trunnion.toolpath.contact_passes.linking.parameters import NEAR, LinkParameters, is_upright
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.tool_moves import ToolMoves

MOST_TURN = math.radians(45.0)
"""Largest turn of the axis between two leads that are near each other: beyond, the tool is led through the air."""
APART = 0.5
"""mm that no place of the tool goes between two poses of a way at which stock is asked for."""
HEIGHTS = (0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
"""mm along their axes that both ends of a way through the air are off the leads at least, the lowest first."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinkMoves:
    """Moves to tips with axes (k, 3) each: at rapid, or at the feed of cuts."""

    tip: Floats
    axis: Floats
    mark: Mark
    rapid: bool = False


Link = tuple[LinkMoves, ...]
"""All moves from the end of a pass to the start of the next one, which is the last of them."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LeaningLinks:
    """Successive passes, m - 1 pairs of them: the last tip of the one and the first of the other, where their leads end, and both axes.

    end, start, lead_end, lead_start (m - 1, 3) mm; end_axis, start_axis (m - 1, 3).
    """

    passes: Sequence[Pass]
    leads: Leads
    end: Floats
    start: Floats
    lead_end: Floats
    lead_start: Floats
    end_axis: Floats
    start_axis: Floats

    @staticmethod
    def of(passes: Sequence[Pass], leads: Leads) -> LeaningLinks:
        """Return what may be linked of passes with their leads."""
        return LeaningLinks(
            passes=passes,
            leads=leads,
            end=np.array([p.tip[-1] for p in passes])[:-1],
            start=np.array([p.tip[0] for p in passes])[1:],
            lead_end=leads.lead_out[:-1, -1],
            lead_start=leads.lead_in[1:, 0],
            end_axis=np.array([p.axis[-1] for p in passes])[:-1],
            start_axis=np.array([p.axis[0] for p in passes])[1:],
        )

    @property
    def leaning(self) -> Ints:
        """The pairs (k,) one of whose axes leans: others go over the dropped cutter."""
        pairs = zip(self.end_axis, self.start_axis, strict=True)
        return np.flatnonzero([not (is_upright(a) and is_upright(b)) for a, b in pairs])

    def near(self, tool: Tool, parameters: LinkParameters) -> dict[int, Link]:
        """Return the links of pairs that are near each other: straight over the surface where the axis turns little enough, else by the
        leads of both, up to the tool's radius."""
        query = parameters.query
        if query is None:
            return {}
        away = np.linalg.norm(self.start - self.end, axis=1)
        turn = angle_between(self.end_axis, self.start_axis)
        rows = self.leaning
        near = away <= NEAR * parameters.stepover
        slow = rows[
            near[rows] & (turn[rows] <= parameters.turn * away[rows] + tolerance.PARAMETRIC)
        ]
        straight = slow[self._is_clear(slow, self.end, self.start, query)]
        straight = straight[
            self._is_free(straight, self.end, self.start, tool.gauge_length, parameters)
        ]
        near |= away <= tool.radius
        rows = rows[near[rows] & (turn[rows] <= MOST_TURN)]
        rows = rows[~np.isin(rows, straight)]
        # A tool that turns where it touches the face would leave a mark: leads that have no radius are none.
        rows = rows[(self._lengths_of_leads(rows) > tolerance.SHORT_MOVE).all(axis=1)]
        led = rows[self._is_clear(rows, self.lead_end, self.lead_start, query)]
        led = led[self._is_free(led, self.lead_end, self.lead_start, tool.gauge_length, parameters)]
        return {
            **{k: (self._onto_pass(k, Mark.LINK),) for k in straight.tolist()},
            **{
                k: (self._off_pass(k, Mark.LINK), self._lead_onto(k, Mark.LINK))
                for k in led.tolist()
            },
        }

    def through_air(
        self,
        rows: Ints,
        retract: Floats,
        approach: Floats,
        parameters: LinkParameters,
        progress: Progress,
    ) -> dict[int, Link]:
        """Return the links of some pairs through the air: out along the axis, across at rapid, in along the next axis; as low as is clear.

        `retract`, `approach` (m - 1,): how far in mm the tool is fed along its axis from the lead off a pass, and to that onto the next.
        """
        found = dict[int, Link]()
        if parameters.link_clearance is None:
            return found
        rows = np.intersect1d(rows, self.leaning)
        tried = np.full((len(rows), 2), -1.0)
        for n, height in enumerate(HEIGHTS):
            progress.at(n / len(HEIGHTS), "Linking passes through the air")
            lifts = np.maximum(np.column_stack([retract[rows], approach[rows]]), height)
            clear = np.zeros(len(rows), dtype=bool)
            # Where both ends have to be higher anyway this way is tried already.
            new = np.flatnonzero((lifts != tried).any(axis=1))
            some = rows[new]
            clear[new] = parameters.link_clearance.is_free_between(
                self.lead_end[some] + lifts[new, :1] * self.end_axis[some],
                self.end_axis[some],
                self.lead_start[some] + lifts[new, 1:] * self.start_axis[some],
                self.start_axis[some],
            )
            for k, (out, into) in zip(rows[clear].tolist(), lifts[clear].tolist(), strict=True):
                found[k] = self._over(k, (float(retract[k]), out), (into, float(approach[k])))
            rows, tried = rows[~clear], lifts[~clear]
            if not len(rows):
                break
        return found

    def _over(self, k: int, out: tuple[float, float], into: tuple[float, float]) -> Link:
        """Return a link through the air: `out` and `into` are the mm off the leads where feeds and rapids end, in their order."""
        fed, away = (self.lead_end[k] + lift * self.end_axis[k] for lift in out)
        over, down = (self.lead_start[k] + lift * self.start_axis[k] for lift in into)
        first, last = self.end_axis[k], self.start_axis[k]
        return (
            self._off_pass(k, Mark.LEAD),
            _moves(fed[None], first, Mark.LEAD),
            _moves(away[None], first, Mark.RETRACT, rapid=True),
            _moves(np.array([over, down]), last, Mark.RETRACT, rapid=True),
            self._lead_onto(k, Mark.LEAD),
        )

    def _off_pass(self, k: int, mark: Mark) -> LinkMoves:
        return _moves(self.leads.off(k), self.end_axis[k], mark)

    def _lead_onto(self, k: int, mark: Mark) -> LinkMoves:
        tips = np.vstack([self.leads.onto(k + 1), self.start[k : k + 1]])
        return _moves(tips, self.start_axis[k], mark)

    def _onto_pass(self, k: int, mark: Mark) -> LinkMoves:
        return _moves(self.start[k : k + 1], self.start_axis[k], mark)

    def _lengths_of_leads(self, rows: Ints) -> Floats:
        """Return how far (k, 2) in mm leads take the tool off the passes of some pairs."""
        leads = (self.lead_end[rows] - self.end[rows], self.lead_start[rows] - self.start[rows])
        return np.column_stack([np.linalg.norm(w, axis=1) for w in leads])

    def _is_clear(self, rows: Ints, tips: Floats, others: Floats, query: ClearanceQuery) -> Bools:
        """Return which pairs' ways from tips to others (m - 1, 3) are clear."""
        if not len(rows):
            return np.zeros(0, dtype=bool)
        return query(
            others[rows],
            self.start_axis[rows],
            start_tip=tips[rows],
            start_axis=self.end_axis[rows],
        )

    def _is_free(
        self, rows: Ints, tips: Floats, others: Floats, reach: float, parameters: LinkParameters
    ) -> Bools:
        """Return on which pairs' ways from tips to others (m - 1, 3) a tool that reaches so far (mm) meets no stock above its flutes."""
        if parameters.pass_stock is None or not len(rows):
            return np.ones(len(rows), dtype=bool)
        moves = ToolMoves(tips[rows], self.end_axis[rows], others[rows], self.start_axis[rows])
        way, tip, axis = moves.poses(np.ceil((moves.travel + reach * moves.turn) / APART))
        is_free = parameters.pass_stock.is_free(tip, axis, rows[way] + 1)
        return np.bincount(way, ~is_free, len(rows)) == 0.0


def _moves(tips: Floats, axis: Floats, mark: Mark, *, rapid: bool = False) -> LinkMoves:
    return LinkMoves(tip=tips, axis=np.broadcast_to(axis, tips.shape), mark=mark, rapid=rapid)
