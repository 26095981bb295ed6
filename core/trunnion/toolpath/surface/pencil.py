"""Finishing valleys: passes along the lines where the cutter touches two faces at once, and beside them where a larger one left material.

Over a grid of drops the position that is touched moves little from point to point, but jumps where the cutter rolls from one side of a
valley to the other. The lines through these jumps are the valleys (pencil lines); where an earlier cutter was larger it stood higher in
them, and passes are laid beside the lines as far as it did.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion.findings import Finding, Refused, info
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.sheet import edges_of
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stepover.spacing import slopes_of
from trunnion.toolpath.contact_passes.upright.tip_grid import grid_around, spread
from trunnion.toolpath.contact_passes.upright.tracing import follow
from trunnion.toolpath.contact_passes.upright.upright_path import linked_without_contact
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock

CELL, FINEST, COARSEST = 0.1, 0.05, 0.5
"""Of the cutter's radius, and mm at least and at most: side of the grid's cells."""
MARGIN = 3
"""Cells round the area's tips that are looked at."""
HALVINGS = 14
"""Times the distance between two positions on both sides of a valley is halved."""
JUMP = 2.0
"""Cells that touched positions on both sides of a valley are apart at least, beyond what a turn of the face explains."""
MOST_SIDES = 200
"""Passes beside a valley at most."""
SHORTEST = 0.5
"""Of the cutter's radius: a shorter line is no valley but a dent of the mesh."""


@settings("surface.pencil")
class PencilSettings:
    """How valleys are finished."""

    angle: float = setting(
        20.0,
        unit="deg",
        low=2.0,
        high=170.0,
        label="Valley angle",
        help="The least angle between the faces on both sides, as the cutter touches them.",
    )
    sides: int = setting(
        0,
        low=0,
        high=MOST_SIDES,
        label="Passes beside",
        help="Passes on each side of a valley; 0: as far as the earlier "
        "cutter left material, if there was one.",
    )
    stepover: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Stepover",
        help="Distance of the passes beside a valley; 0: by the wanted scallop height.",
    )
    chord: float = setting(
        0.0005,
        unit="mm",
        low=0.00005,
        high=0.1,
        label="Chord error",
        help="How far straight moves may leave the cutter's way over the faces.",
    )
    lead_radius: float = setting(
        1.0,
        unit="mm",
        low=0.05,
        high=50.0,
        label="Lead radius",
        help="Of the quarter circles onto and off passes.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there.",
    )


@strategy(
    settings=PencilSettings,
    drive=SurfaceDrive,
    finds_rest=True,
    meets=surface_leftovers,
    own_faces=True,
)
def pencil(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: PencilSettings,
    progress: Progress,
) -> Planned:
    """Return the motions along the valleys of the drive's faces."""
    if drive.height <= 0.0 and settings.stepover <= 0.0:
        raise Refused(
            f"{drive.feature}: passes beside valleys need a scallop height or a stepover above zero"
        )
    if tool.corner_radius <= 0.0:
        raise Refused(
            f"{tool.name}: a flat end can't follow valleys of curved faces; choose a ball, bull, taper or barrel end"
        )
    slopes = slopes_of(drive, tool)
    if not len(slopes.row):
        return Planned(findings=(_nothing(drive, tool),))
    cell = float(np.clip(CELL * tool.radius, FINEST, COARSEST))
    ground = _Ground(
        drive=drive,
        pieces=lower_side(tool, drive.allowance),
        lowest=float(drive.low[2]) - tool.flute_length,
    )
    valleys = _valleys(
        spread(slopes.tips, cell),
        cell,
        ground,
        math.radians(settings.angle),
        progress.part(0.0, 0.5),
    )
    valleys = [line for line in valleys if _length(line) >= SHORTEST * tool.radius]
    if not valleys:
        return Planned(findings=(_nothing(drive, tool),))
    stepover = settings.stepover or stepover_on_plane(tool.corner_radius, drive.height)
    lines = [
        line
        for valley in valleys
        for line in _parallel_passes(
            valley, stepover, _sides(valley, stepover, ground, tool, settings)
        )
    ]
    passes = _passes(lines, ground, settings.chord, progress.part(0.5, 0.8))
    parameters = LinkParameters(
        stepover=stepover,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        order="nearest",
        reversing=True,
        chord=settings.chord,
    )
    path, blocked = linked_without_contact(
        passes, stepover, drive, tool, data, stock, setup, parameters, progress.part(0.8, 1.0)
    )
    return Planned(path=path, findings=blocked)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Ground:
    """What a cutter, its lower side given by pieces, touches of a drive's part."""

    drive: SurfaceDrive
    pieces: Floats
    lowest: float

    def contacts(self, plan: Floats, progress: Progress) -> tuple[Floats, Bools, Floats]:
        """Return over plan points (n, 2) how high the tip is, whether it touches the area, and where it touches (n, 3)."""
        z, facet, contact = self.drive.skin.drop.contacts(plan, self.pieces, self.lowest, progress)
        return (
            z,
            np.asarray((facet >= 0) & self.drive.skin.of(self.drive.faces)[np.maximum(facet, 0)]),
            contact,
        )


def _nothing(drive: SurfaceDrive, tool: Tool) -> Finding:
    return info(
        "surface.no-valley",
        f"{drive.feature} has no valley in which {tool.name} touches two faces",
        drive.feature,
        remedy="suppress the operation",
    )


def _valleys(
    tips: Floats, cell: float, ground: _Ground, angle: float, progress: Progress
) -> list[Floats]:
    """Return the valleys (k, 2) near tips (n, 3), in plan: what the cutter touches jumps across them."""
    # Jumps of the contact along edges of a grid of drops mark a valley.
    grid = grid_around(tips, cell, MARGIN)
    z, on_area, contact = ground.contacts(grid.points[:, :2], progress.part(0.0, 0.5))
    ends, side = edges_of(grid.triangles, len(grid.points))
    a, b = ends.T
    apart = np.linalg.norm(contact[a] - contact[b], axis=1)
    # Seen from the cutter the touched positions of a valley are turned from each other; a face that bends moves them by less.
    reach = np.column_stack([grid.points[:, :2], z + ground.pieces[-1, 4]])
    turned = _angle(reach[a] - contact[a], reach[b] - contact[b]) >= angle
    jumps = turned & (apart > JUMP * cell) & (on_area[a] | on_area[b]) & np.isfinite(apart)
    rows = np.flatnonzero(jumps)
    # Bisect each jumping edge to where the contact changes sides.
    near, far = grid.points[a[rows], :2].copy(), grid.points[b[rows], :2].copy()
    for k in range(HALVINGS):
        middle = 0.5 * (near + far)
        _, _, found = ground.contacts(
            middle, progress.part(0.5 + 0.5 * k / HALVINGS, 0.5 + 0.5 * (k + 1) / HALVINGS)
        )
        stays = np.linalg.norm(found - contact[a[rows]], axis=1) <= np.linalg.norm(
            found - contact[b[rows]], axis=1
        )
        near, far = np.where(stays[:, None], middle, near), np.where(stays[:, None], far, middle)
    position = np.full((len(ends), 2), np.nan)
    position[rows] = 0.5 * (near + far)
    # Join jumps across triangles with two of them: every triangle passes a line on, or ends it.
    both = jumps[side].sum(axis=1) == 2
    pairs = np.sort(np.where(jumps[side[both]], side[both], -1), axis=1)[:, 1:]
    return [position[line] for line in _chained(pairs)]


def _angle(a: Floats, b: Floats) -> Floats:
    """Return the angles (k,) rad between directions (k, 3)."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))


def _chained(pairs: Ints) -> list[Ints]:
    """Return the lines of nodes that pairs (p, 2) of neighbours make, none of which has more than two."""
    neighbours: dict[int, list[int]] = {}
    for a, b in pairs.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    lines, used = [], set()
    # Open lines first, from their lower end; what is left then is closed.
    for first in sorted(neighbours, key=lambda node: (len(neighbours[node]), node)):
        if first in used:
            continue
        line, here = [first], first
        used.add(first)
        while True:
            ahead = [n for n in neighbours[here] if n not in used]
            if not ahead:
                break
            here = min(ahead)
            used.add(here)
            line.append(here)
        if len(line) > 2 and first in neighbours[here]:
            line.append(first)
        if len(line) > 1:
            lines.append(np.array(line))
    return lines


def _sides(
    valley: Floats, stepover: float, ground: _Ground, tool: Tool, settings: PencilSettings
) -> int:
    """Return how many passes lie on each side of a valley: as set, or as far as the earlier cutter stood off its ground."""
    earlier = ground.drive.earlier
    if settings.sides or earlier is None:
        return settings.sides
    larger = _Ground(
        drive=ground.drive, pieces=lower_side(earlier, ground.drive.allowance), lowest=ground.lowest
    )
    direction = np.gradient(valley, axis=0)
    left = (
        np.column_stack([-direction[:, 1], direction[:, 0]])
        / np.maximum(np.hypot(direction[:, 0], direction[:, 1]), np.finfo(float).tiny)[:, None]
    )
    far = 0.0
    for aside in (-0.05 * tool.radius, 0.05 * tool.radius):
        positions = valley + aside * left
        (_, _, theirs), (_, _, ours) = (
            g.contacts(positions, NO_PROGRESS) for g in (larger, ground)
        )
        beyond = np.abs(((theirs - ours)[:, :2] * left).sum(axis=1))
        far = max(far, float(np.nanmax(beyond, initial=0.0)))
    return min(math.ceil(far / stepover) + 1, MOST_SIDES)


def _parallel_passes(valley: Floats, stepover: float, sides: int) -> list[Floats]:
    """Return a valley and the lines (k, 2) beside it, from one side to the other."""
    line = shapely.LineString(valley)
    found = []
    for k in range(-sides, sides + 1):
        made = shapely.offset_curve(line, k * stepover) if k else line
        found += [
            shapely.get_coordinates(part) for part in shapely.get_parts(made) if part.length > 0.0
        ]
    return found


def _passes(lines: list[Floats], ground: _Ground, chord: float, progress: Progress) -> list[Pass]:
    """Return the passes along lines (k, 2) where the cutter touches the area."""
    tips = follow(
        ground.drive.skin.drop, ground.pieces, lines, chord, ground.lowest, progress.part(0.0, 0.8)
    )
    plan = np.concatenate([tip[:, :2] for tip in tips])
    _, on_area, contact = ground.contacts(plan, progress.part(0.8, 1.0))
    passes, first = [], 0
    for tip in tips:
        rows = np.arange(first, first + len(tip))
        first += len(tip)
        middle = tip + float(ground.pieces[-1, 4]) * UPRIGHT
        normal = middle - contact[rows]
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
        edges = np.flatnonzero(np.diff(on_area[rows].astype(np.int8), prepend=0, append=0)).reshape(
            -1, 2
        )
        for a, b in edges.tolist():
            if b - a > 1 and np.isfinite(normal[a:b]).all():
                passes.append(
                    Pass(
                        tip=tip[a:b] + ground.drive.allowance * UPRIGHT,
                        axis=np.broadcast_to(UPRIGHT, (b - a, 3)),
                        normal=normal[a:b],
                    )
                )
    return passes


def _length(line: Floats) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())
