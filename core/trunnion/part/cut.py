"""Cuts one face of a part in two, by a plane or by a curve drawn on it: the pieces are faces with tags of their own.

The pieces' common edges cut the whole solid, so that the faces around stay joined to them and the part stays as closed as it was.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TypeVar

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepAlgoAPI import BRepAlgoAPI_Splitter
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Dir, gp_Pln, gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.Standard import Standard_Failure
from OCP.TopTools import TopTools_IndexedMapOfShape, TopTools_ListOfShape

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.cut import Cut
from trunnion.geometry.dimension import Dimension
from trunnion.part.build import compound
from trunnion.part.face_curve import DrawnCurve
from trunnion.part.part import Part
from trunnion.part.topology.identity import (
    Shape,
    edges_of,
    face_index,
    faces_of,
    shells_of,
    solids_of,
)
from trunnion.part.topology.measure import open_edges

T = TypeVar("T")
TURNED = tuple(
    tolerance.COINCIDENT * np.array(way)
    for way in ((0.0, 0.0, 0.0), (0.9, 0.5, 0.7), (-0.7, 0.9, 0.5))
)
"""What is added to the unit normal of a plane, try by try: the CAD kernel misses a plane that is off a symmetric place by about its own
confusion, as across the seam of a cylinder."""
REACH = 1.0
"""mm that a position of a drawn cut may be away from the face: a click on a coarse picture's triangles is."""


def divided(part: Part, cut: Cut) -> Part:
    """Return the part with one face cut: what lies behind the plane or left of the path keeps its tag, the rest takes the next free ones.

    Several pieces on one side are faces of their own, the largest first. Raises `BadInput` when the part has no such face, or when the cut
    doesn't divide it.
    """
    where = f"face {cut.face} of {part.name}"
    face = part.face_shape(cut.face)
    if face is None:
        raise BadInput(
            f"{where}: the chosen solid has no such face; its faces are {min(part.tags)} to {max(part.tags)}"
        )
    try:
        as_read = faces_of(part.as_read)
        read_pieces = _pieces(as_read[cut.face - 1], cut, where)
        own_pieces = _matching(read_pieces, _pieces(face, cut, where), where)
        shape, images = _with_edges(
            part.shape, _common_edges(own_pieces), [part.face_shape(t) for t in part.tags]
        )
    except Standard_Failure as reason:
        raise BadInput(
            f"{where}: the CAD kernel can't make this cut ({type(reason).__name__}); move it a little"
        ) from None
    new_tags = [cut.face, *range(part.n_faces + 1, part.n_faces + len(read_pieces))]
    pieces = _matching(own_pieces, images[part.tags.index(cut.face)], where)
    tagged = {t: found[0] for t, found in zip(part.tags, images, strict=True)} | dict(
        zip(new_tags, pieces, strict=True)
    )
    tags = _tags(shape, tagged)
    if len(tags) != len(tagged) or (
        part.is_closed and (open_edges(shape) or not BRepCheck_Analyzer(shape).IsValid())
    ):
        raise BadInput(f"{where}: the part would not be whole after this cut; move it a little")
    facts = part.facts
    after = replace(
        facts,
        n_faces=facts.n_faces + len(new_tags) - 1,
        tags=tags,
        names=_inherited(facts.names, new_tags),
        entities=_inherited(facts.entities, new_tags),
        colours=_inherited(facts.colours, new_tags),
        dimensions=tuple(_of_pieces(d, new_tags) for d in facts.dimensions),
    )
    as_read[cut.face - 1] = read_pieces[0]
    return Part(after, shape, compound([*as_read, *read_pieces[1:]]))


def _pieces(face: Shape, cut: Cut, where: str) -> list[Shape]:
    """Return the pieces of a face, those that keep the tag's side first, the larger first on either side."""
    positions = np.array(cut.places, dtype=np.float64).reshape(-1, 3)
    curve = None if cut.is_plane else DrawnCurve(face, positions, REACH, where)
    if curve is None:
        pieces = _cut_by_plane(face, positions[0], np.array(cut.normal))
    else:
        pieces = faces_of(_split(face, [curve.edge()]).Shape())
    if len(pieces) < 2:
        raise BadInput(
            f"{where}: the cut doesn't divide it; "
            + ("move or turn the plane" if cut.is_plane else "draw it from edge to edge, or closed")
        )
    measured = [_measured(p) for p in pieces]
    if curve is None:
        stays = [
            float((centre - positions[0]) @ np.array(cut.normal)) < 0.0 for _, centre in measured
        ]
    else:
        stays = [curve.is_left(p) for p in pieces]
    order = sorted(
        range(len(pieces)),
        key=lambda k: (
            not stays[k],
            -round(measured[k][0], 6),
            *np.round(measured[k][1], 6).tolist(),
        ),
    )
    return [pieces[k] for k in order]


def _cut_by_plane(face: Shape, position: Floats, normal: Floats) -> list[Shape]:
    """Return the faces that a plane parts a face into; the face itself where it doesn't."""
    unit = normal / np.linalg.norm(normal)
    for turn in TURNED:
        pieces = faces_of(_split(face, [_plane(face, position, unit + turn)]).Shape())
        # A plane that only touches the face must not part a sliver off it by being turned.
        least = tolerance.AREA if turn.any() else 0.0
        if len(pieces) > 1 and min(_measured(p)[0] for p in pieces) > least:
            return pieces
    return [face]


def _plane(face: Shape, position: Floats, normal: Floats) -> Shape:
    """Return a plane face that is larger than the face to be cut."""
    box = Bnd_Box()
    BRepBndLib.Add_s(face, box)
    x0, y0, z0, x1, y1, z1 = box.Get()
    low, high = np.array([x0, y0, z0]), np.array([x1, y1, z1])
    normal = normal / np.linalg.norm(normal)
    middle = 0.5 * (low + high)
    foot = middle - ((middle - position) @ normal) * normal
    reach = float(np.linalg.norm(high - low))
    plane = gp_Pln(gp_Pnt(*foot.tolist()), gp_Dir(*normal.tolist()))
    return BRepBuilderAPI_MakeFace(plane, -reach, reach, -reach, reach).Face()


def _split(shape: Shape, tools: Iterable[Shape]) -> BRepAlgoAPI_Splitter:
    """Return the kernel's splitter after it has cut a shape, which stays as it was."""
    made = BRepAlgoAPI_Splitter()
    made.SetArguments(_listed([shape]))
    made.SetTools(_listed(tools))
    made.SetNonDestructive(True)
    made.SetToFillHistory(True)
    made.Build()
    return made


def _with_edges(
    shape: Shape, edges: list[Shape], own: list[Shape]
) -> tuple[Shape, list[list[Shape]]]:
    """Return a part's shape cut by edges on its faces, and what each of its faces has become."""
    made = _split(shape, edges)
    images = []
    for face in own:
        after = list(made.Modified(face))
        images.append(after or [face])
    found = made.Shape()
    inside = solids_of(found) if solids_of(shape) else shells_of(found) if shells_of(shape) else []
    return (inside[0] if len(inside) == 1 else found), images


def _common_edges(pieces: list[Shape]) -> list[Shape]:
    """Return the edges that two pieces share."""
    seen, common = TopTools_IndexedMapOfShape(), TopTools_IndexedMapOfShape()
    for piece in pieces:
        for edge in edges_of(piece):
            (common if seen.Contains(edge) else seen).Add(edge)
    return [common.FindKey(n) for n in range(1, common.Extent() + 1)]


def _matching(wanted: list[Shape], pieces: list[Shape], where: str) -> list[Shape]:
    """Return pieces in the order of those wanted, each the one whose centre is nearest."""
    centres = np.array([_measured(p)[1] for p in pieces])
    picked = [int(np.linalg.norm(centres - _measured(w)[1], axis=1).argmin()) for w in wanted]
    if sorted(picked) != list(range(len(pieces))):
        raise BadInput(f"{where}: the cut runs along an edge; move it a little")
    return [pieces[k] for k in picked]


def _measured(piece: Shape) -> tuple[float, Floats]:
    """Return the area of a piece and the centre of that area."""
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(piece, found, tolerance.FITTED)
    return float(found.Mass()), np.array(found.CentreOfMass().Coord())


def _tags(shape: Shape, tagged: dict[int, Shape]) -> tuple[int, ...]:
    """Return the tag of each of a shape's own faces, in their order; fewer when one has none."""
    index = face_index(shape)
    positions = {index.FindIndex(face): tag for tag, face in tagged.items()}
    return tuple(positions[n] for n in range(1, index.Extent() + 1) if n in positions)


def _inherited(words: Mapping[int, T], tags: list[int]) -> dict[int, T]:
    return {**words, **{t: words[tags[0]] for t in tags[1:] if tags[0] in words}}


def _of_pieces(dimension: Dimension, tags: list[int]) -> Dimension:
    """Return a dimension of a cut face as one of all its pieces: each keeps the size of the whole."""
    if tags[0] not in dimension.faces:
        return dimension
    return replace(dimension, faces=tuple(sorted({*dimension.faces, *tags})))


def _listed(shapes: Iterable[Shape]) -> TopTools_ListOfShape:
    found = TopTools_ListOfShape()
    for shape in shapes:
        found.Append(shape)
    return found
