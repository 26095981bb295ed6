"""The sizes of a hole in the words of drawings: diameter, depth, counterbore, countersink, point, in mm and degrees."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from trunnion.model.feature import Size
from trunnion.recognize.holes.hole import (
    BOTTOM,
    COUNTERBORE_FLOOR,
    COUNTERBORE_SIDE,
    COUNTERSINK,
    SIDE,
    Hole,
    own_side,
)
from trunnion.recognize.holes.segments import Segment
from trunnion.units import degrees, rounded

BACK = "back_"
"""Stands before the sizes of what is at the far end of a through hole."""


def diameter(hole: Hole) -> float:
    """Return the diameter (mm) of a hole's side, of a tapered one at its narrow end; of a bare point that of its rim."""
    sides = hole.with_role(SIDE, COUNTERSINK)
    own = [s.narrow for s in hole.with_role(SIDE) if s.surface in ("cylinder", "cone")]
    return 2.0 * min(own or [s.narrow for s in sides] or [s.wide for s in hole.segments])


def depth(hole: Hole) -> float:
    """Return the depth (mm) below the highest rim: all through, or as far as the full diameter goes, which is above a point or a ball."""
    full = [s for s in hole.segments if s.surface == "cylinder"] or list(hole.with_role(SIDE))
    reached = hole.segments if hole.through or not full else full
    return max(-s.low for s in reached)


def hole_sizes(hole: Hole) -> dict[str, Size]:
    """Return the sizes of a hole by name.

    `diameter`, `depth`, `through`; where it has them `counterbore_diameter`, `counterbore_depth`, `shoulder_angle`,
    `countersink_diameter`, `countersink_angle`, `rim_radius` (those of the far end with `back_` before), `point_angle`, `bottom_radius`,
    `taper_angle`, and from three diameters on `diameters` with the `step_depths` at which they end.
    """
    sizes: dict[str, Size] = {
        "diameter": rounded(diameter(hole)),
        "depth": rounded(depth(hole)),
        "through": hole.through,
    }
    first, after = own_side(hole.segments)
    parts = list(zip(hole.segments, hole.roles, strict=True))
    sizes.update(_end_sizes("", parts[:first], lambda s: -s.low))
    if hole.through:
        low = min(s.low for s in hole.segments)
        sizes.update(_end_sizes(BACK, parts[after:][::-1], lambda s: s.high - low))
    for segment, role in parts:
        if role == BOTTOM and segment.surface == "cone":
            sizes["point_angle"] = _angle(segment)
        elif role == BOTTOM and segment.surface == "sphere":
            sizes["bottom_radius"] = rounded(segment.minor)
        elif role == SIDE and segment.surface == "cone":
            sizes["taper_angle"] = _angle(segment)
    steps = [s for s in hole.segments if s.surface == "cylinder"]
    if len(steps) > 2:
        sizes["diameters"] = tuple(rounded(2.0 * s.narrow) for s in steps)
        sizes["step_depths"] = tuple(rounded(-s.low) for s in steps)
    return sizes


def _end_sizes(
    prefix: str, parts: Sequence[tuple[Segment, str]], deep: Callable[[Segment], float]
) -> dict[str, Size]:
    """Return the sizes of what is between an end and the hole's own side, the outermost of a sort; `parts` run inward."""
    sizes: dict[str, Size] = {}
    for segment, role in parts:
        if role == COUNTERBORE_SIDE and f"{prefix}counterbore_diameter" not in sizes:
            sizes[f"{prefix}counterbore_diameter"] = rounded(2.0 * segment.narrow)
            sizes[f"{prefix}counterbore_depth"] = rounded(deep(segment))
        elif role == COUNTERBORE_FLOOR and segment.surface == "cone":
            sizes.setdefault(f"{prefix}shoulder_angle", _angle(segment))
        elif role == COUNTERSINK and segment.surface == "cone":
            sizes.setdefault(f"{prefix}countersink_diameter", rounded(2.0 * segment.wide))
            sizes.setdefault(f"{prefix}countersink_angle", _angle(segment))
        elif role == COUNTERSINK:
            sizes.setdefault(f"{prefix}rim_radius", rounded(segment.minor))
    return sizes


def _angle(segment: Segment) -> float:
    return rounded(degrees(2.0 * segment.half_angle))
