"""What lies just past the rim of an area: a strip of the faces beside it that passes go on over, so that no ridge stays where areas meet.

Two areas are cut by themselves, and the nearest passes on both sides of the rim between them may be a whole stepover away from it. So
passes are made as far as a stepover past the rim. Beyond a sharp edge there is nothing to go on over.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.sheet.sheet import sheet_of
from trunnion.geometry.sheet.skin import Skin

SMOOTH = math.cos(math.radians(45.0))
"""Cosine of the most that a strip turns away from the rim: it may run up a tight fillet, but not round an edge."""
CLOSE = 0.25
"""Of the strip's width: how far apart positions along the rim are that distances are measured from."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OverrunStrip:
    """The strip of a width (mm) past the rim of an area; the rim's positions (k, 3) and the outward unit normals (k, 3) of the area
    there."""

    skin: Skin
    position: Floats
    normal: Floats
    width: float

    @staticmethod
    def of(skin: Skin, faces: tuple[int, ...], width: float) -> OverrunStrip:
        """Return the strip beside faces (tags) of a skin."""
        sheet = sheet_of(skin, faces)
        position, normal = [np.zeros((0, 3))], [np.zeros((0, 3))]
        for rim in sheet.rims():
            a, b = rim, np.roll(rim, -1)
            size = np.linalg.norm(sheet.points[b] - sheet.points[a], axis=1)
            count = np.maximum(np.ceil(size / (CLOSE * width)), 1.0).astype(np.int64)
            row, number = items_of(count)
            share = number / count[row]
            for x, out in ((sheet.points, position), (sheet.normals, normal)):
                out.append(x[a[row]] + share[:, None] * (x[b[row]] - x[a[row]]))
        joined = np.concatenate(normal)
        return OverrunStrip(
            skin=skin,
            position=np.concatenate(position),
            normal=joined / np.linalg.norm(joined, axis=1, keepdims=True),
            width=width,
        )

    def has(self, contact: Floats, facet: Ints) -> Bools:
        """Return for contacts (n, 3) on triangles (n,) of the skin, -1: none, whether they lie in the strip, or as near to the rim
        inside."""
        found = np.zeros(len(contact), dtype=bool)
        rows = np.flatnonzero(facet >= 0)
        if len(rows) and len(self.position):
            away, nearest = (
                np.asarray(x)
                for x in cKDTree(self.position).query(
                    contact[rows], distance_upper_bound=self.width
                )
            )
            rows, nearest = rows[np.isfinite(away)], nearest[np.isfinite(away)]
            corners = self.skin.normals[self.skin.triangles[facet[rows]]].sum(axis=1)
            along = (corners * self.normal[nearest]).sum(axis=1)
            found[rows] = along >= SMOOTH * np.linalg.norm(corners, axis=1)
        return found
