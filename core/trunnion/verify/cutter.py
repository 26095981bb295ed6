"""Cutter, neck, shank and holder as the proof sees them: convex bodies of revolution stacked along the axis.

A convex body is known by its supporting half-planes. Its outline in (rho, h), rho from the axis and h from the tip, is a chain of arcs
(of radius 0 at sharp corners); each arc covers a cone of outward normals, and straight flanks are where two cones meet. The depth of a
point is then the smallest distance to all those half-planes: exact inside and outside, concave, and its slope is a normal
(`kernels/body.py`). Where an outline bends inwards it is cut level, and each part is a body of its own.

The proof keeps its own cutter forms, apart from those that toolpaths are planned with: a shared one would hide a shared fault.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.tool import Tool
from trunnion.verify.kernels import body as kernel

OVERLAP = 1.0
"""mm that a closed body reaches into the one that goes on from it, so that a depth near their joint is not cut short."""

Point = tuple[float, float]
"""r, z."""
Span = tuple[float, float, float, float, float, float, float]
"""A part of an outline: r, z of its ends, r, z of its centre, and its radius: 0 straight, above 0 rounded outwards, below 0 inwards."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bodies:
    """The bodies of some tools, as the kernels read them.

    arc (a, 7) as `kernels/body.py` names its columns; piece (p, 8): FIRST and LAST of the arcs, Z_LOW, Z_HIGH, R_MAX, KIND (0 cuts, 1 does
    not), CLOSED_FIRST and CLOSED_LAST of the arcs of the body closed at both ends (`OVERLAP` beyond an end that has no free face).
    start (t + 1,): the pieces of each tool, those that cut first.
    """

    arc: Floats
    piece: Floats
    start: Ints

    def of(self, tool: int) -> Floats:
        """Return the pieces (k, 8) of one tool."""
        return self.piece[self.start[tool] : self.start[tool + 1]]

    def widest(self, *, cutting: bool = False) -> Floats:
        """Return the largest radius of each tool (t,), of its cutting pieces alone when `cutting`."""
        rows = [self.of(k) for k in range(len(self.start) - 1)]
        return np.array(
            [float(p[(p[:, kernel.KIND] == 0.0) | (not cutting), kernel.R_MAX].max()) for p in rows]
        )


def bodies_of(tools: Sequence[Tool]) -> Bodies:
    """Return the bodies of tools, in their order."""
    arcs: list[Floats] = []
    pieces, start = [], [0]
    for tool in tools:
        for spans, kind, under, over in _stacked(tool):
            opened = _arcs(
                spans,
                spans[0][:2] if under is None else None,
                spans[-1][2:4] if over is None else None,
            )
            closed = _arcs(spans, _gone_on(spans, under, -OVERLAP), _gone_on(spans, over, OVERLAP))
            first = sum(map(len, arcs))
            arcs += [opened, closed]
            pieces.append(
                (
                    first,
                    first + len(opened),
                    spans[0][1],
                    spans[-1][3],
                    _widest(spans),
                    kind,
                    first + len(opened),
                    first + len(opened) + len(closed),
                )
            )
        start.append(len(pieces))
    return Bodies(
        arc=np.vstack([np.zeros((0, kernel.ARC_COLUMNS)), *arcs]),
        piece=np.array(pieces, dtype=np.float64).reshape(-1, 8),
        start=np.array(start, dtype=np.int64),
    )


@lru_cache(maxsize=256)
def bodies_of_one(tool: Tool) -> Bodies:
    """Return the bodies of one tool, cached: not to be changed."""
    return bodies_of((tool,))


def outline_of(tool: Tool) -> list[Span]:
    """Return the outline of what cuts, from the axis (or a level end face) up to the top of the flutes; no span is without a length."""
    return [
        span
        for span in _spans_of(tool)
        if math.hypot(span[2] - span[0], span[3] - span[1]) > tolerance.PARAMETRIC
    ]


def _spans_of(tool: Tool) -> list[Span]:
    r, c, top = tool.radius, tool.corner_radius, tool.flute_length
    if tool.form == "taper":
        lean = math.radians(tool.taper_angle)
        edge, height = r - c + c * math.cos(lean), c - c * math.sin(lean)
        return [
            *_end_face(r - c),
            *_arc(r - c, 0.0, edge, height, r - c, c, c),
            _line(edge, height, edge + (top - height) * math.tan(lean), top),
        ]
    if tool.form == "barrel":
        middle, big = (r - tool.barrel_radius, tool.widest_height), tool.barrel_radius
        lean = math.atan2(c - middle[1], -middle[0])
        edge, height = c * math.cos(lean), c + c * math.sin(lean)
        return [
            *_arc(0.0, 0.0, edge, height, 0.0, c, c),
            *_arc(
                edge,
                height,
                middle[0] + math.sqrt(big**2 - (top - middle[1]) ** 2),
                top,
                *middle,
                big,
            ),
        ]
    if tool.form == "t-slot":
        return [
            *_end_face(r - c),
            *_arc(r - c, 0.0, r, c, r - c, c, c),
            *([_line(r, c, r, top - c)] if top > 2 * c else []),
            *_arc(r, top - c, r - c, top, r - c, top - c, c),
        ]
    if tool.form == "drill" and tool.point_length > 0.0:
        return [_line(0.0, 0.0, r, tool.point_length), _line(r, tool.point_length, r, top)]
    if tool.form in ("reamer", "boring-bar"):
        lead = tool.lead
        return [*_end_face(r - lead), _line(r - lead, 0.0, r, lead), _line(r, lead, r, top)]
    if tool.form == "tap":
        # Its threads lie outside of the core; the bore that it follows is at least as wide as that.
        core = 0.5 * (tool.diameter - 1.25 * math.sqrt(0.75) * tool.pitch)
        return [*_end_face(core), _line(core, 0.0, core, top)]
    if tool.form == "thread-mill":
        # The cylinder inside its teeth; a single tooth has the flat of its finest pitch and reaches out farther for the coarsest.
        low, high = (tool.pitch, tool.pitch) if tool.pitch else (tool.pitch_low, tool.pitch_high)
        core = 0.5 * tool.diameter - math.sqrt(0.75) * (0.625 * high + 0.125 * (high - low))
        return [*_end_face(core), _line(core, 0.0, core, top)]
    if tool.form == "form":
        return _from_rows(tool.outline)
    return [*_end_face(r - c), *_arc(r - c, 0.0, r, c, r - c, c, c), _line(r, c, r, top)]


def lowest_height(tool: Tool, rho: Floats) -> Floats:
    """Return how high above the tip the fluted cutter begins at distances (n,) from the axis; infinite outside of it. A plain reference."""
    rho = np.asarray(rho, dtype=np.float64)
    out = np.full(rho.shape, np.inf)
    for r0, z0, r1, z1, cr, cz, radius in outline_of(tool):
        furthest = cr + radius if radius > 0.0 and min(z0, z1) <= cz <= max(z0, z1) else max(r0, r1)
        inside = (rho >= min(r0, r1)) & (rho <= furthest)
        if radius:
            across = np.sqrt(np.clip(radius**2 - (rho - cr) ** 2, 0.0, None))
            z = np.clip(cz - math.copysign(1.0, radius) * across, min(z0, z1), max(z0, z1))
        else:
            z = (
                np.full(rho.shape, min(z0, z1))
                if r0 == r1
                else z0 + (rho - r0) / (r1 - r0) * (z1 - z0)
            )
        out = np.where(inside, np.minimum(out, z), out)
    return out


def _line(r0: float, z0: float, r1: float, z1: float) -> Span:
    return (r0, z0, r1, z1, 0.0, 0.0, 0.0)


def _end_face(radius: float) -> list[Span]:
    return [_line(0.0, 0.0, radius, 0.0)] if radius > 0.0 else []


def _arc(
    r0: float, z0: float, r1: float, z1: float, cr: float, cz: float, radius: float
) -> list[Span]:
    return [(r0, z0, r1, z1, cr, cz, radius)] if radius > 0.0 else []


def _from_rows(rows: Sequence[tuple[float, float, float]]) -> list[Span]:
    spans = _end_face(rows[0][0])
    for (r0, z0, bulge), (r1, z1, _) in pairwise(rows):
        if bulge == 0.0:
            spans.append(_line(r0, z0, r1, z1))
            continue
        # Upwards along the outline the body is on the left: an arc that turns left bends outwards.
        share = (1.0 / bulge - bulge) / 4.0
        cr, cz = (r0 + r1) / 2 - share * (z1 - z0), (z0 + z1) / 2 + share * (r1 - r0)
        spans.append((r0, z0, r1, z1, cr, cz, math.copysign(math.hypot(r0 - cr, z0 - cz), bulge)))
    return spans


def _stacked(tool: Tool) -> list[tuple[list[Span], float, list[Span] | None, list[Span] | None]]:
    """Return the convex runs of a tool's outline: spans, kind, and the runs under and over it, None where that is thinner: a free face."""
    cutting = _convex_runs(outline_of(tool))
    runs = [(spans, 0.0) for spans in cutting] + [
        ([_line(r0, z0, r1, z1)], 1.0)
        for z0, r0, z1, r1 in tool.profile()
        if z1 - z0 > tolerance.PARAMETRIC
    ]
    found = []
    for k, (spans, kind) in enumerate(runs):
        under, over = runs[k - 1][0] if k else None, runs[k + 1][0] if k + 1 < len(runs) else None
        if under is not None and spans[0][0] > under[-1][2] + tolerance.PARAMETRIC:
            under = None
        if over is not None and spans[-1][2] > over[0][0] + tolerance.PARAMETRIC:
            over = None
        found.append((spans, kind, under, over))
    return found


def _convex_runs(spans: list[Span]) -> list[list[Span]]:
    """Cut an outline where it bends inwards; arcs that are hollow are opened into chords."""
    plain = [piece for span in spans for piece in (_opened(span) if span[6] < 0.0 else [span])]
    runs: list[list[Span]] = [[]]
    for span in plain:
        rises = span[3] - span[1] > tolerance.PARAMETRIC
        if runs[-1] and _turns_in(runs[-1][-1], span):
            runs.append([])
        if runs[-1] or rises or span[2] > span[0]:
            runs[-1].append(span)
    return [run for run in runs if any(s[3] - s[1] > tolerance.PARAMETRIC for s in run)]


def _opened(span: Span) -> list[Span]:
    """Return the chords of a hollow arc; the cutter grows by at most a quarter of the contact bound."""
    r0, z0, r1, z1, cr, cz, radius = span
    a, b = math.atan2(z0 - cz, r0 - cr), math.atan2(z1 - cz, r1 - cr)
    turn = math.remainder(b - a, math.tau)
    step = math.sqrt(2.0 * tolerance.CONTACT_BOUND / -radius)
    angles = a + turn * np.linspace(0.0, 1.0, max(2, math.ceil(abs(turn) / step) + 1))
    points = [
        (r0, z0),
        *((cr - radius * math.cos(t), cz - radius * math.sin(t)) for t in angles[1:-1]),
        (r1, z1),
    ]
    return [_line(*p, *q) for p, q in pairwise(points)]


def _turns_in(one: Span, other: Span) -> bool:
    (_, n0), (n1, _) = _normals(one), _normals(other)
    return n0[0] * n1[1] - n0[1] * n1[0] < -tolerance.COINCIDENT


def _normals(span: Span) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the outward normals at both ends of a span that is not hollow."""
    r0, z0, r1, z1, cr, cz, radius = span
    if radius > 0.0:
        return ((r0 - cr) / radius, (z0 - cz) / radius), ((r1 - cr) / radius, (z1 - cz) / radius)
    length = math.hypot(r1 - r0, z1 - z0)
    normal = ((z1 - z0) / length, (r0 - r1) / length)
    return normal, normal


def _arcs(spans: list[Span], low: Point | None, high: Point | None) -> Floats:
    """Return the arcs of a convex run. It is closed by level faces at the points `low` and `high`, its own ends or further on; without them
    it is left open."""
    rows: list[tuple[float, ...]] = []
    if low is not None and low != spans[0][:2]:
        spans = [_line(*low, *spans[0][:2]), *spans]
    if high is not None and high != spans[-1][2:4]:
        spans = [*spans, _line(*spans[-1][2:4], *high)]
    normals = [_normals(span) for span in spans]
    if low is not None:
        rows += _corner(*low, (0.0, -1.0), normals[0][0])
    for k, (span, (n0, n1)) in enumerate(zip(spans, normals, strict=True)):
        if span[6] > 0.0:
            rows += _halves(span[4], span[5], span[6], n0, n1)
        if k + 1 < len(spans):
            rows += _corner(span[2], span[3], n1, normals[k + 1][0])
    if high is not None:
        rows += _corner(*high, normals[-1][1], (0.0, 1.0))
    if not rows:
        rows.append((*spans[0][:2], 0.0, *normals[0][0], *normals[0][0]))
    return np.array(rows)


def _gone_on(spans: list[Span], other: list[Span] | None, by: float) -> Point:
    """Return where a closed run ends that goes on by `by` (below 0: down) inside the run beside it: on its own tangent, or where that one
    is thinner on its outline. Without a neighbour it ends where it is."""
    r, z = spans[-1][2:4] if by > 0.0 else spans[0][:2]
    if other is None:
        return r, z
    normal = _normals(spans[-1])[1] if by > 0.0 else _normals(spans[0])[0]
    far = min(abs(by), other[-1][3] - other[0][1])
    slope = -math.copysign(1.0, by) * normal[1] / max(normal[0], tolerance.PARAMETRIC)
    if r + slope * far < 0.0:
        far = r / -slope
    at = z + math.copysign(far, by)
    return max(min(r + slope * far, _radius_at(other, at)), 0.0), at


def _radius_at(spans: list[Span], z: float) -> float:
    """Return the radius of a convex run at a height within its ends."""
    span = next(s for s in spans if s is spans[-1] or z <= s[3])
    r0, z0, r1, z1, cr, cz, radius = span
    if radius > 0.0:
        return cr + math.sqrt(max(radius**2 - (z - cz) ** 2, 0.0))
    return max(r0, r1) if z1 == z0 else r0 + (r1 - r0) * (z - z0) / (z1 - z0)


def _corner(
    r: float, z: float, n0: tuple[float, float], n1: tuple[float, float]
) -> list[tuple[float, ...]]:
    turn = n0[0] * n1[1] - n0[1] * n1[0]
    return _halves(r, z, 0.0, n0, n1) if turn > tolerance.PARAMETRIC else []


def _halves(
    r: float, z: float, radius: float, n0: tuple[float, float], n1: tuple[float, float]
) -> list[tuple[float, ...]]:
    """Return an arc, in two where its normals go from down to up."""
    if n0[1] < -tolerance.PARAMETRIC and n1[1] > tolerance.PARAMETRIC:
        return [(r, z, radius, *n0, 1.0, 0.0), (r, z, radius, 1.0, 0.0, *n1)]
    return [(r, z, radius, *n0, *n1)]


def _widest(spans: list[Span]) -> float:
    """Return the largest radius of a convex run."""
    bulging = [
        cr + radius
        for r0, z0, r1, z1, cr, cz, radius in spans
        if radius > 0.0 and min(z0, z1) <= cz <= max(z0, z1)
    ]
    return max([max(s[0], s[2]) for s in spans] + bulging)
