"""Where a tool can go in a gap between two blades: columns of tips along its own axis, from the hub up to the shroud.

A column stands over each place (u, v) of the hub. Its axis is the gap's ruling there, or the nearest free one. A tool that is nowhere
slimmer than below stays clear on its way out along its axis, so a column is free from one height on: its foot. Levels between hub and
shroud are surfaces through all columns at the same share of their height.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter, maximum_filter1d, uniform_filter1d

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.channel.gap import Gap
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.open_axes import OpenAxes, open_axes
from trunnion.toolpath.contact_passes.stock_clearance import grown

COARSE_U, COARSE_V = 15, 9
"""Places along and across a gap at which axes are looked for."""
ALONG, ACROSS = 0.8, 0.25
"""mm between columns along the stream and across it, about."""
LEAST_ACROSS = 25
LIFTS = (0.0, 0.15, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0, 4.5, 6.5, 9.0, 13.0, 18.0, 25.0, 35.0, 50.0)
"""mm along its axis at which a column is asked, the lowest free one is its foot."""
STEEPEST = math.radians(80.0)
"""Largest angle of an axis and the hub's normal."""
SPACE, PULL = math.radians(3.0), 0.6
"""Space to the sides that an axis had better keep, and what leaving the ruling costs in rad a rad: next to a wall a tool stays along it."""
OFF = 0.01
"""mm that columns begin over the allowance: a tool that touches is not clear."""
EVEN = 1.0
"""Places over which axes are eased (one sigma)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Columns:
    """Columns over places of a gap: u (nu,), v (nv,); point, normal (nu, nv, 3) of the hub there; root (nu, nv, 3) the tip at the hub's allowance, axis (nu, nv, 3); foot (nu, nv) mm
    above it where the column is free, infinite where it never is; height (nu, nv) mm from hub to shroud."""

    u: Floats
    v: Floats
    point: Floats
    normal: Floats
    root: Floats
    axis: Floats
    foot: Floats
    height: Floats

    def axes(self) -> OpenAxes:
        """Return the axes of all columns at the places of the hub that they stand over."""
        return OpenAxes(
            point=self.point.reshape(-1, 3),
            normal=self.normal.reshape(-1, 3),
            axis=self.axis.reshape(-1, 3),
            free=np.ones(self.axis[..., 0].size, dtype=bool),
        )

    def at(self, v: Floats, rise: Floats) -> tuple[Floats, Floats]:
        """Return tips and axes (nu, 3), one for each u, at places v (nu,) across and rises (nu,) mm above the root: between columns."""
        place = np.clip(np.interp(v, self.v, np.arange(len(self.v))), 0.0, len(self.v) - 1.0)
        low = np.minimum(place.astype(np.int64), len(self.v) - 2)
        share = (place - low)[:, None]
        row = np.arange(len(self.u))
        root = (1.0 - share) * self.root[row, low] + share * self.root[row, low + 1]
        axis = (1.0 - share) * self.axis[row, low] + share * self.axis[row, low + 1]
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        return root + rise[:, None] * axis, axis

    def heights(self, v: Floats) -> Floats:
        """Return the height (nu,) mm of the gap at places v (nu,)."""
        return np.array([np.interp(x, self.v, row) for x, row in zip(v, self.height, strict=True)])

    def open(self, share: float) -> tuple[Floats, Floats, Bools]:
        """Return the range of v (nu,), (nu,) that is free at a share of the height above the hub, even along u, and where there is any."""
        rise = share * self.height
        free = self.foot <= rise + 1e-9
        middle = len(self.v) // 2
        first, last, some = [], [], []
        for row, foot in zip(free, self.foot, strict=True):
            low, high = _widest(row, middle)
            some.append(high >= low)
            best = int(np.argmin(foot)) if high < low else 0
            first.append(self.v[low if high >= low else best])
            last.append(self.v[high if high >= low else best])
        # On the side of the gap's middle: the farthest in of the neighbours, then their mean.
        low = uniform_filter1d(maximum_filter1d(np.array(first), 3), 3, mode="nearest")
        high = -uniform_filter1d(maximum_filter1d(-np.array(last), 3), 3, mode="nearest")
        middle_v = 0.5 * (low + high)
        crossed = low > high
        return (
            np.where(crossed, middle_v, low),
            np.where(crossed, middle_v, high),
            np.array(some),
        )


def columns_of(
    gap: Gap,
    tool: Tool,
    allowance: float,
    query_for: Callable[[Tool], ClearanceQuery],
    ends: tuple[float, float],
    outside: Callable[[Floats, Floats], Bools],
    progress: Progress = NO_PROGRESS,
) -> Columns:
    """Return the columns of a tool in a gap, `allowance` mm off hub and walls.

    `ends`: how far in mm they go on before the leading edge and behind the outlet. `outside` says at which tips and axes (k, 3) what is
    above the flutes stays out of the blank.
    """
    hub = gap.meridian.hub
    before, behind = ends[0] / hub.run, ends[1] / hub.run
    nu = max(COARSE_U, math.ceil(hub.run * (1.0 + before + behind) / ALONG))
    u = np.linspace(-before, 1.0 + behind, nu)
    wide = _width(gap, np.linspace(0.0, 1.0, 9))
    nv = max(LEAST_ACROSS, math.ceil(wide / ACROSS))
    v = np.linspace(0.0, 1.0, nv)
    thick = grown(tool, allowance)
    asked = query_for(thick)

    def clear(tip: Floats, axis: Floats) -> Bools:
        found = np.asarray(outside(tip, axis))
        rows = np.flatnonzero(found)
        found[rows] = asked(tip[rows] - allowance * axis[rows], axis[rows])
        return found

    axis = _axes(gap, u, v, tool, clear, allowance + OFF, progress.part(0.0, 0.5))
    uu, vv = (a.ravel() for a in np.meshgrid(u, v, indexing="ij"))
    point, normal = gap.hub(uu, vv)
    flat = axis.reshape(-1, 3)
    root = tip_at(tool, point + (allowance + OFF) * normal, normal, flat)
    foot = np.full(len(root), np.inf)
    for n, lift in enumerate(LIFTS):
        progress.at(0.5 + 0.5 * n / len(LIFTS), "Looking how deep the tool goes between blades")
        rows = np.flatnonzero(~np.isfinite(foot))
        tips = root[rows] + lift * flat[rows]
        foot[rows[clear(tips, flat[rows])]] = lift
    inner = np.clip(uu, 0.0, 1.0)
    height = np.linalg.norm(
        gap.at(inner, vv, np.ones_like(uu)) - gap.at(inner, vv, np.zeros_like(uu)), axis=1
    )
    shape = (nu, nv)
    return Columns(
        u=u,
        v=v,
        point=point.reshape(*shape, 3),
        normal=normal.reshape(*shape, 3),
        root=root.reshape(*shape, 3),
        axis=axis,
        foot=foot.reshape(shape),
        height=height.reshape(shape),
    )


def _axes(
    gap: Gap,
    u: Floats,
    v: Floats,
    tool: Tool,
    clear: ClearanceQuery | Callable[[Floats, Floats], Bools],
    allowance: float,
    progress: Progress,
) -> Floats:
    """Return the axes (nu, nv, 3) over a gap: chosen at a few places, eased, and even between them."""
    few_u = np.linspace(u[0], u[-1], COARSE_U)
    few_v = np.linspace(0.0, 1.0, COARSE_V)
    uu, vv = (a.ravel() for a in np.meshgrid(few_u, few_v, indexing="ij"))
    point, normal = gap.hub(uu, vv)
    wanted = _leant_in(gap, uu, vv, tool)
    found = open_axes(
        point,
        normal,
        wanted,
        tool,
        clear,  # type: ignore[arg-type]
        STEEPEST,
        allowance=allowance,
        enough=SPACE,
        pull=PULL,
        progress=progress,
    )
    axis = np.where(found.free[:, None], found.axis, np.nan).reshape(COARSE_U, COARSE_V, 3)
    axis = _filled(axis, wanted.reshape(axis.shape))
    axis = np.stack(
        [gaussian_filter(axis[:, :, k], EVEN, mode="nearest") for k in range(3)], axis=-1
    )
    fine = np.stack(
        [
            np.stack([np.interp(u, few_u, axis[:, c, k]) for c in range(COARSE_V)], axis=-1)
            for k in range(3)
        ],
        axis=-1,
    )
    fine = np.stack(
        [np.stack([np.interp(v, few_v, fine[r, :, k]) for r in range(len(u))]) for k in range(3)],
        axis=-1,
    )
    return np.asarray(fine / np.linalg.norm(fine, axis=-1, keepdims=True))


def _leant_in(gap: Gap, u: Floats, v: Floats, tool: Tool) -> Floats:
    """Return the rulings at places, leant off the nearer wall by as much as the tool's flank leans: its flank then lies along the wall."""
    ruling = gap.rulings(u, v)
    point = gap.at(u, v, np.full_like(u, 0.5))
    across = np.column_stack([-point[:, 1], point[:, 0], np.zeros(len(point))])
    across -= (across * ruling).sum(axis=1, keepdims=True) * ruling
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    lean = math.radians(tool.taper_angle) * (1.0 - 2.0 * v)
    return np.asarray(np.cos(lean)[:, None] * ruling + np.sin(lean)[:, None] * across)


def _filled(axis: Floats, wanted: Floats) -> Floats:
    """Return axes (nu, nv, 3) without gaps: where none is free the one of the nearest place across, turned as the rulings turn."""
    out = axis.copy()
    for r in range(len(axis)):
        known = np.flatnonzero(np.isfinite(axis[r, :, 0]))
        for c in np.flatnonzero(~np.isfinite(axis[r, :, 0])).tolist():
            if not len(known):
                out[r, c] = wanted[r, c]
                continue
            near = int(known[np.argmin(np.abs(known - c))])
            moved = axis[r, near] + wanted[r, c] - wanted[r, near]
            out[r, c] = moved / np.linalg.norm(moved)
    return out


def _width(gap: Gap, u: Floats) -> float:
    """Return how wide the gap is at the shroud from camber to camber, mm at most."""
    one, zero = np.ones_like(u), np.zeros_like(u)
    radius = gap.meridian.at(u, one)[:, 0]
    return float((radius * (gap.angle(u, one, one) - gap.angle(u, zero, one))).max())


def _widest(row: Bools, middle: int) -> tuple[int, int]:
    """Return the first and last place of the longest free run of a row, of equal ones the nearest to the middle; (0, -1) for none."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], row, [False]]).astype(np.int8)))
    runs = edges.reshape(-1, 2)
    if not len(runs):
        return 0, -1
    best = min(runs.tolist(), key=lambda r: (r[0] - r[1], abs(0.5 * (r[0] + r[1]) - middle)))
    return best[0], best[1] - 1
