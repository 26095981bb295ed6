"""Pockets that open at a panel's edges: what neither its upper nor its lower side shows, as it is seen along the panel."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import partial

import numpy as np

from trunnion.findings import BadInput, Finding, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, CONVEX, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature
from trunnion.progress import Progress
from trunnion.recognize.contract import Slicer
from trunnion.recognize.grow import same_surface
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.features import FeatureNumbers, SideFeatures, make_features
from trunnion.recognize.panel.pockets.rules import GraphFeatures, Pocket, pockets_of
from trunnion.recognize.panel.side import Direction, PanelSide
from trunnion.recognize.panel.slicing.confirm import confirm, refusal
from trunnion.recognize.panel.views import level_view, named_direction
from trunnion.tolerance import ANGLE, SLIVER

MOST = 12
"""Directions that are looked along: each is a setup, and a part with more of them is no panel."""


def level_features(
    above: PanelSide,
    graph: FaceGraph,
    frame: Frame,
    slicer: Slicer,
    rows: Collection[int],
    numbers: FeatureNumbers,
    progress: Progress,
) -> SideFeatures:
    """Return the pockets and islands that the faces left (rows) are of, as they are seen along the panel; `graph` is in the part's own
    coordinates, `above` and `frame` those of recognition.

    Directions are taken by what they show, the one with the largest floors first: each is a setup of its own.
    """
    remaining, looked = set(rows), set[Direction]()
    features: list[Feature] = []
    findings: list[Finding] = []
    while len(looked) < MOST and (direction := _next_direction(above.graph, remaining, looked)):
        share = progress.part(len(looked) / MOST, (len(looked) + 1) / MOST)
        looked.add(direction)
        try:
            view = level_view(above, graph, frame, slicer, direction, remaining, share)
        except BadInput as reason:
            findings.append(
                warning(
                    "panel.no-slice",
                    f"the part can't be looked at along ({_words(direction)}): {reason}",
                    remedy="name the features there by hand, or heal the part",
                )
            )
            continue
        made = share.aside(partial(_made, above, view, frozenset(remaining), numbers))
        features += made.features
        findings += (*view.slices.findings, *made.findings) if made.features else ()
        remaining -= {tag - 1 for f in made.features for tag in f.tags}
    return SideFeatures(features=tuple(features), findings=tuple(findings))


def _made(
    above: PanelSide,
    view: PanelSide,
    remaining: Collection[int],
    numbers: FeatureNumbers,
    progress: Progress,
) -> SideFeatures:
    shown = pockets_of(view)
    # What is refused from here may be seen whole from elsewhere.
    pockets = tuple(
        _with_continued(view, p, remaining)
        for p in shown.pockets
        if _is_new(view, p, remaining) and refusal(view, confirm(view, p)) is None
    )
    seen = GraphFeatures(pockets=pockets, tops=shown.tops, ribs=(), bosses=())
    return make_features(view, seen, above.graph, numbers)


def _is_new(view: PanelSide, pocket: Pocket, remaining: Collection[int]) -> bool:
    """Return whether a pocket is none that another side has, by its floors, which lie open to this one, without any by one of its sides."""
    if pocket.floors:
        return all(f in remaining and view.is_clear(f) for f in pocket.floors)
    return any(s in remaining for s in pocket.sides)


def _with_continued(view: PanelSide, pocket: Pocket, remaining: Collection[int]) -> Pocket:
    """Return a pocket with the upright faces left that belong to its walls where others cross it: they meet these in an inner edge, or lie
    in one plane with one of them, under its mouth and over its floor."""
    graph, sides = view.graph, list(pocket.sides)
    if not sides:
        return pocket
    low = graph.box_low[sides].min(axis=0) - SLIVER
    high = graph.box_high[sides].max(axis=0) + SLIVER
    if not pocket.floors:
        low[2], high[2] = -np.inf, np.inf
    upright = [
        r
        for r in sorted(remaining)
        if view.classes.kind[r] is FaceClass.VERTICAL
        and r not in pocket.faces
        and (graph.box_low[r] >= low).all()
        and (graph.box_high[r] <= high).all()
    ]
    more: list[int] = []
    for side in sides:
        for r in upright:
            if r not in more and (_meet_inside(graph, side, r) or _in_one_plane(graph, side, r)):
                more.append(r)
                sides.append(r)
    return replace(pocket, walls=(*pocket.walls, *more)) if more else pocket


def _meet_inside(graph: FaceGraph, face: int, other: int) -> bool:
    return any(
        graph.convexity[e] == CONCAVE and graph.across(e, face) == other
        for e in graph.edges_of[face]
    )


def _in_one_plane(graph: FaceGraph, face: int, other: int) -> bool:
    return graph.surface[face] == "plane" and same_surface(graph, face, other, SLIVER, ANGLE)


def _next_direction(
    graph: FaceGraph, rows: Collection[int], looked: Collection[Direction]
) -> Direction | None:
    """Return the level direction that shows most of some faces (rows), floors before sides; None where none is left that may show any."""
    best: tuple[tuple[float, float], Direction] | None = None
    for direction in _directions(graph, rows):
        if direction not in looked:
            shown = _shown(graph, rows, np.array(direction))
            if shown > (0.0, 0.0) and (best is None or shown > best[0]):
                best = (shown, direction)
    return best[1] if best else None


def _directions(graph: FaceGraph, rows: Collection[int]) -> tuple[Direction, ...]:
    """Return the level directions that some plane faces (rows) look in, and both ways along their straight inner edges."""
    found: list[Floats] = []

    def add(direction: Floats) -> None:
        if abs(float(direction[2])) < np.sin(ANGLE) and not any(
            float(direction @ other) > np.cos(ANGLE) for other in found
        ):
            found.append(direction)

    for r in sorted(rows):
        if graph.surface[r] == "plane":
            add(graph.normal[r])
    for r in sorted(rows):
        for e in graph.edges_of[r]:
            if graph.curve[e] == "line" and graph.convexity[e] != CONVEX:
                along = graph.end[e] - graph.start[e]
                along = along / np.linalg.norm(along)
                add(along)
                add(-along)
    return tuple(named_direction(d) for d in found)


def _shown(graph: FaceGraph, rows: Collection[int], direction: Floats) -> tuple[float, float]:
    """Return the area of plane faces (rows) that are floors seen from a direction, at the foot of something, and of those along it."""
    floors = sides = 0.0
    for r in rows:
        if graph.surface[r] != "plane":
            continue
        cosine = float(graph.normal[r] @ direction)
        if cosine > np.cos(ANGLE) and any(
            graph.convexity[e] == CONCAVE or graph.surface[graph.across(e, r)] != "plane"
            for e in graph.edges_of[r]
        ):
            floors += float(graph.area[r])
        elif abs(cosine) < np.sin(ANGLE):
            sides += float(graph.area[r])
    return floors, sides


def _words(direction: Direction) -> str:
    return ", ".join(f"{v:g}" for v in direction)
