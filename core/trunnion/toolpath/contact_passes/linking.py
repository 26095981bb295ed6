"""From passes to a toolpath: in which order they are cut, how the cutter comes to each and leaves it, and the links between.

A pass is entered and left by a quarter circle in the plane of feed and normal, so that no mark shows where. A pass that begins near the
end of the one before is reached over the surface; else the cutter is lifted as far as the stock demands. Whatever is not a cut is lifted
where it would come below the dropped cutter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats, Ints, unit
from trunnion.model.motion.toolpath import EMPTY, Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.extension import extended
from trunnion.toolpath.contact_passes.overhang import overhang_tops
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stock_clearance import LEAST_STOCK, STOCK_SHARE
from trunnion.toolpath.contact_passes.upright.tracing import follow, thinned
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import is_free, lowest_tip
from trunnion.toolpath.stock.heightfield import PlanningStock

NEAR = 3.0
"""Stepovers: a pass that begins no farther from the end of the one before is reached without lifting."""
QUARTER = 16
"""Straight moves in a lead's quarter circle at most, as many where it is lifted over something, and positions at which it is tested:
a power of two."""
LEAD_CHORD = 0.01
"""mm: the chord error of quarter circles that are not lifted; chords cut their corners on the side away from the face."""
SHORTER = (0.4, 0.0)
"""Shares of the lead radius that are tried one after the other where the tool touches something on a lead."""
BETWEEN = 9
"""Positions between two leads that are tested for space."""
LIFT_STEP = 0.02
"""mm: the difference of what two neighbours on a lead are lifted by, from which on the lead is left out."""
SAME = 1e-9
"""Two directions that differ by less are one."""
REORIENT = math.cos(math.radians(60.0))
"""The least part along z of an axis that may turn on a move over the work; a tool that leans more is set upright before."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkParameters:
    """How passes are linked: the `stepover` between them, the `safety` distance of rapids and the `lead_radius` in mm; `order` is "given"
    or "nearest"; `reversing` allows passes to be cut the other way where that is nearer; `chord` is the chord error of links, mm. With
    `arcs` a near pass is reached by the leads of both, and above the stock where these have no space: for walls, beside which a cutter that
    follows the surface would be lifted to their tops. Closed passes go on over their start by the `overlap` in mm. `retreats`
    says how far (k,) in mm a tool at tips (k, 3) with axes (k, 3) is fed along them before it goes on at rapid; None: not at all.
    `query` says which straight moves of a leaning tool are clear: other ones between near passes are lifted over, leads are shorter where
    these are not."""

    stepover: float
    safety: float = 2.0
    lead_radius: float = 1.0
    order: str = "given"
    reversing: bool = False
    chord: float = 2e-3
    arcs: bool = False
    overlap: float = 0.0
    retreats: Callable[[Floats, Floats], Floats] | None = None
    query: ClearanceQuery | None = None


def linked(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    parameters: LinkParameters,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return the toolpath that cuts all passes, in the cutting frame; it begins and ends at the setup's clearance height."""
    passes = extended([p for p in passes if len(p) > 1], drive, tool, parameters.query)
    if not passes:
        return EMPTY
    # Order, then leads and links of all passes at once: drops on the skin are cheap only in batches.
    passes = _ordered(passes, parameters, progress.part(0.0, 0.2))
    near = _near(passes, parameters)
    leads = _leads(passes, drive, tool, parameters, progress.part(0.2, 0.4))
    leads_in, leads_out = leads.lead_in, leads.lead_out
    if parameters.arcs:
        near &= leads.has_links
        chords = [np.array([leads_out[k, -1], leads_in[k + 1, 0]]) for k in np.flatnonzero(near)]
        near[near] = _is_over(chords, drive, tool, parameters, progress.part(0.4, 0.8))
        links = iter(
            [
                np.vstack([leads.off(k), leads.onto(k + 1), passes[k + 1].tip[:1]])
                for k in np.flatnonzero(near).tolist()
            ]
        )
    else:
        links = iter(_links(passes, near, drive, tool, parameters, progress.part(0.4, 0.8)))
    approach, retract = _retreats(passes, near, leads_in, leads_out, parameters, progress)
    # Assemble: a near pass is linked on the surface, a far one by its leads and a travel through the air.
    blocks = _Blocks(tool, data, stock, setup, drive, parameters)
    for k, one in enumerate(passes):
        progress.at(0.9 + 0.1 * k / len(passes), "Linking passes")
        if k and near[k - 1]:
            blocks.feed(next(links), one.axis[0], Mark.LINK)
        else:
            if k:
                blocks.feed(leads.off(k - 1), passes[k - 1].axis[-1], Mark.LEAD)
            blocks.travel(leads_in[k][0], one.axis[0], retract[k - 1] if k else 0.0, approach[k])
            blocks.feed(np.vstack([leads.onto(k)[1:], one.tip[:1]]), one.axis[0], Mark.LEAD)
        blocks.feed(one.tip, one.axis, Mark.CUT)
    blocks.feed(leads.off(len(passes) - 1), passes[-1].axis[-1], Mark.LEAD)
    return blocks.finished(retract[-1])


def _retreats(
    passes: Sequence[Pass],
    near: Bools,
    leads_in: Floats,
    leads_out: Floats,
    parameters: LinkParameters,
    progress: Progress,
) -> tuple[list[float], list[float]]:
    """Return how far in mm a tool comes at feed along its axis to the lead of each pass, and goes off after it; 0 where links join them."""
    approach, retract = np.zeros(len(passes)), np.zeros(len(passes))
    if parameters.retreats is not None:
        progress.at(0.8, "Linking passes")
        begun, left = (np.flatnonzero(np.insert(~near, at, True)) for at in (0, len(passes) - 1))
        for found, rows, lead, end, of_pass in (
            (approach, begun, leads_in, 0, 0),
            (retract, left, leads_out, -1, -1),
        ):
            axes = np.array([passes[k].axis[of_pass] for k in rows.tolist()])
            found[rows] = parameters.retreats(lead[rows, end], axes)
    return approach.tolist(), retract.tolist()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Leads:
    """The leads onto passes, `lead_in` (m, QUARTER, 3), up to their first tips, and off them, `lead_out` (m, QUARTER, 3), after their last.

    Every `stride_in`-th (m,), or `stride_out`-th, position is needed: all where a lead is lifted over something. `has_links` (m - 1,):
    whether the path off a pass and onto the next one needs no lifting, as far as `BETWEEN` positions tell.
    """

    lead_in: Floats
    lead_out: Floats
    stride_in: Ints
    stride_out: Ints
    has_links: Bools

    def onto(self, k: int) -> Floats:
        """Return the positions (k, 3) of the lead onto a pass, without the pass's own."""
        return np.asarray(self.lead_in[k][:: self.stride_in[k]])

    def off(self, k: int) -> Floats:
        """Return the positions (k, 3) of the lead off a pass, without the pass's own."""
        stride = int(self.stride_out[k])
        return np.asarray(self.lead_out[k][stride - 1 :: stride])


class _Blocks:
    """A toolpath in the making, in arrays: most of it are whole passes."""

    def __init__(
        self,
        tool: Tool,
        data: CuttingData,
        stock: PlanningStock,
        setup: Setup,
        drive: SurfaceDrive,
        parameters: LinkParameters,
    ) -> None:
        # A builder without a block: it answers how low the tip may go over the stock before the operation.
        self._air = PathBuilder(tool, data, stock, setup, parameters.safety)
        self._has_retreats = parameters.retreats is not None
        self._thickness = max(STOCK_SHARE * data.depth, LEAST_STOCK)
        self._tool, self._data, self._drive = tool, data, drive
        held = [
            drive.low,
            drive.high,
            *(setup.frame.to_local(f.mesh.points) for f in setup.fixtures),
        ]
        corners = np.vstack(held)[:, :2]
        self._low, self._high = corners.min(axis=0), corners.max(axis=0)
        self._parts: list[tuple[Floats, Floats, Motion, float, Mark]] = []

    @property
    def here(self) -> Floats:
        """Where the tip is (3,)."""
        return self._parts[-1][0][-1]

    @property
    def axis(self) -> Floats:
        """How the tool stands (3,)."""
        return self._parts[-1][1][-1]

    @cached_property
    def _overhang_top(self) -> Callable[[Floats], float]:
        return overhang_tops(self._drive.skin, self._tool, self._thickness)

    def feed(self, tips: Floats, axis: Floats, mark: Mark) -> None:
        """Feed along tips (k, 3) with one axis (3,) or an axis each (k, 3)."""
        if len(tips):
            self._parts.append(
                (tips, np.broadcast_to(axis, tips.shape), Motion.LINE, self._data.feed, mark)
            )

    def travel(self, position: Floats, axis: Floats, retract: float, approach: float) -> None:
        """Bring the tip to a position (3,) through the air, at the end by a feed; it goes off and comes at feed for so many mm at least."""
        stops = self._outside(position, axis)
        if self._parts and _is_upright(self.axis) and _is_upright(axis):
            self._lift(position)
        else:
            if self._parts:
                self._leave(retract)
                if min(self.axis[2], axis[2]) < REORIENT:
                    self._rapid(self.here, UPRIGHT)
                    self._rapid(np.append(stops[-1][:2], self.here[2]), UPRIGHT)
            for stop in stops[::-1]:
                self._rapid(stop, axis)
            if self._has_retreats:
                self._rapid(_towards(position, axis, stops[0], approach), axis)
        if _is_upright(axis):
            self._down(position)
        else:
            self._add(position, axis, Motion.LINE, self._data.feed, Mark.LEAD)

    def finished(self, retract: float) -> Toolpath:
        """Return the path, its last block a retract to the clearance height; the tool goes off at feed for so many mm."""
        self._leave(retract)
        count = [len(p[0]) for p in self._parts]
        position, axis = (np.concatenate([p[k] for p in self._parts]) for k in (0, 1))
        motion, feed, mark = (np.repeat([p[k] for p in self._parts], count) for k in (2, 3, 4))
        kept = _goes(position, axis)
        return Toolpath(
            position=position[kept],
            axis=axis[kept],
            motion=motion[kept],
            feed=feed[kept],
            mark=mark[kept],
            centre=np.full((int(kept.sum()), 3), np.nan),
        )

    def _lift(self, position: Floats) -> None:
        """Go over a position, upright: no higher than what may be in between demands."""
        safe = lowest_tip(self._air, self.here[:2], position[:2]) + self._air.safety
        height = min(max(safe, float(self.here[2]), float(position[2])), self._air.clearance)
        self._rise(height)
        self._rapid(np.append(self.here[:2], height), UPRIGHT)
        self._rapid(np.append(position[:2], height), UPRIGHT)

    def _rise(self, height: float) -> None:
        """Feed up to a height at most as far as something hangs over beside the tool, or a wall stands beside it that it could not be led
        off: what was left there stands in its way."""
        top = self._overhang_top(self.here)
        if self._led_straight_up():
            top = max(top, self._air.stock().height(self.here, self.here, self._tool.radius))
        if top > self.here[2]:
            self.feed(np.append(self.here[:2], min(top, height))[None], UPRIGHT, Mark.LEAD)

    def _led_straight_up(self) -> bool:
        """Return whether the tool was just led straight up off a pass: beside something steep, where it had no space for an arc."""
        tips, axis, _, _, mark = self._parts[-1]
        return (
            mark is Mark.LEAD
            and bool(tips[-1, 2] - tips[0, 2] > tolerance.SHORT_MOVE)
            and bool(np.ptp(tips[:, :2], axis=0).max() < SAME)
            and _is_upright(axis[-1])
        )

    def _down(self, position: Floats) -> None:
        """Come down upright: at rapid as far as the stock allows, then at feed, slowly where there is material."""
        safe = (
            max(lowest_tip(self._air, position[:2], position[:2]), float(position[2]))
            + self._air.safety
        )
        self._rapid(np.append(position[:2], min(safe, float(self.here[2]))), UPRIGHT)
        if is_free(self._air, position[:2], float(position[2])):
            self._add(position, UPRIGHT, Motion.LINE, self._data.feed, Mark.LEAD)
        else:
            self._add(position, UPRIGHT, Motion.LINE, self._data.plunge_feed, Mark.ENTRY)

    def _leave(self, retract: float) -> None:
        axis, stops = self.axis, self._outside(self.here, self.axis)
        if self._has_retreats:
            self.feed(_towards(self.here, axis, stops[0], retract)[None], axis, Mark.LEAD)
        elif _is_upright(axis):
            self._rise(float(stops[0][2]))
        for stop in stops:
            self._rapid(stop, axis)

    def _outside(self, here: Floats, axis: Floats) -> list[Floats]:
        """Return the positions that a tool passes along its axis from the work up to clearance: past blank and fixtures and up
        from there where it leans so much that the path up is longer."""
        height = self._air.clearance + _below(self._tool, float(axis[2]))
        up = (height - here[2]) / axis[2] if axis[2] > 0.0 else math.inf
        aside = (
            max([self._tool.radius, *(max(r0, r1) for _, r0, _, r1 in self._tool.profile())])
            + self._air.safety
        )
        wall = np.where(axis[:2] > 0.0, self._high + aside, self._low - aside)
        to_wall = np.divide(
            wall - here[:2], axis[:2], out=np.full(2, math.inf), where=axis[:2] != 0.0
        ).min()
        if axis[2] >= REORIENT or up <= to_wall:
            return [here + up * axis]
        if to_wall == math.inf:
            raise Refused(
                f"{self._drive.feature}: a tool that points straight up can't be brought to the part"
            )
        stop = here + max(to_wall, 0.0) * axis
        return [stop, np.append(stop[:2], max(height, stop[2]))]

    def _rapid(self, position: Floats, axis: Floats) -> None:
        self._add(position, axis, Motion.RAPID, 0.0, Mark.RETRACT)

    def _add(self, position: Floats, axis: Floats, motion: Motion, feed: float, mark: Mark) -> None:
        self._parts.append((np.asarray(position)[None], np.asarray(axis)[None], motion, feed, mark))


def _towards(here: Floats, axis: Floats, stop: Floats, lift: float) -> Floats:
    """Return the position so many mm along an axis from here, on the way to a stop (3,) at most."""
    far = max(float((stop - here) @ axis), 0.0)
    return np.asarray(here + min(lift, far) * axis)


def _below(tool: Tool, upright: float) -> float:
    """Return how far anything on the spindle is below the tip when the axis has a part `upright` along z."""
    across = math.sqrt(max(1.0 - upright * upright, 0.0))
    rings = [
        (0.0, tool.radius),
        *((z, r) for z0, r0, z1, r1 in tool.profile() for z, r in ((z0, r0), (z1, r1))),
    ]
    return max(0.0, *(r * across - z * upright for z, r in rings))


def _is_upright(axis: Floats) -> bool:
    return bool(np.abs(axis - UPRIGHT).max() < SAME)


def _goes(position: Floats, axis: Floats) -> Bools:
    """Return which blocks (n,) go anywhere or turn the tool: posts write four decimals, so a shorter move would be an empty block."""
    kept = np.ones(len(position), dtype=bool)
    while True:
        rows = np.flatnonzero(kept)
        still = (np.linalg.norm(np.diff(position[rows], axis=0), axis=1) < tolerance.SHORT_MOVE) & (
            np.abs(np.diff(axis[rows], axis=0)).max(axis=1) < SAME
        )
        # Of several short moves in a row every other one goes; what is left may then be long enough.
        still[1:] &= ~still[:-1]
        if not still.any():
            return kept
        kept[rows[1:][still]] = False


def _ordered(passes: Sequence[Pass], parameters: LinkParameters, progress: Progress) -> list[Pass]:
    """Return the passes in the order they are cut, closed ones begun where they come nearest to the end of the one before."""
    if parameters.order == "nearest":
        passes = _nearest(passes, parameters.reversing, progress)
    out: list[Pass] = []
    for one in passes:
        if one.closed:
            one = _overlapped(
                _begun(one, out[-1].tip[-1] if out else one.tip[0]), parameters.overlap
            )
        out.append(one)
    return out


def _nearest(passes: Sequence[Pass], reversing: bool, progress: Progress) -> list[Pass]:
    """Return the passes so that each begins near where the one before ends, from the first on."""
    # Greedy nearest neighbour on the passes' ends, O(m^2).
    starts, ends = (np.array([p.tip[k] for p in passes]) for k in (0, -1))
    out, remaining = [passes[0]], np.ones(len(passes), dtype=bool)
    remaining[0] = False
    while remaining.any():
        progress.at(len(out) / len(passes), "Ordering passes")
        rows, here = np.flatnonzero(remaining), out[-1].tip[-1]
        ahead = np.linalg.norm(starts[rows] - here, axis=1)
        back = np.linalg.norm(ends[rows] - here, axis=1)
        turns = reversing and back.min() < ahead.min() - tolerance.COINCIDENT
        row = int(rows[np.argmin(back if turns else ahead)])
        out.append(passes[row].reversed() if turns else passes[row])
        remaining[row] = False
    return out


def _begun(one: Pass, position: Floats) -> Pass:
    """Return a closed pass that begins at its tip nearest to a position."""
    row = int(np.argmin(np.linalg.norm(one.tip[:-1] - position, axis=1)))
    order = np.append(np.roll(np.arange(len(one) - 1), -row), row)
    return Pass(tip=one.tip[order], axis=one.axis[order], normal=one.normal[order], closed=True)


def _overlapped(one: Pass, overlap: float) -> Pass:
    """Return a closed pass that goes on over its start by an overlap."""
    if overlap <= 0.0:
        return one
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(one.tip, axis=0), axis=1))])
    last = min(overlap, 0.5 * float(run[-1]))
    row = int(np.searchsorted(run, last, side="right")) - 1
    share = (last - run[row]) / (run[row + 1] - run[row])
    more = (
        np.vstack([a[1 : row + 1], (1.0 - share) * a[row : row + 1] + share * a[row + 1 : row + 2]])
        for a in (one.tip, one.axis, one.normal)
    )
    tip, axis, normal = (
        np.vstack([a, b]) for a, b in zip((one.tip, one.axis, one.normal), more, strict=True)
    )
    return Pass(tip=tip, axis=unit(axis), normal=normal)


def _near(passes: Sequence[Pass], parameters: LinkParameters) -> Bools:
    """Return for each pass but the last whether the next one is reached without lifting."""
    ends, starts = (
        np.array([p.tip[-1] for p in passes[:-1]]).reshape(-1, 3),
        np.array([p.tip[0] for p in passes[1:]]).reshape(-1, 3),
    )
    turned = np.array([np.abs(a.axis[-1] - b.axis[0]).max() for a, b in pairwise(passes)])
    near = np.linalg.norm(starts - ends, axis=1) <= NEAR * parameters.stepover
    near &= turned < SAME
    if parameters.query is not None and near.any():
        axes = np.array([p.axis[-1] for p in passes[:-1]])[near]
        near[near] = parameters.query(starts[near], axes, start_tip=ends[near], start_axis=axes)
    return np.asarray(near)


def _links(
    passes: Sequence[Pass],
    near: Bools,
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress,
) -> list[Floats]:
    """Return the paths over the surface (k, 3) from the ends of near passes to the next ones: straight, lifted where that would gouge.

    Between leaning passes they are straight: a stepover is short.
    """
    rows = np.flatnonzero(near).tolist()
    chords = [np.array([passes[k].tip[-1], passes[k + 1].tip[0]]) for k in rows]
    upright = [bool(_is_upright(passes[k].axis[-1])) for k in rows]
    if not any(upright):
        return chords
    lowest = float(drive.low[2]) - tool.flute_length
    # Twice the error goes in, once by following and once by thinning: together no more than a finishing move may enter what it touches.
    error = min(parameters.chord, 0.5 * tolerance.FINISH_GOUGE)
    over = iter(
        follow(
            drive.skin.drop,
            lower_side(tool, drive.allowance),
            [c[:, :2] for c, up in zip(chords, upright) if up],
            error,
            lowest,
            progress,
        )
    )
    return [
        _bridged(next(over), chord, drive.allowance, error) if up else chord
        for chord, up in zip(chords, upright)
    ]


def _bridged(points: Floats, chord: Floats, allowance: float, error: float) -> Floats:
    """Return a path over the surface (k, 3), the height of the chord (2, 3) between its ends where that is higher."""
    lifted = np.column_stack(
        [points[:, :2], np.maximum(points[:, 2] + allowance, _on_chord(points, chord))]
    )
    return lifted[thinned(lifted, np.zeros(len(lifted), np.int64), error)]


def _is_over(
    chords: Sequence[Floats],
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress,
) -> Bools:
    """Return whether an upright tool on each straight link (2, 3) stays over the surface, whole: between a few positions of a long one
    that rises there is space for the rim of what it goes over."""
    most = min(parameters.chord, tolerance.FINISH_GOUGE)
    lowest = float(drive.low[2]) - tool.flute_length
    lower, error = lower_side(tool, drive.allowance), 0.5 * most
    plan = [c[:, :2] for c in chords]
    over = follow(drive.skin.drop, lower, plan, error, lowest, progress)
    return np.array(
        [
            bool((p[:, 2] + drive.allowance - _on_chord(p, c)).max() <= most - error)
            for p, c in zip(over, chords, strict=True)
        ],
        dtype=bool,
    )


def _on_chord(points: Floats, chord: Floats) -> Floats:
    """Return the heights (k,) of a chord (2, 3) at points (k, 3) over it."""
    run = np.hypot(*(points[:, :2] - chord[0, :2]).T)
    share = run / run[-1] if run[-1] > 0.0 else np.linspace(0.0, 1.0, len(points))
    return np.asarray(chord[0, 2] + share * (chord[1, 2] - chord[0, 2]))


def _leads(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress,
) -> _Leads:
    """Return the leads onto all passes and off them: quarter circles, lifted where they would gouge."""
    starts, ends = _PassEnds.of(passes, at_end=False), _PassEnds.of(passes, at_end=True)
    radius_in, radius_out = (e.radii(parameters) for e in (starts, ends))
    lead_in, lead_out = starts.arcs(radius_in)[:, ::-1], ends.arcs(radius_out)
    upright = np.array([[_is_upright(p.axis[row]) for p in passes] for row in (0, -1)])
    # Drop the cutter at all points of leads and of the chords between them, and lift what would gouge: max(floor + allowance - z, 0).
    share = np.linspace(0.0, 1.0, BETWEEN)[:, None]
    between = lead_out[:-1, -1:] + share * (lead_in[1:, :1] - lead_out[:-1, -1:])
    links = (lead_in, lead_out, between)
    flat = np.concatenate([w.reshape(-1, 3) for w in links])
    lift = np.zeros(len(flat))
    if upright.any():
        # Leaning tools are never lifted, and a skin costs much to make ready for dropping.
        floor = drive.skin.drop.drop(
            flat[:, :2],
            lower_side(tool, drive.allowance),
            float(drive.low[2]) - tool.flute_length,
            progress,
        )
        lift = np.maximum(floor + drive.allowance - flat[:, 2], 0.0)
    lifts = [
        x.reshape(w.shape[:2])
        for x, w in zip(
            np.split(lift, np.cumsum([w[..., 0].size for w in links])[:-1]), links, strict=True
        )
    ]
    is_arc = list[Bools]()
    for arcs, up, is_upright, nearest, end in zip(
        (lead_in, lead_out), lifts, upright, (-1, 0), (starts, ends), strict=False
    ):
        arcs[:, :, 2] += np.where(is_upright[:, None], up, 0.0)
        is_arc.append(~is_upright | (up.max(axis=1) <= 0.0))
        # Lifted unevenly an arc runs along something steep, which its chords would enter: the tool then comes and goes along its axis.
        uneven = is_upright & (
            np.abs(np.diff(up, axis=1)).max(axis=1, initial=0.0) + up[:, nearest] > LIFT_STEP
        )
        rise = np.arange(1, QUARTER + 1) * (parameters.lead_radius / QUARTER)
        arcs[uneven] = (
            end.tip[uneven][:, None]
            + (rise if nearest == 0 else rise[::-1])[None, :, None] * UPRIGHT
        )
    # A link along both arcs holds where neither arc nor the chord between was lifted by more than the chord error, or than a finishing move
    # may enter what it touches: passes may leave their curves by more than that, to both sides of these.
    most = min(parameters.chord, tolerance.FINISH_GOUGE)
    has_links = (lifts[0][1:].max(axis=1, initial=0.0) <= most) & (
        lifts[1][:-1].max(axis=1, initial=0.0) <= most
    )
    return _Leads(
        lead_in=lead_in,
        lead_out=lead_out,
        stride_in=np.where(is_arc[0], _strides(radius_in), 1),
        stride_out=np.where(is_arc[1], _strides(radius_out), 1),
        has_links=np.asarray(
            has_links
            & (lifts[2].max(axis=1, initial=0.0) <= most)
            & upright[1, :-1]
            & upright[0, 1:]
        ),
    )


def _strides(radius: Floats) -> Ints:
    """Return of how many of its `QUARTER` chords each quarter circle of some radii (m,) in mm may make one: powers of two, half of all at
    most. A chord over an angle a is r (1 - cos(a / 2)) from its arc."""
    found = np.ones(len(radius), np.int64)
    for stride in (2**n for n in range(int(math.log2(QUARTER)) - 1)):
        error = radius * (1.0 - math.cos(0.5 * math.pi * stride / QUARTER))
        found[(found == stride) & (error <= LEAD_CHORD)] *= 2
    return found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _PassEnds:
    """One end of each of some passes: the tip (m, 3) there, `along` (m, 3) on from the pass, the face's normal and the axis (m, 3)."""

    tip: Floats
    along: Floats
    normal: Floats
    axis: Floats

    @staticmethod
    def of(passes: Sequence[Pass], *, at_end: bool) -> _PassEnds:
        """Return the last, or the first, ends of passes."""
        row, step = (-1, -1) if at_end else (0, 1)
        return _PassEnds(
            tip=np.array([p.tip[row] for p in passes]),
            along=np.array([_off(p.tip[::step], p.axis[row]) for p in passes]),
            normal=np.array([p.normal[row] for p in passes]),
            axis=np.array([p.axis[row] for p in passes]),
        )

    def arcs(self, radius: Floats) -> Floats:
        """Return the quarter circles (m, QUARTER, 3) of some radii (m,) that leave the passes; without the tips."""
        return _arcs(self.tip, self.along, self.normal, self.axis, radius[:, None, None])

    def radii(self, parameters: LinkParameters) -> Floats:
        """Return the radii (m,) in mm of the leads: where the tool would touch something on one it is shorter, or there is none."""
        radius, query = np.full(len(self.tip), parameters.lead_radius), parameters.query
        if query is None:
            return radius
        touching = np.arange(len(radius))
        for share in SHORTER:
            stride = int(_strides(radius[touching[:1]])[0])
            arcs = self.arcs(radius)[touching, stride - 1 :: stride]
            start = np.concatenate([self.tip[touching, None], arcs[:, :-1]], axis=1)
            axis = np.repeat(self.axis[touching], arcs.shape[1], axis=0)
            is_clear = query(
                arcs.reshape(-1, 3), axis, start_tip=start.reshape(-1, 3), start_axis=axis
            )
            touching = touching[~is_clear.reshape(arcs.shape[:2]).all(axis=1)]
            if not len(touching):
                break
            radius[touching] = share * parameters.lead_radius
        return radius


def _off(tip: Floats, axis: Floats) -> Floats:
    """Return the points (3,) on which a pass that begins with tips (k, 3) is left, or come to, there: straight on, or along the axis where
    the tool only turns about its tip, as a ball does in a hollow as round as it is."""
    away = tip[0] - tip
    moved = np.flatnonzero(np.linalg.norm(away, axis=1) > tolerance.COINCIDENT)
    return np.asarray(away[moved[0]] if len(moved) else axis)


def _arcs(tips: Floats, along: Floats, normals: Floats, axes: Floats, radius: Floats) -> Floats:
    """Return quarter circles (m, QUARTER, 3) of radii (m, 1, 1) that leave tips (m, 3) along directions and turn to the side of the
    normals; without the tips."""
    along = unit(along)
    side = normals - (normals * along).sum(axis=1, keepdims=True) * along
    flat = np.linalg.norm(side, axis=1) < SAME
    side[flat] = axes[flat] - (axes[flat] * along[flat]).sum(axis=1, keepdims=True) * along[flat]
    side = np.divide(
        side,
        np.linalg.norm(side, axis=1, keepdims=True),
        out=axes.copy(),
        where=np.linalg.norm(side, axis=1)[:, None] > SAME,
    )
    angle = 0.5 * math.pi * np.arange(1, QUARTER + 1)[:, None] / QUARTER
    out: Floats = tips[:, None] + radius * (
        np.sin(angle) * along[:, None] + (1.0 - np.cos(angle)) * side[:, None]
    )
    return out
