"""Leads: quarter circles in the plane of feed and normal, so that no mark shows where a pass is entered and left."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, unit
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc, lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.linking.parameters import SAME, LinkParameters, is_upright
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Leads:
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


def leads_of(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress,
) -> Leads:
    """Return the leads onto all passes and off them: quarter circles, lifted where they would gouge."""
    starts, finishes = (_PassEnds.of(passes, at_end=at_end) for at_end in (False, True))
    # Asked for together: stock is cut anew, pass by pass, each time it is asked for.
    radius_in, radius_out = np.split(starts.with_others(finishes).radii(parameters), 2)
    lead_in, lead_out = starts.arcs(radius_in)[:, ::-1], finishes.arcs(radius_out)
    upright = np.array([[is_upright(p.axis[row]) for p in passes] for row in (0, -1)])
    # Drop the cutter at all points of leads and of the chords between them, and lift what would gouge: max(floor + allowance - z, 0).
    share = np.linspace(0.0, 1.0, BETWEEN)[:, None]
    between = lead_out[:-1, -1:] + share * (lead_in[1:, :1] - lead_out[:-1, -1:])
    links = (lead_in, lead_out, between)
    flat = np.concatenate([w.reshape(-1, 3) for w in links])
    lift, met = np.zeros(len(flat)), np.zeros(len(flat), dtype=bool)
    if upright.any():
        # Leaning tools are never lifted, and a skin costs much to make ready for dropping.
        floor = drive.skin.drop.drop(
            flat[:, :2],
            lower_side(tool, drive.allowance),
            float(drive.low[2]) - tool.flute_length,
            progress,
        )
        lift = np.maximum(floor + drive.allowance - flat[:, 2], 0.0)
        met = _shank_meets(flat, drive, tool, progress)
    ends = np.cumsum([w[..., 0].size for w in links])[:-1]
    lifts, meets = (
        [x.reshape(w.shape[:2]) for x, w in zip(np.split(of, ends), links, strict=True)]
        for of in (lift, met)
    )
    is_arc = list[Bools]()
    for arcs, up, shank, is_up, nearest, end in zip(
        (lead_in, lead_out), lifts, meets, upright, (-1, 0), (starts, finishes), strict=False
    ):
        arcs[:, :, 2] += np.where(is_up[:, None], up, 0.0)
        is_arc.append(~is_up | (up.max(axis=1) <= 0.0))
        # Lifted unevenly an arc runs along something steep, which its chords would enter, or the shank on it would: the tool then comes and
        # goes along its axis.
        is_steep = np.abs(np.diff(up, axis=1)).max(axis=1, initial=0.0) + up[:, nearest] > LIFT_STEP
        uneven = is_up & (is_steep | shank.any(axis=1))
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
    return Leads(
        lead_in=lead_in,
        lead_out=lead_out,
        stride_in=np.where(is_arc[0], _strides(radius_in), 1),
        stride_out=np.where(is_arc[1], _strides(radius_out), 1),
        has_links=np.asarray(
            has_links
            & (lifts[2].max(axis=1, initial=0.0) <= most)
            & ~(meets[0][1:].any(axis=1) | meets[1][:-1].any(axis=1) | meets[2].any(axis=1))
            & upright[1, :-1]
            & upright[0, 1:]
        ),
    )


def _shank_meets(tips: Floats, drive: SurfaceDrive, tool: Tool, progress: Progress) -> Bools:
    """Return at which tips (k, 3) of an upright tool what is wider than its cutter stands on the part, or comes as near beside it as passes
    don't."""
    met, highest = np.zeros(len(tips), dtype=bool), float(drive.skin.points[:, 2].max())
    for height, radius in tool.rings()[1:]:
        low = np.flatnonzero(tips[:, 2] + height < highest)
        if len(low):
            disc = level_disc(radius + tolerance.HOLDER_CLEARANCE)
            bottom = tips[low, 2] + height
            met[low] |= drive.skin.drop.drop(tips[low, :2], disc, bottom, progress) > bottom
    return met


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
    """One end of each of some passes: the tip (m, 3) there, `along` (m, 3) on from the pass, the face's normal and the axis (m, 3), and how
    many passes are `cut` (m,) when the tool is there."""

    tip: Floats
    along: Floats
    normal: Floats
    axis: Floats
    cut: Ints

    @staticmethod
    def of(passes: Sequence[Pass], *, at_end: bool) -> _PassEnds:
        """Return the last, or the first, ends of passes."""
        row, step = (-1, -1) if at_end else (0, 1)
        return _PassEnds(
            tip=np.array([p.tip[row] for p in passes]),
            along=np.array([_off(p.tip[::step], p.axis[row]) for p in passes]),
            normal=np.array([p.normal[row] for p in passes]),
            axis=np.array([p.axis[row] for p in passes]),
            cut=np.arange(len(passes)) + int(at_end),
        )

    def with_others(self, others: _PassEnds) -> _PassEnds:
        """Return these ends and others behind them."""
        return _PassEnds(
            **{
                f.name: np.concatenate([getattr(self, f.name), getattr(others, f.name)])
                for f in fields(self)
            }
        )

    def arcs(self, radius: Floats) -> Floats:
        """Return the quarter circles (m, QUARTER, 3) of some radii (m,) that leave the passes; without the tips."""
        return _arcs(self.tip, self.along, self.normal, self.axis, radius[:, None, None])

    def radii(self, parameters: LinkParameters) -> Floats:
        """Return the radii (m,) in mm of the leads: where the tool would touch something on one it is shorter, or there is none."""
        radius = np.full(len(self.tip), parameters.lead_radius)
        if parameters.query is None and parameters.pass_stock is None:
            return radius
        touching = np.arange(len(radius))
        for share in SHORTER:
            stride = int(_strides(radius[touching[:1]])[0])
            arcs = self.arcs(radius)[touching, stride - 1 :: stride]
            start = np.concatenate([self.tip[touching, None], arcs[:, :-1]], axis=1)
            axis = np.repeat(self.axis[touching], arcs.shape[1], axis=0)
            cut = np.repeat(self.cut[touching], arcs.shape[1])
            moves = start.reshape(-1, 3), arcs.reshape(-1, 3)
            is_clear = _free_moves(*moves, axis, cut, parameters)
            touching = touching[~is_clear.reshape(arcs.shape[:2]).all(axis=1)]
            if not len(touching):
                break
            radius[touching] = share * parameters.lead_radius
        return radius


def _free_moves(
    start: Floats, end: Floats, axis: Floats, cut: Ints, parameters: LinkParameters
) -> Bools:
    """Return which straight moves (k,) with axes (k, 3) meet nothing when so many passes (k,) are cut."""
    clear = np.ones(len(end), dtype=bool)
    if parameters.query is not None:
        clear &= parameters.query(end, axis, start_tip=start, start_axis=axis)
    if parameters.pass_stock is not None:
        rows = np.flatnonzero(clear)
        clear[rows] = parameters.pass_stock.is_free(end[rows], axis[rows], cut[rows])
    return clear


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
