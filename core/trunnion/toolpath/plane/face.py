"""Faces the blank's top: straight rows over its length in layers, starting, turning and ending outside the material."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import error, info
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where, points_along
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.axis_region import AxisRegion, level_at
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion import choices
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import is_free, top_under, travel
from trunnion.toolpath.offsetting.entry import ramp_along
from trunnion.toolpath.offsetting.levels import steps_down
from trunnion.toolpath.offsetting.rings import SAFE_SHARE
from trunnion.toolpath.stock.heightfield import PlanningStock

RAMP = math.radians(3.0)
"""Slope of the ramp into material that no row comes to from outside, between fixtures."""
ONE_ROW = "one row takes the whole top"


@settings("plane.face")
class FaceSettings:
    """How a top is faced. Width and depth of cut come with the cutting data."""

    pattern: str = setting(
        "zigzag",
        label="Pattern",
        help="Rows to and fro, or all rows in the climbing direction.",
        choices=("zigzag", "climb"),
    )
    run_out: float = setting(
        3.0,
        unit="mm",
        low=0.5,
        high=100.0,
        label="Run-out",
        help="How far the whole cutter leaves the blank.",
    )
    overlap: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Overlap",
        help="How far the last row reaches past the edge.",
    )
    safety: float = choices.safety()


def row_width(
    tool: Tool, data: CuttingData, settings: FaceSettings, before: Operation | None
) -> Engagement:
    """Return the width of a row: where one row takes the whole top, all of it."""
    whole = 0.0 < data.widest <= _one_row(tool, settings.overlap)
    return Engagement(
        width=max(data.width, data.widest) if whole else data.width,
        depth=data.depth,
        share=1.0,
        at=ONE_ROW if whole else "",
    )


@strategy(settings=FaceSettings, drive=PlaneDrive, meets=row_width)
def face(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: FaceSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that take the blank's top down to the drive's bottom."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    area = drive.levels[0].wanted if drive.levels else None
    if not area:
        return Planned(
            findings=(
                error(
                    "face.nothing",
                    f"{drive.feature} has no top to face",
                    drive.feature,
                    remedy="suppress it",
                ),
            )
        )
    box = _remaining_box(stock, area, drive.bottom)
    if box is None:
        nothing = "what is over it has gone in an earlier setup"
        return Planned(findings=(info("face.gone", f"{drive.feature}: {nothing}", drive.feature),))
    (x0, y0), (x1, y1) = box
    # Rows run along the longer side; `turned` says that this is y.
    turned = y1 - y0 > x1 - x0
    along, across = ((y0, y1), (x0, x1)) if turned else ((x0, x1), (y0, y1))
    rows = _rows(across, tool, data.width, settings.overlap)
    out = tool.radius + settings.run_out
    heights = steps_down(max(drive.top, drive.stock_top), drive.bottom, data.depth)
    ends = (along[0] - out, along[1] + out)
    for z in heights:
        progress.at(
            (drive.top - z) / max(drive.top - drive.bottom, tolerance.SEW),
            f"{drive.feature}: layer at {z:.3f}",
        )
        free = AxisRegion.of(level_at(drive, z).boundary, tool.radius)
        whole = [_row(v, ends, turned) for v in rows]
        if all(free.holds_line(row.start, row.end) for row in whole):
            _cut_rows(builder, rows, ends, z, turned, settings.pattern == "zigzag")
        else:
            _cut_parts(builder, whole, area, free, z)
    return Planned(path=builder.finished())


def _remaining_box(stock: PlanningStock, area: Region, z: float) -> tuple[Floats, Floats] | None:
    """Return the box (low, high) of an area as far as stock stands over a height there; None where none does."""
    low, high = area.box()
    cells = np.argwhere(stock.heights > z + tolerance.SEW)
    if not len(cells):
        return None
    first = stock.corner + stock.cell * (cells.min(axis=0) - 1)
    last = stock.corner + stock.cell * (cells.max(axis=0) + 2)
    return np.maximum(low, first), np.minimum(high, last)


def _row(v: float, ends: tuple[float, float], turned: bool) -> Curve:
    return Curve.polyline([(v, u) if turned else (u, v) for u in ends])


def _cut_parts(
    builder: PathBuilder, rows: list[Curve], area: Region, free: AxisRegion, z: float
) -> None:
    """Cut what of rows lies where the axis may be, each part from outside of an area inwards, then go along the rim of what is kept
    free for the ridges between their ends."""
    near = area.offset(builder.tool.radius)
    rims = [c for c in free.region.curves() if near.contains(c.points).any()]
    parts = [part for row in rows for part in parts_where(row, free.depth)]
    for part in [*parts, *(p for c in rims for p in parts_where(c, near.signed_distance))]:
        inwards = part
        if (
            not part.closed
            and is_free(builder, part.end, z)
            and not is_free(builder, part.start, z)
        ):
            inwards = part.reversed()
        if is_free(builder, inwards.start, z):
            travel(builder, inwards.start, z)
        else:
            opened = inwards.split(0.0, 0.0) if inwards.closed else inwards
            top = max(top_under(builder, p) for p in points_along(opened)[1])
            ramp_along(builder, opened, top, z, RAMP)
        builder.curve(inwards, z, builder.data.feed)


def _one_row(tool: Tool, overlap: float) -> float:
    """Return the widest top in mm that one row covers with its overlaps."""
    return 2.0 * SAFE_SHARE * (tool.radius - tool.corner_radius) - 2.0 * overlap


def _rows(across: tuple[float, float], tool: Tool, width: float, overlap: float) -> Floats:
    """Return where the middles of the rows are: each takes one width, the first and last cover the edges with their flat end."""
    flat = tool.radius - tool.corner_radius
    size = across[1] - across[0]
    if size <= _one_row(tool, overlap):
        return np.array([0.5 * (across[0] + across[1])])
    step = min(width, 2.0 * SAFE_SHARE * flat)
    count = max(1, math.ceil((size + overlap) / step - tolerance.COINCIDENT))
    middles: Floats = across[0] - flat + (size + overlap) / count * np.arange(1.0, count + 1.0)
    return middles


def _cut_rows(
    builder: PathBuilder,
    rows: Floats,
    along: tuple[float, float],
    z: float,
    turned: bool,
    zigzag: bool,
) -> None:
    def position(u: float, v: float) -> tuple[float, float, float]:
        return (v, u, z) if turned else (u, v, z)

    # Climbing with the uncut material on the right: the first row goes towards -x (towards +y when turned, where right is +x).
    forward = turned
    for v in rows:
        begin, end = along if forward else along[::-1]
        travel(builder, position(begin, v)[:2], z)
        builder.line(position(end, v), builder.data.feed)
        forward = forward != zigzag
