"""Flow lines over joined patches between two guide curves, and one continuous spiral where these are rims of a tube or ring.

A blend goes from 0 on the first guide to 1 on the second (`geometry/sheet/fields.py`); its level lines are the passes, as many as keep
every two neighbours within a stepover. They are lines of contacts: where the tool leans on them is for others to say.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadInput, Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.contours import SheetLine, pieces_over, whole_levels
from trunnion.geometry.sheet.fields import Metric, blend, turns_about
from trunnion.geometry.sheet.refine_sheet import split_finely
from trunnion.geometry.sheet.sheet import Sheet, sheet_of
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.guides import (
    Guides,
    adjacent_guides,
    guides_of,
    holes_of,
    tags_named,
)
from trunnion.toolpath.contact_passes.stepover.metric import metric_of, spread, stepover_measure

FINENESS = 1.0
"""Stepovers: the longest edge of the triangles that a blend is laid over, if not so many are needed that it takes seconds."""
ENOUGH = 6000
"""Squares, as wide as the longest edge, that an area is cut in at most: a blend is smooth, a finer one is no better."""
SMALLEST = 0.002
"""Share of the area whose steps may be wider than the passes' own: a blend stands still in a sharp corner between guide and rim."""
MOST_DENSE = 8.0
"""Passes in the room of one, on the average over an area and one more, from which on flow lines are no way to cut it: guides run
into each other, or it is a scrap whose guides have little to do with its shape."""


class DenseFlowLines(Refused):
    """Flow lines would lie far closer nearly everywhere than they need to; passes at a constant scallop don't."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowParameters:
    """How flow lines run: the faces beyond the rims where they begin and end (`guides.tags_named`; empty: chosen), whether a tube or ring
    is one spiral, and the chord error (mm) that contacts are set by."""

    first_guide: str = ""
    second_guide: str = ""
    spiral: bool = True
    chord: float = 0.0005


def flow_lines(
    drive: SurfaceDrive,
    tool: Tool,
    flow: FlowParameters = FlowParameters(),
    progress: Progress = NO_PROGRESS,
) -> tuple[Contacts, ...]:
    """Return the passes of contacts over the drive's faces from the first guide to the second, in the cutting frame.

    All of them run the same way, the part that is still to be cut on their right: a tool that turns clockwise climbs. Each connected part
    of the area has its own passes, one after the other. Raises `BadInput` for guides that can't be, `Refused` for a cutter that can't,
    `DenseFlowLines` for an area that flow lines don't suit.
    """
    measure = stepover_measure(tool, drive.height)
    parts = sheet_of(drive.skin, drive.faces).components() if drive.faces else []
    if not parts:
        raise BadInput(f"{drive.feature}: no face to lay passes over")
    made: list[Contacts] = []
    for k, part in enumerate(parts):
        share = progress.part(k / len(parts), (k + 1) / len(parts))
        share.at(0.0, "Laying flow lines")
        coarse = metric_of(part, measure)
        wide = float(coarse.area().sum())
        # Guides that a person named may be rims of holes.
        whole = part if flow.first_guide else part.filled(holes_of(coarse))
        longest = max(FINENESS, math.sqrt(wide / ENOUGH))
        sheet = split_finely(whole, measure, longest, share, evenly=True)
        guides = _guides(sheet, drive, flow)
        for line in _lines(metric_of(sheet, measure), guides, flow.spiral, share):
            point, normal = spread(
                *sheet.on_edges(line.ends, line.share),
                line.closed,
                tool.radius,
                flow.chord,
                stepover_on_plane(tool.corner_radius, drive.height),
            )
            made.append(Contacts(point=point, normal=normal, closed=line.closed))
    return tuple(made)


def _guides(sheet: Sheet, drive: SurfaceDrive, flow: FlowParameters) -> Guides:
    first, second = tags_named(flow.first_guide), tags_named(flow.second_guide)
    if bool(first) != bool(second):
        raise BadInput("flow lines need both guides, or none of them to have them chosen")
    return adjacent_guides(sheet, drive.skin, first, second) if first else guides_of(sheet)


def _lines(metric: Metric, guides: Guides, spiral: bool, progress: Progress) -> list[SheetLine]:
    """Return the passes from the first guide to the second, what is not cut yet on their right."""
    field = blend(metric, guides.first, guides.second, progress)
    real = metric.sheet.face > 0
    slope, area = metric.slope(field)[real], metric.sheet.area()[real]
    order = np.argsort(slope)
    narrowest = slope[order[np.searchsorted(np.cumsum(area[order]), SMALLEST * area.sum())]]
    if MOST_DENSE * narrowest * (1.0 + float(area.sum() / (slope @ area))) < 1.0:
        raise DenseFlowLines(
            "flow lines between these guides would lie far closer than the scallop wants; passes at a constant scallop don't, "
            "nor may those between other guides"
        )
    count = max(math.ceil(1.0 / narrowest), 1)
    lines = [_turned(line) for line in whole_levels(metric.sheet, field * count + 0.5)]
    if spiral and guides.rings and count > 1:
        return _wound(metric, guides, field, count, lines)
    return pieces_over(lines, metric.sheet, real)


def _wound(
    metric: Metric, guides: Guides, field: Floats, count: int, lines: list[SheetLine]
) -> list[SheetLine]:
    """Return the first and the last of closed passes, and the spiral that winds from one to the other."""
    angle, turns = turns_about(metric, guides.first, guides.second)
    for sign in (1, -1):
        # The field rises by one from guide to guide's next turn and changes by one on the way round: a line of it is a spiral.
        turning = [
            _turned(line)
            for line in whole_levels(metric.sheet, field * count + sign * angle, sign * turns)
        ]
        spiral = max(turning, key=lambda line: len(line.share))
        field_value = spiral.value(field)
        if field_value[-1] > field_value[0]:
            break
    first, last = lines[0], lines[-1]
    between = np.flatnonzero((field_value > 0.5 / count) & (field_value < 1.0 - 0.5 / count))
    if field_value[0] >= field_value[-1] or not len(between) or not first.closed or not last.closed:
        return lines
    middle = spiral.of(slice(int(between[0]), int(between[-1]) + 1))
    start, end = (
        metric.sheet.on_edges(middle.ends[k:][:1], middle.share[k:][:1])[0] for k in (0, -1)
    )
    return [_joined([_begun(metric.sheet, first, start), middle, _begun(metric.sheet, last, end)])]


def _begun(sheet: Sheet, ring: SheetLine, position: Floats) -> SheetLine:
    """Return a closed line that begins and ends where it comes nearest to a position (1, 3)."""
    points, _ = sheet.on_edges(ring.ends[:-1], ring.share[:-1])
    order = np.roll(
        np.arange(len(points)), -int(np.argmin(np.linalg.norm(points - position, axis=1)))
    )
    order = np.append(order, order[0])
    return SheetLine(ends=ring.ends[order], share=ring.share[order], closed=True, level=ring.level)


def _joined(lines: list[SheetLine]) -> SheetLine:
    return SheetLine(
        ends=np.concatenate([line.ends for line in lines]),
        share=np.concatenate([line.share for line in lines]),
        closed=False,
        level=lines[0].level,
    )


def _turned(line: SheetLine) -> SheetLine:
    return SheetLine(
        ends=line.ends[::-1], share=line.share[::-1], closed=line.closed, level=line.level
    )
