"""The bench a session is worked on at: what a step needs that is not plain data (the CAD part) or not the session's own (the shop)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.session import PartInfo
from trunnion.shop import Shop

if TYPE_CHECKING:
    from trunnion.part.part import Part


DECIMALS = 7
"""Decimals of a box in mm: ten times finer than two points are told apart."""


@dataclass(frozen=True)
class Bench:
    """The part that a session programs and the shop it is programmed for."""

    part: Part
    shop: Shop

    @cached_property
    def facts(self) -> PartInfo:
        """What a session keeps of the part."""
        p = self.part
        return PartInfo(path=str(p.path), name=p.name, digest=p.digest, unit=p.unit, n_faces=p.n_faces, n_solids=p.n_solids, solid=p.solid,
                        area=p.area, volume=p.volume, low=p.low, high=p.high, findings=tuple(p.findings))

    def box(self, frame: Frame) -> tuple[Floats, Floats]:
        """Return the part's box (low, high) in a frame, from the exact faces' extreme points and the mesh's."""
        points = frame.to_local(self.part.mesh().points)
        graph = self.part.graph().in_frame(frame)
        own = np.asarray(self.part.tags) - 1
        low = np.minimum(points.min(axis=0), graph.box_low[own].min(axis=0))
        high = np.maximum(points.max(axis=0), graph.box_high[own].max(axis=0))
        # What is computed from a turned part carries noise far below any meaning; a programmer should not see it in a work offset.
        return np.round(low, DECIMALS), np.round(high, DECIMALS)
