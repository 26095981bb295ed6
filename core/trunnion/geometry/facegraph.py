"""The attributed face graph as plain arrays: faces with their surface, edges with convexity and dihedral angle. No CAD.

A face is row r, its tag r + 1 (`face N`, N the index of the face in the shape as read). An edge joins two face rows; the
seam of one face and an open edge are left out (`open_edges` counts the latter). Coordinates are the part's, as read,
until `in_frame` gives the same graph in another frame. To and from JSON, so that recognisers are tested without CAD.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame

SURFACES = (
    "plane",
    "cylinder",
    "cone",
    "sphere",
    "torus",
    "revolution",
    "extrusion",
    "spline",
    "other",
)
CURVES = ("line", "circle", "ellipse", "spline", "other")
CONCAVE, SMOOTH, CONVEX = -1, 0, 1


@dataclass(frozen=True, eq=False, kw_only=True)
class FaceGraph:
    """Faces and the edges between them.

    Faces (n):
        surface (n,) name from `SURFACES`; area (n,) mm2; centre (n, 3) a point inside the trimmed area; normal (n, 3) outward at
        the centre; axis_point, axis (n, 3) of cylinders, cones, spheres (point only), tori, revolutions, NaN elsewhere; radius (n,)
        of cylinder, sphere, torus (major) and of a cone at its axis point, minor (n,) radius of a torus, half angle (radians) of
        a cone, NaN elsewhere; bend (n,) +1 where the surface bulges out of the material (a boss), -1 where it is hollow (a bore, a
        fillet at a wall's foot), 0 for planes and what has both; box_low, box_high (n, 3).
    Samples (s): points spread over the trimmed faces, on curved ones at least 9, with outward normals.
        sample_face (s,) rows; sample_point, sample_normal (s, 3).
    Edges (m):
        edge_face (m, 2) rows; convexity (m,) -1 concave, 0 smooth, +1 convex; dihedral (m,) radians, pi is flat, below pi is
        convex (the angle through the material); length (m,); edge_loop (m, 2) index of the loop inside either face, 0 is the
        outer one; curve (m,) name from `CURVES`; start, middle, end (m, 3); curve_centre, curve_axis (m, 3) and curve_radius
        (m,) of circles, NaN elsewhere.
    """

    surface: tuple[str, ...]
    area: Floats
    centre: Floats
    normal: Floats
    axis_point: Floats
    axis: Floats
    radius: Floats
    minor: Floats
    bend: Ints
    box_low: Floats
    box_high: Floats
    sample_face: Ints
    sample_point: Floats
    sample_normal: Floats
    edge_face: Ints
    convexity: Ints
    dihedral: Floats
    length: Floats
    edge_loop: Ints
    curve: tuple[str, ...]
    start: Floats
    middle: Floats
    end: Floats
    curve_centre: Floats
    curve_axis: Floats
    curve_radius: Floats
    open_edges: int = 0

    def __post_init__(self) -> None:
        n, m, s = len(self.surface), len(self.curve), len(np.asarray(self.sample_face))
        for name in ("area", "radius", "minor"):
            object.__setattr__(self, name, floats(getattr(self, name), (n,), name, may_be_nan=True))
        for name in ("centre", "normal", "axis_point", "axis", "box_low", "box_high"):
            object.__setattr__(
                self,
                name,
                floats(getattr(self, name), (n, 3), name, may_be_nan=name.startswith("axis")),
            )
        for name in ("start", "middle", "end", "curve_centre", "curve_axis"):
            object.__setattr__(
                self,
                name,
                floats(getattr(self, name), (m, 3), name, may_be_nan=name.startswith("curve")),
            )
        for name in ("dihedral", "length", "curve_radius"):
            object.__setattr__(self, name, floats(getattr(self, name), (m,), name, may_be_nan=True))
        for name in ("sample_point", "sample_normal"):
            object.__setattr__(self, name, floats(getattr(self, name), (s, 3), name))
        object.__setattr__(self, "bend", ints(self.bend, (n,), "bend"))
        object.__setattr__(self, "sample_face", ints(self.sample_face, (s,), "sample_face"))
        object.__setattr__(self, "edge_face", ints(self.edge_face, (m, 2), "edge_face"))
        object.__setattr__(self, "edge_loop", ints(self.edge_loop, (m, 2), "edge_loop"))
        object.__setattr__(self, "convexity", ints(self.convexity, (m,), "convexity"))
        unknown = set(self.surface) - set(SURFACES) | set(self.curve) - set(CURVES)
        if unknown:
            raise ValueError(f"unknown surface or curve names: {', '.join(sorted(unknown))}")

    def __len__(self) -> int:
        return len(self.surface)

    @cached_property
    def edges_of(self) -> tuple[tuple[int, ...], ...]:
        """Edge rows of every face row."""
        lists: list[list[int]] = [[] for _ in self.surface]
        for e, (a, b) in enumerate(self.edge_face):
            lists[a].append(e)
            if b != a:
                lists[b].append(e)
        return tuple(tuple(x) for x in lists)

    def across(self, edge: int, face: int) -> int:
        """Return the row of the face on the other side of an edge."""
        a, b = self.edge_face[edge]
        return int(b if a == face else a)

    def neighbours(self, face: int, convexity: int | None = None) -> tuple[int, ...]:
        """Return the rows of the faces beside a face, each once, across edges of one convexity when given."""
        found = {
            self.across(e, face): None
            for e in self.edges_of[face]
            if convexity is None or self.convexity[e] == convexity
        }
        return tuple(found)

    def in_frame(self, frame: Frame) -> FaceGraph:
        """Return the same graph with every point and direction in a frame (boxes are those of the samples and edge points)."""
        moved = {
            n: frame.to_local(getattr(self, n))
            for n in (
                "centre",
                "axis_point",
                "sample_point",
                "start",
                "middle",
                "end",
                "curve_centre",
            )
        }
        turned = {
            n: frame.local_direction(getattr(self, n))
            for n in ("normal", "axis", "sample_normal", "curve_axis")
        }
        low, high = np.full((len(self), 3), np.inf), np.full((len(self), 3), -np.inf)
        points = [
            moved["sample_point"],
            *(moved[n] for n in ("start", "middle", "end") for _ in (0, 1)),
        ]
        owners = [self.sample_face, *(self.edge_face[:, side] for _ in range(3) for side in (0, 1))]
        for point, owner in zip(points, owners, strict=True):
            np.minimum.at(low, owner, point)
            np.maximum.at(high, owner, point)
        return replace(
            self,
            **moved,  # type: ignore[arg-type]
            **turned,  # type: ignore[arg-type]
            box_low=np.minimum(low, moved["centre"]),
            box_high=np.maximum(high, moved["centre"]),
        )

    def to_json(self) -> str:
        """Return the graph as JSON text; NaN is written as null."""
        plain = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        return json.dumps(plain, indent=1)

    @staticmethod
    def from_json(text: str) -> FaceGraph:
        """Return the graph that `to_json` wrote; raise `BadInput` when it is not one."""
        try:
            data = json.loads(text)
            ready = {
                k: tuple(v) if k in ("surface", "curve") else _filled(v) for k, v in data.items()
            }
            return FaceGraph(**ready)  # type: ignore[arg-type]
        except (ValueError, TypeError, KeyError) as reason:
            raise BadInput(f"not a face graph: {reason}") from None


def _plain(value: object) -> object:
    if isinstance(value, np.ndarray):
        return (
            [_plain(row) for row in value]
            if value.ndim > 1
            else [None if v != v else v for v in value.tolist()]
        )
    return list(value) if isinstance(value, tuple) else value


def _filled(value: object) -> object:
    if isinstance(value, list):
        return [_filled(v) for v in value]
    return float("nan") if value is None else value
