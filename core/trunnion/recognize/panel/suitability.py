"""How surely a part is a panel: the share of its area that lies level or upright, or is the floor of a pocket between walls."""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.recognize.contract import Suitability
from trunnion.recognize.grow import grown, loops
from trunnion.recognize.panel.classes import STEEP_CLASSES, FaceClass, FaceClasses, classify
from trunnion.recognize.panel.frame import height_frame
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.recognize.tunnels import tunnel_walls
from trunnion.settings import choose
from trunnion.units import percent

STRAIGHT = (FaceClass.UP, FaceClass.DOWN, FaceClass.VERTICAL)
"""Classes of faces that a panel has, whatever surface they lie on."""
RULED = ("plane", "cylinder", "cone")
"""Surfaces of walls that lean."""


def suitability(graph: FaceGraph) -> Suitability:
    """Return the share of the part's area that lies level or upright in the frame that a panel would have, curved floors of pockets, and
    walls of tunnels along the part too.

    Walls may lean; free-form faces that do are no walls of a panel. Faces that enclose no material can't be sliced.
    """
    if graph.open_edges:
        return Suitability(score=0.0, explained=0.0, reason="the faces enclose no material")
    try:
        frame = height_frame(graph)
    except BadInput:
        return Suitability(score=0.0, explained=0.0, reason="no face is flat")
    seen = graph.in_frame(frame)
    classes = classify(seen, choose(PanelSettings, {}))
    straight = np.array(
        [
            k in STRAIGHT or (k in STEEP_CLASSES and s in RULED)
            for k, s in zip(classes.kind, graph.surface, strict=True)
        ]
    )
    straight |= tunnel_walls(seen, np.array([0.0, 0.0, 1.0]))
    floors = _curved_floors(seen, classes, straight)
    total = graph.area.sum()
    share = min(1.0, float(graph.area[straight | floors].sum() / total))
    curved = float(graph.area[floors].sum() / total)
    reason = f"{percent(share)} of the area level or upright"
    if curved > 0.0:
        reason += " or a curved floor between walls"
    return Suitability(score=share, explained=share, reason=reason)


def _curved_floors(graph: FaceGraph, classes: FaceClasses, straight: Bools) -> Bools:
    """Return which faces (n,) are curved floors, with the fillets at their foot: faces that are not straight and hang together, with
    nothing around but steep faces that stand up from them; holes may go through.

    A dome stands on a level face, a hollow in a plate has a convex rim: neither is a floor.
    """
    found = np.zeros(len(straight), dtype=bool)
    waiting = set(np.flatnonzero(~straight).tolist())
    while waiting:
        part = grown(graph, [min(waiting)], lambda _edge, _face, other: not straight[other])
        waiting -= set(part)
        own = set(part)
        edges = [
            (e, n, graph.across(e, f))
            for f in part
            for n, loop in loops(graph, f).items()
            for e in loop
        ]
        if all(
            other in own or (classes.steep[other] and (n > 0 or graph.convexity[e] != CONVEX))
            for e, n, other in edges
        ):
            found[list(part)] = True
    return found
