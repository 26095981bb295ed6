"""Flow lines over joined patches between two guide curves, and one continuous spiral where these are rims of a tube or ring.

A blend goes from 0 on the first guide to 1 on the second (`geometry/fields.py`); its level lines are the passes, as many as keep every
two neighbours within a stepover. Contacts come first; where the tool leans is decided by others (`streamlines` serves them), an upright
one is put on the contacts and lifted where another face is in its way.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.contours import SheetLine, whole_levels
from trunnion.geometry.fields import Metric, blend, turns_about
from trunnion.geometry.sheet import Sheet, sheet_of, split_finely
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.surface.drive import SurfaceDrive
from trunnion.plan.surface.scallop import stepover_on_plane
from trunnion.progress import QUIET, Progress
from trunnion.settings import choose, setting, settings
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.stock import PlanningStock
from trunnion.toolpath.surface import choices
from trunnion.toolpath.surface.contacts import Contacts
from trunnion.toolpath.surface.guides import Guides, guides_beside, guides_of, holes_of, tags_named
from trunnion.toolpath.surface.linking import Manner, linked
from trunnion.toolpath.surface.stepovers import metric_of, spread, stepover_measure
from trunnion.toolpath.surface.upright import stood

FINENESS = 1.0
"""Stepovers: the longest edge of the triangles that a blend is laid over, if not so many are needed that it takes seconds."""
ENOUGH = 6000
"""Squares, as wide as the longest edge, that an area is cut in at most: a blend is smooth, a finer one is no better."""
SMALLEST = 0.002
"""Share of the area whose steps may be wider than the passes' own: a blend stands still in a sharp corner between guide and rim."""


@settings("surface.streamline")
class StreamlineSettings:
    """How flow lines run and how finely they are cut."""

    first_guide: str = setting("", label="First guide", help="Faces beyond the rim where the passes begin, as in: face 12, face 13. "
                               "Without: a whole rim of a tube, or one of the two longest opposite sides.")
    second_guide: str = setting("", label="Second guide", help="Faces beyond the rim where the passes end.")
    spiral: bool = setting(True, label="Spiral", help="Cut a tube or ring in one continuous spiral instead of closed passes.")
    pattern: str = setting("zigzag", label="Pattern", help="Passes to and fro, or all of them in the climbing direction.",
                           choices=("zigzag", "climb"))
    steepest: float = choices.steepest()
    chord: float = choices.chord()
    lead_radius: float = choices.lead_radius()
    safety: float = choices.safety()


@strategy(settings=StreamlineSettings)
def streamline(drive: SurfaceDrive, tool: Tool, data: CuttingData, stock: PlanningStock, setup: Setup, settings: StreamlineSettings,
               progress: Progress = QUIET) -> Planned:
    """Return the motions of an upright tool along flow lines over the drive's faces, and what it leaves."""
    ways = streamlines(drive, tool, settings, progress.part(0.0, 0.4))
    to_and_fro = settings.pattern == "zigzag"
    done = stood(ways, drive, tool, settings.chord, math.radians(settings.steepest), progress.part(0.4, 0.8))
    stepover = stepover_on_plane(tool.corner_radius, drive.height)
    manner = Manner(stepover=stepover, safety=settings.safety, lead_radius=settings.lead_radius,
                    order="nearest" if to_and_fro else "given", reversing=to_and_fro)
    path = linked(done.passes, drive, tool, data, stock, setup, manner, progress.part(0.8, 1.0))
    return Planned(path=path, findings=done.left(drive, tool, stepover))


def streamlines(drive: SurfaceDrive, tool: Tool, settings: StreamlineSettings | None = None,
                progress: Progress = QUIET) -> tuple[Contacts, ...]:
    """Return the passes of contacts over the drive's faces from the first guide to the second, in the cutting frame.

    All of them run the same way, the part that is still to be cut on their right: a tool that turns clockwise climbs. Each connected part
    of the area has its own passes, one after the other. Raises `BadInput` for guides that can't be, `Refused` for a cutter that can't.
    """
    chosen = settings or choose(StreamlineSettings, {})
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
        whole = part if chosen.first_guide else part.filled(holes_of(coarse))
        sheet = split_finely(whole, measure, max(FINENESS, math.sqrt(wide / ENOUGH)), share)
        guides = _guides(sheet, drive, chosen)
        for line in _lines(metric_of(sheet, measure), guides, chosen.spiral, share):
            point, normal = spread(*sheet.on_edges(line.ends, line.share), line.closed, tool.radius, chosen.chord,
                                   stepover_on_plane(tool.corner_radius, drive.height))
            made.append(Contacts(point=point, normal=normal, closed=line.closed))
    return tuple(made)


def _guides(sheet: Sheet, drive: SurfaceDrive, chosen: StreamlineSettings) -> Guides:
    first, second = tags_named(chosen.first_guide), tags_named(chosen.second_guide)
    if bool(first) != bool(second):
        raise BadInput("flow lines need both guides, or none of them to have them chosen")
    return guides_beside(sheet, drive.skin, first, second) if first else guides_of(sheet)


def _lines(metric: Metric, guides: Guides, spiral: bool, progress: Progress) -> list[SheetLine]:
    """Return the passes from the first guide to the second, what is not cut yet on their right."""
    field = blend(metric, guides.first, guides.second, progress)
    real = metric.sheet.face > 0
    slope, area = metric.slope(field)[real], metric.sheet.area()[real]
    order = np.argsort(slope)
    narrowest = slope[order[np.searchsorted(np.cumsum(area[order]), SMALLEST * area.sum())]]
    count = max(math.ceil(1.0 / narrowest), 1)
    lines = [_turned(line) for line in whole_levels(metric.sheet, field * count + 0.5)]
    if spiral and guides.rings and count > 1:
        return _wound(metric, guides, field, count, lines)
    return [piece for line in lines for piece in line.on(metric.sheet, real)]


def _wound(metric: Metric, guides: Guides, field: Floats, count: int, lines: list[SheetLine]) -> list[SheetLine]:
    """Return the first and the last of closed passes, and the spiral that winds from one to the other."""
    angle, turns = turns_about(metric, guides.first, guides.second)
    for sign in (1, -1):
        # The field rises by one from guide to guide's next turn and changes by one on the way round: a line of it is a spiral.
        turning = [_turned(line) for line in whole_levels(metric.sheet, field * count + sign * angle, sign * turns)]
        spiral = max(turning, key=lambda line: len(line.share))
        way = spiral.value(field)
        if way[-1] > way[0]:
            break
    first, last = lines[0], lines[-1]
    between = np.flatnonzero((way > 0.5 / count) & (way < 1.0 - 0.5 / count))
    if way[0] >= way[-1] or not len(between) or not first.closed or not last.closed:
        return lines
    middle = spiral.of(slice(int(between[0]), int(between[-1]) + 1))
    start, end = (metric.sheet.on_edges(middle.ends[k:][:1], middle.share[k:][:1])[0] for k in (0, -1))
    return [_joined([_begun(metric.sheet, first, start), middle, _begun(metric.sheet, last, end)])]


def _begun(sheet: Sheet, ring: SheetLine, place: Floats) -> SheetLine:
    """Return a closed line that begins and ends where it comes nearest to a place (1, 3)."""
    points, _ = sheet.on_edges(ring.ends[:-1], ring.share[:-1])
    order = np.roll(np.arange(len(points)), -int(np.argmin(np.linalg.norm(points - place, axis=1))))
    order = np.append(order, order[0])
    return SheetLine(ends=ring.ends[order], share=ring.share[order], closed=True, level=ring.level)


def _joined(lines: list[SheetLine]) -> SheetLine:
    return SheetLine(ends=np.concatenate([line.ends for line in lines]), share=np.concatenate([line.share for line in lines]), closed=False,
                     level=lines[0].level)


def _turned(line: SheetLine) -> SheetLine:
    return SheetLine(ends=line.ends[::-1], share=line.share[::-1], closed=line.closed, level=line.level)
