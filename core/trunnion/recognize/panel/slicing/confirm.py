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


def refusal(
    view: PanelSide, confirmed: ConfirmedPocket
) -> tuple[str, str, str, tuple[int, ...]] | None:
    """Return why a vertical strategy would gouge or leave a pocket: code, reason, remedy and the face rows, or None when it wouldn't."""
    pocket, kind = confirmed.pocket, view.classes.kind
    sides = (*pocket.sides, *(f for i in pocket.islands for f in (*i.walls, *i.corners)))
    leaning = tuple(f for f in sides if kind[f] is not FaceClass.VERTICAL)
    if leaning or pocket.slopes:
        lean = max((abs(float(view.classes.lean[f])) for f in leaning + pocket.slopes), default=0.0)
        return (
            "panel.leaning-wall",
            f"its walls lean by up to {lean:.1f} degrees",
            LEANING_REMEDY,
            leaning + pocket.slopes,
        )
    if _curved(view, pocket):
        return (
            "panel.curved-floor",
            "its floor is curved",
            "plan the part as one of curved surfaces (recognize.family=surface)",
            tuple(f for f in pocket.floors if kind[f] is not FaceClass.UP),
        )
    if confirmed.covered > COVER:
        return (
            "panel.overhang",
            f"material stands over {confirmed.covered:.0%} of it",
            "machine it from another side, or with a T-slot cutter",
            pocket.floors,
        )
    return None


def _has_holes_in_walls(view: PanelSide, pocket: Pocket) -> bool:
    return any(not view.holes.isdisjoint(view.graph.neighbours(side)) for side in pocket.sides)


def _curved(view: PanelSide, pocket: Pocket) -> bool:
    return any(view.classes.kind[f] is not FaceClass.UP for f in pocket.floors)
