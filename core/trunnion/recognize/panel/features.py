"""Features with names, roles and sizes, numbered by where they lie: from the front row to the back one, in a row along x."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from trunnion.findings import Finding, face_tags, info, warning
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.model.feature import FaceRole, Feature, Size
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.pockets.blends import is_rounding
from trunnion.recognize.panel.pockets.rules import GraphFeatures, Island, Pocket
from trunnion.recognize.panel.side import PanelSide
from trunnion.recognize.panel.sizes import (
    boss_sizes,
    corner_radius,
    island_sizes,
    pocket_sizes,
    rib_sizes,
)
from trunnion.recognize.panel.slicing.confirm import (
    ConfirmedPocket,
    confirm,
    refusal,
    shape_remarks,
)
from trunnion.units import rounded

T = TypeVar("T")
ROW = 0.01
"""mm: centres whose y differs by less lie in one row."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SideFeatures:
    """The features of one side and what is to be reported of them."""

    features: tuple[Feature, ...]
    findings: tuple[Finding, ...]


class FeatureNumbers:
    """Hands out ids, counting by kind."""

    def __init__(self) -> None:
        self._used: dict[str, int] = {}

    def next(self, kind: str) -> str:
        """Return the next id of a kind."""
        self._used[kind] = self._used.get(kind, 0) + 1
        return f"{kind}-{self._used[kind]:02d}"


def in_rows(things: Iterable[T], centre: Callable[[T], tuple[float, float]]) -> list[T]:
    """Return things sorted by rows of y, then x; a row holds what differs in y by rounding only."""
    ordered = sorted(things, key=lambda t: centre(t)[1])
    rows: list[list[T]] = []
    for thing in ordered:
        if rows and centre(thing)[1] - centre(rows[-1][-1])[1] < ROW:
            rows[-1].append(thing)
        else:
            rows.append([thing])
    return [t for row in rows for t in sorted(row, key=lambda t: centre(t)[0])]


def make_features(
    view: PanelSide, shown: GraphFeatures, main: FaceGraph, numbers: FeatureNumbers
) -> SideFeatures:
    """Return pockets, islands, ribs and bosses of one side; `main` is the graph in the recognition's frame."""

    def middle(faces: Sequence[int]) -> tuple[float, float, float]:
        low, high = main.box_low[list(faces)].min(axis=0), main.box_high[list(faces)].max(axis=0)
        x, y, z = (0.5 * (low + high)).tolist()
        return x, y, z

    def in_plan(faces: Sequence[int]) -> tuple[float, float]:
        return middle(faces)[:2]

    checked = in_rows(
        [confirm(view, p) for p in shown.pockets],
        lambda c: in_plan(c.pocket.floors or c.pocket.sides),
    )
    named = [(numbers.next("open_pocket" if c.open else "pocket"), c) for c in checked]
    ids = {floor: id for id, c in named for floor in c.pocket.floors}
    features: list[Feature] = []
    findings: list[Finding] = []
    for id, c in named:
        feature, found = _pocket(view, id, c, shown.ribs, ids, middle)
        features.append(feature)
        findings.extend(found)
    islands = [(i, id) for id, c in named for i in c.pocket.islands]
    for island, inside in in_rows(islands, lambda pair: in_plan(pair[0].faces)):
        features.append(make_island(view, numbers.next("island"), island, inside))
    pockets = [c.pocket for _, c in named]
    for top in in_rows(shown.ribs, lambda r: in_plan((r,))):
        features.append(make_rib(view, numbers.next("rib"), top, pockets))
    for top in in_rows(shown.bosses, lambda r: in_plan((r,))):
        features.append(make_boss(view, numbers.next("boss"), top))
    return SideFeatures(features=tuple(features), findings=tuple(findings))


def make_profile(view: PanelSide, taken: set[int], id: str) -> SideFeatures:
    """Return the outer profile, if any steep face lies on the outline: concave arcs are walls, convex roundings corners, and what leans
    has the role of a pocket's wall that leans away from or over a floor."""
    upright = [f for f in view.profile if f not in taken]
    leaning = [f for f in view.leaning_profile if f not in taken]
    if not (upright or leaning):
        return SideFeatures(features=(), findings=())
    round_ = [f for f in upright if is_rounding(view.graph, view.classes, f)]
    roles = {f: "corner" if f in round_ else "wall" for f in upright}
    roles |= {
        f: "inner_convergence" if view.classes.kind[f] is FaceClass.INNER else "outer_convergence"
        for f in leaning
    }
    sizes: dict[str, Size] = {"height": rounded(view.height)}
    radius = corner_radius(view, round_) if round_ else None
    if radius is not None:
        sizes["corner_radius"] = radius
    faces = tuple(FaceRole(role=roles[f], face=f + 1) for f in sorted(roles))
    return SideFeatures(
        features=(Feature(id=id, kind="profile", faces=faces, sizes=sizes),), findings=()
    )


def make_datum(top: Sequence[int], bottom: Sequence[int], height: float, id: str) -> Feature | None:
    """Return the datum feature of the flat top and bottom faces (rows) that belong to nothing else."""
    roles = (
        *(FaceRole(role="top", face=f + 1) for f in top),
        *(FaceRole(role="bottom", face=f + 1) for f in bottom),
    )
    return (
        Feature(id=id, kind="datum", faces=roles, sizes={"top_z": rounded(height), "bottom_z": 0.0})
        if roles
        else None
    )


def _pocket(
    view: PanelSide,
    id: str,
    confirmed: ConfirmedPocket,
    ribs: Sequence[int],
    ids: dict[int, str],
    middle: Callable[[Sequence[int]], tuple[float, float, float]],
) -> tuple[Feature, tuple[Finding, ...]]:
    pocket, kind = confirmed.pocket, "open_pocket" if confirmed.open else "pocket"
    sizes = pocket_sizes(view, pocket, ribs)
    x, y, z = (rounded(v) for v in middle(pocket.floors or pocket.sides))
    attributes: dict[str, Size] = {
        "centre": (x, y, z if view.is_level else float(sizes["floor_z"])),  # type: ignore[arg-type]
        "identification": kind,
    }
    if not pocket.floors:
        attributes["through"] = True
    if pocket.parent is not None and pocket.parent in ids:
        attributes["nested_in"] = ids[pocket.parent]
    attributes |= view.attributes
    findings = list(confirmed.findings)
    reason = refusal(view, confirmed)
    if reason is not None:
        attributes["refused"] = reason.why
        findings.append(
            warning(
                reason.code,
                f"{id} is not planned: {reason.why}",
                id,
                *face_tags(r + 1 for r in reason.rows),
                remedy=reason.remedy,
            )
        )
    else:
        findings += [
            info(
                remark.code,
                f"{id}: {remark.why}",
                id,
                *face_tags(r + 1 for r in remark.rows),
                remedy=remark.remedy,
            )
            for remark in shape_remarks(view, confirmed)
        ]
    return Feature(
        id=id, kind=kind, faces=pocket_faces(view, pocket), sizes=sizes, attributes=attributes
    ), tuple(findings)


def pocket_faces(view: PanelSide, pocket: Pocket) -> tuple[FaceRole, ...]:
    """Return the faces of a pocket with their roles."""
    return _faces(
        (
            *_roles("floor", pocket.floors),
            *((_side_role(view, w), w) for w in pocket.walls),
            *_roles("corner", pocket.corners),
            *_roles("floor_fillet", pocket.fillets),
        )
    )


def make_island(view: PanelSide, id: str, island: Island, inside: str) -> Feature:
    """Return an island that stands in the pocket named `inside`."""
    roles = (
        *_roles("top", island.tops),
        *((_side_role(view, w), w) for w in island.walls),
        *_roles("corner", island.corners),
        *_roles("floor_fillet", island.fillets),
    )
    attributes: dict[str, Size] = {"in": inside}
    attributes |= view.attributes
    return Feature(
        id=id,
        kind="island",
        faces=_faces(roles),
        sizes=island_sizes(view, island),
        attributes=attributes,
    )


def make_rib(view: PanelSide, id: str, top: int, pockets: Sequence[Pocket]) -> Feature:
    """Return the rib with a top, between pockets."""
    adjacent = {
        view.graph.across(e, top)
        for e in view.graph.edges_of[top]
        if view.graph.convexity[e] == CONVEX
    }
    floors = [f for p in pockets if adjacent.intersection(p.sides) for f in p.floors]
    return Feature(
        id=id,
        kind="rib",
        faces=(FaceRole(role="top", face=top + 1),),
        sizes=rib_sizes(view, top, floors),
        attributes=view.attributes,
    )


def make_boss(view: PanelSide, id: str, top: int) -> Feature:
    """Return the boss with a top: what is lower than the part's top, too wide for a rib and in no pocket. Its sides are the outline and
    walls of the pockets beside it."""
    return Feature(
        id=id,
        kind="boss",
        faces=(FaceRole(role="top", face=top + 1),),
        sizes=boss_sizes(view, top),
        attributes=view.attributes,
    )


def _side_role(view: PanelSide, face: int) -> str:
    kind = view.classes.kind[face]
    if kind is FaceClass.VERTICAL:
        return "wall"
    return "outer_convergence" if view.classes.lean[face] > 0.0 else "inner_convergence"


def _roles(role: str, rows: Iterable[int]) -> tuple[tuple[str, int], ...]:
    return tuple((role, r) for r in rows)


def _faces(roles: Iterable[tuple[str, int]]) -> tuple[FaceRole, ...]:
    return tuple(FaceRole(role=role, face=row + 1) for role, row in roles)
