"""The fix `exclude`: an operation leaves out where its tool collides whatever is done; what that leaves is for others, or is told."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from trunnion import registry
from trunnion.findings import Fix
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.keep_out import KeepOutBox
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import ToolAxis
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.setups.frames import cutting_frame
from trunnion.registry import STRATEGIES
from trunnion.settings import choose

MARGIN, MARGIN_AGAIN = 1.0, 3.0
"""mm that a box goes past the tips that collided, since other passes run between them; and where it has met a box before."""
HEIGHT_MARGIN, HEIGHT_MARGIN_AGAIN = 0.5, 10.0
"""mm that it goes over them and over how deep they went in; and where it has met a box before."""
LEVELLED = 2.0
"""mm: boxes whose tops differ by less are as high as the higher one."""
DECIMALS = 3
"""Decimals in mm of a box."""
WHY = "It keeps out of where its tool collides, because no other tool or approach helped: the proof asked for it."


def with_exclusion(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with an operation that avoids the boxes of a fix, with a margin; None where the fix has none, the tool leans, or
    it avoids them already."""
    operation = process.operation(fix.operation)
    if not fix.boxes or operation.suppressed or not _is_upright(operation, job):
        return None
    frame = process.setup(operation.setup).frame
    cutting = cutting_frame(frame, operation.direction)
    boxes = (_around(_seen(b, frame, cutting), fix.amount, operation.avoid) for b in fix.boxes)
    new = [b for b in boxes if not any(known.holds(b) for known in operation.avoid)]
    if not new:
        return None
    known = [k for k in operation.avoid if not any(b.holds(k) for b in new)]
    rules = operation.rules if WHY in operation.rules else (*operation.rules, WHY)
    avoid = tuple(sorted(_levelled({*known, *new})))
    return process.with_operation(replace(operation, avoid=avoid, rules=rules))


def _levelled(boxes: Collection[KeepOutBox]) -> set[KeepOutBox]:
    """Return boxes as high as the highest that is hardly higher: each height parts what is cut."""
    tops: list[float] = []
    for top in sorted({b.top for b in boxes}, reverse=True):
        if not tops or top < tops[-1] - LEVELLED:
            tops.append(top)
    return {replace(b, top=min(t for t in tops if t >= b.top)) for b in boxes}


def _is_upright(operation: Operation, job: RepairJob) -> bool:
    strategy = registry.get(STRATEGIES, operation.strategy)
    settings = choose(strategy.settings, {**job.choices, **operation.choices})
    return bool(strategy.tool_axis(settings) is ToolAxis.FIXED)


def _seen(box: tuple[float, ...], frame: Frame, cutting: Frame) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner (3,), as a cutting frame has them, of what is around a setup frame's box (6,)."""
    corners = np.array(list(itertools.product(*zip(box[:3], box[3:], strict=True))))
    if cutting is not frame:
        corners = cutting.to_local(frame.to_world(corners))
    return corners.min(axis=0), corners.max(axis=0)


def _around(
    corners: tuple[Floats, Floats], depth: float, known: Sequence[KeepOutBox]
) -> KeepOutBox:
    """Return the box to keep out of around where the tip was while the tool went in by a depth: larger where a known box was too small."""
    small = _with_margin(*corners, MARGIN, HEIGHT_MARGIN + depth)
    if not any(small.meets(k) for k in known):
        return small
    return _with_margin(*corners, MARGIN_AGAIN, HEIGHT_MARGIN_AGAIN + depth)


def _with_margin(low: Floats, high: Floats, margin: float, height_margin: float) -> KeepOutBox:
    x0, y0, x1, y1, top = (
        round(float(v), DECIMALS)
        for v in (*(low[:2] - margin), *(high[:2] + margin), high[2] + height_margin)
    )
    return KeepOutBox(low=(x0, y0), high=(x1, y1), top=top)
