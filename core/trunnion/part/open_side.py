"""The side that faces which enclose no material are machined from: the one that sees all of them, none twice.

Seen along a direction d, a triangle of area a with outward normal n covers a (n . d). A connected piece of faces looks to the side where
the sum of that is positive. A direction serves when no piece has more than `AWAY` of its area turned away from it, and when the plan areas
of the triangles don't overlap by more than `OVERLAP`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.shape.tessellate import tessellated
from trunnion.part.topology.graph import face_graph
from trunnion.part.topology.identity import faces_of
from trunnion.tolerance import MESH_ANGLE, PICTURE
from trunnion.units import percent, radians

if TYPE_CHECKING:
    from trunnion.geometry.mesh import Mesh
    from trunnion.part.part import Part

AUTOMATIC, NORMALS = "auto", "normals"
SIDES = {
    "+z": (0.0, 0.0, 1.0),
    "+x": (1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
    "-x": (-1.0, 0.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
}
"""The axes of the part's file by their names, in the order in which equally good ones are taken."""
TILT = radians(1.0)
"""A triangle that leans over by less than this stands upright: triangles lean by as much on a face whose rim is upright, in radians."""
AWAY = 0.01
"""Share of a piece's area that may look away from its direction: triangles at upright rims do; the kernel's solid is checked."""
OVERLAP = 2e-3
"""Share of the plan area that faces may cover twice."""
AS_GOOD = 0.9
"""Share of the largest plan area from which on an axis of the file is taken: who drew a part along an axis meant it."""
DECIMALS = 6
"""Decimals to which plan areas are compared, as shares of the area: below that they are noise."""
ADVICE = (
    "choose open.side, export the faces of one side alone (trunnion export), or close the gaps in the CAD system where this is to "
    "be a solid"
)
"""What to do with faces that no single side sees."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenSide:
    """A direction (3,), a unit vector in the part's coordinates from the material to the tool, and the tags of the faces that have to be
    turned over to look there."""

    direction: Floats
    turned: frozenset[int]

    def frame(self) -> Frame:
        """Return the frame whose z is the direction and whose x is nearest to the file's x, or to its y where that is along z."""
        for axis in (WORLD.x, WORLD.y):
            across = axis - (axis @ self.direction) * self.direction
            length = float(np.linalg.norm(across))
            if length > 0.5:
                return Frame(np.zeros(3), across / length, self.direction)
        raise AssertionError("no direction is along x and y at once")


def pieces_of(graph: FaceGraph, tags: tuple[int, ...]) -> Ints:
    """Return the number of the connected piece that each face (n,) belongs to; -1 for faces of other tags."""
    piece = np.full(len(graph), -1)
    for tag in tags:
        border, number = [tag - 1], int(piece.max()) + 1
        while border:
            row = border.pop()
            if piece[row] < 0:
                piece[row] = number
                border += [graph.across(e, row) for e in graph.edges_of[row]]
    return piece


class _Seen:
    """Triangles of open faces with what each covers; `piece` (t,) is the piece of each, `away` (3,) areas that pieces turn off."""

    def __init__(self, part: Part) -> None:
        self.mesh: Mesh = tessellated(
            part.shape, {t: part.face_shape(t) for t in part.tags}, PICTURE, MESH_ANGLE
        )
        self.normal, self.area = self.mesh.normals(), self.mesh.areas()
        self.by_face = pieces_of(part.graph(), part.tags)
        self.piece = self.by_face[self.mesh.face - 1]
        self.vector = np.stack(
            [np.bincount(self.piece, self.area * self.normal[:, k]) for k in range(3)], axis=1
        )

    def signs(self, direction: Floats) -> Floats:
        """Return +1 or -1 for each piece: whether it looks towards a direction as it is."""
        return np.where(self.vector @ direction < 0.0, -1.0, 1.0)

    def away(self, direction: Floats, sign: Floats) -> Bools:
        """Return which triangles (t,) look away from a direction."""
        rise = sign[self.piece] * (self.normal @ direction)
        return np.asarray(rise < -np.sin(TILT))

    def share_away(self, direction: Floats, sign: Floats) -> float:
        """Return the largest share of a piece's area that looks away from a direction."""
        gone = np.bincount(
            self.piece, self.area * self.away(direction, sign), minlength=len(self.vector)
        )
        return float((gone / np.bincount(self.piece, self.area)).max())

    def covered(self, direction: Floats, sign: Floats) -> float:
        """Return the plan area as a share of the area, rounded."""
        return round(float(sign @ (self.vector @ direction)) / float(self.area.sum()), DECIMALS)

    def overlap(self, side: OpenSide) -> float:
        """Return the share of the plan area that is covered more than once."""
        plan = side.frame().to_local(self.mesh.corners().reshape(-1, 3)).reshape(-1, 3, 3)
        triangles = shapely.polygons(plan[:, :, :2])
        each = float(shapely.area(triangles).sum())
        return 1.0 - float(shapely.union_all(triangles).area) / each if each else 0.0


def open_side(part: Part, wanted: str = AUTOMATIC) -> OpenSide:
    """Return the side that open faces are machined from: a name of `SIDES`, `auto`, or `normals`, to which the normals of the file point.

    Only `normals` trusts the file's normals. Raises `BadInput` when faces fold back under others, or look to several sides.
    """
    seen = _Seen(part)
    own = _file_signs(part, seen) if wanted == NORMALS else None
    rated = []
    for rank, direction in enumerate(_candidates(seen, wanted, own)):
        sign = seen.signs(direction) if own is None else own
        rated.append(
            _Rated(
                away=seen.share_away(direction, sign),
                covered=seen.covered(direction, sign),
                rank=rank,
                direction=direction,
                sign=sign,
            )
        )
    return _checked(part, seen, _best(rated), wanted)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Rated:
    """A direction (3,), the sides (+1 or -1) that pieces look from there, the largest share of a piece that looks away, the plan area over
    the area, and its rank among equals."""

    away: float
    covered: float
    rank: int
    direction: Floats
    sign: Floats


def _candidates(seen: _Seen, wanted: str, own: Floats | None) -> list[Floats]:
    """Return the directions to try: one axis, or all of them and the mean normals of pieces as they are, or turned to face each axis."""
    if wanted in SIDES:
        return [np.array(SIDES[wanted])]
    axes = [np.array(axis) for axis in SIDES.values()]
    means = [
        sign @ seen.vector for sign in ([seen.signs(a) for a in axes] if own is None else [own])
    ]
    return [*axes, *(m / np.linalg.norm(m) for m in means if np.linalg.norm(m) > 0.0)]


def _best(rated: list[_Rated]) -> _Rated:
    """Return the best direction: it sees all, else the most; axes go before means that see little more."""
    whole = [r for r in rated if r.away <= AWAY and r.covered > 0.0]
    if not whole:
        return min(rated, key=lambda r: (round(r.away, DECIMALS), -r.covered, r.rank))
    enough = AS_GOOD * max(r.covered for r in whole)
    axes = [r for r in whole if r.rank < len(SIDES) and r.covered >= enough]
    return min(axes or whole, key=lambda r: (-r.covered, r.rank))


def _checked(part: Part, seen: _Seen, best: _Rated, wanted: str) -> OpenSide:
    """Return the side of a direction; raise `BadInput` where it doesn't see every face, or sees one under another."""
    side = OpenSide(
        direction=best.direction,
        turned=frozenset(t for t in part.tags if best.sign[seen.by_face[t - 1]] < 0.0),
    )
    cause = f"the faces enclose no material and can't be machined from {_words(wanted)}"
    if best.away > AWAY:
        tags = np.unique(seen.mesh.face[seen.away(best.direction, best.sign)]).tolist()
        raise BadInput(
            f"{cause}: {percent(best.away)} of a piece looks away there ({_named(tags)}); {ADVICE}"
        )
    if best.covered <= 0.0 or seen.overlap(side) > OVERLAP:
        raise BadInput(f"{cause}: some lie under others, or are seen edge on; {ADVICE}")
    return side


def _words(wanted: str) -> str:
    return f"the side {wanted}" if wanted in SIDES else "any one side"


def _named(tags: list[int], most: int = 5) -> str:
    """Return some faces by their tags."""
    more = f" and {len(tags) - most} more" if len(tags) > most else ""
    return f"face{'s' if len(tags) > 1 else ''} {', '.join(map(str, tags[:most]))}{more}"


def _file_signs(part: Part, seen: _Seen) -> Floats:
    """Return for each piece +1 where most of its area looks as in the file, else -1: sewing and healing may have turned it over."""
    read = face_graph(
        part.as_read, dict(enumerate(faces_of(part.as_read), 1)), len(faces_of(part.as_read))
    )
    graph, rows = part.graph(), np.array(part.tags) - 1
    same = np.sign((read.normal[rows] * graph.normal[rows]).sum(axis=1))
    return np.where(np.bincount(seen.by_face[rows], graph.area[rows] * same) < 0.0, -1.0, 1.0)
