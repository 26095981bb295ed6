"""Protocols of clearance queries for tilted tools: contact of a pose with part and fixtures, the machine's axis limits, and the stock.

`pipeline.planning.clearance` meets them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.progress import Progress


class ClearanceQuery(Protocol):
    """Clearance of one tool from part and fixtures; poses are in the cutting frame."""

    def __call__(
        self,
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> Bools:
        """Return which poses (k,) enter nothing deeper than the tolerance: tips (k, 3) mm, unit axes (k, 3); or moves from a start."""


class ClearanceScene(Protocol):
    """Part, fixtures and machine around a tilted tool."""

    def __call__(self, tool: Tool) -> ClearanceQuery:
        """Return the clearance query of a tool."""

    def holds(self, axis: Floats) -> Bools:
        """Return which tool axes (k, 3), in the cutting frame, the machine can hold."""


class RemainingStockQuery(Protocol):
    """Material that stands off the part, as positions (`toolpath.stock.remaining.RemainingStock`)."""

    @property
    def cut(self) -> str:
        """A digest of what leaning tools have cut of it, empty where that is nothing."""

    @property
    def is_empty(self) -> bool:
        """Whether nothing stands."""

    def is_free(
        self,
        rows: Sequence[tuple[float, float, float, float]],
        tip: Floats,
        axis: Floats,
        progress: Progress = ...,
    ) -> Bools:
        """Return at which poses (k,) a body of cones (z0, r0, z1, r1) from the tip up holds nothing of it."""
