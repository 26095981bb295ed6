"""Names to things that are imported only when wanted: families, kinds of part, planners, strategies, dialects, views.

The names come from the entry points `trunnion.KIND` of installed packages, so a user's own package adds one without
touching ours; the module behind a name is imported on the first `get`.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from trunnion.findings import BadCall

KINDS = ("families", "part_kinds", "planners", "strategies", "dialects", "views")


@cache
def _points(kind: str) -> dict[str, EntryPoint]:
    if kind not in KINDS:
        raise BadCall(f"there is no registry of {kind}; known: {', '.join(KINDS)}")
    found: dict[str, EntryPoint] = {}
    for point in entry_points(group=f"trunnion.{kind}"):
        if point.name in found and found[point.name].value != point.value:
            raise BadCall(
                f"two packages give the {kind} name {point.name}: {found[point.name].value} and {point.value}"
            )
        found[point.name] = point
    return found


def names(kind: str) -> tuple[str, ...]:
    """Return the registered names of a kind (one of `KINDS`), sorted."""
    return tuple(sorted(_points(kind)))


@cache
def get(kind: str, name: str) -> Any:
    """Return the thing registered under a name, importing it now; raise `BadCall` with the known names."""
    points = _points(kind)
    if name not in points:
        raise BadCall(f"unknown {kind} name {name}; known: {', '.join(sorted(points))}")
    return points[name].load()
