"""What a family of parts has to offer, and what it may ask of a part beside its face graph."""

from __future__ import annotations

from typing import Any, Protocol

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.region import Region
from trunnion.model.feature import Recognition
from trunnion.progress import Progress


class Slicer(Protocol):
    """Something that can be cut by planes; a part satisfies it, and so does a table of regions in a test."""

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material that the plane `z` (mm) of a frame cuts, in the frame's xy.

        Raises `BadInput` or `ValueError` when the part can't be cut there.
        """
        ...


class Family(Protocol):
    """A family of parts with its own features: the name it is registered under, its settings and its recogniser.

    A package adds one through the entry points `trunnion.families`.
    """

    name: str
    settings: type

    def suits(self, graph: FaceGraph) -> float:
        """Return how well the family fits a part, from 0 (not at all) to 1."""
        ...

    def recognize(self, graph: FaceGraph, slicer: Slicer, settings: Any, progress: Progress) -> Recognition:
        """Return the features of a part. Every face is in a feature or in `unexplained`, with a finding that names it.

        Raises `Cancelled` when a person asked to stop.
        """
        ...
