"""Features of a casing with names, roles and sizes: bosses round the axis from z up, holes after them, then pockets and profiles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import FaceRole, Feature, Size
from trunnion.recognize.casing.boss_sizes import boss_attributes, boss_sizes
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.kinds import (
    BOSS,
    BOTTOM,
    FACE,
    HOLE,
    POCKET,
    PROFILE,
    RESTRICT,
    ROOT_FILLET,
    SIDE,
    TOP,
)
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import boss_outline
from trunnion.recognize.casing.pockets import PocketFaces, find_pockets, find_profiles
from trunnion.recognize.casing.turned_sizes import pocket_sizes, profile_sizes
from trunnion.recognize.holes.features import hole_feature, pattern_attributes
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.patterns import hole_patterns
from trunnion.units import degrees

DECIMALS = 3
"""Decimals of mm and degrees that features are ordered by: beyond is noise of the file."""


def made_features(
    faces: CasingFaces,
    bosses: Sequence[BossFaces],
    holes: Sequence[Hole],
    frame: Frame,
    graph: FaceGraph,
) -> tuple[Feature, ...]:
    """Return all features; `faces` are in the casing's frame, `graph` and `holes` in the part's coordinates."""
    order = sorted(range(len(bosses)), key=lambda n: _around(faces, bosses[n].top))
    bosses = [bosses[n] for n in order]
    pockets = sorted(find_pockets(faces, bosses), key=lambda p: _along(faces, p.bottom))
    taken = {r for b in bosses for r in b.rows} | {r for p in pockets for r in p.rows}
    profiles = sorted(find_profiles(faces, taken), key=lambda p: _along(faces, p))
    boss_ids = _ids(BOSS, len(bosses))
    made = [
        *_bosses(faces, bosses, boss_ids, pockets),
        *_pockets(faces, pockets),
        *(
            Feature(
                id=id,
                kind=PROFILE,
                faces=_roles({FACE: rows}),
                **profile_sizes(faces, rows),
            )
            for id, rows in zip(_ids(PROFILE, len(profiles)), profiles, strict=True)
        ),
    ]
    return (*made, *_holes(graph, holes, frame, made))


def _ids(kind: str, count: int) -> list[str]:
    width = max(2, len(str(count)))
    return [f"{kind}-{n:0{width}d}" for n in range(1, count + 1)]


def _roles(rows: dict[str, Iterable[int]]) -> tuple[FaceRole, ...]:
    return tuple(FaceRole(role=role, face=r + 1) for role, own in rows.items() for r in own)


def _bosses(
    faces: CasingFaces,
    bosses: Sequence[BossFaces],
    ids: Sequence[str],
    pockets: Sequence[PocketFaces],
) -> Iterable[Feature]:
    pocket_of = {n: k for k, pocket in enumerate(pockets) for n in pocket.bosses}
    names = _ids(POCKET, len(pockets))
    for n, (id, boss) in enumerate(zip(ids, bosses, strict=True)):
        pocket = pocket_of[n]
        outline = boss_outline(faces, boss)
        meridian = Meridian.of(faces, pockets[pocket].bottom)
        yield Feature(
            id=id,
            kind=BOSS,
            faces=_roles({TOP: boss.top, SIDE: boss.sides, ROOT_FILLET: boss.fillets}),
            sizes=boss_sizes(faces, boss, outline, meridian),
            attributes={**boss_attributes(outline, meridian), "on": names[pocket]},
        )


def _pockets(faces: CasingFaces, pockets: Sequence[PocketFaces]) -> Iterable[Feature]:
    for id, pocket in zip(_ids(POCKET, len(pockets)), pockets, strict=True):
        yield Feature(
            id=id,
            kind=POCKET,
            faces=_roles({BOTTOM: pocket.bottom, SIDE: pocket.side, RESTRICT: pocket.restrict}),
            **pocket_sizes(faces, pocket),
        )


def _holes(
    graph: FaceGraph, holes: Sequence[Hole], frame: Frame, others: Sequence[Feature]
) -> Iterable[Feature]:
    def at_mouth(hole: Hole) -> tuple[float, ...]:
        x, y, z = frame.to_local(hole.mouth).tolist()
        angle = round(degrees(float(np.arctan2(y, x))) % 360.0, DECIMALS) % 360.0
        return round(z, DECIMALS), angle, round(float(np.hypot(x, y)), DECIMALS)

    own = sorted(holes, key=at_mouth)
    owners: dict[int, str] = {}
    for feature in others:
        for tag in feature.tags:
            owners.setdefault(tag - 1, feature.id)
    made = [hole_feature(h, id, frame) for h, id in zip(own, _ids(HOLE, len(own)), strict=True)]
    names = {f: feature.id for h, feature in zip(own, made, strict=True) for f in h.faces}
    patterns = pattern_attributes(hole_patterns(graph, own, frame))
    for n, (hole, feature) in enumerate(zip(own, made, strict=True)):
        around: dict[str, Size] = {}
        carrier = next((owners[f] for f in hole.opens_in if f in owners), None)
        if carrier is not None:
            around["on"] = carrier
        crossed = sorted({names[f] for f in hole.crosses if f in names})
        if crossed:
            around["crosses"] = " ".join(crossed)
        yield replace(feature, attributes={**feature.attributes, **around, **patterns.get(n, {})})


def _around(faces: CasingFaces, rows: Sequence[int]) -> tuple[float, ...]:
    x, y, z = faces.graph.centre[rows[0]].tolist()
    return round(degrees(float(np.arctan2(y, x))) % 360.0, DECIMALS) % 360.0, round(z, DECIMALS)


def _along(faces: CasingFaces, rows: Sequence[int]) -> tuple[float, ...]:
    mine = list(rows)
    return (
        round(float(faces.graph.box_low[mine, 2].min()), DECIMALS),
        -round(float(np.linalg.norm(faces.graph.centre[mine, :2], axis=1).max()), DECIMALS),
    )
