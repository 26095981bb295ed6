"""The least distance between two sets of faces, with the two points that are so near: the width of a channel, the thickness of a wall.

Points spread over both sets and along their edges find where the faces come near each other; from each of these places the kernel's
projections onto the trimmed faces go to and fro until neither point moves on. A distance found is one between points of the faces, so
it is never too small; only what comes near in a spot finer than the spread could be missed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import WORLD
from trunnion.part.part import Part
from trunnion.part.shape.exact import ExactFace
from trunnion.progress import NO_PROGRESS, Progress

SPREAD = 41
"""Positions along either parameter of a face, and along each of its edges."""
STARTS = 6
"""Places that are followed: the nearest ones that lie a spacing of the spread apart."""
TO_AND_FRO = 60
"""Projections from each place at most; most end after ten."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceGap:
    """The least distance (mm) of two sets of faces, between a point (3,) of each, and the tags of the two faces."""

    distance: float
    first: Floats
    second: Floats
    faces: tuple[int, int]


def least_gap(
    part: Part, first: Iterable[int], second: Iterable[int], progress: Progress = NO_PROGRESS
) -> FaceGap:
    """Return the least distance of two sets of faces (tags); raise `BadInput` where one is empty or not of the chosen solid."""
    clouds = [_cloud(part, tuple(tags), progress) for tags in (first, second)]
    (a, tags_a), (b, tags_b) = clouds
    neighbours = cKDTree(b).query(a)
    away, nearest = (np.asarray(values) for values in neighbours)
    found: FaceGap | None = None
    for row in _starts(a, away):
        pair = _followed(
            part, a[row], b[nearest[row]], int(tags_a[row]), int(tags_b[nearest[row]]), progress
        )
        if found is None or pair.distance < found.distance:
            found = pair
    assert found is not None
    return found


def _starts(points: Floats, away: Floats) -> list[int]:
    """Return the rows of points with the least distances, each the nearest in its surroundings."""
    reach = 2.0 * float(np.linalg.norm(np.ptp(points, axis=0))) / SPREAD
    kept: list[int] = []
    for row in np.argsort(away, kind="stable").tolist():
        if len(kept) == STARTS:
            break
        if all(np.linalg.norm(points[row] - points[k]) > reach for k in kept):
            kept.append(row)
    return kept


def _cloud(part: Part, tags: tuple[int, ...], progress: Progress) -> tuple[Floats, Floats]:
    """Return points (k, 3) spread over faces and along their edges, and the tag (k,) of the face that each is of."""
    points, owners = [], []
    for tag in tags:
        progress.check()
        exact = ExactFace(part, tag, WORLD)
        u0, u1, v0, v1 = exact.bounds()
        share = (np.arange(SPREAD) + 0.5) / SPREAD
        grid = np.stack(
            np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0), indexing="ij"), axis=-1
        ).reshape(-1, 2)
        cloud = [exact.at(grid[exact.inside(grid)]).point, exact.rim(SPREAD)]
        points.extend(cloud)
        owners.append(np.full(sum(len(c) for c in cloud), tag))
    if not points:
        raise BadInput("the distance of faces needs at least one face on either side")
    return np.vstack(points), np.concatenate(owners)


def _followed(
    part: Part, a: Floats, b: Floats, tag_a: int, tag_b: int, progress: Progress
) -> FaceGap:
    """Return the gap that two points lead to when each in turn is moved to the point of its face that is nearest to the other."""
    shapes = [part.face_shape(tag_a), part.face_shape(tag_b)]
    ends = [a, b]
    best = float(np.linalg.norm(a - b))
    for n in range(TO_AND_FRO):
        progress.check()
        moving = n % 2
        nearer = _projected(shapes[moving], ends[1 - moving])
        distance = best if nearer is None else float(np.linalg.norm(nearer - ends[1 - moving]))
        # The kernel may miss a face's nearest point: the one before is kept then.
        if nearer is None or distance > best - tolerance.PARAMETRIC:
            if n:
                break
            continue
        ends[moving], best = nearer, distance
    return FaceGap(distance=best, first=ends[0], second=ends[1], faces=(tag_a, tag_b))


def _projected(face: Any, point: Floats) -> Floats | None:
    """Return the point of a trimmed face that is nearest to a point, None where the kernel finds none."""
    found = BRepExtrema_DistShapeShape(
        BRepBuilderAPI_MakeVertex(gp_Pnt(*point.tolist())).Vertex(), face
    )
    if not found.IsDone() or not found.NbSolution():
        return None
    return np.array(found.PointOnShape2(1).Coord())
