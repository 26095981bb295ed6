"""Face classes by the angle of the outward normal to the height axis (the slicing paper's equation 1, widened)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.units import degrees, radians


class FaceClass(StrEnum):
    """How a face stands. `STEEP` leans both ways, `BLEND` turns by more than half a right angle, `ABSENT` is of another solid."""

    UP = "horizontal"
    DOWN = "underside"
    VERTICAL = "vertical"
    INNER = "inner convergence"
    OUTER = "outer convergence"
    STEEP = "steep"
    CROSS = "cross ruled"
    OVERHANG = "overhang"
    BLEND = "blend"
    ABSENT = "absent"


STEEP_CLASSES = (FaceClass.VERTICAL, FaceClass.INNER, FaceClass.OUTER, FaceClass.STEEP)
BLEND_TURN = radians(45.0)
"""A curved face whose normal turns towards the height axis by more than this joins a floor and a wall."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceClasses:
    """The class of every face row, with the range of alpha (n,) in radians and the mean lean (n,) in degrees.

    A positive lean leans away from the space (open angle), a negative one over it (closed angle). `steep` (n,): within beta of the
    vertical; `rising` (n,): also slopes that are steeper than half a right angle, which may bound a pocket like a wall does.
    """

    kind: tuple[FaceClass, ...]
    alpha_low: Floats
    alpha_high: Floats
    lean: Floats
    steep: Bools
    rising: Bools

    def rows(self, *kinds: FaceClass) -> tuple[int, ...]:
        """Return the rows of the faces of some classes, in order."""
        return tuple(r for r, k in enumerate(self.kind) if k in kinds)


def classify(graph: FaceGraph, settings: PanelSettings) -> FaceClasses:
    """Return the class of every face of a graph that lies in the frame of recognition (z up)."""
    n = len(graph)
    low, high = np.full(n, np.inf), np.full(n, -np.inf)
    total, count = np.zeros(n), np.zeros(n)
    alpha = np.arccos(np.clip(graph.sample_normal[:, 2], -1.0, 1.0))
    np.minimum.at(low, graph.sample_face, alpha)
    np.maximum.at(high, graph.sample_face, alpha)
    np.add.at(total, graph.sample_face, alpha)
    np.add.at(count, graph.sample_face, 1.0)
    own = np.arccos(np.clip(graph.normal[:, 2], -1.0, 1.0))
    bare = count == 0.0
    low, high = np.where(bare, own, low), np.where(bare, own, high)
    mean = np.where(bare, own, total / np.maximum(count, 1.0))
    kinds = tuple(
        FaceClass.ABSENT if graph.area[r] == 0.0 else _kind(low[r], high[r], settings)
        for r in range(n)
    )
    lean = np.array([degrees(np.pi / 2 - m) for m in mean])
    steep = np.array([k in STEEP_CLASSES for k in kinds])
    slope = np.array([k is FaceClass.CROSS for k in kinds]) & (low >= np.pi / 4)
    return FaceClasses(
        kind=kinds, alpha_low=low, alpha_high=high, lean=lean, steep=steep, rising=steep | slope
    )


def _kind(low: float, high: float, settings: PanelSettings) -> FaceClass:
    level, beta, upright = radians(settings.angle), radians(settings.beta), np.pi / 2
    if high <= level:
        return FaceClass.UP
    if low >= np.pi - level:
        return FaceClass.DOWN
    if low >= upright - level and high <= upright + level:
        return FaceClass.VERTICAL
    if low > upright - beta and high < upright + beta:
        if high <= upright + level:
            return FaceClass.OUTER
        return FaceClass.INNER if low >= upright - level else FaceClass.STEEP
    if high - low > BLEND_TURN:
        return FaceClass.BLEND
    return FaceClass.CROSS if high <= upright else FaceClass.OVERHANG
