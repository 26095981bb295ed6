"""The skin of a part: triangles so fine that a path over them is a path over the faces themselves."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from trunnion.geometry.frame import Frame
from trunnion.geometry.skin import Skin
from trunnion.part.facets import facets_of
from trunnion.progress import QUIET, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part


def skin_of(part: Part, frame: Frame, chord: float, progress: Progress = QUIET, fine: Collection[int] | None = None) -> Skin:
    """Return the skin of a whole part in a frame, within a chord error (mm) on the faces of the tags in `fine` (all when not given)."""
    facets = facets_of(part, frame, chord, progress)
    a, b, c = np.moveaxis(facets.points[facets.triangles], 1, 0)
    normals = np.zeros_like(facets.points)
    for k in range(3):
        np.add.at(normals, facets.triangles[:, k], np.cross(b - a, c - a))
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, size, out=np.zeros_like(normals), where=size > 0.0)
    return Skin(points=facets.points, normals=normals, triangles=facets.triangles, face=facets.tag[facets.face], bound=facets.bound)
