"""The size table: every size of the part and its features, with the faces and the point that it is measured at.

Names are those of the features (`docs/words.md`); the part's own sizes have the feature `part`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.model.session import SizeEntry
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import analysed_sizes, smallest_sizes
from trunnion.recognize.extent import box
from trunnion.recognize.grow import bend_radius

if TYPE_CHECKING:
    from trunnion.part.part import Part

PART = "part"
ROLES = {
    "depth": ("floor", "wall", "bottom", "side"),
    "floor_z": ("floor",),
    "floors_z": ("floor",),
    "top_z": ("top", "wall"),
    "bottom_z": ("bottom",),
    "lowest_rim_z": ("wall",),
    "corner_radius": ("corner", "wall"),
    "floor_fillet": ("floor_fillet", "floor"),
    "leans": ("inner_convergence", "outer_convergence", "wall"),
    "thickness": ("top",),
    "length": ("top",),
    "height": ("top", "wall"),
    "lower_height": ("top",),
    "below_top": ("top",),
    "diameter": ("side",),
    "point_angle": ("bottom",),
    "counterbore_diameter": ("counterbore_side",),
    "counterbore_depth": ("counterbore_floor", "counterbore_side"),
    "countersink_diameter": ("countersink",),
    "countersink_angle": ("countersink",),
}
"""The roles that a size is measured at: the first that the feature has."""
SINGULAR = {
    "floors_z": "floor_z",
    "leans": "lean",
    "diameters": "step_diameter",
    "step_depths": "step_depth",
}
"""What one value of a size with several is called."""
DECIMALS = 4
UNITS = (("lean", "degrees"), ("angle", "degrees"), ("area", "mm2"), ("ratio", ""))
"""Units of sizes whose names end so; all others are lengths."""


def size_table(
    recognition: Recognition,
    graph: FaceGraph,
    part: Part | None = None,
    progress: Progress = NO_PROGRESS,
) -> tuple[SizeEntry, ...]:
    """Return the sizes of the part, then those of its features in their order; `graph` is in the part's coordinates as read.

    With the part itself, what its family measures on it stands among its sizes.
    """
    entries = list(_part_sizes(recognition, graph))
    if part is not None:
        entries.extend(analysed_sizes(recognition, graph, part, progress))
    for feature in recognition.features:
        for name, value in feature.sizes.items():
            if isinstance(value, (bool, str)):
                continue
            faces = measured_at(feature, name, graph)
            if isinstance(value, tuple):
                entries.extend(
                    _entry(SINGULAR.get(name, name), v, feature.id, faces, graph) for v in value
                )
            else:
                entries.append(_entry(name, value, feature.id, faces, graph))
    return tuple(entries)


def measured_at(feature: Feature, name: str, graph: FaceGraph) -> tuple[int, ...]:
    """Return the tags of the faces that a size of a feature is measured at; of radii the faces that have the radius."""
    value = feature.sizes[name]
    for role in ROLES.get(name, ()):
        tags = feature.with_role(role)
        if name in ("corner_radius", "floor_fillet") and isinstance(value, (int, float)):
            tags = tuple(
                t for t in tags if abs(bend_radius(graph, t - 1) - value) < 10.0**-DECIMALS
            )
        if tags:
            return tags
    return feature.tags


def _part_sizes(recognition: Recognition, graph: FaceGraph) -> Iterable[SizeEntry]:
    low, high = box(graph.in_frame(recognition.frame))
    for name, value in zip(("length", "width", "height"), (high - low).tolist(), strict=True):
        yield _entry(name, value, PART, (), graph)
    for name, value in zip(
        ("stock_box_length", "stock_box_width", "stock_box_height"),
        (high - low).tolist(),
        strict=True,
    ):
        yield _entry(name, value, PART, (), graph)
    for rule in smallest_sizes(recognition.family):
        holders = [f for f in recognition.of_kind(*rule.kinds) if _positive(f, rule.size)]
        if holders:
            smallest = min(holders, key=lambda f: (_number(f, rule.size), f.id))
            yield _entry(
                rule.name,
                _number(smallest, rule.size),
                PART,
                measured_at(smallest, rule.size, graph),
                graph,
            )


def _entry(
    name: str, value: float, feature: str, faces: Sequence[int], graph: FaceGraph
) -> SizeEntry:
    at = tuple(np.round(graph.centre[faces[0] - 1], DECIMALS).tolist()) if faces else ()
    unit = next((u for end, u in UNITS if name.endswith(end)), "mm")
    return SizeEntry(
        name=name,
        value=round(float(value), DECIMALS) + 0.0,
        unit=unit,
        feature=feature,
        faces=tuple(faces),
        at=at,
    )


def _positive(feature: Feature, size: str) -> bool:
    return isinstance(feature.sizes.get(size), (int, float)) and _number(feature, size) > 0.0


def _number(feature: Feature, size: str) -> float:
    value = feature.sizes[size]
    return float(value) if isinstance(value, (int, float)) else 0.0
