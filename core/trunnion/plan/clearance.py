"""Protocols of clearance queries for tilted tools: contact of a pose with part and fixtures, the machine's axis limits, and the stock.

`pipeline.planning.clearance` meets them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
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


class LeaningCutQuery(Protocol):
    """What a leaning tool has cut (`toolpath.stock.leaning_cuts.LeaningCut`)."""

    @property
    def digest(self) -> str:
        """A short stable digest of what is cut."""

    def poses_in(self, frame: Frame, step: float = ...) -> tuple[Floats, Floats]:
        """Return tips and axes (k, 3) along the moves in a frame, between which no place of the flutes goes farther than a step (mm)."""

    def flutes(self, inside: float) -> Floats:
        """Return the cutting part of the tool as cones (r, 4) from the tip up, with at least `inside` (mm) of it all round them."""


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
