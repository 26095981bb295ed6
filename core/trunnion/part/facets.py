"""A part's faces as triangles, for whatever has no closed form: free-form faces, and tools whose axis leans or turns.

Planes come as few triangles; on curved faces only the chord error counts, never an angle, which makes them as few as that error allows.
The mesher now and then goes beyond what it was asked, so its work is measured against the faces' own surfaces, at the middles of triangles
and of their edges, and done again where it is too coarse; `Facets.bound` says what came of it.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput, OutOfMemory
from trunnion.geometry.arrays import Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame
from trunnion.progress import QUIET, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

MOST_TRIANGLES = 4_000_000
"""About 1 GB with the tree over them."""
MEASURED = 512
"""Triangles of a free-form face whose distance from it is measured; of plainer faces it is all."""
BETWEEN = 1.07
"""What a triangle may be further off than at its middle and those of its edges: 1.066 at most for an even bend (searched)."""
UNMEASURED = 1.25
"""What other triangles of a free-form face may be further off than those that were measured."""
TRIES = 4
"""Times that the mesher is asked again, each time for less."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Facets:
    """Triangles of trimmed faces in a frame. f faces in rows, v points, t triangles.

    tag (f,) as `Surfaces.tag`; points (v, 3) mm; triangles (t, 3) rows of points, anticlockwise seen from outside; face (t,) rows of tag.
    bound: how far the triangles may be from the faces, mm. whole: no face was left out.
    """

    tag: Ints
    points: Floats
    triangles: Ints
    face: Ints
    bound: float = 0.0
    whole: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "tag", ints(self.tag, (None,), "facets tag"))
        object.__setattr__(self, "points", floats(self.points, (None, 3), "facets points"))
        object.__setattr__(self, "triangles", ints(self.triangles, (None, 3), "facets triangles"))
        object.__setattr__(self, "face", ints(self.face, (len(self.triangles),), "facets face"))

    @staticmethod
    def of_mesh(points: Floats, triangles: Ints, face: Ints, tag: Ints, bound: float = 0.0) -> Facets:
        """Return facets of a mesh, as of fixtures: points (v, 3), triangles (t, 3), face (t,) rows of tag (f,)."""
        return Facets(tag=tag, points=points, triangles=triangles, face=face, bound=bound)

    def moved(self, frame: Frame, other: Frame) -> Facets:
        """Return the same facets, given in one frame, in another one."""
        return replace(self, points=other.to_local(frame.to_world(self.points)))

    def of_faces(self, rows: Ints) -> Facets:
        """Return the facets of some faces; all faces keep their rows."""
        keep = np.isin(self.face, rows)
        return replace(self, triangles=self.triangles[keep], face=self.face[keep], whole=False)


def facets_of(part: Part, frame: Frame, chord: float = tolerance.FACET_CHORD, progress: Progress = QUIET,
              only: Collection[int] | None = None) -> Facets:
    """Return a part's faces as triangles in a frame, curved ones within a chord error (mm) of about `chord`.

    Rows are those of `Surfaces.tag`; with `only`, faces of other tags come without triangles. Raises `BadInput` for a face that the mesher
    can't do and `OutOfMemory` beyond `MOST_TRIANGLES`.
    """
    from OCP.BRepTools import BRepTools

    tags = [tag for tag in part.tags if part.face_shape(tag) is not None]
    BRepTools.Clean_s(part.shape)
    bound, count, made = 0.0, 0, 0
    points, triangles, owners = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    wanted = [(row, tag) for row, tag in enumerate(tags) if only is None or tag in only]
    for row, tag in progress.over(wanted, "Opening the faces into triangles"):
        p, t, off = _opened(part.face_shape(tag), chord)
        if not len(t):
            raise BadInput(f"face {tag} of {part.name} can't be opened into triangles: heal the part, or leave the face out of the solid")
        made += len(t)
        if made > MOST_TRIANGLES:
            BRepTools.Clean_s(part.shape)
            raise OutOfMemory(f"{part.name} needs more than {MOST_TRIANGLES} triangles at a chord error of {chord:g} mm: "
                              "allow a larger one")
        bound = max(bound, off)
        points.append(p)
        triangles.append(t + count)
        owners.append(np.full(len(t), row))
        count += len(p)
    BRepTools.Clean_s(part.shape)
    return Facets(tag=np.array(tags), points=frame.to_local(np.concatenate(points)), triangles=np.concatenate(triangles),
                  face=np.concatenate(owners), bound=bound, whole=len(wanted) == len(tags))


def facet_samples(facets: Facets, rows: Ints, spacing: float) -> tuple[Ints, Floats, Floats, Floats]:
    """Return samples of some faces about `spacing` mm apart: face (s,) rows, point and outward normal (s, 3), area (s,) mm2.

    Triangles wider than that are cut into equal ones; of those that share a cell of a grid one stands for all.
    """
    chosen = np.isin(facets.face, rows)
    corners, face = facets.points[facets.triangles[chosen]], facets.face[chosen]
    normal, area = _normals(corners)
    width = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1, initial=0.0)
    cuts = np.maximum(np.ceil(width / spacing), 1.0).astype(np.int64)
    parts = [_middles(corners[cuts == n], int(n)) for n in np.unique(cuts)]
    owner = np.concatenate([np.zeros(0, np.int64), *(np.repeat(np.flatnonzero(cuts == n), n * n) for n in np.unique(cuts))])
    point, share = np.vstack([np.zeros((0, 3)), *parts]), (area / cuts**2)[owner]
    cell = np.column_stack([face[owner], np.floor(point / spacing).astype(np.int64)])
    _, group = np.unique(cell, axis=0, return_inverse=True)
    total: Floats = np.bincount(group, share).astype(np.float64)
    middle = np.column_stack([np.bincount(group, share * point[:, k]).astype(np.float64) for k in range(3)])
    middle = middle / np.maximum(total, tolerance.COINCIDENT**2)[:, None]
    away = np.linalg.norm(point - middle[group], axis=1)
    order = np.lexsort((away, group))
    first = order[np.flatnonzero(np.diff(group[order], prepend=-1))]
    return face[owner[first]], point[first], normal[owner[first]], total


def _normals(corners: Floats) -> tuple[Floats, Floats]:
    """Return unit normals (t, 3) and areas (t,) of triangles (t, 3, 3)."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    return across / np.maximum(size, tolerance.COINCIDENT**2)[:, None], 0.5 * size


def _middles(corners: Floats, n: int) -> Floats:
    """Return the middles (t n n, 3) of the n n equal triangles that each of t triangles (t, 3, 3) is cut into."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    up = i + j < n
    # Upright ones at (i, j) with i + j < n; the others stand on their heads in between.
    v = np.concatenate([i[up] + 1.0 / 3.0, i[i + j < n - 1] + 2.0 / 3.0]) / n
    w = np.concatenate([j[up] + 1.0 / 3.0, j[i + j < n - 1] + 2.0 / 3.0]) / n
    shares = np.column_stack([1.0 - v - w, v, w])
    return np.einsum("sk,tkd->tsd", shares, corners).reshape(-1, 3)


def _opened(shape: Any, chord: float) -> tuple[Floats, Ints, float]:
    """Return a face's points and triangles, and how far they may be from it."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.IMeshTools import IMeshTools_Parameters

    from trunnion.part.tessellate import face_triangles

    how = IMeshTools_Parameters()
    how.Deflection, how.Angle, how.Relative = chord, np.pi, False
    for _ in range(TRIES):
        BRepMesh_IncrementalMesh(shape, how)
        points, triangles = face_triangles(shape)
        off, beyond = _off(shape, points, triangles)
        if off <= chord:
            break
        how.Deflection *= 0.8 * chord / off
    return points, triangles, off * beyond


def _off(shape: Any, points: Floats, triangles: Ints) -> tuple[float, float]:
    """Return how far a face's triangles are from its surface where that was measured, and what factor holds elsewhere."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType as Kind

    surface = BRepAdaptor_Surface(shape)
    kind = surface.GetType()
    if kind == Kind.GeomAbs_Plane or not len(triangles):
        return 0.0, 1.0
    plain = {Kind.GeomAbs_Cylinder: _from_cylinder, Kind.GeomAbs_Cone: _from_cone, Kind.GeomAbs_Sphere: _from_sphere,
             Kind.GeomAbs_Torus: _from_torus}
    if kind in plain:
        return float(np.abs(plain[kind](surface, _MIDDLES @ points[triangles])).max()), BETWEEN
    return _from_free(surface, shape, points, triangles), BETWEEN * UNMEASURED


_MIDDLES = np.array([[2.0, 2.0, 2.0], [3.0, 3.0, 0.0], [0.0, 3.0, 3.0], [3.0, 0.0, 3.0]]) / 6.0
"""Shares of the corners in the middles of a triangle and of its edges."""


def _about(position: Any, points: Floats) -> tuple[Floats, Floats]:
    """Return the distances of points from an axis, and their heights along it."""
    away = points - np.array(position.Location().Coord())
    axis = np.array(position.Direction().Coord())
    height = away @ axis
    return np.linalg.norm(away - height[..., None] * axis, axis=-1), height


def _from_cylinder(surface: Any, points: Floats) -> Floats:
    return _about(surface.Cylinder().Position(), points)[0] - surface.Cylinder().Radius()


def _from_cone(surface: Any, points: Floats) -> Floats:
    cone = surface.Cone()
    rho, height = _about(cone.Position(), points)
    return (rho - cone.RefRadius()) * np.cos(cone.SemiAngle()) - height * np.sin(cone.SemiAngle())


def _from_sphere(surface: Any, points: Floats) -> Floats:
    return np.hypot(*_about(surface.Sphere().Position(), points)) - surface.Sphere().Radius()


def _from_torus(surface: Any, points: Floats) -> Floats:
    torus = surface.Torus()
    rho, height = _about(torus.Position(), points)
    return np.hypot(rho - torus.MajorRadius(), height) - torus.MinorRadius()


def _from_free(surface: Any, shape: Any, points: Floats, triangles: Ints) -> float:
    """Return how far the largest triangles of a face, and evenly chosen others, are from its surface along their normals."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    corners = points[triangles]
    size = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    largest = np.argsort(-size, kind="stable")[:MEASURED // 2]
    chosen = triangles[np.union1d(largest, np.arange(0, len(triangles), -(-2 * len(triangles) // MEASURED)))]
    mesh = BRep_Tool.Triangulation_s(shape, TopLoc_Location())
    place = {int(n): mesh.UVNode(int(n) + 1).Coord() for n in np.unique(chosen)}
    uv = _MIDDLES @ np.array([[place[int(n)] for n in row] for row in chosen])
    on = np.array([surface.Value(float(u), float(v)).Coord() for u, v in uv.reshape(-1, 2)]).reshape(-1, 4, 3)
    ends = points[chosen]
    return float(np.abs(((on - _MIDDLES @ ends) * _normals(ends)[0][:, None]).sum(axis=2)).max())
