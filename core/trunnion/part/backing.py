"""The backing of faces that enclose no material: what makes a solid of them, for machining them from one side.

Every connected piece is closed by walls that fall from its free edges against the side's direction, and by a copy of itself below all
faces. A plane `thickness` under the lowest point cuts these off. The faces keep their tags; what the backing adds has tags after them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.gp import gp_Trsf, gp_Vec
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.part.build import box_blank, compound
from trunnion.part.open_side import ADVICE, OpenSide, pieces_of
from trunnion.part.part import Part
from trunnion.part.topology.identity import (
    Shape,
    edges_of,
    face_index,
    faces_of,
    shells_of,
    solids_of,
)
from trunnion.part.topology.measure import area_of, open_edges, volume_of
from trunnion.settings import digest

MARGIN = 1.0
"""mm: how far walls go on under the plane that cuts them off, and that plane's box past them."""
DECIMALS = 6
"""Decimals of the plane's height in mm: the kernel's boxes are no finer."""
VOLUME = 1e-2
"""Share by which a backing's volume may differ from what stands over its plane, reckoned from triangles."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Ground:
    """Lowest corner and highest corner (3,) of the faces in the side's frame, and the height of the plane under them."""

    side: OpenSide
    low: Floats
    high: Floats
    base: float

    @property
    def drop(self) -> Floats:
        """The way (3,) from the faces to their copies: these lie below the plane, wherever the faces are."""
        return -(float(self.high[2]) - self.base + MARGIN) * self.side.direction

    def box(self) -> Shape:
        """Return a solid box that holds all above the plane."""
        low, high = self.low - MARGIN, self.high + MARGIN
        return box_blank(self.side.frame(), [low[0], low[1], self.base], high)


def backed(part: Part, side: OpenSide, thickness: float) -> Part:
    """Return the closed part of open faces and their backing, `Part.backing`; its base lies `thickness` mm under their lowest point.

    Raises `BadInput` when the CAD kernel can't make a valid one.
    """
    ground = _ground(part, side, thickness)
    try:
        made = [_solid(faces, ground) for faces in _pieces(part, side)]
    except Standard_Failure as reason:
        raise BadInput(_failure(type(reason).__name__)) from None
    own = {tag: face for _, faces in made for tag, face in faces.items()}
    shape = made[0][0] if len(made) == 1 else compound([solid for solid, _ in made])
    volume = volume_of(shape)
    _check(part, side, ground, shape, volume)
    index = face_index(shape)
    position = {index.FindIndex(face): tag for tag, face in own.items()}
    if 0 in position or len(position) != len(part.tags):
        raise BadInput(_failure("it changes the faces"))
    extra = [n for n in range(1, index.Extent() + 1) if n not in position]
    position |= {n: part.n_faces + k for k, n in enumerate(extra, 1)}
    facts = replace(
        part.facts,
        digest=digest(part.digest, side.direction, sorted(side.turned), thickness),
        n_faces=part.n_faces + len(extra),
        is_closed=True,
        area=area_of(shape),
        volume=volume,
        tags=tuple(position[n] for n in range(1, index.Extent() + 1)),
        backing=tuple(range(part.n_faces + 1, part.n_faces + len(extra) + 1)),
    )
    walls = [index.FindKey(n) for n in extra]
    return Part(facts, shape, compound([*faces_of(part.as_read), *walls]))


def _ground(part: Part, side: OpenSide, thickness: float) -> _Ground:
    """Return the plane under a part's faces and the box around them in the side's frame."""
    low, high = part.box(side.frame())
    return _Ground(side=side, low=low, high=high, base=round(float(low[2]) - thickness, DECIMALS))


def _pieces(part: Part, side: OpenSide) -> list[dict[int, Shape]]:
    """Return the faces of every connected piece by tag, turned to look to the side."""
    piece = pieces_of(part.graph(), part.tags)
    found: list[dict[int, Shape]] = [{} for _ in range(int(piece.max()) + 1)]
    for tag in part.tags:
        face: Shape = part.face_shape(tag)
        found[piece[tag - 1]][tag] = face.Reversed() if tag in side.turned else face
    return found


def _solid(faces: dict[int, Shape], ground: _Ground) -> tuple[Shape, dict[int, Shape]]:
    """Return the solid of one piece's faces down to the plane, and the faces in it by tag."""
    down = gp_Trsf()
    down.SetTranslation(gp_Vec(*ground.drop.tolist()))
    below = TopLoc_Location(down)
    walls = BRepPrimAPI_MakePrism(
        compound(_free_edges(compound(list(faces.values())))), gp_Vec(*ground.drop.tolist())
    )
    sewing = BRepBuilderAPI_Sewing(tolerance.FITTED)
    for face in (*faces.values(), *faces_of(walls.Shape())):
        sewing.Add(face)
    for face in faces.values():
        sewing.Add(face.Moved(below).Reversed())
    sewing.Perform()
    shells = shells_of(sewing.SewedShape())
    if len(shells) != 1 or open_edges(shells[0]):
        raise BadInput(_failure("its walls don't meet the faces all along their rim"))
    whole = BRepBuilderAPI_MakeSolid(shells[0]).Solid()
    BRepLib.OrientClosedSolid_s(whole)
    cut = BRepAlgoAPI_Common(whole, ground.box())
    solids = solids_of(cut.Shape())
    if len(solids) != 1:
        raise BadInput(_failure("the plane under them doesn't cut it off"))
    kept = {}
    for tag, face in faces.items():
        sewn = sewing.ModifiedSubShape(face) if sewing.IsModifiedSubShape(face) else face
        kept[tag] = next(iter(cut.Modified(sewn)), sewn)
    return solids[0], kept


def _free_edges(shape: Shape) -> list[Shape]:
    """Return the edges of a shape with a face on one side only; neither seams nor degenerate ones."""
    owners = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(shape, TopAbs_EDGE, TopAbs_FACE, owners)
    found = []
    for edge in edges_of(shape):
        faces = owners.FindFromKey(edge)
        alone = faces.Extent() == 1 and not BRep_Tool.Degenerated_s(edge)
        if alone and not BRep_Tool.IsClosed_s(edge, TopoDS.Face_s(faces.First())):
            found.append(edge)
    return found


def _check(part: Part, side: OpenSide, ground: _Ground, shape: Shape, volume: float) -> None:
    """Raise `BadInput` unless a backing is closed, valid, and as large as what stands over its plane."""
    corners = side.frame().to_local(part.mesh().corners().reshape(-1, 3)).reshape(-1, 3, 3)
    a, b, c = np.moveaxis(corners, 1, 0)
    plan = 0.5 * np.cross(b - a, c - a)[:, 2]
    turned = np.isin(part.mesh().face, sorted(side.turned))
    over = (corners[:, :, 2].mean(axis=1) - ground.base) * np.where(turned, -plan, plan)
    expected = float(over.sum())
    if open_edges(shape) or not BRepCheck_Analyzer(shape).IsValid():
        raise BadInput(_failure("the solid is not valid"))
    if abs(volume - expected) > VOLUME * expected:
        raise BadInput(_failure(f"it has {volume:.6g} mm3 in place of {expected:.6g}"))


def _failure(why: str) -> str:
    return f"the faces enclose no material and can't be given a backing ({why}); {ADVICE}"
