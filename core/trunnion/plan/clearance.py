"""Clearance queries: is a tool in a pose clear of part and fixtures, and can the machine hold its axis?

Answered by `pipeline.clearance`.
"""

from __future__ import annotations

from typing import Protocol

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool


class ClearanceQuery(Protocol):
    """Asks whether a tool is clear of part and fixtures; poses are in the cutting frame."""

    def __call__(
        self,
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> Bools:
        """Say for tips (k, 3) with unit axes (k, 3) which poses (or moves from a start) enter nothing deeper than the tolerance."""


class ClearanceScene(Protocol):
    """What stands round a leaning tool: who asks for a tool, and which axes the machine holds."""

    def __call__(self, tool: Tool) -> ClearanceQuery:
        """Return who asks for a tool."""

    def holds(self, axis: Floats) -> Bools:
        """Say which tool axes (k, 3), in the cutting frame, the machine can hold."""
