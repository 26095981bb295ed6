"""What is left, and what does the cutter do on the way? A setup's moves run through the stock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.motion import Moves, seen_from
from trunnion.verify.stock.engagement import engagement_of, probes_of
from trunnion.verify.stock.graze_check import confirm_grazed, rays_in_cell
from trunnion.verify.stock.heights import run_heights
from trunnion.verify.stock.rays import BundleStart, Passed, run_rays
from trunnion.verify.stock.stock import Stock

GRAZE_FROM = 0.9
"""Share of the work after which the rapids that graze material are looked at."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StockRun:
    """What happened on the way, a row a move.

    removed (n,) mm3; rapid_depth (n,) how deep a rapid goes into stock, 0 when clear; rapid_position (n, 3) in the setup frame, NaN when
    clear; body_depth (n,) how deep shank or holder enter stock; engagement (n,) rad, the largest angle of the cutter's circumference in
    material along a feed move, and depth_of_cut (n,) mm along the axis, both 0 for rapids; widest (n,) mm how wide the cut is over the
    diameter's length where it is widest, peak (n,) how many times as wide as on the mean of the path.
    """

    removed: Floats
    rapid_depth: Floats
    rapid_position: Floats
    body_depth: Floats
    engagement: Floats
    depth_of_cut: Floats
    widest: Floats
    peak: Floats


def run_stock(
    stock: Stock,
    moves: Moves,
    frame: Frame,
    sweep: Sweep | None = None,
    progress: Progress = NO_PROGRESS,
    threads: int = 0,
) -> StockRun:
    """Cut moves given in a setup frame out of the stock (changed in place) and return what each did.

    `sweep` of the same moves answers for rapids that graze material between rays; without it they are judged by the rays alone.
    `threads` 0: one a core; the result is the same for any number. Cancelled or out of memory half-way, the stock is of no use any more:
    go back to a snapshot. Raises `OutOfMemory` when rays are cut in too many pieces.
    """
    local, probes = progress.aside(
        lambda _: (seen_from(moves, frame, stock.frame), probes_of(moves)), "Cutting the stock"
    )
    found = Passed.empty(len(moves), probes)
    heights = progress.part(0.0, GRAZE_FROM if stock.bundles == ("z",) else 0.3)
    row, looked = run_heights(stock, local, frame, sweep, probes, found, heights)
    if row < len(moves):
        stock.open_field()
    starts = [
        BundleStart(b) if name != "z" else BundleStart(b, row, looked)
        for name, b in stock.rays.items()
    ]
    if starts:
        fine = rays_in_cell(stock.pitch) if sweep is not None else 0
        run_rays(stock, starts, local, probes, found, fine, progress.part(0.3, GRAZE_FROM), threads)
    if sweep is not None:
        confirm_grazed(stock, found, frame, sweep, progress.part(GRAZE_FROM, 1.0), threads)
        stock.cut_by.append((sweep, frame))
    rapid_depth = np.where(found.depth > tolerance.RAPID_DEPTH, found.depth, 0.0)
    position = np.where(rapid_depth[:, None] > 0.0, found.position, np.nan)
    engaged = progress.aside(lambda _: engagement_of(probes, found.tally, moves))
    return StockRun(
        removed=found.removed,
        rapid_depth=rapid_depth,
        rapid_position=frame.to_local(stock.frame.to_world(position)),
        body_depth=found.body,
        engagement=engaged.largest,
        depth_of_cut=engaged.depth,
        widest=engaged.widest,
        peak=engaged.peak,
    )
