"""Areas that one operation avoids: its tip stays out of their boxes, and what its cutter then can't come to is cut off its plane drive."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.keep_out import KeepOutBox
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.prismatic.fixtures import kept_out

EXCLUDED = "operation.left-out"
"""Code of the finding on what an operation leaves because it avoids some areas."""
CORNER_SHARE = 2.0**0.5 / 2.0
"""Of the cutter's radius: what is so far inside a box on both sides is a radius from its corners."""
SPINE = 0.05
"""mm: half the width of what is left of a narrow box."""


@dataclass(frozen=True, slots=True, eq=False)
class PlanBoxes:
    """Boxes that the tip stays out of, as what the cutter's envelope stays out of."""

    boxes: tuple[KeepOutBox, ...]
    name: str = "area"

    def keeps_out(self, tool: Tool, z: float, within: Region) -> Region:
        """Return what the envelope of a cutter that is within a region must stay out of for its tip, at a height, to be outside all boxes:
        what the cutter covers from no other tip. Where that lets it into one still, some of the box too."""
        boxes = [_area(b) for b in self.boxes if b.top > z + tolerance.COINCIDENT]
        inside = union_all(boxes) if boxes else EMPTY_REGION
        tips = within.offset(-tool.radius)
        if not tips.intersect(inside):
            return EMPTY_REGION
        # Minkowski opening and closing: from the tips outside, a cutter covers their offset; within that it has all tips of their closing.
        around = tips.minus(inside).offset(tool.radius)
        lost = tips.offset(tool.radius).minus(around)
        still = around.offset(-tool.radius - tolerance.SEW).intersect(inside)
        return union_all([lost, *_deep(inside, boxes, still, tool.radius)])

    def changes(self, tool: Tool) -> list[float]:
        """Return the boxes' tops: over them the tip goes everywhere."""
        return sorted({b.top for b in self.boxes})


def _area(box: KeepOutBox) -> Region:
    return Region.rectangle(*box.low, *box.high)


def _deep(inside: Region, boxes: Sequence[Region], still: Region, radius: float) -> list[Region]:
    """Return regions inside boxes, together `inside`, that keep a cutter's axis out of what is `still` open to it, corners included: as
    deep as they can be where the boxes are wide, the middle of narrow ones."""
    if not still:
        return []
    deep = inside.offset(-CORNER_SHARE * radius).intersect(still.offset(radius))
    rest = still.minus(deep.offset(radius))
    narrow = [b for b in boxes if rest.area > tolerance.SEW and b.intersect(rest)]
    return [deep, *(_middle(b, radius) for b in narrow)]


def _middle(box: Region, radius: float) -> Region:
    low, high = box.box()
    deep = np.clip(0.5 * (high - low) - SPINE, 0.0, CORNER_SHARE * radius)
    return Region.rectangle(*(low + deep), *(high - deep))


def off_boxes(
    drive: PlaneDrive, tool: Tool, setup: Setup, boxes: Sequence[KeepOutBox]
) -> tuple[PlaneDrive, tuple[Finding, ...]]:
    """Return a drive without what a cutter can't come to while its tip stays out of boxes of the setup's frame, and a finding that names
    it."""
    return kept_out(drive, tool, setup, [PlanBoxes(tuple(boxes))], excluded)


def excluded(
    what: str, size: str, by: Sequence[str], tool: Tool, at: Floats, where: Sequence[str]
) -> Finding:
    """Return the finding on what of something an operation leaves out, its size in words; `at` (3,) is there, in the part's coordinates."""
    x, y, z = (float(v) + 0.0 for v in at)
    return warning(
        EXCLUDED,
        f"{size} of {what} at x {x:.1f} y {y:.1f} z {z:.1f} are left out: {tool.name} would collide there",
        *where,
        remedy="finish what is left with another tool or from another side",
    )
