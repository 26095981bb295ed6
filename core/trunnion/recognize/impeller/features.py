"""Features of an impeller: blades in their order round the axis, with what a planner wants to know of each, hub, bore and turned faces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from trunnion.model.feature import FaceRole, Feature, Size
from trunnion.recognize.holes.hole import COUNTERSINK, Hole
from trunnion.recognize.holes.sizes import depth, diameter
from trunnion.recognize.impeller.kinds import (
    BLADE,
    BORE,
    CHAMFER,
    FACE,
    HUB,
    PAIR,
    PLANE,
    PROFILE,
    SIDE,
    SPLITTER,
)
from trunnion.recognize.impeller.rows import BladeRows, in_degrees
from trunnion.recognize.impeller.turned import TurnedFaces
from trunnion.units import rounded


def blade_names(rows: BladeRows) -> tuple[str, ...]:
    """Return the names of the blades in order: blades and splitters are numbered each by themselves."""
    numbers = {BLADE: 0, SPLITTER: 0}
    found = []
    for row in rows.row:
        kind = BLADE if row == 0 else SPLITTER
        numbers[kind] += 1
        found.append(f"{kind}-{numbers[kind]:02}")
    return tuple(found)


def blade_features(rows: BladeRows) -> tuple[Feature, ...]:
    """Return the blades in their order round the axis.

    Attributes: `order` round the axis from 1, `angle` at the outlet (degrees about the frame's z from its x), `row` (0 main blades, then
    splitters by where they begin), `next` the blade after it, for splitters `channel`, the main blades that it stands between; `pair` on
    the two neighbours that represent all.
    """
    names = blade_names(rows)
    found = []
    for n, (blade, name) in enumerate(zip(rows.blades, names, strict=True)):
        attributes: dict[str, Size] = {
            "order": n + 1,
            "angle": rounded(in_degrees(float(rows.angle[n]))),
            "row": int(rows.row[n]),
            "next": names[(n + 1) % len(names)],
        }
        if rows.row[n]:
            attributes["channel"] = " ".join(names[k] for k in rows.channel(n))
        if n in rows.pair:
            attributes[PAIR] = True
        found.append(
            Feature(
                id=name,
                kind=SPLITTER if rows.row[n] else BLADE,
                faces=_faces(dict(blade.roles(rows.turns or 1.0))),
                attributes=attributes,
            )
        )
    return tuple(found)


def turned_features(turned: TurnedFaces, bore: Hole | None) -> tuple[Feature, ...]:
    """Return hub, bore, planes (from the inlet's to the back) and profile, as far as they are there."""
    found = []
    if turned.hub:
        found.append(Feature(id=f"{HUB}-01", kind=HUB, faces=_faces({FACE: turned.hub})))
    if bore is not None:
        found.append(_bore(bore))
    found.extend(
        Feature(id=f"{PLANE}-{n:02}", kind=PLANE, faces=_faces({FACE: rows}))
        for n, rows in enumerate(turned.planes, 1)
    )
    if turned.profile:
        found.append(
            Feature(id=f"{PROFILE}-01", kind=PROFILE, faces=_faces({FACE: turned.profile}))
        )
    return tuple(found)


def _bore(bore: Hole) -> Feature:
    """Return the bore: its depth goes from mouth to end, chamfers included."""
    faces = tuple(
        FaceRole(role=CHAMFER if role == COUNTERSINK else SIDE, face=row + 1)
        for segment, role in zip(bore.segments, bore.roles, strict=True)
        for row in segment.faces
    )
    sides = [s for s, role in zip(bore.segments, bore.roles, strict=True) if role == SIDE]
    sizes: dict[str, Size] = {
        "diameter": rounded(diameter(bore)),
        "depth": rounded(depth(bore)),
        "through": bore.through,
    }
    if sides:
        sizes["side_length"] = rounded(max(s.high for s in sides) - min(s.low for s in sides))
    return Feature(id=f"{BORE}-01", kind=BORE, faces=faces, sizes=sizes)


def _faces(rows: Mapping[str, Sequence[int]]) -> tuple[FaceRole, ...]:
    return tuple(FaceRole(role=role, face=r + 1) for role, own in rows.items() for r in own)
