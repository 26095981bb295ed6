"""Passes of a leaning cutter along lines of contacts: axes first, then the poses along them, in blocks within the chord error.

Moves between two clear poses may touch something: they go back to the search for axes. What no pass covers is the rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.cutter_contact.drop_cutter import ROUND, C
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import lower_side, touching
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.axis_fields import AxisField
from trunnion.toolpath.contact_passes.axis_search import (
    STEP,
    AxisSearch,
    FreeAxes,
    LeanLimits,
    free_axes,
)
from trunnion.toolpath.contact_passes.contacts import Contacts, between
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.run_poses import AxisRuns, RunPoses, poses_along

TRIES = 4
"""Times that axes are chosen again where a move between two clear ones touched something."""
OVERLAP = 0.25
"""Of an earlier cutter's radius: how far what it left is cut beyond its end."""
CONTACTS = 20_000
"""Contacts of the lines that are followed together: many short runs are one work for arrays and for all cores, and it is soon done."""
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
        met_on = dict[int, Floats]()
        for lines in share.over(
            list(_chunks(contact_lines, again)), "Following flow lines with a leaning tool"
        ):
            runs = [(k, run) for k in lines for run in axes_of_lines[k].runs()]
            found_on = _cut(contact_lines, runs, tool, chord, allowance, query)
            for k in lines:
                found[k], met_on[k] = found_on.get(k, ([], np.zeros(0)))
        if n + 1 < TRIES:
            search.met({k: met for k, met in met_on.items() if len(met)})
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


def _chunks(contact_lines: Sequence[Contacts], numbers: Sequence[int]) -> Iterator[list[int]]:
    """Yield the numbers of lines in pieces of `CONTACTS` contacts and one line more at most."""
    some, size = list[int](), 0
    for k in numbers:
        some.append(k)
        size += len(contact_lines[k])
        if size >= CONTACTS:
            yield some
            some, size = [], 0
    if some:
        yield some


def _cut(
    contact_lines: Sequence[Contacts],
    runs: Sequence[tuple[int, FreeAxes]],
    tool: Tool,
    chord: float,
    allowance: float,
    query: ClearanceQuery | None,
) -> dict[int, tuple[list[tuple[Floats, Pass]], Floats]]:
    """Return by lines, which runs are given with, the stretches whose moves are clear, and the positions where a move is not."""
    if not runs:
        return {}
    joined = AxisRuns.of([(contact_lines[k], run) for k, run in runs], tool, allowance)
    made = poses_along(joined, chord)
    blocks = made.blocks()
    clear = np.zeros(len(made.position), bool)
    clear[blocks] = _clear(made, blocks, query)
    # A long block that touches something is tried again from one of the run's axes to the next: these poses are clear.
    long = blocks[~clear[blocks]]
    run, position = made.axes_within(long)
    if len(run):
        order = joined.order(made.run, made.position)
        at = np.searchsorted(order, joined.order(run, position))
        made, clear = made.with_positions(run, position), np.insert(clear, at, False)
        parts = np.insert(np.zeros(len(order), bool), at, True)
        # All parts of a block that was split: those that begin at a new pose, and the one before the first of these.
        parts[:-1] |= parts[1:]
        again = np.flatnonzero(parts)
        clear[again] = _clear(made, again, query)
    found = {k: (list[tuple[Floats, Pass]](), list[Floats]()) for k, _ in runs}
    start = np.searchsorted(made.run, np.arange(len(runs) + 1))
    for (k, _), a, b in zip(runs, start[:-1].tolist(), start[1:].tolist(), strict=True):
        positions, own = made.position[a:b], clear[a : b - 1]
        pieces, met = found[k]
        pieces += [
            (positions[s], made.poses.of(slice(a + s.start, a + s.stop))) for s in _stretches(own)
        ]
        met.append(0.5 * (positions[:-1] + positions[1:])[~own])
    return {k: (pieces, np.concatenate(met)) for k, (pieces, met) in found.items()}


def _clear(made: RunPoses, blocks: Ints, query: ClearanceQuery | None) -> Bools:
    """Return which of some blocks (b,) are clear."""
    if query is None or not len(blocks):
        return np.ones(len(blocks), bool)
    tip, axis = made.poses.tip, made.poses.axis
    return query(tip[blocks + 1], axis[blocks + 1], start_tip=tip[blocks], start_axis=axis[blocks])


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
