"""Names to things that are imported only when wanted: families, kinds of part, planners, strategies, dialects, views, commands, formats of
tool libraries, data.

The names come from the entry points `trunnion.KIND` of installed packages, so a user's own package adds one without
touching ours; the module behind a name is imported on the first `get`.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import EntryPoint, entry_points
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Any

from trunnion.findings import BadCall

FAMILIES = "families"
"""Families of parts, by name."""
PART_KINDS = "part_kinds"
"""Kinds of part that are told from others, but that no family serves yet."""
PLANNERS = "planners"
"""Planners, by the name of their family."""
STRATEGIES = "strategies"
"""Strategies, by name."""
DIALECTS = "dialects"
"""Dialects of controls, by name."""
VIEWS = "views"
"""What families bring to the window, by the family's name."""
FIXES = "fixes"
"""Kinds of fixes that findings ask for: functions that change a process, by the kind's name."""
COMMANDS = "commands"
"""Functions that add a command to the command line (a module's `add(commands)`), by the command's name."""
TOOL_FORMATS = "tool_formats"
"""Formats of tool libraries of other programs, by name."""
RESOURCES = "resources"
"""Packages with data of their own, in folders like those of `trunnion_resources`."""
KINDS = (
    FAMILIES,
    PART_KINDS,
    PLANNERS,
    STRATEGIES,
    DIALECTS,
    VIEWS,
    FIXES,
    COMMANDS,
    TOOL_FORMATS,
    RESOURCES,
)
OWN_RESOURCES = "trunnion_resources"
"""The program's own package of data."""


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


def resource_folders(kind: str) -> tuple[Traversable, ...]:
    """Return where data of a kind (`tools`, `plans`, `translations`, ...) lie: the program's own folder, then those of registered
    packages in the order of their names. A package need not have every folder."""
    packages = (OWN_RESOURCES, *(get(RESOURCES, name) for name in names(RESOURCES)))
    return tuple(files(package).joinpath(kind) for package in packages)
