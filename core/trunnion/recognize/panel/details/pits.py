"""Pits: recesses sunk into a wall, under material, which no upright cutter gets into (the slicing paper's T-slots)."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.model.feature import FaceRole, Feature, Size
from trunnion.recognize.grow import bend_radius, grown, samples
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.features import FeatureNumbers, in_rows
from trunnion.recognize.panel.side import PanelSide
from trunnion.units import radians, rounded

PARALLEL = float(np.cos(radians(10.0)))
"""Cosine between the back of a pit and its wall."""
UNDER = (FaceClass.DOWN, FaceClass.OVERHANG)
"""Classes of a pit's upper face."""


def pits(
    view: PanelSide, features: Sequence[Feature], rows: Collection[int], numbers: FeatureNumbers
) -> list[Feature]:
    """Return the pits among connected faces (rows): one steep wall all round their mouth, over a convex edge, and a back parallel to it."""
    graph, waiting = view.graph, set(rows)
    owners = {
        tag - 1: f.id
        for f in features
        for tag in f.with_role("wall", "inner_convergence", "outer_convergence")
    }
    found: list[tuple[tuple[int, ...], int, int]] = []
    while waiting:
        group = grown(graph, [min(waiting)], lambda _e, _f, other: other in rows)
        waiting -= set(group)
        wall = _wall(view, group)
        back = None if wall is None else _back(view, group, wall)
        if wall is not None and back is not None:
            found.append((tuple(sorted(group)), wall, back))

    def middle(pit: tuple[tuple[int, ...], int, int]) -> tuple[float, float]:
        x, y, _ = graph.centre[pit[2]]
        return float(x), float(y)

    return [
        _pit(view, group, wall, back, owners.get(wall, ""), numbers.next("pit"))
        for group, wall, back in in_rows(found, middle)
    ]


def _wall(view: PanelSide, group: Sequence[int]) -> int | None:
    """Return the steep face that holds the mouth of a recess, None where its mouth is on no such face or not all of it is convex."""
    graph, own = view.graph, set(group)
    mouth: dict[int, float] = {}
    for row in group:
        for edge in graph.edges_of[row]:
            other = graph.across(edge, row)
            if other not in own:
                if graph.convexity[edge] != CONVEX or not view.classes.steep[other]:
                    return None
                mouth[other] = mouth.get(other, 0.0) + float(graph.length[edge])
    return max(mouth, key=lambda f: (mouth[f], -f)) if mouth else None


def _back(view: PanelSide, group: Sequence[int], wall: int) -> int | None:
    """Return the face at the back of a recess: parallel to its wall, with no edge on the mouth; None where there is none, or nothing of the
    recess looks down."""
    graph, own = view.graph, set(group)
    if not any(view.classes.kind[r] in UNDER for r in group):
        return None
    inner = [
        r
        for r in group
        if own.issuperset(graph.neighbours(r))
        and view.classes.steep[r]
        and float(graph.normal[r] @ graph.normal[wall]) > PARALLEL
    ]
    return max(inner, key=lambda r: (float(graph.area[r]), -r)) if inner else None


def _pit(
    view: PanelSide, group: tuple[int, ...], wall: int, back: int, owner: str, id: str
) -> Feature:
    graph = view.graph
    out = graph.normal[wall]
    along = np.array([-out[1], out[0], 0.0]) / np.hypot(out[0], out[1])
    points = _points(graph, group)
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    round_ = [bend_radius(graph, r) for r in group if graph.bend[r] < 0]
    sizes: dict[str, Size] = {
        "depth": rounded(float((graph.centre[wall] - graph.centre[back]) @ out)),
        "length": rounded(float(np.ptp(points @ along))),
        "height": rounded(high - low),
        "z0": rounded(low),
        "z1": rounded(high),
    }
    if round_:
        sizes["corner_radius"] = rounded(min(round_))
    return Feature(
        id=id,
        kind="pit",
        faces=tuple(FaceRole(role="floor" if r == back else "wall", face=r + 1) for r in group),
        sizes=sizes,
        attributes={"in": owner} if owner else {},
    )


def _points(graph: FaceGraph, group: Sequence[int]) -> Floats:
    """Return points (k, 3) of faces: their samples, and the ends and middles of their edges."""
    edges = sorted({e for r in group for e in graph.edges_of[r]})
    inside = [samples(graph, r)[0] for r in group]
    return np.vstack([*inside, graph.start[edges], graph.middle[edges], graph.end[edges]])
