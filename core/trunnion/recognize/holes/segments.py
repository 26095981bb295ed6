"""The segments of a coaxial run along its axis: one surface each, with how high they reach and how wide they are at either end."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.grow import samples
from trunnion.recognize.holes.bores import radii
from trunnion.recognize.holes.sweep import arcs, holds
from trunnion.tolerance import ANGLE, SLIVER

POINTED = 0.9
"""A cone whose samples come nearer to the axis than this share of its boundary's smallest radius runs to its tip."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Segment:
    """One surface of a coaxial run: its faces (rows), heights `low` and `high` along the axis and radii there, in mm.

    `closes` is -1 when it closes the run at its low end (a bottom that looks up the axis), +1 at its high end, else 0. `half_angle` is a
    cone's in radians, `minor` a torus' or sphere's radius in mm, 0 for others; `bulges` when a torus rounds an edge off.
    """

    surface: str
    faces: tuple[int, ...]
    low: float
    high: float
    radius_low: float
    radius_high: float
    closes: int = 0
    half_angle: float = 0.0
    minor: float = 0.0
    bulges: bool = False

    @property
    def narrow(self) -> float:
        """The smaller radius."""
        return min(self.radius_low, self.radius_high)

    @property
    def wide(self) -> float:
        """The larger radius."""
        return max(self.radius_low, self.radius_high)

    def radius_at(self, height: float) -> float:
        """Return the radius (mm) of a cylinder, or of a cone with its slope, at a height."""
        rise = np.sign(self.radius_high - self.radius_low) * np.tan(self.half_angle)
        return float(self.radius_low + (height - self.low) * rise)

    def turned(self) -> Segment:
        """Return the segment as it is with the axis reversed."""
        return Segment(
            surface=self.surface,
            faces=self.faces,
            low=-self.high,
            high=-self.low,
            radius_low=self.radius_high,
            radius_high=self.radius_low,
            closes=-self.closes,
            half_angle=self.half_angle,
            minor=self.minor,
            bulges=self.bulges,
        )


def segments_of(graph: FaceGraph, faces: Sequence[int], frame: Frame) -> tuple[Segment, ...]:
    """Return the segments that coaxial faces (rows) form, from low to high along a frame's z.

    Faces of one surface are one segment where they overlap or touch along the axis, however many faces a file has made of it.
    """
    whole = set(faces)
    found: list[Segment] = []
    for face in faces:
        new = _segment(graph, (face,), frame, whole)
        same = [s for s in found if _continues(s, new)]
        merged = _segment(graph, (*(f for s in same for f in s.faces), face), frame, whole)
        found = [s for s in found if s not in same] + [merged]
    return tuple(sorted(found, key=lambda s: (s.low + s.high, s.faces)))


def _continues(a: Segment, b: Segment) -> bool:
    if (a.surface, a.closes, a.bulges) != (b.surface, b.closes, b.bulges):
        return False
    meets = min(a.high, b.high) > max(a.low, b.low) - SLIVER
    if a.surface in ("cylinder", "cone"):
        ends = ((b.low, b.radius_low), (b.high, b.radius_high))
        return meets and all(abs(a.radius_at(h) - radius) < SLIVER for h, radius in ends)
    return meets


def _segment(graph: FaceGraph, faces: tuple[int, ...], frame: Frame, whole: set[int]) -> Segment:
    maker = {"plane": _level, "cylinder": _cylinder, "cone": _cone}.get(
        graph.surface[faces[0]], _ball
    )
    return maker(graph, tuple(sorted(faces)), frame, whole)


def _level(graph: FaceGraph, faces: tuple[int, ...], frame: Frame, whole: set[int]) -> Segment:
    height = float(frame.to_local(graph.centre[faces[0]])[2])
    up = bool(graph.normal[faces[0]] @ frame.z > 0.0)
    inner = [
        e
        for f in faces
        for e in graph.edges_of[f]
        if (other := graph.across(e, f)) in whole
        and other not in faces
        and (graph.convexity[e] == CONVEX or graph.bend[other] > 0)
    ]
    outer = [e for f in faces for e in graph.edges_of[f] if graph.across(e, f) in whole]
    wide = float(radii(graph, outer, frame).max(initial=0.0))
    narrow = float(radii(graph, inner, frame).max(initial=0.0))
    return Segment(
        surface="plane",
        faces=faces,
        low=height,
        high=height,
        radius_low=narrow if up else wide,
        radius_high=wide if up else narrow,
        closes=0 if inner else -1 if up else 1,
    )


def _cylinder(graph: FaceGraph, faces: tuple[int, ...], frame: Frame, whole: set[int]) -> Segment:
    radius = float(np.mean(graph.radius[list(faces)]))
    heights = np.concatenate(
        [_heights(graph, faces, frame), *(_cut_heights(graph, f, frame) for f in faces)]
    )
    return Segment(
        surface="cylinder",
        faces=faces,
        low=float(heights.min()),
        high=float(heights.max()),
        radius_low=radius,
        radius_high=radius,
    )


def _cone(graph: FaceGraph, faces: tuple[int, ...], frame: Frame, whole: set[int]) -> Segment:
    first = faces[0]
    half = float(graph.minor[first])
    slope = float(np.tan(half)) * (1.0 if graph.axis[first] @ frame.z > 0.0 else -1.0)
    foot = float(frame.to_local(graph.axis_point[first])[2])
    heights = _heights(graph, faces, frame)
    edge = float(radii(graph, _edges(graph, faces), frame).min(initial=np.inf))
    inside = np.concatenate([samples(graph, f)[0] for f in faces])
    nearest = np.linalg.norm(frame.to_local(inside)[:, :2], axis=1).min(initial=np.inf)
    pointed = bool(edge < SLIVER or nearest < POINTED * edge)
    low, high = float(heights.min()), float(heights.max())
    if pointed:
        tip = foot - float(graph.radius[first]) / slope
        low, high = min(low, tip), max(high, tip)
    ends = [max(0.0, float(graph.radius[first]) + (h - foot) * slope) for h in (low, high)]
    return Segment(
        surface="cone",
        faces=faces,
        low=low,
        high=high,
        radius_low=ends[0],
        radius_high=ends[1],
        closes=0 if not pointed else -1 if slope > 0.0 else 1,
        half_angle=half,
    )


def _ball(graph: FaceGraph, faces: tuple[int, ...], frame: Frame, whole: set[int]) -> Segment:
    """Return the segment of a torus or a sphere; a sphere closes the run on the side of its rim that its samples lie on."""
    edges = _edges(graph, faces)
    rows = np.array(edges, dtype=np.int64)
    rim = frame.to_local(np.stack([graph.start[rows], graph.middle[rows], graph.end[rows]], axis=1))
    height, radius = rim[..., 2].ravel(), radii(graph, edges, frame).ravel()
    first = faces[0]
    sphere = graph.surface[first] == "sphere"
    inside = frame.to_local(np.concatenate([samples(graph, f)[0] for f in faces]))[:, 2]
    reach = np.concatenate([height, inside])
    low, high = float(reach.min()), float(reach.max())
    closes = 0 if not sphere else -1 if inside.mean() < height.mean() else 1
    at_low, at_high = float(radius[height.argmin()]), float(radius[height.argmax()])
    return Segment(
        surface=graph.surface[first],
        faces=faces,
        low=low,
        high=high,
        radius_low=0.0 if closes < 0 else at_low,
        radius_high=0.0 if closes > 0 else at_high,
        closes=closes,
        minor=float(graph.radius[first] if sphere else graph.minor[first]),
        bulges=bool(graph.bend[first] > 0),
    )


def _edges(graph: FaceGraph, faces: Iterable[int]) -> list[int]:
    return sorted({e for f in faces for e in graph.edges_of[f]})


def _heights(graph: FaceGraph, faces: Iterable[int], frame: Frame) -> Floats:
    """Return heights that include the ends of faces: of points on their edges, and of their boxes where the axis is one of the graph's.

    A box reaches past a face whose axis leans from the graph's, by no more than the sine of that times how far it is from the axis.
    """
    own = list(faces)
    rows = np.array(_edges(graph, own), dtype=np.int64)
    points = np.concatenate([graph.start[rows], graph.middle[rows], graph.end[rows]])
    found = [frame.to_local(points)[:, 2]]
    along = int(np.argmax(np.abs(frame.z)))
    if abs(frame.z[along]) > np.cos(ANGLE):
        corners = np.concatenate([graph.box_low[own], graph.box_high[own]]) - frame.origin
        far = np.linalg.norm(np.abs(np.delete(corners, along, axis=1)).max(axis=0))
        past = float(np.linalg.norm(np.delete(frame.z, along)) * far)
        reached = corners[:, along] * np.sign(frame.z[along])
        found.append(np.array([reached.min() + past, reached.max() - past]))
    return np.concatenate(found)


def _cut_heights(graph: FaceGraph, face: int, frame: Frame) -> Floats:
    """Return the highest and lowest heights at which inclined planes cut a cylinder.

    A plane n . (p - q) = 0 meets the cylinder of radius r at h = q_h - r (n_x cos t + n_y sin t - n . q_xy / r) / n_h: a sine of
    amplitude r |n_xy| / |n_h|, whose extremes count where the edge sweeps over them.
    """
    found = [np.empty(0)]
    for edge in graph.edges_of[face]:
        other = graph.across(edge, face)
        if graph.surface[other] != "plane":
            continue
        normal = frame.local_direction(graph.normal[other])
        if abs(normal[2]) < ANGLE:
            continue
        point = frame.to_local(graph.start[edge])
        middle = float(point @ normal / normal[2])
        lean = float(np.hypot(normal[0], normal[1]) / normal[2]) * float(graph.radius[face])
        falls = float(np.arctan2(normal[1], normal[0]))
        around = arcs(graph, [edge], frame)
        found.append(
            np.array(
                [
                    middle - sign * lean
                    for sign, at in ((1.0, falls), (-1.0, falls + np.pi))
                    if holds(around, at)
                ]
            )
        )
    return np.concatenate(found)
