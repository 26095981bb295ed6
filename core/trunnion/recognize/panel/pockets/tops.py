"""What each horizontal face that looks up is: the part's top, a rib's, a floor, or none of these (rules 4, 5 and 9)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.facegraph import CONCAVE, CONVEX
from trunnion.recognize.grow import loops
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.side import PanelSide
from trunnion.tolerance import SLIVER

FOOT_SHARE = 1.0 / 3.0
"""A narrow top whose border has less than this share at the foot of walls is a rib's; a ledge along a wall has half of it there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tops:
    """The faces that look up, as rows: `highest` at the part's top, `ribs`, `floors` at the foot of walls (also curved ones),
    `islands` with nothing above their border, `undercut` with material all over them."""

    highest: tuple[int, ...]
    ribs: tuple[int, ...]
    floors: tuple[int, ...]
    islands: tuple[int, ...]
    undercut: tuple[int, ...]


def sort_tops(view: PanelSide) -> Tops:
    """Return what the faces that look up are; those of holes are none of these."""
    found: dict[str, list[int]] = {
        n: [] for n in ("highest", "ribs", "floors", "islands", "undercut")
    }
    for face in view.classes.rows(FaceClass.UP):
        if face not in view.holes:
            found[_sort(view, face)].append(face)
    for face in view.classes.rows(FaceClass.CROSS):
        if face in view.holes:
            continue
        if view.graph.surface[face] != "plane" and is_curved_floor(view, face):
            found["undercut" if view.undercut(face) else "floors"].append(face)
    return Tops(**{name: tuple(rows) for name, rows in found.items()})


def foot_share(view: PanelSide, face: int) -> float:
    """Return the share of a face's border that lies at the foot of something."""
    foot, edge = _border(view, face)
    return foot / (foot + edge) if foot + edge > 0.0 else 0.0


def mean_width(view: PanelSide, face: int) -> float:
    """Return twice the area over the length of the free border: the width of a strip, whatever way it runs."""
    _, edge = _border(view, face)
    return float(2.0 * view.graph.area[face] / edge) if edge > 0.0 else float("inf")


def is_curved_floor(view: PanelSide, face: int) -> bool:
    """Return whether a curved face that looks up lies at the foot of walls all round."""
    outer = loops(view.graph, face).get(0, ())
    return bool(outer) and all(_is_foot(view, e, face) for e in outer)


def _sort(view: PanelSide, face: int) -> str:
    if view.z(face) >= view.height - SLIVER:
        return "highest"
    if view.undercut(face):
        return "undercut"
    share = foot_share(view, face)
    if share == 0.0:
        return "islands"
    return (
        "ribs"
        if share < FOOT_SHARE and mean_width(view, face) <= view.settings.rib_width
        else "floors"
    )


def _border(view: PanelSide, face: int) -> tuple[float, float]:
    """Return the lengths of a face's border at the foot of something and over a drop; the rims of holes in it are none of it."""
    edges = [e for e in view.graph.edges_of[face] if view.graph.across(e, face) not in view.holes]
    foot = [e for e in edges if _is_foot(view, e, face)]
    free = [e for e in edges if view.graph.convexity[e] == CONVEX]
    return float(np.sum(view.graph.length[foot])), float(np.sum(view.graph.length[free]))


def _is_foot(view: PanelSide, edge: int, face: int) -> bool:
    convexity = view.graph.convexity[edge]
    return bool(
        convexity == CONCAVE
        or (convexity != CONVEX and view.graph.across(edge, face) in view.fillets)
    )
