"""Protocols of clearance queries for tilted tools: contact of a pose with part and fixtures, and the machine's axis limits.

`pipeline.planning.clearance` meets them.
"""

from __future__ import annotations

from typing import Protocol

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool


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
