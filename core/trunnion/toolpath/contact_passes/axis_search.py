"""Tool axes that are free: the nearest to what a field wants that keeps cutter, shank, holder and machine out of trouble.

Along each pass the axis is chosen from directions spread over the sphere, as one least-cost path for the whole pass: near what is wanted,
turning little and never faster than allowed, away from where something is touched. What is free is only queried where a run of axes has met
something; contacts that lie close together, on faces that look the same way, share one answer until it proves wrong. The axes are then
eased, and every eased axis is queried again. Where no axis is free the pass has a gap.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np

from trunnion.findings import Finding, Refused, warning
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels.shortest_paths.least_cost_path_compiled import least_cost_path
from trunnion.geometry.sphere import angle_between, directions, neighbours
from trunnion.model.tool import Holder, Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.axis_fields import AxisField, eased, leaning
from trunnion.toolpath.contact_passes.contacts import Contacts, axis_between, between, slerp
from trunnion.toolpath.contact_passes.passes import Pass

FINE, COARSE = 3, 2
"""Halvings of the directions that a run of axes is chosen from, 9 degrees apart, and of those that are queried, 18 degrees apart."""
STEP = math.radians(10.5)
"""Turn from one position of a run of axes to the next: just to the next direction."""
STIFFNESS = 1.5
"""mm: what the wanted axis does within this is evened out."""
EASING = 2.0
"""Positions over which a run of axes is eased."""
RIM = 0.1
"""What a direction costs whose neighbours are all taken, as a deviation from the wanted axis (rad squared)."""
LEAP = 50.0
"""What it costs to lift the tool and set it down with another axis: 20 mm with an axis that is 90 degrees off."""
ROUNDS = 12
"""Times that a run of axes is chosen again after something was met."""
AHEAD = 4
"""Positions before and behind one that met something which are queried with it."""
CLOSE, ALIKE = 2.0, 0.25
"""mm and (of the normal's unit sphere) how close contacts lie that share an answer."""
SMALLEST_SHARE = 0.001
"""Less of the passes than this may be lost without a word."""
AWAY = 1e4
"""mm: a tool this far from the part only meets the machine's limits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LeanLimits:
    """What axes keep to: `turn` rad a mm of the cutter's travel; `steepest` rad between axis and normal."""

    turn: float = math.radians(10.0)
    steepest: float = math.radians(75.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FreeAxes:
    """Free axes of one pass: at positions (k,) along its contacts (2.25: a quarter of the distance from the third to the next) axis (k, 3).

    free (k,): whether there is one; leap (k,): whether the axis is not reached from the position before without lifting the tool.
    """

    position: Floats
    axis: Floats
    free: Bools
    leap: Bools

    def runs(self) -> list[FreeAxes]:
        """Return the pieces that are cut without lifting the tool, those of two positions and more."""
        ends = np.flatnonzero(self.leap | ~self.free | ~np.concatenate([[False], self.free[:-1]]))
        found = []
        for a, b in pairwise([*ends.tolist(), len(self.position)]):
            # After a leap the way that leads up to it is cut again, with the new axis.
            rows = np.arange(a, b) if not self.leap[a] else np.concatenate([[a], np.arange(a, b)])
            position = self.position[rows]
            position[0] = self.position[a - 1] if self.leap[a] else position[0]
            if self.free[a] and len(rows) > 1:
                found.append(
                    FreeAxes(
                        position=position,
                        axis=self.axis[rows],
                        free=self.free[rows],
                        leap=self.leap[rows],
                    )
                )
        return found

    def at(self, position: Floats) -> Floats:
        """Return the axes (m, 3) at samples (m,) of the pass."""
        row = np.clip(
            np.interp(position, self.position, np.arange(len(self.position))),
            0.0,
            len(self.position) - 1.0,
        )
        return axis_between(self.axis, row)


def free_axes(
    passes: Sequence[Contacts],
    field: AxisField,
    tool: Tool,
    query: ClearanceQuery | None,
    limits: LeanLimits,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> list[FreeAxes]:
    """Return the free axes of contact passes, as near as can be to what a field wants.

    `query` says what is free; without it only the limits count. `allowance`: mm that the cutter keeps from the contacts.
    """
    return AxisSearch(passes, field, tool, query, limits, allowance).found_axes(progress)


def leaned(
    passes: Sequence[Pass],
    tool: Tool,
    field: AxisField,
    query: ClearanceQuery | None,
    limits: LeanLimits,
    chord: float,
    progress: Progress = NO_PROGRESS,
) -> list[Pass]:
    """Return passes of a ball (or a taper with a ball) with the axis leant to a field: the ball's centre stays on its path.

    Turning the axis while the tip goes straight bends the centre's way: blocks are cut so short that it stays within `chord` mm.
    """
    radius, some = tool.corner_radius, [p for p in passes if len(p) > 1]
    contact_lines = [
        Contacts(point=p.tip + radius * (p.axis - p.normal), normal=p.normal, closed=p.closed)
        for p in some
    ]
    found = []
    for origin, contacts, free in zip(
        some,
        contact_lines,
        free_axes(contact_lines, field, tool, query, limits, 0.0, progress),
        strict=True,
    ):
        centre = origin.tip + radius * origin.axis
        for run in free.runs():
            position = _finely(
                run, np.arange(len(contacts), dtype=np.float64), math.sqrt(8.0 * chord / radius)
            )
            row = np.clip(position.astype(np.int64), 0, len(contacts) - 2)
            share = (position - row)[:, None]
            axis = run.at(position)
            normal = slerp(contacts.normal[row], contacts.normal[row + 1], position - row)
            whole = origin.closed and len(run.position) == len(free.position)
            found.append(
                Pass(
                    tip=(1.0 - share) * centre[row] + share * centre[row + 1] - radius * axis,
                    axis=axis,
                    normal=normal,
                    closed=whole and bool(angle_between(axis[:1], axis[-1:])[0] < 1e-9),
                )
            )
    return found


def leaned_by(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    lead: float,
    tilt: float,
    chord: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[list[Pass], tuple[Finding, ...]]:
    """Return passes of a ball leant by a lead and a tilt (rad), further where that keeps clear, and what had to be left; as they are when
    both are 0. Raises `Refused` for a cutter that is no ball and where no tool may lean."""
    if lead == 0.0 and tilt == 0.0:
        return list(passes), ()
    if drive.query_for is None:
        raise Refused(f"{drive.feature}: a lead or tilt angle needs a machine with rotary axes")
    if tool.corner_radius < tool.radius:
        raise Refused(
            f"{tool.name}: only passes of a ball keep their place when it leans; choose a ball, or point milling"
        )
    found = leaned(
        passes, tool, leaning(lead, tilt), drive.query_for(tool), LeanLimits(), chord, progress
    )
    whole, done = (
        sum(
            float(np.linalg.norm(np.diff(p.tip + tool.radius * p.axis, axis=0), axis=1).sum())
            for p in some
        )
        for some in (passes, found)
    )
    if done > (1.0 - SMALLEST_SHARE) * whole:
        return found, ()
    return found, (
        warning(
            "lean.left",
            f"{100.0 * (1.0 - done / whole):.1f} % of the passes over {drive.feature} stay: {tool.name} finds "
            "no way to lean there",
            drive.feature,
            remedy="choose another lead or tilt, or a longer cutter",
        ),
    )


def thickened(tool: Tool, clearance: float) -> Tool:
    """Return a tool whose neck, shank and holder are thicker by a clearance in mm; its cutting part stays as it is."""
    rows = tuple((z0, r0 + clearance, z1, r1 + clearance) for z0, r0, z1, r1 in tool.holder.rows)
    return replace(
        tool,
        neck_diameter=tool.neck_diameter + 2.0 * clearance,
        shank_diameter=tool.shank_diameter + 2.0 * clearance,
        holder=Holder(name=tool.holder.name, rows=rows),
    )


def _finely(run: FreeAxes, rows: Floats, turn: float) -> Floats:
    """Return the positions of a run at which its pass has rows, and as many between as keep the axis from turning further than `turn`."""
    low, high = run.position[0], run.position[-1]
    position = np.unique(np.concatenate([[low], rows[(rows > low) & (rows < high)], [high]]))
    axis = run.at(position)
    count = np.maximum(1, np.ceil(angle_between(axis[:-1], axis[1:]) / turn)).astype(np.int64)
    owner, number = items_of(count)
    share = number / count[owner]
    return np.append(position[owner] + share * np.diff(position)[owner], high)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _AxisSamples:
    """The positions of all passes together: where (k,) along which contacts; point, normal, wanted axis (k, 3) there; from `start`
    (p + 1,) on those of a pass; `pitch` (p,) mm of travel from position to position."""

    position: Floats
    point: Floats
    normal: Floats
    wanted: Floats
    start: Ints
    pitch: Floats

    @staticmethod
    def of(
        passes: Sequence[Contacts],
        field: AxisField,
        tool: Tool,
        limits: LeanLimits,
        allowance: float,
    ) -> _AxisSamples:
        """Return positions at even steps of what the cutter travels."""
        radius = max(tool.corner_radius, 0.25 * tool.radius)
        positions, points, normals, wanted, pitches = [], [], [], [], []
        for contacts in passes:
            travel, feed = contacts.travel(radius), contacts.feed
            steps = max(1, math.ceil(travel[-1] * limits.turn / STEP))
            position = np.interp(
                np.linspace(0.0, travel[-1], steps + 1),
                travel,
                np.arange(len(contacts), dtype=np.float64),
            )
            point, normal = between(contacts.point, contacts.normal, feed, position)
            row = np.clip(np.round(position).astype(np.int64), 0, len(contacts) - 1)
            desired = field(point, normal, feed[row])
            positions.append(position)
            points.append(point + allowance * normal)
            normals.append(normal)
            wanted.append(desired)
            pitches.append(travel[-1] / steps)
        empty = np.zeros((0, 3))
        return _AxisSamples(
            position=np.concatenate([np.zeros(0), *positions]),
            point=np.vstack([empty, *points]),
            normal=np.vstack([empty, *normals]),
            wanted=np.vstack([empty, *wanted]),
            start=np.cumsum([0, *(len(p) for p in positions)]),
            pitch=np.array(pitches),
        )


class AxisSearch:
    """Free axes of contact passes, found as `free_axes` says; keeps what was queried so far: a table of free directions, a row for each
    position.

    Where a move between two positions is found to touch something, `met` takes that in and the axes are requested again.
    """

    def __init__(
        self,
        passes: Sequence[Contacts],
        field: AxisField,
        tool: Tool,
        query: ClearanceQuery | None,
        limits: LeanLimits,
        allowance: float = 0.0,
    ) -> None:
        self.samples = samples = _AxisSamples.of(passes, field, tool, limits, allowance)
        self.tool, self.query, self.limits = tool, query, limits
        k = len(samples.position)
        self.axis, self.free, self.leap = np.zeros((k, 3)), np.zeros(k, bool), np.zeros(k, bool)
        self.clear, self.column = np.zeros(k, bool), np.zeros(k, dtype=np.int64)
        # Whether a position has a result of its own, and whether it takes a direction as requested, not eased.
        self.own, self.raw = np.zeros(k, bool), np.zeros(k, bool)
        self.dirty = np.ones(max(len(samples.start) - 1, 0), bool)
        # Row 0: nothing is known, all that the machine can hold is free.
        self.table = self._held()[None]
        self.row = np.zeros(k, dtype=np.int64)
        alike = np.column_stack(
            [np.floor(samples.point / CLOSE), np.floor(samples.normal / ALIKE)]
        ).astype(np.int64)
        self.first, self.node = (
            np.unique(alike, axis=0, return_index=True, return_inverse=True)[1:]
            if k
            else (self.row, self.row)
        )

    def _held(self) -> Bools:
        point = _sphere()[0]
        if self.query is None or not len(self.samples.position):
            return np.ones(len(point), bool)
        return self.query(self.samples.point.mean(axis=0) + AWAY * point, point)

    def found_axes(self, progress: Progress = NO_PROGRESS) -> list[FreeAxes]:
        """Return the free axes of all passes."""
        # Lazy collision checking: the cheapest axes are chosen first, and only those are queried; each round learns where they met
        # something.
        for n in range(ROUNDS):
            progress.at(n / ROUNDS, "Leaning the tool clear")
            if not self._improved():
                break
        at = [slice(a, b) for a, b in pairwise(self.samples.start.tolist())]
        # The search may go on: what is given away is a copy.
        axis, free, leap = self.axis.copy(), self.free.copy(), self.leap.copy()
        return [
            FreeAxes(position=self.samples.position[s], axis=axis[s], free=free[s], leap=leap[s])
            for s in at
        ]

    def met(self, positions: Mapping[int, Floats]) -> None:
        """Take in that on passes, by their numbers, something was met at samples (k,): the axes to both sides of them won't do."""
        found = [np.zeros(0, dtype=np.int64)]
        for number, samples in positions.items():
            start, end = self.samples.start[number : number + 2]
            after = np.searchsorted(self.samples.position[start:end], samples)
            found.append(
                start + np.unique(np.clip(np.concatenate([after - 1, after]), 0, end - start - 1))
            )
        rows = np.concatenate(found)
        rows = rows[self.free[rows]]
        self.clear[rows] = self.free[rows] = False
        self._learn(rows)

    def _improved(self) -> bool:
        """Choose the axes of passes about which something new is known; return whether what they met is worth another try."""
        for n in np.flatnonzero(self.dirty).tolist():
            self._choose(
                slice(int(self.samples.start[n]), int(self.samples.start[n + 1])),
                float(self.samples.pitch[n]),
            )
        self.dirty[:] = False
        rows = np.flatnonzero(self.free & ~self.clear)
        met = self._touching(rows)
        self.clear[rows], self.clear[met] = True, False
        if len(met):
            self._learn(met)
            self.free[met] = False
        return len(met) > 0

    def _choose(self, rows: slice, pitch: float) -> None:
        """Choose the axes at the positions of one pass."""
        # Candidates: vertices of a subdivided icosahedron on the free side of the face, no steeper than the limit.
        point, near, turn = _sphere()
        normal, allowed = self.samples.normal[rows], self.table[self.row[rows]]
        upright = normal @ point.T >= math.cos(self.limits.steepest)
        # The normal may turn away between two positions: half the distance to the next ones is kept in sight too.
        for neighbour in (
            np.vstack([normal[1:], normal[-1:]]),
            np.vstack([normal[:1], normal[:-1]]),
        ):
            upright &= (normal + neighbour) @ point.T >= math.cos(
                self.limits.steepest
            ) * np.linalg.norm(normal + neighbour, axis=1)[:, None]
        allowed = allowed & upright
        # Viterbi over positions x directions; node cost (off^2 + RIM taken) pitch, edge cost STIFFNESS^2 turn^2 / pitch.
        off = np.arccos(np.clip(self.samples.wanted[rows] @ point.T, -1.0, 1.0))
        taken = 1.0 - _share_near(allowed, near)
        cost = np.where(allowed, (off * off + RIM * taken) * pitch, np.inf)
        column, leap = least_cost_path(cost, near, STIFFNESS**2 * turn**2 / pitch, LEAP)
        self.free[rows], self.leap[rows] = column >= 0, leap
        # The direction next to the wanted axis stands for it.
        near_wanted = off[np.arange(len(column)), column] < STEP
        axis = np.where(
            (near_wanted & ~self.raw[rows])[:, None], self.samples.wanted[rows], point[column]
        )
        axis = self._eased(rows, axis, column >= 0, leap)
        self.clear[rows] &= (axis == self.axis[rows]).all(axis=1)
        self.axis[rows], self.column[rows] = axis, column

    def _eased(self, rows: slice, axis: Floats, free: Bools, leap: Bools) -> Floats:
        """Return the axes of a run eased, run by run, as far as they stay within the steepest lean."""
        out, ends = (
            axis.copy(),
            np.flatnonzero(leap | ~free | ~np.concatenate([[False], free[:-1]])),
        )
        for a, b in pairwise([*ends.tolist(), len(axis)]):
            out[a:b] = eased(axis[a:b], EASING) if free[a] else axis[a:b]
        steep = (out * self.samples.normal[rows]).sum(axis=1) < math.cos(self.limits.steepest)
        raw = (self.raw[rows] | steep) & free
        neighbour = (np.append(raw[1:], False) | np.append(False, raw[:-1])) & ~raw
        out[neighbour] = slerp(out[neighbour], axis[neighbour], np.full(int(neighbour.sum()), 0.5))
        return np.where(raw[:, None], axis, out)

    def _touching(self, rows: Ints) -> Ints:
        """Return those of some rows whose axes touch something."""
        if self.query is None:
            return rows[:0]
        p = self.samples
        return rows[
            ~self.query(
                tip_at(self.tool, p.point[rows], p.normal[rows], self.axis[rows]), self.axis[rows]
            )
        ]

    def _learn(self, met: Ints) -> None:
        """Ask what is free where something was met: once for contacts that are alike, then for the contact itself; a contact that has been
        asked takes its directions as they are, and strikes out the one that failed."""
        k, owner = len(self.row), np.repeat(np.arange(len(self.dirty)), np.diff(self.samples.start))
        # A position with a row of its own takes directions as they are, and loses the one that failed then.
        struck = met[self.own[met]]
        self.table[self.row[struck[self.raw[struck]]], self.column[struck[self.raw[struck]]]] = (
            False
        )
        self.raw[struck] = True
        # One whose shared row failed gets a row of its own; those without a row, and their neighbours, share one a node of alike contacts.
        own = met[(self.row[met] > 0) & ~self.own[met]]
        around = np.unique(np.clip(met[:, None] + np.arange(-AHEAD, AHEAD + 1), 0, k - 1))
        shared = np.unique(self.node[around[self.row[around] == 0]])
        base = len(self.table)
        self.table = np.vstack(
            [self.table, self._queried(np.concatenate([self.first[shared], own]))]
        )
        of_node = np.full(int(self.node.max(initial=-1)) + 1, -1, dtype=np.int64)
        of_node[shared] = base + np.arange(len(shared))
        # Invariant: `row` of each position names the row of `table` that holds for it; passes with changed rows are dirty.
        new = (of_node[self.node] >= 0) & (self.row == 0)
        self.row[new] = of_node[self.node[new]]
        self.row[own] = base + len(shared) + np.arange(len(own))
        self.own[own] = True
        new[own] = new[struck] = True
        self.dirty[np.unique(owner[new])] = True

    def _queried(self, rows: Ints) -> Bools:
        """Return which directions (k, m) are free at some positions: the coarse ones as requested, one between two of them where both
        are."""
        if self.query is None:
            return np.repeat(self.table[:1], len(rows), axis=0)
        point, parents = directions(FINE)
        coarse = len(directions(COARSE)[0])
        p, free = self.samples, np.zeros((len(rows), len(point)), bool)
        # Coarse directions are queried; a finer one between two is taken as free where both its parents are.
        able = (
            p.normal[rows] @ point[:coarse].T >= math.cos(self.limits.steepest + STEP)
        ) & self.table[0, :coarse]
        which, column = np.nonzero(able)
        at, axis = rows[which], point[column]
        free[which, column] = self.query(tip_at(self.tool, p.point[at], p.normal[at], axis), axis)
        free[:, coarse:] = (
            free[:, parents[coarse:, 0]] & free[:, parents[coarse:, 1]] & self.table[0, coarse:]
        )
        return free


@cache
def _sphere() -> tuple[Floats, Ints, Floats]:
    point = directions(FINE)[0]
    return (point, *neighbours(point, STEP))


def _share_near(free: Bools, near: Ints) -> Floats:
    """Return for each direction (k, m) the share of its neighbours (m, q) that are free."""
    total = np.zeros(free.shape)
    for q in range(near.shape[1]):
        total += np.where(near[:, q] >= 0, free[:, near[:, q]], False)
    return total / (near >= 0).sum(axis=1)
