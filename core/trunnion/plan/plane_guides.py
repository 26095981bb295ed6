"""Guide lines of plane curves: their points, the faces that their elements lie on, and how the elements of walls' follow each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.faces_of_points import nearest_faces
from trunnion.geometry.mesh import Mesh
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.model.guides import GuideChain, GuideCurve, GuideKind, LinkRelation

ON_FACE = 0.25
"""mm beside the chord error of the part's triangles that elements of guide lines are off their faces at most."""

ABOVE_FOOT = 1.0
"""mm over its foot that a wall's face is looked for, on walls that are so high."""


@dataclass(frozen=True, slots=True, eq=False)
class GuideSpace:
    """Where guide lines are: `to_world` takes points (n, 3) of a drive's frame to the part's coordinates, `faces_at` returns which of some
    faces (tags) points (n, 3) there lie on, 0 where on none."""

    to_world: Callable[[Floats], Floats]
    faces_at: Callable[[Floats, tuple[int, ...]], Ints]


class MeshSource(Protocol):
    """What is asked of a part to find its faces."""

    @property
    def picture_chord(self) -> float:
        """Chord error (mm) of the triangles that pictures show: they are made anyway."""

    def mesh(self, chord: float) -> Mesh:
        """Return triangles of the solid within a chord error (mm)."""


def guide_space(part: MeshSource, to_world: Callable[[Floats], Floats]) -> GuideSpace:
    """Return where the guide lines on a part are, by its triangles: they are made when a face is first looked for."""

    def faces_at(points: Floats, faces: tuple[int, ...]) -> Ints:
        if not faces:
            return np.zeros(len(points), dtype=np.int64)
        chord = part.picture_chord
        return nearest_faces(part.mesh(chord), points, faces, ON_FACE + chord)

    return GuideSpace(to_world, faces_at)


def wall_faces_on(
    curve: Curve, foot: float, top: float, faces: tuple[int, ...], space: GuideSpace
) -> Ints:
    """Return the face (m,) of each segment of a wall's curve, by its middle a little over the wall's foot; heights in mm."""
    segments = curve.segments()
    middles = segments.at(np.arange(len(segments)), 0.5 * segments.length)
    z = foot + min(ABOVE_FOOT, 0.5 * (top - foot))
    return space.faces_at(space.to_world(_at_height(middles, z)), faces)


def wall_line(
    kind: GuideKind, curve: Curve, z: float, on: Ints, faces: tuple[int, ...], space: GuideSpace
) -> GuideCurve:
    """Return the guide line of a wall's curve, the part on its right, at a height in mm; `on` has the face (m,) of each segment.

    Segments that are tangent on one face are one element.
    """
    corners, relations = relations_along(curve)
    after = np.roll(on, -1)[: len(relations)]
    meets = np.array([r is not LinkRelation.TANGENT for r in relations], dtype=bool)
    kept = meets | (on[: len(relations)] != after)
    if curve.closed and not kept.any():
        # A closed line of one face all round is one element, which goes on to itself.
        kept[-1] = True
    return GuideCurve(
        chain=GuideChain(
            kind=kind,
            closed=curve.closed,
            faces=faces,
            on=_elements(on, kept, curve.closed),
            relations=tuple(r for r, is_kept in zip(relations, kept, strict=True) if is_kept),
        ),
        points=space.to_world(_at_height(curve.sampled(tolerance.PICTURE), z)),
        corners=space.to_world(_at_height(corners[kept], z)),
    )


def area_lines(
    area: Region, z: float, faces: tuple[int, ...], space: GuideSpace
) -> tuple[GuideCurve, ...]:
    """Return the rims of an area at a height in mm."""
    return tuple(
        _plain(
            GuideKind.AREA,
            _at_height(curve.sampled(tolerance.PICTURE), z),
            faces,
            space,
            closed=True,
        )
        for curve in area.curves()
    )


def line_along(
    kind: GuideKind, points: Floats, faces: tuple[int, ...], space: GuideSpace
) -> GuideCurve:
    """Return the guide line through points (n, 3) of a drive's frame."""
    return _plain(kind, points, faces, space, closed=False)


def relations_along(curve: Curve) -> tuple[Floats, tuple[LinkRelation, ...]]:
    """Return where segments of a wall's curve meet (k, 2), and how the next follows there: where the curve turns left the next wall stands
    in the tool's way, where it turns right the tool goes past the end of this one."""
    parts = curve.segments()
    first = np.arange(len(parts) if curve.closed else len(parts) - 1)
    after = (first + 1) % len(parts)
    before_it = parts.directions(first, parts.length[first])
    after_it = parts.directions(after, np.zeros(len(after)))
    sine = before_it[:, 0] * after_it[:, 1] - before_it[:, 1] * after_it[:, 0]
    angle = np.arctan2(sine, (before_it * after_it).sum(axis=1))
    relations = tuple(
        LinkRelation.TANGENT
        if abs(a) <= tolerance.TANGENT
        else LinkRelation.TO
        if a > 0.0
        else LinkRelation.PAST
        for a in angle.tolist()
    )
    return parts.end[first], relations


def _elements(on: Ints, kept: Bools, closed: bool) -> tuple[int, ...]:
    """Return the face of each element: of the segment that ends at each link that is kept, and of the last one of an open line."""
    faces = on[: len(kept)][kept].tolist()
    return tuple(faces if closed else [*faces, int(on[-1])])


def _plain(
    kind: GuideKind, points: Floats, faces: tuple[int, ...], space: GuideSpace, *, closed: bool
) -> GuideCurve:
    return GuideCurve(
        chain=GuideChain(kind=kind, closed=closed, faces=faces),
        points=space.to_world(points),
        corners=np.zeros((0, 3)),
    )


def _at_height(points: Floats, z: float) -> Floats:
    return np.column_stack([points, np.full(len(points), z)])
