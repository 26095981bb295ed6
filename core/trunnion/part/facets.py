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
    bound: how far the triangles may be from the faces, mm.
    """

    tag: Ints
    points: Floats
    triangles: Ints
    face: Ints
    bound: float = 0.0

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

    def corners(self) -> Floats:
        """Return the corners of every triangle (t, 3, 3)."""
        return self.points[self.triangles]


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
            raise OutOfMemory(f"{part.name} needs more than {MOST_TRIANGLES} triangles at a chord error of {chord:g} mm: allow a larger one")
        bound = max(bound, _off(shape, p, t, chord))
        points.append(p)
        triangles.append(t + count)
        owners.append(np.full(len(t), row))
        count += len(p)
    BRepTools.Clean_s(part.shape)
    return Facets(tag=np.array(tags), points=frame.to_local(np.concatenate(points)), triangles=np.concatenate(triangles),
                  face=np.concatenate(owners), bound=bound)


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
    across = np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), tolerance.COINCIDENT**2)
    off = np.abs(((on - shares @ ends) * across[:, None]).sum(axis=2)).max()
    return UNMEASURED * max(float(off), chord)
