"""Slices: the part cut between all its horizontal faces, and in every slice the spaces that are to be emptied (rules 1 to 3).

In a slice the loops form a nesting forest. A loop that bounds material from inside is a guide profile; the material standing directly
in it are islands; what lies outside all material, but within the part's outline seen from above, is open space.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from trunnion.findings import BadInput, Finding, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.progress import Progress
from trunnion.recognize.contract import Slicer
from trunnion.tolerance import AREA, PARAMETRIC, PLANE_REGION, SLIVER

NARROW = 0.05
"""mm: open space narrower than this is the slope of an outer wall seen from above, or noise between two slices."""


TRIES = (0.5, 0.37, 0.71)
"""Where between two levels a slice lies; the next position is tried when the part can't be cut there (a seam or a vertex in the plane)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SliceSpace:
    """One connected area to be emptied in a slice: its plan, whether material closes it all round, and the islands in it."""

    plan: BaseGeometry
    closed: bool
    islands: tuple[BaseGeometry, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Slice:
    """The part cut at height `z`, between the events `bottom` and `top`."""

    z: float
    bottom: float
    top: float
    material: BaseGeometry
    spaces: tuple[SliceSpace, ...]

    def space_at(self, point: Floats) -> int | None:
        """Return the number of the space that holds a point (x, y), None in material and outside."""
        spot = shapely.Point(point[0], point[1])
        return next((n for n, s in enumerate(self.spaces) if s.plan.covers(spot)), None)


@dataclass(frozen=True, eq=False, kw_only=True)
class Slices:
    """The slices of a part from the lowest to the highest, and its `outline` (seen from above, openings filled).

    A plane that the part can't be cut by is left out, with a finding.
    """

    layers: tuple[Slice, ...]
    outline: BaseGeometry
    findings: tuple[Finding, ...] = ()

    @cached_property
    def rim(self) -> BaseGeometry:
        """The border of the outline."""
        return self.outline.boundary

    def flipped(self, width: float, height: float) -> Slices:
        """Return the same slices as they are seen in the frame that looks from below (`frame.flipped`)."""
        layers = tuple(
            Slice(
                z=height - s.z,
                bottom=height - s.top,
                top=height - s.bottom,
                material=_mirrored(s.material, width),
                spaces=tuple(
                    SliceSpace(
                        plan=_mirrored(p.plan, width),
                        closed=p.closed,
                        islands=tuple(_mirrored(i, width) for i in p.islands),
                    )
                    for p in s.spaces
                ),
            )
            for s in reversed(self.layers)
        )
        return Slices(layers=layers, outline=_mirrored(self.outline, width))


def heights(events_at: Iterable[float], low: float, high: float, depth: float) -> tuple[float, ...]:
    """Return the heights where something begins or ends, all horizontal faces that count, with a part's bottom and top, and further ones at
    most `depth` apart.

    A slice lies between each two of them, so none passes through a floor: what the paper moves its roughing planes for.
    """
    found = [low, high, *events_at]
    events: list[float] = []
    for z in sorted(found):
        if not events or z - events[-1] > SLIVER:
            events.append(z)
    levels: list[float] = []
    for bottom, top in itertools.pairwise(events):
        pieces = max(1, int(np.ceil((top - bottom) / depth - SLIVER)))
        levels.extend(float(z) for z in np.linspace(bottom, top, pieces, endpoint=False))
    return (*levels, events[-1])


def cut(slicer: Slicer, frame: Frame, levels: tuple[float, ...], progress: Progress) -> Slices:
    """Return a slice between each two levels, in the middle when the part can be cut there; raise `BadInput` when no plane cuts it."""
    cuts: list[tuple[float, float, float, BaseGeometry]] = []
    findings: list[Finding] = []
    for bottom, top in progress.over(list(itertools.pairwise(levels)), "slicing"):
        failed = ""
        for share in TRIES:
            z = bottom + share * (top - bottom)
            try:
                cuts.append((z, bottom, top, plan(slicer.section(frame, z))))
                break
            except (BadInput, ValueError) as reason:
                failed = str(reason)
        else:
            findings.append(
                warning(
                    "panel.no-slice",
                    f"the part can't be cut between the heights {bottom:.3f} and {top:.3f} mm: {failed}",
                    remedy="the graph decides alone between the faces there; heal the part",
                )
            )
    if not cuts:
        raise BadInput(
            f"the part can't be cut by a plane: {findings[0].text}"
            if findings
            else "the part has no height in its frame"
        )
    progress.at(1.0, "slicing")
    outline = _filled(
        shapely.union_all([c[3] for c in cuts])
        .buffer(SLIVER, join_style="mitre")
        .buffer(-SLIVER, join_style="mitre")
    )
    layers = tuple(
        Slice(z=z, bottom=b, top=t, material=m, spaces=tuple(progress.each(_spaces(m, outline))))
        for z, b, t, m in cuts
    )
    return Slices(layers=layers, outline=outline, findings=tuple(findings))


def plan(region: Region) -> BaseGeometry:
    """Return a region as polygons on chords, for questions of topology."""
    shapes = []
    for piece in region.pieces:
        shape = Polygon(_ring(piece.outer), [_ring(h) for h in piece.holes])
        shapes.append(shape if shape.is_valid else shape.buffer(0.0))
    return shapely.union_all(shapes)


def _ring(curve: Curve) -> Floats:
    points = np.asarray(curve.sampled(10.0 * PLANE_REGION))
    # What is left of a zero after a part was turned has squares that no number holds, and the polygon kernel divides by them.
    return np.where(np.abs(points) < PARAMETRIC, 0.0, points)


def _spaces(material: BaseGeometry, outline: BaseGeometry) -> Iterable[SliceSpace]:
    """Yield the spaces of a slice: rule 3 for the closed ones, the rest of the outline for the open ones."""
    pieces = [g for g in shapely.get_parts(material) if g.area > AREA]
    for guide in (Polygon(hole) for piece in pieces for hole in piece.interiors):
        if guide.area > AREA:
            islands = tuple(
                p
                for p in pieces
                if guide.covers(p.representative_point())
                and p.area < guide.area
                and guide.contains(p)
            )
            direct = tuple(
                i
                for i in islands
                if not any(Polygon(o.exterior).contains(i) for o in islands if o is not i)
            )
            yield SliceSpace(
                plan=_largest(
                    guide.difference(shapely.union_all([Polygon(i.exterior) for i in direct]))
                ),
                closed=True,
                islands=direct,
            )
    air = outline.difference(_filled(material))
    for part in shapely.get_parts(air.buffer(-NARROW).buffer(NARROW, join_style="mitre")):
        if part.area > AREA:
            hollow = [Polygon(r) for r in part.interiors]
            yield SliceSpace(
                plan=part,
                closed=False,
                islands=tuple(
                    p for p in pieces if any(h.buffer(NARROW).contains(p) for h in hollow)
                ),
            )


def _largest(shape: BaseGeometry) -> BaseGeometry:
    return max(shapely.get_parts(shape), key=lambda g: g.area)


def _filled(shape: BaseGeometry) -> BaseGeometry:
    return shapely.union_all(
        [Polygon(p.exterior) for p in shapely.get_parts(shape) if isinstance(p, Polygon)]
    )


def _mirrored(shape: BaseGeometry, width: float) -> BaseGeometry:
    return shapely.transform(shape, lambda xy: np.column_stack([xy[:, 0], width - xy[:, 1]]))
