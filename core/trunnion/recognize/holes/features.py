"""Features of the kind `hole` as every family writes them: roles by face, sizes in a frame, patterns as attributes."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.geometry.frame import Frame
from trunnion.geometry.sphere import on_axis
from trunnion.model.feature import FaceRole, Feature, Size
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.patterns import CIRCLE, HolePattern
from trunnion.recognize.holes.sizes import hole_sizes
from trunnion.recognize.holes.sweep import TURN
from trunnion.tolerance import TANGENT
from trunnion.units import rounded

HOLE = "hole"
"""The kind of the features."""
UP = (0.0, 0.0, 1.0)


def hole_feature(hole: Hole, id: str, frame: Frame) -> Feature:
    """Return a hole as a feature: `x`, `y` and `top_z` are where it opens in a frame.

    Attributes: `identification`; `direction`, from which it is drilled, where that is not the frame's z; `open_side` where less than a
    whole turn of its side is there.
    """
    x, y, z = frame.to_local(hole.mouth).tolist()
    sizes = {**hole_sizes(hole), "x": rounded(x), "y": rounded(y), "top_z": rounded(z)}
    attributes: dict[str, Size] = {"identification": identification(hole)}
    direction = direction_in(hole, frame)
    if direction != UP:
        attributes["direction"] = direction
    if hole.sweep < TURN - TANGENT:
        attributes["open_side"] = True
    return Feature(
        id=id,
        kind=HOLE,
        faces=tuple(
            FaceRole(role=role, face=row + 1)
            for segment, role in zip(hole.segments, hole.roles, strict=True)
            for row in segment.faces
        ),
        sizes=sizes,
        attributes=attributes,
    )


def direction_in(hole: Hole, frame: Frame) -> tuple[float, float, float]:
    """Return the direction out of a hole in a frame; along one of its axes within the tolerance of angles it is just that axis."""
    x, y, z = (rounded(v) for v in on_axis(frame.local_direction(hole.direction)))
    return x, y, z


def identification(hole: Hole) -> str:
    """Return what sort of hole it is in words: through or blind, with what stands at its ends."""
    sizes = hole_sizes(hole)
    words = ["through" if hole.through else "blind"]
    words += [
        word
        for word, size in (
            ("tapered", "taper_angle"),
            ("counterbored", "counterbore_diameter"),
            ("countersunk", "countersink_diameter"),
        )
        if size in sizes
    ]
    return " ".join([*words, "hole"])


def pattern_attributes(patterns: Sequence[HolePattern]) -> dict[int, dict[str, Size]]:
    """Return for the number of each hole in a pattern what is said of the pattern.

    `pattern` is its kind, `pattern_number` distinguishes patterns, `pattern_count` is the number of its holes. A circle has the
    `pitch_circle_diameter`, and `pattern_positions` where some have no hole; a row its `pitch`; a grid one for each direction and the
    `grid` of holes along them.
    """
    found: dict[int, dict[str, Size]] = {}
    for number, pattern in enumerate(patterns, start=1):
        more: dict[str, Size] = {
            "pattern": pattern.kind,
            "pattern_number": number,
            "pattern_count": len(pattern.members),
        }
        if pattern.kind == CIRCLE:
            more["pitch_circle_diameter"] = pattern.diameter
            if pattern.counts[1] > pattern.counts[0]:
                more["pattern_positions"] = pattern.counts[1]
        elif len(pattern.pitch) == 1:
            more["pitch"] = pattern.pitch[0]
        else:
            more["pitch"] = pattern.pitch
            more["grid"] = tuple(float(c) for c in pattern.counts)
        found.update(dict.fromkeys(pattern.members, more))
    return found
