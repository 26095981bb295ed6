"""What slices confirm of the graph's pockets: open or closed, islands, overhang. Where the two differ a finding says which decided."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.findings import Finding, face_tags, remark, warning
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.pockets.rules import Pocket
from trunnion.recognize.panel.side import PanelSide
from trunnion.recognize.panel.slicing.tree import COVER

LEANING_REMEDY = (
    "plan the part as one of curved surfaces (recognize.family=surface), or make the walls vertical"
)

SHAPE_REMEDY = (
    "nothing needs to be done: layers rough it, waterlines and passes of constant scallop finish it"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ConfirmedPocket:
    """A pocket with what the slices say of it: `open` to the outline, `covered` the share of its plan that material stands over."""

    pocket: Pocket
    open: bool
    covered: float
    findings: tuple[Finding, ...]


def confirm(view: PanelSide, pocket: Pocket) -> ConfirmedPocket:
    """Return a pocket with what slices and graph agree on. The slices decide what is open, the graph which faces belong to it.

    A hole through a wall lets no cutter in: where a slice goes through one, the graph decides what is open and what stands in it.
    """
    where = face_tags(f + 1 for f in (pocket.floors or pocket.sides))
    drops = set(pocket.drops) - set(pocket.sides)
    graph_open = bool(drops & set(view.profile))
    if not pocket.floors:
        return ConfirmedPocket(pocket=pocket, open=False, covered=0.0, findings=())
    nodes = [
        n
        for n in (
            view.tree.over(view.graph.centre[f][:2], view.z(f))
            for f in pocket.floors
            if view.classes.kind[f] is FaceClass.UP
        )
        if n is not None
    ]
    if not nodes:
        return ConfirmedPocket(
            pocket=pocket,
            open=graph_open,
            covered=0.0,
            findings=()
            if _curved(view, pocket)
            else (
                warning(
                    "panel.slices-differ",
                    "the slices show material where the graph shows a pocket: the graph decided",
                    *where,
                    remedy="look at the part there; it may be damaged",
                ),
            ),
        )
    is_drilled = _has_holes_in_walls(view, pocket)
    is_open = any(not view.tree.space(n).closed for n in nodes) and (graph_open or not is_drilled)
    found = []
    if is_open != graph_open:
        words = ("open", "closed") if is_open else ("closed", "open")
        found.append(
            remark(
                "panel.slices-differ",
                f"the slices show an {words[0]} space, the graph a {words[1]} one: the slices decided",
                *where,
                remedy="check whether a cutter may enter from the side",
            )
        )
    most_islands = max(len(view.tree.space(n).islands) for n in nodes)
    differs = most_islands != len(pocket.islands) and not is_drilled
    if not is_open and len(nodes) == 1 and differs:
        words = (str(most_islands), str(len(pocket.islands)))
        found.append(
            remark(
                "panel.slices-differ",
                f"the slices show {words[0]} islands, the graph {words[1]}: the graph decided",
                *where,
                remedy="check the islands of this pocket",
            )
        )
    return ConfirmedPocket(
        pocket=pocket,
        open=is_open,
        covered=max(view.tree.covered(n) for n in nodes),
        findings=tuple(found),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class PocketFinding:
    """What a finding says of a pocket that upright walls round a level floor don't tell of: code, reason, remedy and the face rows."""

    code: str
    why: str
    remedy: str
    rows: tuple[int, ...]


def refusal(view: PanelSide, confirmed: ConfirmedPocket) -> PocketFinding | None:
    """Return why nothing is planned for a pocket, or None: slopes beside it belong to no feature, or material stands over it."""
    pocket, kind = confirmed.pocket, view.classes.kind
    if pocket.slopes:
        return _leaning(view, pocket)
    hangs = any(kind[f] in (FaceClass.INNER, FaceClass.STEEP) for f in _all_sides(pocket))
    if confirmed.covered > COVER and not hangs:
        return PocketFinding(
            code="panel.overhang",
            why=f"material stands over {confirmed.covered:.0%} of it",
            remedy="machine it from another side, or with a T-slot cutter",
            rows=pocket.floors,
        )
    return None


def shape_remarks(view: PanelSide, confirmed: ConfirmedPocket) -> tuple[PocketFinding, ...]:
    """Return what a vertical strategy alone would gouge or leave of a pocket: leaning walls, a curved floor."""
    pocket, kind = confirmed.pocket, view.classes.kind
    found = []
    if any(kind[f] is not FaceClass.VERTICAL for f in _all_sides(pocket)):
        found.append(_leaning(view, pocket))
    if _curved(view, pocket):
        found.append(
            PocketFinding(
                code="panel.curved-floor",
                why="its floor is curved",
                remedy=SHAPE_REMEDY,
                rows=tuple(f for f in pocket.floors if kind[f] is not FaceClass.UP),
            )
        )
    return tuple(found)


def _leaning(view: PanelSide, pocket: Pocket) -> PocketFinding:
    rows = (
        *(f for f in _all_sides(pocket) if view.classes.kind[f] is not FaceClass.VERTICAL),
        *pocket.slopes,
    )
    lean = max((abs(float(view.classes.lean[f])) for f in rows), default=0.0)
    return PocketFinding(
        code="panel.leaning-wall",
        why=f"its walls lean by up to {lean:.1f} degrees",
        remedy=LEANING_REMEDY if pocket.slopes else SHAPE_REMEDY,
        rows=rows,
    )


def _all_sides(pocket: Pocket) -> tuple[int, ...]:
    """Return the sides of a pocket and of the islands in it."""
    return (*pocket.sides, *(f for i in pocket.islands for f in (*i.walls, *i.corners)))


def _has_holes_in_walls(view: PanelSide, pocket: Pocket) -> bool:
    return any(not view.holes.isdisjoint(view.graph.neighbours(side)) for side in pocket.sides)


def _curved(view: PanelSide, pocket: Pocket) -> bool:
    return any(view.classes.kind[f] is not FaceClass.UP for f in pocket.floors)
