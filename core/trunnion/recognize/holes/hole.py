"""A hole: a coaxial run with the end that it is drilled from, and what each of its surfaces is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from trunnion.geometry.arrays import Floats
from trunnion.recognize.holes.segments import Segment
from trunnion.tolerance import SLIVER
from trunnion.units import radians

STEEPEST_TAPER = radians(15.0)
"""Half angle up to which a cone by itself is the side of a tapered hole, above it a countersink: tapers of pins, reamers and pipe threads
stay below 5 degrees, countersinks begin at 30."""

SIDE, BOTTOM, COUNTERSINK = "side", "bottom", "countersink"
COUNTERBORE_SIDE, COUNTERBORE_FLOOR = "counterbore_side", "counterbore_floor"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Hole:
    """A hole by face rows, in the coordinates of its graph.

    `mouth` (3,) is the point of the axis where it opens, as high as its highest rim; `direction` (3,) the unit vector out of it. `segments`
    run from the mouth down, heights in mm from the mouth: below it they are negative; `roles` says what each is. `through`: no bottom
    closes it. `sweep` is how much of a turn (radians) its side sweeps: less than a whole one when it is open on a side.

    Rows of faces beyond it, those with the longest common edge first: `opens_in` around the mouth, `leaves_in` around the other end of a
    through hole, `crosses` those of other holes.
    """

    mouth: Floats
    direction: Floats
    segments: tuple[Segment, ...]
    roles: tuple[str, ...]
    through: bool
    sweep: float
    opens_in: tuple[int, ...] = ()
    leaves_in: tuple[int, ...] = ()
    crosses: tuple[int, ...] = ()

    @property
    def faces(self) -> tuple[int, ...]:
        """All face rows, from the mouth down."""
        return tuple(f for s in self.segments for f in s.faces)

    def with_role(self, *roles: str) -> tuple[Segment, ...]:
        """Return the segments that play one of some roles, from the mouth down."""
        return tuple(s for s, r in zip(self.segments, self.roles, strict=True) if r in roles)


def own_side(segments: Sequence[Segment]) -> tuple[int, int]:
    """Return the numbers of the first segment of a hole's own side and of the first one after it; segments run from the mouth down.

    The side is of the narrowest cylinders, or of the steep cones where there is no cylinder, with what is between them. Countersinks alone
    have none: both numbers are then that of the first segment that widens downward.
    """
    cylinders = [s.narrow for s in segments if s.surface == "cylinder"]
    own = [
        k
        for k, s in enumerate(segments)
        if (s.surface == "cylinder" and s.narrow < min(cylinders) + SLIVER)
        or (not cylinders and s.surface == "cone" and s.half_angle <= STEEPEST_TAPER)
    ]
    if own:
        return own[0], own[-1] + 1
    wider = [k for k, s in enumerate(segments) if s.radius_low > s.radius_high + SLIVER]
    neck = min(wider, default=len(segments))
    return neck, neck


def roles_of(segments: Sequence[Segment], through: bool) -> tuple[str, ...]:
    """Return what each segment of a hole is; segments run from the mouth down."""
    first, after = own_side(segments)
    found = []
    for k, segment in enumerate(segments):
        if first <= k < after:
            found.append(SIDE)
        elif segment.closes or (not through and k >= after):
            found.append(BOTTOM if _narrows(segment) else SIDE)
        else:
            found.append(_end_role(segments, k, -1 if k < first else 1))
    return tuple(found)


def _narrows(segment: Segment) -> bool:
    """Return whether a segment becomes narrower downward, or closes: the bottom does, an undercut above it doesn't."""
    return segment.closes != 0 or segment.radius_low < segment.radius_high - SLIVER


def _end_role(segments: Sequence[Segment], k: int, outward: int) -> str:
    """Return what a segment between a hole's side and one of its ends is, `outward` the step to the next one towards that end."""
    segment = segments[k]
    if segment.surface == "cylinder":
        return COUNTERBORE_SIDE
    if segment.bulges:
        return COUNTERSINK
    beyond = k + outward
    shoulder = (
        0 <= beyond < len(segments)
        and segments[beyond].surface == "cylinder"
        and abs(segments[beyond].narrow - segment.wide) < SLIVER
    )
    return COUNTERSINK if segment.surface == "cone" and not shoulder else COUNTERBORE_FLOOR
