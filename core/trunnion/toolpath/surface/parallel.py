"""Finishing by passes in parallel upright planes, as far apart as the wanted scallop height allows where the faces lean most across them.

Planes are laid over all positions where the cutter's tip is while it touches the area, and each is followed over the whole part's skin.
What touches a face of the area is cut, and a little more on either side, so that no mark stays where areas meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.findings import Finding, Refused, face_tags, warning
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.sheet.skin import Skin
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.axis_search import leaned_by
from trunnion.toolpath.contact_passes.choices import TOO_SHALLOW, TOO_STEEP
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.overrun import OverrunStrip
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stepover.spacing import (
    FacetSlopes,
    marched,
    slopes_of,
    strips_over,
    tip_spacing,
)
from trunnion.toolpath.contact_passes.upright.tracing import follow
from trunnion.toolpath.contact_passes.upright.upright_path import linked_without_contact
from trunnion.toolpath.contract import Planned, lead_and_tilt, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock

ALONG = 0.1
"""Of the cutter's radius: distance of the positions along a plane that are queried for what the cutter touches."""
HALVINGS = 7
"""Times the distance between a position that touches the area and one that doesn't is halved."""
SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""
HasContact = Callable[[Ints, Floats, Progress], Bools]
"""Returns for planes (n,) and positions (n,) along them whether the cutter touches the area there."""


@settings("surface.parallel")
class ParallelSettings:
    """How an area is finished by parallel passes."""

    direction: str = setting(
        "auto",
        choices=("auto", "angle"),
        label="Direction",
        help="auto: along the side of the area that makes the shortest way; angle: as said by the angle.",
    )
    angle: float = setting(
        0.0,
        unit="deg",
        low=-180.0,
        high=180.0,
        label="Angle",
        help="From the setup's x axis to the feed direction.",
    )
    way: str = setting(
        "both",
        choices=("both", "one"),
        label="Way",
        help="both: to and fro; one: every pass in the same direction.",
    )
    stepover: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Stepover",
        help="Distance of the planes; 0: by the wanted scallop height and how the faces lean.",
    )
    steepest: float = setting(
        80.0,
        unit="deg",
        low=5.0,
        high=89.5,
        label="Steepest",
        help="Faces that lean by more from level are left to waterlines.",
    )
    overlap: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Overlap",
        help="How far passes go on past the rim of the area.",
    )
    chord: float = setting(
        0.0005,
        unit="mm",
        low=0.00005,
        high=0.1,
        label="Chord error",
        help="How far straight moves may leave the cutter's way over the faces.",
    )
    lead: float = setting(
        0.0,
        unit="deg",
        low=-60.0,
        high=60.0,
        label="Lead angle",
        help="Lean of a ball from the normal towards the feed "
        "on a machine with rotary axes; with a tilt of 0 as well the tool stays upright.",
    )
    tilt: float = setting(
        0.0,
        unit="deg",
        low=-60.0,
        high=60.0,
        label="Tilt angle",
        help="Lean of a ball to the left of the feed.",
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
    settings=ParallelSettings,
    drive=SurfaceDrive,
    tool_axis=lead_and_tilt,
    leaves=(TOO_STEEP,),
    settles=(TOO_SHALLOW,),
    meets=surface_leftovers,
    own_faces=True,
)
def parallel(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ParallelSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that finish the drive's faces by parallel passes, and the area that is too steep for them."""
    if drive.height <= 0.0 and settings.stepover <= 0.0:
        raise Refused(
            f"{drive.feature}: parallel passes need a scallop height or a stepover above zero"
        )
    slopes = slopes_of(drive, tool)
    slopes = slopes.some(slopes.normal[:, 2] >= math.cos(math.radians(settings.steepest)))
    found = _too_steep(drive, slopes)
    if not len(slopes.row):
        return Planned(findings=found)
    planes = _planes(slopes, tool, drive.height, settings)
    passes = _passes(planes, drive, tool, settings, progress.part(0.0, 0.6))
    if not passes:
        return Planned(findings=(*found, _untouched(drive, tool)))
    passes, lost = leaned_by(
        passes,
        drive,
        tool,
        math.radians(settings.lead),
        math.radians(settings.tilt),
        settings.chord,
        progress.part(0.6, 0.7),
    )
    parameters = LinkParameters(
        stepover=planes.widest,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        order="nearest",
        reversing=settings.way == "both",
        chord=settings.chord,
    )
    path, blocked = linked_without_contact(
        passes,
        planes.widest,
        drive,
        tool,
        data,
        stock,
        setup,
        parameters,
        progress.part(0.7, 1.0),
    )
    return Planned(path=path, findings=(*found, *lost, *blocked))


def _untouched(drive: SurfaceDrive, tool: Tool) -> Finding:
    """Return the finding that a cutter is too large to touch the area anywhere."""
    return warning(
        "surface.out-of-reach",
        f"{tool.name} touches nothing of the faces of {drive.feature}",
        drive.feature,
        *face_tags(drive.faces),
        remedy="finish them with a smaller or longer cutter",
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Planes:
    """Upright planes along unit directions `along` and across `across` (2,): at distances (p,) along `across`, each from where to where
    (p, 2) along `along` the tips of the area lie; `widest`: the largest distance of two; `beyond`: how far past the rim of the area passes
    are made, mm; `triangles` (m,): the area's rows of the skin."""

    along: Floats
    across: Floats
    at: Floats
    reach: Floats
    widest: float
    beyond: float
    triangles: Ints


def _planes(slopes: FacetSlopes, tool: Tool, height: float, settings: ParallelSettings) -> _Planes:
    """Return the planes of the direction that is requested, or of the better one of both sides of the box around the area."""
    if settings.direction == "angle":
        return _laid(slopes, tool, height, math.radians(settings.angle), settings.stepover)
    box = shapely.get_coordinates(
        shapely.oriented_envelope(shapely.MultiPoint(slopes.tips.reshape(-1, 3)[:, :2]))
    )
    sides = np.diff(box[:3], axis=0)
    longest = sides[np.argmax(np.hypot(*sides.T))]
    angle = math.atan2(longest[1], longest[0]) % math.pi
    both = [
        _laid(slopes, tool, height, a, settings.stepover)
        for a in (angle, (angle + 0.5 * math.pi) % math.pi)
    ]
    return min(
        both,
        key=lambda planes: (
            float(np.diff(planes.reach, axis=1).sum()) + tool.diameter * len(planes.at)
        ),
    )


def _laid(slopes: FacetSlopes, tool: Tool, height: float, angle: float, stepover: float) -> _Planes:
    """Return the planes at an angle (radians), from one side of the area to the other, as far apart as any position near both allows."""
    along, across = (
        np.array([math.cos(angle), math.sin(angle)]),
        np.array([-math.sin(angle), math.cos(angle)]),
    )
    run, sideways = slopes.tips[:, :, :2] @ along, slopes.tips[:, :, :2] @ across
    low, high = sideways.min(axis=1), sideways.max(axis=1)
    spacing = (
        np.full(len(low), stepover)
        if stepover > 0.0
        else tip_spacing(slopes, tool, height, np.append(across, 0.0))
    )
    at = marched(low, high, spacing, float(low.min()), float(high.max()))
    # From where to where along a plane the tips of the triangles are that it passes.
    beyond = stepover if stepover > 0.0 else stepover_on_plane(tool.corner_radius, height)
    width = max(
        float(np.diff(at).min(initial=np.inf)), (at[-1] - at[0]) / len(at), tolerance.SHORT_MOVE
    )
    strip, row = strips_over(
        np.maximum(low - beyond, at[0]), np.minimum(high + beyond, at[-1]), at[0], width
    )
    least, most = (
        np.full(int((at[-1] - at[0]) / width) + 1, np.inf),
        np.full(int((at[-1] - at[0]) / width) + 1, -np.inf),
    )
    np.minimum.at(least, strip, run.min(axis=1)[row])
    np.maximum.at(most, strip, run.max(axis=1)[row])
    rows = ((at - at[0]) / width).astype(np.int64)
    kept = least[rows] <= most[rows]
    return _Planes(
        along=along,
        across=across,
        at=at[kept],
        reach=np.column_stack([least[rows], most[rows]])[kept],
        widest=float(np.diff(at).max(initial=width)),
        beyond=beyond,
        triangles=slopes.row,
    )


def _passes(
    planes: _Planes, drive: SurfaceDrive, tool: Tool, settings: ParallelSettings, progress: Progress
) -> list[Pass]:
    """Return the passes where the cutter touches the area, plane by plane; none where it touches it nowhere."""
    # What a drop at a position in a plane touches: the area itself, or the strip past its rim.
    pieces, lowest = lower_side(tool, drive.allowance), float(drive.low[2]) - tool.flute_length
    on_area = np.zeros(len(drive.skin.triangles), dtype=bool)
    on_area[planes.triangles] = True
    area = DropSurface.of(drive.skin.points, drive.skin.triangles[on_area])
    strip = OverrunStrip.of(drive.skin, drive.faces, planes.beyond)

    def contacts_of(plan: Floats, share: Progress) -> tuple[Bools, Bools, Ints]:
        z, facet, contact = drive.skin.drop.contacts(plan, pieces, lowest, share)
        found = (facet >= 0) & on_area[np.maximum(facet, 0)]
        # On the rim either of two faces may be named.
        other = np.flatnonzero((facet >= 0) & ~found)
        found[other] = (
            area.drop(plan[other], pieces, lowest, share) >= z[other] - tolerance.COINCIDENT
        )
        return found, np.asarray(~found & strip.has(contact, facet)), facet

    def contacted(plane: Ints, run: Floats, share: Progress) -> tuple[Bools, Bools]:
        plan = run[:, None] * planes.along + planes.at[plane, None] * planes.across
        found, others, _ = contacts_of(plan, share)
        # Past the area the cutter rolls over its rim.
        within = (run >= planes.reach[plane, 0]) & (run <= planes.reach[plane, 1])
        return np.asarray(found & within), others

    def has_contact(plane: Ints, run: Floats, share: Progress) -> Bools:
        area, others = contacted(plane, run, share)
        return area | others

    # While the contact goes over the strip, the tip of a cutter that rolls over something tight goes its radius farther at most.
    plane, runs = _runs(
        planes,
        ALONG * tool.radius,
        planes.beyond + tool.radius,
        has_contact,
        progress.part(0.0, 0.4),
    )
    # A run that ends past a smooth join has gone on over it.
    others = contacted(np.repeat(plane, 2), runs.ravel(), progress.part(0.4, 0.4))[1].reshape(-1, 2)
    overlap = np.where(others, max(settings.overlap - planes.beyond, 0.0), settings.overlap)
    plane, runs = _joined(plane, runs, overlap, tool.radius)
    if not len(runs):
        return []
    # Follow the runs over the whole skin, so that nothing beside the area is gouged (`tracing.follow`).
    lines = [
        planes.at[p] * planes.across + np.outer(r, planes.along)
        for p, r in zip(plane, runs, strict=True)
    ]
    tips = follow(drive.skin.drop, pieces, lines, settings.chord, lowest, progress.part(0.4, 0.9))
    count = np.cumsum([len(t) for t in tips])[:-1]
    plan = np.concatenate([np.zeros((0, 2)), *(t[:, :2] for t in tips)])
    found, others, facet = contacts_of(plan, progress.part(0.9, 1.0))
    normals = np.split(_facing(drive.skin, facet), count)
    lift = drive.allowance * UPRIGHT
    return [
        Pass(
            tip=_level_past(tip, kept, planes.along) + lift,
            axis=np.broadcast_to(UPRIGHT, tip.shape),
            normal=normal,
        )
        for tip, kept, normal in zip(tips, np.split(found | others, count), normals, strict=True)
    ]


def _level_past(tip: Floats, kept: Bools, along: Floats) -> Floats:
    """Return tips (n, 3) of a pass with those that touch neither the area nor the strip past it no lower than the straight way between
    those that do (n,), and level past the last: over a rim that hangs free the cutter would fall to whatever lies below."""
    if kept.all() or not kept.any():
        return tip
    run = tip[:, :2] @ along
    straight = np.interp(run, run[kept], tip[kept, 2])
    height = np.where(kept, tip[:, 2], np.maximum(tip[:, 2], straight))
    return np.column_stack([tip[:, :2], height])


def _facing(skin: Skin, facet: Ints) -> Floats:
    """Return the unit normals (n, 3) of the triangles that are touched; upwards where none is."""
    a, b, c = np.moveaxis(skin.points[skin.triangles[np.maximum(facet, 0)]], 1, 0)
    normal = np.where(facet[:, None] >= 0, np.cross(b - a, c - a), UPRIGHT)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.divide(
        normal, size, out=np.broadcast_to(UPRIGHT, normal.shape).copy(), where=size > 0.0
    )


def _too_steep(drive: SurfaceDrive, level: FacetSlopes) -> tuple[Finding, ...]:
    """Return a finding of the area that no level position stands for."""
    a, b, c = np.moveaxis(drive.skin.points[drive.skin.triangles[drive.skin.of(drive.faces)]], 1, 0)
    area = float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() - level.area.sum())
    if area < SMALLEST_LEFTOVER:
        return ()
    return (
        warning(
            TOO_STEEP,
            f"{area:.1f} mm2 of {drive.feature} are too steep for parallel passes",
            drive.feature,
            remedy="cut them by waterlines or from another direction",
        ),
    )


def _runs(
    planes: _Planes, step: float, past: float, has_contact: HasContact, progress: Progress
) -> tuple[Ints, Floats]:
    """Return the plane (k,) and from where to where (k, 2) along it the cutter touches the area, one run after the other; it is
    looked for on positions a step apart, and no farther than `past` mm beyond the area's tips."""
    # Sample the planes at even steps, then bisect each change between contact and none.
    before = math.ceil(past / step) + 1
    count = (
        np.ceil((planes.reach[:, 1] - planes.reach[:, 0]) / step).astype(np.int64) + 1 + 2 * before
    )
    plane, number = items_of(count)
    step_index = number - before
    run = planes.reach[plane, 0] + step_index * step
    on = has_contact(plane, run, progress.part(0.0, 0.8))
    on[[*(np.cumsum(count) - count), *(np.cumsum(count) - 1)]] = False
    edge = np.flatnonzero((on[1:] != on[:-1]) & (plane[1:] == plane[:-1]))
    inside, outside = (
        np.where(on[edge], run[edge], run[edge + 1]),
        np.where(on[edge], run[edge + 1], run[edge]),
    )
    for k in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        found = has_contact(
            plane[edge],
            middle,
            progress.part(0.8 + 0.2 * k / HALVINGS, 0.8 + 0.2 * (k + 1) / HALVINGS),
        )
        inside, outside = np.where(found, middle, inside), np.where(found, outside, middle)
    return plane[edge[::2]], inside.reshape(-1, 2)


def _joined(plane: Ints, runs: Floats, overlap: Floats, gap: float) -> tuple[Ints, Floats]:
    """Return runs (k, 2) with overlaps (k, 2) at their ends, and as one where the path between two is no longer than a gap. One that stays
    shorter than any move is left out: it only touches a corner of the area."""
    runs = runs + overlap * np.array([-1.0, 1.0])
    begins = np.append(True, (plane[1:] != plane[:-1]) | (runs[1:, 0] - runs[:-1, 1] > gap))[
        : len(plane)
    ]
    ends = np.append(begins[1:], True)[: len(plane)]
    plane, runs = plane[begins], np.column_stack([runs[begins, 0], runs[ends, 1]])
    long = runs[:, 1] - runs[:, 0] > tolerance.SHORT_MOVE
    return plane[long], runs[long]
