"""Links that stay down: over the surface, lifted where a straight way would gouge."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.linking.parameters import (
    NEAR,
    SAME,
    LinkParameters,
    is_upright,
)
from trunnion.toolpath.contact_passes.passes import Pass, spaced
from trunnion.toolpath.contact_passes.upright.tracing import follow, thinned

APART = 0.25
"""mm between positions of a link at which stock is asked for."""


def near_passes(passes: Sequence[Pass], parameters: LinkParameters) -> Bools:
    """Return for each pass but the last whether the next one is reached without lifting, and without turning the tool."""
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


def surface_links(
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
    upright = [bool(is_upright(passes[k].axis[-1])) for k in rows]
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


def is_over(
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


def free_of_stock(
    links: Sequence[Floats],
    axes: Sequence[Floats],
    cut: Sequence[int],
    parameters: LinkParameters,
) -> list[bool]:
    """Return along which links, tips (k, 3) each, a tool meets no stock above its flutes when so many passes are cut; it keeps the axis
    (3,) of each."""
    if parameters.pass_stock is None or not links:
        return [True] * len(links)
    tips = [spaced(link, APART)[0] for link in links]
    number = np.repeat(np.arange(len(tips)), [len(t) for t in tips])
    is_free = parameters.pass_stock.is_free(
        np.concatenate(tips), np.asarray(axes)[number], np.asarray(cut)[number]
    )
    return (np.bincount(number, ~is_free, len(tips)) == 0.0).tolist()


def _on_chord(points: Floats, chord: Floats) -> Floats:
    """Return the heights (k,) of a chord (2, 3) at points (k, 3) over it."""
    run = np.hypot(*(points[:, :2] - chord[0, :2]).T)
    share = run / run[-1] if run[-1] > 0.0 else np.linspace(0.0, 1.0, len(points))
    return np.asarray(chord[0, 2] + share * (chord[1, 2] - chord[0, 2]))
