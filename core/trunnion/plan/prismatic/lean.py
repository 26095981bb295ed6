"""Which pockets are more than upright walls round level floors: walls that lean, floors that are curved."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from trunnion import tolerance
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature

POCKETS = ("pocket", "open_pocket")
"""Kinds of features that are pockets."""
LEANING = ("outer_convergence", "inner_convergence")
"""Roles of walls that lean: away from the floor, over it."""
SIDES = ("wall", *LEANING, "corner", "floor_fillet")
"""Roles of all that stands around a floor."""
ALLOWED_LEAN = math.degrees(tolerance.ANGLE)
"""degrees: walls that lean by more are none that an upright flank may finish."""


def steepest_lean(feature: Feature) -> float:
    """Return by how many degrees the walls of a feature lean at most, whichever way."""
    leans = feature.sizes.get("leans", ())
    return max((abs(v) for v in leans), default=0.0) if isinstance(leans, tuple) else 0.0


def has_leaning_walls(feature: Feature) -> bool:
    """Return whether walls of a feature lean."""
    return bool(feature.with_role(*LEANING)) or steepest_lean(feature) > ALLOWED_LEAN


def curved_floors(feature: Feature, graph: FaceGraph) -> tuple[int, ...]:
    """Return the tags of a feature's floors that are no planes."""
    return tuple(t for t in feature.with_role("floor") if graph.surface[t - 1] != "plane")


def level_floors(feature: Feature, graph: FaceGraph, frame: Frame) -> tuple[int, ...]:
    """Return the tags of a feature's floors that are planes square to a frame's z."""
    up = frame.local_direction(graph.normal)[:, 2] > np.cos(tolerance.ANGLE)
    return tuple(
        t for t in feature.with_role("floor") if graph.surface[t - 1] == "plane" and up[t - 1]
    )


def is_freeform(feature: Feature, islands: Iterable[Feature], graph: FaceGraph) -> bool:
    """Return whether a feature is a pocket with leaning walls, its own or those of islands in it, or with a curved floor."""
    if feature.kind not in POCKETS:
        return False
    return any(has_leaning_walls(f) for f in (feature, *islands)) or bool(
        curved_floors(feature, graph) or feature.sizes.get("curved_floor")
    )
