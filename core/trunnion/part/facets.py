"""A part's faces as triangles, for whatever has no closed form: free-form faces, and tools whose axis leans or turns.

Planes come as few triangles; on curved faces only the chord error counts, never an angle, which makes them as few as that error allows.
`Facets.bound` is measured: the faces' own surfaces are asked at the middles and edge middles of triangles, the largest ones first.
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
MEASURED = 64
"""Triangles of a curved face whose distance from it is measured."""
UNMEASURED = 1.25
"""What others may be further off by: of the panels' tori, the worst of all was 1.05 of the worst of these."""


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

    from trunnion.part.tessellate import face_triangles

    tags = [tag for tag in part.tags if part.face_shape(tag) is not None]
    BRepTools.Clean_s(part.shape)
    mesher, bound, count, made = _mesher(chord), 0.0, 0, 0
    points, triangles, owners = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    wanted = [(row, tag) for row, tag in enumerate(tags) if only is None or tag in only]
    for row, tag in progress.over(wanted, "Opening the faces into triangles"):
        shape = part.face_shape(tag)
        mesher(shape)
        p, t = face_triangles(shape)
        if not len(t):
            raise BadInput(f"face {tag} of {part.name} can't be opened into triangles: heal the part, or leave the face out of the solid")
        made += len(t)
        if made > MOST_TRIANGLES:
            BRepTools.Clean_s(part.shape)
            raise OutOfMemory(f"{part.name} needs more than {MOST_TRIANGLES} triangles at a chord error of {chord:g} mm: "
                              "allow a larger one")
        bound = max(bound, _off(shape, p, t, chord))
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


def _mesher(chord: float) -> Any:
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.IMeshTools import IMeshTools_Parameters

    how = IMeshTools_Parameters()
    # On tori the kernel's mesher goes a quarter beyond what it was asked (measured). An angle of half a turn never counts.
    how.Deflection, how.Angle, how.Relative = 0.8 * chord, np.pi, False
    return lambda shape: BRepMesh_IncrementalMesh(shape, how)


def _off(shape: Any, points: Floats, triangles: Ints, chord: float) -> float:
    """Return how far a face's triangles may be from it: nothing for a plane, else what the largest ones are and a quarter more."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_Plane
    from OCP.TopLoc import TopLoc_Location

    surface = BRepAdaptor_Surface(shape)
    if surface.GetType() == GeomAbs_Plane:
        return 0.0
    corners = points[triangles]
    size = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    largest = np.argsort(-size, kind="stable")[:MEASURED // 2]
    chosen = triangles[np.union1d(largest, np.arange(0, len(triangles), max(1, 2 * len(triangles) // MEASURED)))]
    mesh = BRep_Tool.Triangulation_s(shape, TopLoc_Location())
    place = {int(n): mesh.UVNode(int(n) + 1).Coord() for n in np.unique(chosen)}
    shares = np.array([[1.0, 1.0, 1.0], [1.5, 1.5, 0.0], [0.0, 1.5, 1.5], [1.5, 0.0, 1.5]]) / 3.0
    uv = shares @ np.array([[place[int(n)] for n in row] for row in chosen])
    on = np.array([surface.Value(float(u), float(v)).Coord() for u, v in uv.reshape(-1, 2)]).reshape(-1, 4, 3)
    ends = points[chosen]
    off = np.abs(((on - shares @ ends) * _normals(ends)[0][:, None]).sum(axis=2)).max()
    return UNMEASURED * max(float(off), chord)
