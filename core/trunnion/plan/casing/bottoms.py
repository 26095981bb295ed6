"""The bottoms of a casing with the bosses that stand on them, made of its features and its face graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion.geometry.facegraph import CONVEX, SMOOTH, FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.recognize.casing.boss_sizes import with_fillets
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.foot import FootBounds, bounds
from trunnion.recognize.casing.frame import turned_faces
from trunnion.recognize.casing.kinds import BOSS, BOTTOM, HOLE, POCKET, ROOT_FILLET, SIDE, TOP
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import BossOutline, boss_outline


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CasingBoss:
    """A boss with its outline (pieces say their fillets) and its height over the ground (mm), in the casing's frame."""

    feature: Feature
    outline: BossOutline
    height: float

    @property
    def id(self) -> str:
        """The feature's name."""
        return self.feature.id

    def bounds(self, meridian: Meridian, toe: bool) -> FootBounds:
        """Return the bounds of its foot on ground, with the toe of its fillet or without."""
        return bounds(self.outline, meridian, toe)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CasingBottom:
    """A pocket's bottom: its meridian, the bosses that stand on it or in a recess of it, and whether it runs round the casing.

    A recess says which pocket's bottom it is sunk into, or else, in `sunk_into`, by their tags the turned faces of a profile.
    """

    pocket: Feature
    meridian: Meridian
    bosses: tuple[CasingBoss, ...]
    full_circle: bool
    recess_of: str = ""
    sunk_into: tuple[int, ...] = ()

    @property
    def is_recess(self) -> bool:
        """Whether it is the bottom of a recess."""
        return bool(self.recess_of or self.sunk_into)


def casing_faces(found: Recognition, graph: FaceGraph) -> CasingFaces:
    """Return a casing's faces in its frame as recognition saw them."""
    return CasingFaces(
        graph=graph.in_frame(found.frame),
        turned=turned_faces(graph, found.frame),
        holes=frozenset(t - 1 for f in found.of_kind(HOLE) for t in f.tags),
    )


def casing_bottoms(found: Recognition, graph: FaceGraph) -> tuple[CasingBottom, ...]:
    """Return the bottoms of all pockets; raise `BadInput` for a part that has none."""
    faces = casing_faces(found, graph)
    pockets = [p for p in found.of_kind(POCKET) if p.with_role(BOTTOM)]
    if not pockets:
        raise BadInput(
            "no pocket with a turned bottom was recognised: there are no regions to choose between turning and milling"
        )
    around = {p.id: _around(faces, p) for p in pockets}
    hosts = {p.id: _host(around[p.id], p, pockets) for p in pockets}
    meridians = {p.id: Meridian.of(faces, [t - 1 for t in p.with_role(BOTTOM)]) for p in pockets}
    on_bottom = {p.id: _bosses_on(found, faces, p, meridians[p.id]) for p in pockets}
    return tuple(
        CasingBottom(
            pocket=p,
            meridian=meridians[p.id],
            bosses=tuple(
                sorted(
                    (b for q in pockets if q is p or hosts[q.id] == p.id for b in on_bottom[q.id]),
                    key=lambda b: b.id,
                )
            ),
            full_circle=any(faces.runs_round(t - 1) for t in p.with_role(BOTTOM)),
            recess_of=hosts[p.id],
            sunk_into=() if hosts[p.id] else _profile(faces, p, around[p.id]),
        )
        for p in pockets
    )


def _around(faces: CasingFaces, pocket: Feature) -> frozenset[int]:
    """Return the rows of what a recess is sunk into: over the convex edges of its walls, or over what rounds or breaks these; nothing for a
    bottom that runs round."""
    if any(faces.runs_round(t - 1) for t in pocket.with_role(BOTTOM)):
        return frozenset()
    graph, own = faces.graph, {t - 1 for t in pocket.tags}
    rims = {n for t in pocket.with_role(SIDE) for n in graph.neighbours(t - 1, CONVEX)} - own
    broken = {r for r in _rounded(faces, pocket, own) | rims if not faces.turned[r]}
    beyond = {n for r in broken for sense in (CONVEX, SMOOTH) for n in graph.neighbours(r, sense)}
    return frozenset(rims | {n for n in beyond if faces.turned[n]} - own)


def _rounded(faces: CasingFaces, pocket: Feature, own: set[int]) -> set[int]:
    """Return the rows of roundings that walls of a recess run into smoothly at their upper edges."""
    graph = faces.graph
    beside = {n for t in pocket.with_role(SIDE) for n in graph.neighbours(t - 1, SMOOTH)} - own
    return {n for n in beside if graph.bend[n] > 0}


def _host(around: frozenset[int], pocket: Feature, pockets: Sequence[Feature]) -> str:
    """Return the pocket whose bottom a recess is sunk into; empty where it is none."""
    for other in pockets:
        if other is not pocket and around & {t - 1 for t in other.with_role(BOTTOM)}:
            return other.id
    return ""


def _profile(faces: CasingFaces, pocket: Feature, around: frozenset[int]) -> tuple[int, ...]:
    """Return by their tags the turned faces that a recess of no pocket is sunk into: none where it is open to what runs round beside it, or
    where nothing but faces square to the axis is around it."""
    if any(faces.runs_round(t - 1) for t in pocket.with_role(SIDE)):
        return ()
    return tuple(sorted(r + 1 for r in around if faces.turned[r] and not faces.across[r]))


def _bosses_on(
    found: Recognition, faces: CasingFaces, pocket: Feature, meridian: Meridian
) -> list[CasingBoss]:
    made = []
    for feature in found.of_kind(BOSS):
        if feature.attributes.get("on") != pocket.id or not feature.with_role(TOP):
            continue
        boss = BossFaces(
            top=tuple(t - 1 for t in feature.with_role(TOP)),
            sides=tuple(t - 1 for t in feature.with_role(SIDE)),
            fillets=tuple(t - 1 for t in feature.with_role(ROOT_FILLET)),
            ground=tuple(t - 1 for t in pocket.with_role(BOTTOM)),
        )
        outline = with_fillets(faces, boss, boss_outline(faces, boss), meridian)
        height = feature.sizes.get("height", 0.0)
        made.append(
            CasingBoss(
                feature=feature,
                outline=outline,
                height=float(height) if isinstance(height, (int, float)) else 0.0,
            )
        )
    return made
