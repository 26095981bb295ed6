"""Chamfers: narrow slopes between a level face and a wall, one feature for all faces that follow one another round an edge."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from trunnion.geometry.facegraph import CONCAVE, CONVEX
from trunnion.model.feature import FaceRole, Feature
from trunnion.recognize.grow import grown
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.features import FeatureNumbers, in_rows
from trunnion.recognize.panel.side import PanelSide
from trunnion.units import degrees, radians, rounded

EVEN = radians(5.0)
"""How much the slope of a chamfer may vary: round a corner it is a cone's, along a free-form side it ripples."""


def chamfers(
    above: PanelSide, below: PanelSide, rows: Collection[int], numbers: FeatureNumbers
) -> list[Feature]:
    """Return the chamfers among faces (rows) on edges seen from above, then on those seen from below."""

    def middle(group: tuple[int, ...]) -> tuple[float, float]:
        low = above.graph.box_low[list(group)].min(axis=0)
        high = above.graph.box_high[list(group)].max(axis=0)
        return float(0.5 * (low[0] + high[0])), float(0.5 * (low[1] + high[1]))

    return [
        _chamfer(view, group, numbers.next("chamfer"))
        for view in (above, below)
        for group in in_rows(_groups(view, {r for r in rows if _is_chamfer(view, r)}), middle)
    ]


def _groups(view: PanelSide, rows: Collection[int]) -> list[tuple[int, ...]]:
    """Return faces (rows) in groups of those that follow one another."""
    groups: list[tuple[int, ...]] = []
    for row in sorted(rows):
        if not any(row in g for g in groups):
            group = grown(view.graph, [row], lambda _edge, _face, other: other in rows)
            groups.append(tuple(sorted(group)))
    return groups


def _is_chamfer(view: PanelSide, row: int) -> bool:
    """Return whether a face is a narrow even slope with no concave edge, a level face over it and a steep one below."""
    graph, classes = view.graph, view.classes
    if classes.kind[row] is not FaceClass.CROSS:
        return False
    if classes.alpha_high[row] - classes.alpha_low[row] > EVEN:
        return False
    if any(graph.convexity[e] == CONCAVE for e in graph.edges_of[row]):
        return False
    beside = graph.neighbours(row, CONVEX)
    return (
        any(classes.kind[n] is FaceClass.UP for n in beside)
        and any(classes.steep[n] for n in beside)
        and _width(view, row) <= view.settings.chamfer_width
    )


def _width(view: PanelSide, row: int) -> float:
    """Return how wide in mm a slope is seen from above."""
    height = float(view.graph.box_high[row][2] - view.graph.box_low[row][2])
    return height / float(np.tan(_slope(view, row)))


def _slope(view: PanelSide, row: int) -> float:
    """Return the angle in radians of a slope to the level."""
    return 0.5 * float(view.classes.alpha_low[row] + view.classes.alpha_high[row])


def _chamfer(view: PanelSide, group: tuple[int, ...], id: str) -> Feature:
    largest = max(group, key=lambda r: float(view.graph.area[r]))
    return Feature(
        id=id,
        kind="chamfer",
        faces=tuple(FaceRole(role="face", face=r + 1) for r in group),
        sizes={
            "width": rounded(_width(view, largest)),
            "angle": rounded(degrees(_slope(view, largest))),
        },
        attributes=view.attributes,
    )
