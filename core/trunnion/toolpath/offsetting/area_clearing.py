"""Clears an area at one height by contour-parallel passes, from the inside out, staying down where it may.

Used by every strategy that takes material off a floor-like area; what is roughing and what is finishing is said by the numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_near
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark
from trunnion.progress import Progress
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import descent, is_free, step_aside, top_under, travel
from trunnion.toolpath.motion.order import nearest_first
from trunnion.toolpath.offsetting.entry import (
    deepest_position,
    helix,
    helix_radius,
    ramp_along,
    ramp_round,
)
from trunnion.toolpath.offsetting.lead import enter, fitting_lead, leave
from trunnion.toolpath.offsetting.rings import OffsetRing
from trunnion.toolpath.offsetting.trimming import PassTrimming

RUN_OUTS = (0.5, 1.0, 2.0, 3.0, 4.0)
"""Of the radius: how far before an open pass a position that is certainly free is looked for."""

RUN_OUT_DIRECTIONS = (
    (-1.0, 0.0),
    (-0.7, 0.7),
    (-0.7, -0.7),
    (0.0, 1.0),
    (0.0, -1.0),
    (0.7, 0.7),
    (0.7, -0.7),
)
"""Where it is looked for: along the pass's direction and to its left; straight before the start is best."""

LOOKED_AT = 8
"""Positions along a loop at which the cutter is tried to come down at or beside it."""

NEXT_PASS = 2.5
"""Of the step: a position no farther away is on the neighbouring pass and may be fed to straight."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClearingParameters:
    """How an area is cleared: `step` mm between passes, `ramp` radians of entry, `slot` share of the feed in a full-width cut,
    `lead` radius in mm of tangential leads of open passes (0: none), `share` of the feed of all passes."""

    step: float
    ramp: float
    slot: float
    lead: float = 0.0
    share: float = 1.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClearingLayer:
    """What is cleared at height `z`: the rings, the `axis_region` that links and entries may use, the `clip` outside which nothing is
    wanted (None: everything in the rings), and the height `top` under which material may begin (None: as the stock says).

    `wanted`: the area whose stock a clipped pass must meet, `worth` how high over `z` it must be there to count; where a pass meets
    none it is left out (None: every pass is cut as a whole)."""

    z: float
    rings: tuple[OffsetRing, ...]
    axis_region: AxisRegion
    clip: Region | None = None
    top: float | None = None
    wanted: Region | None = None
    worth: float = 0.0

    def wants(self, points: Floats) -> Floats:
        """Return how far points (k, 2) are inside the clip and the axis region, rims counted in (negative outside)."""
        depth = self.axis_region.depth(points)
        return (
            depth if self.clip is None else np.minimum(depth, self.clip.signed_distance(points))
        ) + tolerance.ON_REGION


def clear_area(
    builder: PathBuilder, layer: ClearingLayer, parameters: ClearingParameters, progress: Progress
) -> None:
    """Cut all passes of a layer."""
    trimming = (
        PassTrimming.of(builder, layer.wanted, layer.z + layer.worth)
        if layer.clip is not None and layer.wanted is not None
        else None
    )
    for ring in nearest_first(layer.rings, lambda: builder.here, _ring_away):
        _cut_ring(builder, layer, ring, parameters, trimming, progress)
    if len(builder):
        _step_off(builder, layer)


def cut_rims(
    builder: PathBuilder, layer: ClearingLayer, parameters: ClearingParameters, progress: Progress
) -> None:
    """Cut the outermost passes of a layer alone; what is inside of them is gone already."""
    for ring in nearest_first(layer.rings, lambda: builder.here, _ring_away):
        feed = builder.data.feed * parameters.share
        _cut_passes(builder, layer, ring, parameters, None, feed, progress)
    if len(builder):
        _step_off(builder, layer)


def cut_lines(
    builder: PathBuilder,
    layer: ClearingLayer,
    lines: Sequence[Curve],
    parameters: ClearingParameters,
    progress: Progress,
) -> None:
    """Cut open passes of a layer in full width, the nearest next; each is come to from free space beside it where there is any."""
    feed = builder.data.feed * parameters.share * parameters.slot
    for line in nearest_first(lines, lambda: builder.here, _curve_away):
        progress.check()
        before = _beside(builder, layer, line.start, line.at(0.0)[1])
        if before is not None:
            travel(builder, before, layer.z, layer.axis_region)
            _feed_across(builder, layer, before, line.start, parameters)
        else:
            _go_down(builder, layer, line, parameters)
        builder.curve(line, layer.z, feed)
    if lines:
        _step_off(builder, layer)


def _cut_ring(
    builder: PathBuilder,
    layer: ClearingLayer,
    ring: OffsetRing,
    parameters: ClearingParameters,
    trimming: PassTrimming | None,
    progress: Progress,
) -> None:
    # Depth first: what lies further inside is cut before the ring round it, so each ring begins beside cut material.
    for inner in nearest_first(ring.inner, lambda: builder.here, _ring_away):
        _cut_ring(builder, layer, inner, parameters, trimming, progress)
    feed = builder.data.feed * parameters.share * (1.0 if ring.inner else parameters.slot)
    _cut_passes(builder, layer, ring, parameters, trimming, feed, progress)


def _cut_passes(
    builder: PathBuilder,
    layer: ClearingLayer,
    ring: OffsetRing,
    parameters: ClearingParameters,
    trimming: PassTrimming | None,
    feed: float,
    progress: Progress,
) -> None:
    """Cut the rim of a ring."""
    passes: list[Curve] = []
    for curve in ring.curves():
        passes += [curve] if layer.clip is None else parts_near(curve, layer.clip, layer.wants)
    for whole in nearest_first(passes, lambda: builder.here, _curve_away):
        progress.check()
        for curve in [whole] if trimming is None else trimming.parts(builder, whole):
            if curve.closed:
                _cut_closed(builder, layer, ring, curve, parameters, feed)
            else:
                _cut_open(builder, layer, curve, parameters, feed)


def _cut_closed(
    builder: PathBuilder,
    layer: ClearingLayer,
    ring: OffsetRing,
    loop: Curve,
    parameters: ClearingParameters,
    feed: float,
) -> None:
    here = builder.here
    s = loop.nearest(here[:2]) if here is not None else 0.0
    start, _ = loop.at(s)
    # How the tool gets down: it stays down, comes down in the free, feeds across from the ring inside or from beside the ring, or enters
    # by `_open_up`.
    if not _stays_down(builder, layer, start, parameters):
        free = _free_position(builder, layer, loop, s)
        if free is not None:
            s = free
            travel(builder, loop.at(s)[0], layer.z, layer.axis_region)
        elif ring.inner:
            s = _from_inner(builder, layer, ring, loop)
        else:
            entered = _enter_sideways(builder, layer, loop, parameters)
            s = _open_up(builder, layer, ring, loop, parameters) if entered is None else entered
    builder.curve(loop.split(s, s), layer.z, feed)


def _free_position(
    builder: PathBuilder, layer: ClearingLayer, loop: Curve, first: float
) -> float | None:
    """Return where on a loop the cutter may come down in the free, on the shortest way that has to be fed, `first` if it is one."""
    best: tuple[float, float] | None = None
    for k in range(LOOKED_AT):
        s = (first + k * loop.length / LOOKED_AT) % loop.length
        position = loop.at(s)[0]
        if is_free(builder, position, layer.z):
            fed = descent(builder, position, layer.z)
            if best is None or fed < best[0]:
                best = fed, s
            if fed <= builder.safety:
                break
    return None if best is None else best[1]


def _enter_sideways(
    builder: PathBuilder, layer: ClearingLayer, loop: Curve, parameters: ClearingParameters
) -> float | None:
    """Come down in the free beside a loop and feed straight onto it; return where on the loop, None where nothing beside it is free."""
    best: tuple[float, float, Floats] | None = None
    for k in range(LOOKED_AT):
        s = k * loop.length / LOOKED_AT
        start, tangent = loop.at(s)
        before = _beside(builder, layer, start, tangent)
        if before is not None:
            fed = float(np.hypot(*(before - start))) + descent(builder, before, layer.z)
            if best is None or fed < best[0] - tolerance.SEW:
                best = fed, s, before
    if best is None:
        return None
    _, s, before = best
    travel(builder, before, layer.z, layer.axis_region)
    _feed_across(builder, layer, before, loop.at(s)[0], parameters)
    return s


def _feed_across(
    builder: PathBuilder,
    layer: ClearingLayer,
    before: Floats,
    position: Floats,
    parameters: ClearingParameters,
) -> None:
    """Feed straight from a free position to another, where material stands no faster than the step removes as much a minute over the whole
    diameter; how far nothing stands is found by bisection."""
    free, met = 0.0, 1.0
    way = position - before
    while (met - free) * float(np.hypot(*way)) > builder.safety:
        middle = 0.5 * (free + met)
        if is_free(builder, before, layer.z, before + middle * way):
            free = middle
        else:
            met = middle
    if free > 0.0:
        builder.line((*(before + free * way), layer.z), builder.data.feed, Mark.LINK)
    share = parameters.slot * min(parameters.step / builder.tool.diameter, 1.0)
    builder.line((*position, layer.z), builder.data.feed * share, Mark.ENTRY)


def _from_inner(builder: PathBuilder, layer: ClearingLayer, ring: OffsetRing, loop: Curve) -> float:
    """Come down where the pass before, one step further inside, was cut, and feed across."""
    seeds = [c.points[0] for inner in ring.inner for c in inner.curves()]
    near = min(seeds, key=lambda p: float(loop.distance(p)[0]))
    s = loop.nearest(near)
    position, _ = loop.at(s)
    travel(builder, near if layer.axis_region.holds_line(near, position) else position, layer.z)
    builder.line((*position, layer.z), builder.data.plunge_feed, Mark.LINK)
    return s


def _open_up(
    builder: PathBuilder,
    layer: ClearingLayer,
    ring: OffsetRing,
    loop: Curve,
    parameters: ClearingParameters,
) -> float:
    centre, depth = deepest_position(AxisRegion(ring.region), layer.axis_region)
    drop = _top(builder, layer, centre, builder.tool.radius) - layer.z
    radius = helix_radius(builder, depth, drop, parameters.ramp)
    s = loop.nearest(centre)
    position, _ = loop.at(s)
    if radius > 0.0 and layer.axis_region.holds_line(centre, position):
        helix(
            builder,
            centre,
            radius,
            position,
            _top(builder, layer, centre, radius),
            layer.z,
            parameters.ramp,
        )
        builder.line((*position, layer.z), builder.data.feed * parameters.slot, Mark.LINK)
    else:
        top = max(_top(builder, layer, p, 0.0) for p in loop.points)
        ramp_round(builder, loop, s, top, layer.z, parameters.ramp)
    return s


def _cut_open(
    builder: PathBuilder,
    layer: ClearingLayer,
    piece: Curve,
    parameters: ClearingParameters,
    feed: float,
) -> None:
    start, tangent = piece.start, piece.at(0.0)[1]
    lead = (
        fitting_lead(start, tangent, parameters.lead, layer.axis_region, leaves=False)
        if parameters.lead > 0.0
        else None
    )
    if lead is not None and _is_off(layer, lead.outside):
        enter(builder, lead, start, layer.z, builder.data.feed)
    elif not _stays_down(builder, layer, start, parameters):
        _come_to(builder, layer, piece, parameters)
    builder.curve(piece, layer.z, feed)
    if parameters.lead > 0.0:
        last = piece.at(piece.length)
        leave(
            builder,
            fitting_lead(last[0], last[1], parameters.lead, layer.axis_region, leaves=True),
            layer.z,
            builder.data.feed,
        )


def _come_to(
    builder: PathBuilder, layer: ClearingLayer, piece: Curve, parameters: ClearingParameters
) -> None:
    """Bring the cutter to the start of an open pass: from outside where it is free, else down into material."""
    before = _beside(builder, layer, piece.start, piece.at(0.0)[1])
    if before is None:
        _go_down(builder, layer, piece, parameters)
        return
    travel(builder, before, layer.z, layer.axis_region)
    builder.line((*piece.start, layer.z), builder.data.feed, Mark.LINK)


def _go_down(
    builder: PathBuilder, layer: ClearingLayer, piece: Curve, parameters: ClearingParameters
) -> None:
    """Go down into material to the start of an open pass: by a helix beside it, else by a ramp along it."""
    start, tangent = piece.start, piece.at(0.0)[1]
    left = np.array([-tangent[1], tangent[0]])
    drop = _top(builder, layer, start, builder.tool.radius) - layer.z
    radius = helix_radius(builder, builder.tool.radius, drop, parameters.ramp)
    centre = start + radius * left
    if radius > 0.0 and float(layer.axis_region.depth(centre)[0]) >= radius - tolerance.ON_REGION:
        helix(
            builder,
            centre,
            radius,
            start,
            _top(builder, layer, centre, radius),
            layer.z,
            parameters.ramp,
        )
        return
    top = max(_top(builder, layer, p, 0.0) for p in piece.points)
    ramp_along(builder, piece, top, layer.z, parameters.ramp)


def _beside(
    builder: PathBuilder, layer: ClearingLayer, start: Floats, tangent: Floats
) -> Floats | None:
    """Return the free position at or near the start of a pass from which the way that has to be fed, down and to the start, is
    shortest; None where none is free."""
    left = np.array([-tangent[1], tangent[0]])
    best: tuple[float, Floats] | None = None
    for share in (0.0, *RUN_OUTS):
        run = share * builder.tool.radius
        if best is not None and run >= best[0]:
            break
        for along, aside in RUN_OUT_DIRECTIONS if run > 0.0 else RUN_OUT_DIRECTIONS[:1]:
            before = start + run * (along * tangent + aside * left)
            # Where the axis may not go the stock isn't asked: what stands there changes nothing here.
            if layer.axis_region.holds_line(before, start) and is_free(builder, before, layer.z):
                fed = run + descent(builder, before, layer.z)
                if best is None or fed < best[0]:
                    best = fed, before
    return None if best is None else best[1]


def _stays_down(
    builder: PathBuilder, layer: ClearingLayer, start: Floats, parameters: ClearingParameters
) -> bool:
    """Feed straight to a position when the tool is down, the path stays in the axis region, and it is short or certainly free; say
    whether."""
    here = builder.here
    if (
        here is None
        or abs(here[2] - layer.z) > tolerance.SHORT_MOVE
        or not layer.axis_region.holds_line(here, start)
    ):
        return False
    if float(np.hypot(*(start - here[:2]))) > NEXT_PASS * parameters.step and not is_free(
        builder, here, layer.z, start
    ):
        return False
    builder.line((*start, layer.z), builder.data.feed, Mark.LINK)
    return True


def _top(builder: PathBuilder, layer: ClearingLayer, position: Floats, radius: float) -> float:
    found = top_under(builder, position, radius)
    return max(found if layer.top is None else min(found, layer.top), layer.z)


def _is_off(layer: ClearingLayer, position: Floats) -> bool:
    return (
        layer.clip is None or float(layer.clip.signed_distance(position)[0]) <= tolerance.ON_REGION
    )


def _step_off(builder: PathBuilder, layer: ClearingLayer) -> None:
    if builder.here is None or abs(builder.here[2] - layer.z) > tolerance.SHORT_MOVE:
        return
    step_aside(builder, builder.heading(), layer.axis_region)


def _ring_away(ring: OffsetRing, position: Floats) -> float:
    return _nearest([_innermost(ring).region], position)


def _innermost(ring: OffsetRing) -> OffsetRing:
    while ring.inner:
        ring = ring.inner[0]
    return ring


def _nearest(regions: Sequence[Region], position: Floats) -> float:
    return min(abs(float(r.signed_distance(position)[0])) for r in regions)


def _curve_away(curve: Curve, position: Floats) -> float:
    return (
        float(curve.distance(position)[0])
        if curve.closed
        else float(np.hypot(*(curve.start - position)))
    )
