"""Fringes: free-form sides that lean, on the outline or in a pocket with nothing but a wall between them and the outline (rule 8)."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
import shapely
from shapely.ops import nearest_points

from trunnion.model.feature import FaceRole, Feature
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.features import FeatureNumbers, in_rows
from trunnion.recognize.panel.side import FREE_FORM, ON_RIM, PanelSide

NEAR = 30.0
"""mm of material between a pocket's fringe and the outline at most: farther in, a free-form wall is a wall."""


def fringes(
    view: PanelSide, features: Sequence[Feature], rows: Collection[int], numbers: FeatureNumbers
) -> list[Feature]:
    """Return the fringes on the outline, among faces (rows), then those in pockets, each of one face."""

    def middle(row: int) -> tuple[float, float]:
        return float(view.graph.centre[row][0]), float(view.graph.centre[row][1])

    outer = [r for r in sorted(rows) if _is_free_form(view, r) and view.looks_outwards(r)]
    owners = {
        tag - 1: f.id
        for f in features
        if f.kind in ("pocket", "open_pocket")
        for tag in f.with_role("outer_convergence", "inner_convergence")
    }
    inner = [r for r in sorted(owners) if _is_free_form(view, r) and _is_near_outline(view, r)]
    return [
        Feature(
            id=numbers.next("fringe"),
            kind="fringe",
            faces=(FaceRole(role="face", face=row + 1),),
            attributes={"in": owners[row]} if row in owners else {"outer": True},
        )
        for group in (outer, inner)
        for row in in_rows(group, middle)
    ]


def _is_free_form(view: PanelSide, row: int) -> bool:
    """Return whether a face is a free-form side that leans, as far as a wall or a slope that bounds a pocket does."""
    leans = view.classes.rising[row] and view.classes.kind[row] is not FaceClass.VERTICAL
    return bool(leans and view.graph.surface[row] in FREE_FORM)


def _is_near_outline(view: PanelSide, row: int) -> bool:
    """Return whether material alone, and little of it, stands between the middle of a face and the outline."""
    point = view.graph.centre[row]
    layers = view.slices.layers
    layer = min(layers, key=lambda s: (abs(s.z - float(point[2])), s.z)) if layers else None
    if layer is None:
        return False
    here = shapely.Point(point[0], point[1])
    way = shapely.LineString([*nearest_points(here, view.slices.rim)])
    # The slice lies a little over or under the middle of a face that leans: as far as that may be, no gap counts.
    aside = abs(layer.z - float(point[2])) * float(np.tan(np.radians(view.settings.beta))) + ON_RIM
    return bool(
        way.length <= NEAR and way.difference(layer.material.buffer(aside)).length <= ON_RIM
    )
