"""Tabs that a plan leaves, held against what stands: how thick each is where it is thinnest, its volume, and which samples lie on it.

The plan says where tabs are to be; whether they are, and whether more is, is measured: on the stock that all programs leave, and on the
samples of the faces. A sample counts as left by intention only where it lies on the outline's wall, no higher and no farther from the tab's
middle than cutters have to leave material there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, remark, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.tabs import PlannedTab
from trunnion.units import trimmed
from trunnion.verify.finish.coverage import Samples
from trunnion.verify.stock import Stock

SPACING = 0.5
"""mm between the points in plan that are looked at on a tab."""
LAYERS = 5
"""Heights that are looked at over a tab, each in the middle of an equal part of its thickness."""
WHOLE = 0.9
"""Share of a tab's cross-section that has to stand everywhere: columns at its edges are half in it."""
OVER = 0.2
"""Of a tab's height: so far over its top nothing is to stand."""
OUTWARD = math.cos(math.radians(30.0))
"""Least cosine between the normal of a wall that a tab stands on and the tab's direction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TabProof:
    """What stands of a tab: the least `section` and the most that stands `over` it, as shares of its cross-section, and `volume` mm3 up to
    its top, with what round cutters leave at its ends."""

    tab: PlannedTab
    section: float
    over: float
    volume: float


def on_tabs(
    samples: Samples, frame: Frame, tabs: Sequence[PlannedTab], setups: Mapping[str, Frame]
) -> Bools:
    """Return for samples in a frame whether they lie on the wall where one of the tabs stands."""
    found = np.zeros(len(samples), bool)
    points, normals = frame.to_world(samples.point), frame.world_direction(samples.normal)
    for left in tabs:
        own, tab = setups[left.setup], left.tab
        p, n = own.to_local(points), own.local_direction(normals)
        local = tab.local(p)
        out = np.array([math.cos(tab.direction), math.sin(tab.direction)])
        z = np.maximum(p[:, 2], tab.bottom)
        half = 0.5 * tab.width + left.radius + (tab.top - z) / math.tan(tab.ramp)
        found |= (
            (np.abs(local[:, 0]) <= half + tolerance.SEW)
            & (np.abs(local[:, 1]) <= tolerance.GOUGE)
            & (p[:, 2] >= tab.bottom - tolerance.SEW)
            & (p[:, 2] <= tab.top + tolerance.SEW)
            & (n[:, :2] @ out >= OUTWARD)
        )
    return found


def measured(
    tabs: Sequence[PlannedTab], setups: Mapping[str, Frame], stock: Stock
) -> tuple[TabProof, ...]:
    """Return what stands of each tab in the stock that all programs leave."""
    return tuple(_measured(left, setups[left.setup], stock) for left in tabs)


def _measured(left: PlannedTab, frame: Frame, stock: Stock) -> TabProof:
    tab = left.tab
    inner = max(0.5 * tab.width - stock.pitch, 0.0)
    heights = tab.bottom + (np.arange(LAYERS) + 0.5) * tab.height / LAYERS
    within = _material(left, frame, stock, inner, np.append(heights, tab.top + OVER * tab.height))
    section = within[:, :, :LAYERS].mean(axis=(0, 2))
    half = tab.half_length(left.radius, tab.bottom)
    around = _material(left, frame, stock, half, heights)
    return TabProof(
        tab=left,
        section=float(section.min()),
        over=float(within[:, :, LAYERS].mean(axis=0).max()),
        volume=float(around.mean()) * 2.0 * half * tab.reach * tab.height,
    )


def _material(left: PlannedTab, frame: Frame, stock: Stock, half: float, heights: Floats) -> Bools:
    """Return whether material stands at points (along the outline, outwards, up) of a box that reaches `half` to both sides of a tab."""
    tab = left.tab
    across = np.linspace(-half, half, max(math.ceil(2.0 * half / SPACING), 1) + 1)
    outwards = np.linspace(
        stock.pitch,
        max(tab.reach - stock.pitch, stock.pitch),
        max(math.ceil(tab.reach / SPACING), 1) + 1,
    )
    u, v, z = np.meshgrid(across, outwards, heights, indexing="ij")
    plan = tab.world(np.stack([u.ravel(), v.ravel()], axis=1))
    points = frame.to_world(np.column_stack([plan, z.ravel()]))
    return stock.contains(stock.frame.to_local(points)).reshape(u.shape)


def tab_findings(proofs: Sequence[TabProof], faces: Ints) -> list[Finding]:
    """Return what is told of tabs: how many stand, where, with how much material; those that don't stand as planned by a warning each.

    `faces` are the tags of the faces that they stand on.
    """
    if not proofs:
        return []
    whole = [s for s in proofs if s.section >= WHOLE and s.over <= 1.0 - WHOLE]
    found = []
    if whole:
        locations = "; ".join(_location(s) for s in whole)
        volume = sum(s.volume for s in whole)
        thick = trimmed(max(s.tab.tab.height for s in whole), 2)
        found.append(
            remark(
                "verify.tabs",
                f"{len(whole)} tabs up to {thick} mm thick hold the part in the blank's frame, {volume:.0f} mm3 in all: {locations}",
                *face_tags(faces.tolist()),
                remedy="cut them off by hand and dress the wall there; it does not count as unfinished",
            )
        )
    for s in proofs:
        if s.section < WHOLE:
            found.append(
                warning(
                    "verify.tab-cut",
                    f"the tab at {_location(s)} does not stand whole: where it is thinnest {100 * s.section:.0f} % of it are there",
                    *face_tags(faces.tolist()),
                    remedy="see which operation cuts there below its top, or plan the route again",
                )
            )
        if s.over > 1.0 - WHOLE:
            found.append(
                warning(
                    "verify.tab-thick",
                    f"more than the tab stands at {_location(s)}: on {100 * s.over:.0f} % of its width material is higher than its top",
                    *face_tags(faces.tolist()),
                    remedy="see that roughing and finishing of the outline both cut over it",
                )
            )
    return found


def _location(proof: TabProof) -> str:
    x, y = proof.tab.tab.middle
    return f"{proof.tab.setup} x {trimmed(x, 1)} y {trimmed(y, 1)} ({proof.volume:.0f} mm3)"
