"""The principal sizes that parts of a family are compared by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from trunnion.model.session import SizeEntry
from trunnion.plan.contract import Planner
from trunnion.plan.size import PART

BOX = ("length", "width", "height")
"""Names of the part's own sizes in the frame of recognition."""


@runtime_checkable
class PrincipalSizes(Protocol):
    """A planner that knows better than length, width and height what sizes make parts of its family alike."""

    def principal_sizes(self, sizes: Sequence[SizeEntry]) -> Mapping[str, float]:
        """Return the principal sizes in mm by name, out of a part's size table."""


def principal_sizes(planner: Planner, sizes: Sequence[SizeEntry]) -> Mapping[str, float]:
    """Return the principal sizes (mm) by the planner of a part's family; its length, width and height where the planner has none."""
    if isinstance(planner, PrincipalSizes):
        return planner.principal_sizes(sizes)
    return box_sizes(sizes)


def box_sizes(sizes: Sequence[SizeEntry]) -> dict[str, float]:
    """Return a part's length, width and height in mm, as far as they are in its size table."""
    return {e.name: e.value for e in sizes if e.feature == PART and e.name in BOX}
