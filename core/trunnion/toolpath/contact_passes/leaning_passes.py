"""Passes of a leaning cutter along lines of contacts: axes first, then the poses along them, in blocks within the chord error.

Moves between two clear poses may touch something: they go back to the search for axes. What no pass covers is the rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels.cutter_contact.drop_cutter import ROUND, C
from trunnion.geometry.sphere import angle_between
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import lower_side, tip_at, touching
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.axis_fields import AxisField
from trunnion.toolpath.contact_passes.axis_search import (
    STEP,
    AxisSearch,
    FreeAxes,
    LeanLimits,
    free_axes,
)
from trunnion.toolpath.contact_passes.contacts import Contacts, between, slerp
from trunnion.toolpath.contact_passes.passes import Pass

SHARES = (0.25, 0.5, 0.75)
"""Where on a block its chord error is looked at, beside the contacts on its path."""
HALVINGS = 16
"""Times that a block is halved at most."""
MOST_AXES, FEWEST_BLOCKS = 16, 4
"""Chosen axes that one block spans at most, and blocks that a pass has at least before they are halved: the ends of a loop meet."""
ASTRAY = math.radians(0.5)
"""rad: how far a block's axis may be from the one that was chosen, between its ends."""
TRIES = 4
"""Times that axes are chosen again where a move between two clear ones touched something."""
OVERLAP = 0.25
"""Of an earlier cutter's radius: how far what it left is cut beyond its end."""
STRAIGHT = 1000.0
"""mm: a cutter that is flatter where it touches counts as this round."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointMilledPasses:
    """Passes of a leaning cutter, the stretches of the contact lines that had to be left, and their share of the paths."""

    passes: tuple[Pass, ...]
    rest: tuple[Contacts, ...]
    remaining: float


def milled(
    contact_lines: Sequence[Contacts],
    tool: Tool,
    field: AxisField,
    query: ClearanceQuery | None,
    limits: LeanLimits,
    chord: float,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> PointMilledPasses:
    """Return the passes of a cutter over contact passes, its axis as near to a field as `query` and the limits let it.

    The cutter stays within `chord` mm of where it touches, thicker by the allowance. Moves that touch what they must not are left out.
    """
    if not contact_lines:
        return PointMilledPasses(passes=(), rest=(), remaining=0.0)
    # Axes first, then the poses along them; moves that touch something go back to the search (`met`) until TRIES are over.
    search = AxisSearch(contact_lines, field, tool, query, limits, allowance)
    axes_of_lines = search.found_axes(progress.part(0.0, 0.5))
    found: list[list[tuple[Floats, Pass]]] = [[] for _ in contact_lines]
    again = list(range(len(contact_lines)))
    for n in range(TRIES):
        share = progress.part(1.0 - 0.5 ** (n + 1), 1.0 - 0.5 ** (n + 2))
        runs = [
            [
                RunPoses.of(contact_lines[k], run, tool, chord, allowance)
                for run in axes_of_lines[k].runs()
            ]
            for k in share.over(again, "Following flow lines with a leaning tool")
        ]
        cut = _cut(runs, query)
        for k, (pieces, _) in zip(again, cut, strict=True):
            found[k] = pieces
        if n + 1 < TRIES:
            search.met({k: met for k, (_, met) in zip(again, cut, strict=True) if len(met)})
        again = np.flatnonzero(search.dirty).tolist()
        axes_of_lines = search.found_axes(share) if again else axes_of_lines
    # What no pass covers is the rest, in rows of the contacts: left to a thinner tool or reported.
    gaps = [
        _gaps(
            len(contacts) - 1.0,
            [(float(position[0]), float(position[-1])) for position, _ in pieces],
        )
        for contacts, pieces in zip(contact_lines, found, strict=True)
    ]
    whole, remaining = (
        sum(_run(contacts, 0.0, len(contacts) - 1.0) for contacts in contact_lines),
        sum(_run(contacts, *g) for contacts, some in zip(contact_lines, gaps) for g in some),
    )
    rest = tuple(
        contacts.of(slice(math.floor(a), math.ceil(b) + 1))
        for contacts, some in zip(contact_lines, gaps, strict=True)
        for a, b in some
    )
    return PointMilledPasses(
        passes=tuple(one for pieces in found for _, one in pieces),
        rest=rest,
        remaining=remaining / whole if whole > 0.0 else 0.0,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RunPoses:
    """A run of axes along a contact pass, and the cutter on it: the `position` (k,) of each of its poses along the contacts."""

    contacts: Contacts
    run: FreeAxes
    tool: Tool
    allowance: float
    position: Floats
    poses: Pass

    @staticmethod
    def of(
        contacts: Contacts, run: FreeAxes, tool: Tool, chord: float, allowance: float = 0.0
    ) -> RunPoses:
        """Return where a cutter is along a run, in blocks as long as the chord error (mm) and the chosen axes allow."""
        axis_positions = run.position
        stride = max(1, min(MOST_AXES, (len(axis_positions) - 1) // FEWEST_BLOCKS))
        position = np.append(axis_positions[:-1:stride], axis_positions[-1])
        made = RunPoses.at(contacts, run, tool, allowance, position)
        radius = max(tool.corner_radius, 0.25 * tool.radius)
        travel = contacts.travel(radius)
        inner = np.concatenate([np.arange(len(contacts), dtype=np.float64), axis_positions[1:-1]])
        inner = inner[(inner > position[0]) & (inner < position[-1])]
        for _ in range(HALVINGS):
            worst = made._off(inner, travel, chord)
            split = np.flatnonzero(
                (worst > 1.0)
                & (
                    np.linalg.norm(np.diff(made.poses.tip, axis=0), axis=1)
                    > 2.0 * tolerance.SHORT_MOVE
                )
            )
            if not len(split):
                break
            middles = 0.5 * (made.position[split] + made.position[split + 1])
            made = made.with_positions(middles)
        return made

    @staticmethod
    def at(
        contacts: Contacts, run: FreeAxes, tool: Tool, allowance: float, position: Floats
    ) -> RunPoses:
        """Return the run with poses at positions (k,)."""
        point, normal = between(contacts.point, contacts.normal, contacts.feed, position)
        axis = run.at(position)
        tip = tip_at(tool, point + allowance * normal, normal, axis)
        return RunPoses(
            contacts=contacts,
            run=run,
            tool=tool,
            allowance=allowance,
            position=position,
            poses=Pass(tip=tip, axis=axis, normal=normal),
        )

    def with_positions(self, more: Floats) -> RunPoses:
        """Return the run with poses at more positions (m,)."""
        position = np.union1d(self.position, more)
        return RunPoses.at(self.contacts, self.run, self.tool, self.allowance, position)

    def axis_positions_within(self, blocks: Bools) -> Floats:
        """Return the positions (m,) of chosen axes within some of the blocks (k - 1,)."""
        block = np.searchsorted(self.position, self.run.position, side="right") - 1
        inside = (block < len(blocks)) & ~np.isin(self.run.position, self.position)
        return self.run.position[inside & blocks[np.minimum(block, len(blocks) - 1)]]

    def _off(self, inner: Floats, travel: Floats, chord: float) -> Floats:
        """Return how far each block (k - 1,) is off, in what it may be: the straight block from the contact's tip along the face's normal,
        against the chord error, and its axis, which turns evenly, from the chosen one, against `ASTRAY`.

        `inner` (m,): positions that are looked at beside `SHARES` of each block; travel (n,): how far the cutter has come at each contact.
        """
        position, tip, axis = self.position, self.poses.tip, self.poses.axis
        share = np.concatenate([position[:-1] + s * np.diff(position) for s in SHARES])
        probe = np.concatenate([inner, share])
        block = np.clip(np.searchsorted(position, probe, side="right") - 1, 0, len(position) - 2)
        gone = np.interp(probe, np.arange(len(travel)), travel)
        ends = np.interp(position, np.arange(len(travel)), travel)
        part = np.clip(
            (gone - ends[block]) / np.maximum(ends[block + 1] - ends[block], tolerance.PARAMETRIC),
            0.0,
            1.0,
        )
        turned = slerp(axis[block], axis[block + 1], part)
        c = self.contacts
        at, out = between(c.point, c.normal, c.feed, probe)
        tip_at_block = tip[block] + part[:, None] * (tip[block + 1] - tip[block])
        wanted = tip_at(self.tool, at + self.allowance * out, out, turned)
        off = np.abs(((tip_at_block - wanted) * out).sum(axis=1))
        astray = angle_between(turned, self.run.at(probe))
        worst = np.zeros(len(position) - 1)
        np.maximum.at(worst, block, np.maximum(off / chord, astray / ASTRAY))
        return worst


def rest_of(
    contact_lines: Sequence[Contacts],
    earlier: Tool,
    field: AxisField,
    query: ClearanceQuery,
    limits: LeanLimits,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> tuple[Contacts, ...]:
    """Return the stretches of contact passes where an earlier cutter had no free axis, and a little more all round."""
    axes_of_lines = free_axes(contact_lines, field, earlier, query, limits, allowance, progress)
    gone = np.vstack(
        [
            np.zeros((0, 3)),
            *(
                between(contacts.point, contacts.normal, contacts.feed, axes.position[~axes.free])[
                    0
                ]
                for contacts, axes in zip(contact_lines, axes_of_lines, strict=True)
            ),
        ]
    )
    if not len(gone):
        return ()
    tree, overlap, found = cKDTree(gone), OVERLAP * earlier.radius + STEP / limits.turn, []
    for contacts in contact_lines:
        near = tree.query(contacts.point)[0] <= overlap
        edges = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(np.int64)))
        found += [contacts.of(slice(a, b)) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]
    return tuple(found)


def grooving(tool: Tool, lead: float, tilt: float) -> Tool:
    """Return the ball that leaves the same grooves as a cutter that leans by a lead and a tilt (rad): how wide apart passes may lie.

    Where a cutter touches, it is as round as its profile in the plane of its axis, and round about its axis across that plane.
    """
    if tool.form == "ball" or (tool.form == "taper" and tool.corner_radius == tool.radius):
        radius = tool.corner_radius
    else:
        lean = math.acos(math.cos(lead) * math.cos(tilt))
        pieces = lower_side(tool)
        rho = float(touching(tool, np.array([lean]))[0][0])
        profile = next(
            (1.0 / row[C] for row in pieces if row[ROUND] and row[0] <= rho <= row[1]), 0.0
        )
        # The share of the lean that lies across the feed.
        across = (math.sin(tilt) / math.sin(lean)) ** 2 if lean > 0.0 else 0.0
        curved = across * profile + (1.0 - across) * (
            math.sin(lean) / rho if rho > 0.0 else profile
        )
        radius = 1.0 / max(curved, 1.0 / STRAIGHT)
    return replace(
        tool,
        form="ball",
        diameter=2.0 * radius,
        corner_radius=radius,
        flute_length=max(tool.flute_length, radius),
        neck_length=max(tool.neck_length, radius),
        stickout=max(tool.stickout, radius),
        gauge_length=max(tool.gauge_length, radius),
        taper_angle=0.0,
        barrel_radius=0.0,
    )


def _cut(
    runs: Sequence[Sequence[RunPoses]], query: ClearanceQuery | None
) -> list[tuple[list[tuple[Floats, Pass]], Floats]]:
    """Return for the runs of each line the stretches whose moves are clear, and the positions where a move is not."""
    every = [run for some in runs for run in some]
    clear = _clear(every, query)
    # A long block that touches something is tried again from one chosen axis to the next: these poses are clear.
    more = [run.axis_positions_within(~own) for run, own in zip(every, clear, strict=True)]
    again = [k for k, positions in enumerate(more) if len(positions)]
    for k in again:
        every[k] = every[k].with_positions(more[k])
    for k, own in zip(again, _clear([every[k] for k in again], query), strict=True):
        clear[k] = own
    found, number = [], iter(range(len(every)))
    for some in runs:
        pieces, met = list[tuple[Floats, Pass]](), [np.zeros(0)]
        for _ in some:
            k = next(number)
            position, poses = every[k].position, every[k].poses
            pieces += [(position[s], poses.of(s)) for s in _stretches(clear[k])]
            met.append(0.5 * (position[:-1] + position[1:])[~clear[k]])
        found.append((pieces, np.concatenate(met)))
    return found


def _clear(runs: Sequence[RunPoses], query: ClearanceQuery | None) -> list[Bools]:
    """Return which blocks of runs are clear, asked for all together: a pass alone is too short a work for two cores."""
    if query is None or not runs:
        return [np.ones(len(run.position) - 1, bool) for run in runs]
    poses = [run.poses for run in runs]
    clear = query(
        np.concatenate([p.tip[1:] for p in poses]),
        np.concatenate([p.axis[1:] for p in poses]),
        start_tip=np.concatenate([p.tip[:-1] for p in poses]),
        start_axis=np.concatenate([p.axis[:-1] for p in poses]),
    )
    return np.split(clear, np.cumsum([len(p) - 1 for p in poses])[:-1])


def _stretches(clear: Bools) -> list[slice]:
    """Return the rows of ends of blocks (k,) that are clear one after the other."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], clear, [False]]).astype(np.int64)))
    return [slice(a, b + 1) for a, b in edges.reshape(-1, 2).tolist()]


def _gaps(end: float, done: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the stretches between positions 0 and `end` that lie in none of those that are done."""
    found, here = [], 0.0
    for a, b in [*sorted(done), (end, end)]:
        if a > here + tolerance.COINCIDENT:
            found.append((here, a))
        here = max(here, b)
    return found


def _run(contacts: Contacts, start: float, end: float) -> float:
    """Return the length in mm of the contact line from a position to another."""
    length = contacts.travel(0.0)
    return float(np.diff(np.interp([start, end], np.arange(len(contacts)), length))[0])
