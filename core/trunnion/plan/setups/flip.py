"""How a part is turned from one setup to the next, and how the next one's zero is found again: what the setup sheet says of it."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, info
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.setup import Setup
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.units import degrees, trimmed

TURNED_OVER = "route.turned-over"
"""Code of the finding that says how the part is turned."""
AXES = ("X", "Y", "Z")


def turn_between(first: Frame, second: Frame) -> tuple[Floats, float]:
    """Return the axis (3,), unit, in the machine's axes, and the angle (radians, 0 to pi) that a part is turned by between two clampings.

    From the rotation matrix by its skew and symmetric parts (Rodrigues). Without a turn the axis is z.
    """
    rotation = second.axes @ first.axes.T
    angle = math.acos(float(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0)))
    if angle < tolerance.ANGLE:
        return np.array([0.0, 0.0, 1.0]), 0.0
    if math.pi - angle < tolerance.ANGLE:
        # R + I = 2 a a^T for a half turn: its longest row lies along the axis.
        rows = rotation + np.eye(3)
        axis = rows[int(np.argmax(np.linalg.norm(rows, axis=1)))]
    else:
        axis = np.array(
            [
                rotation[2, 1] - rotation[1, 2],
                rotation[0, 2] - rotation[2, 0],
                rotation[1, 0] - rotation[0, 1],
            ]
        )
    return axis / np.linalg.norm(axis), angle


def turn_words(first: Setup, second: Setup) -> str:
    """Return in words how the part is turned between two setups, about an axis of the first one."""
    axis, angle = turn_between(first.frame, second.frame)
    if angle == 0.0:
        return f"The part lies as in {first.name}."
    along = int(np.argmax(np.abs(axis)))
    turn = f"{trimmed(degrees(angle), 2)} degrees"
    if abs(float(axis[along])) < math.cos(tolerance.ANGLE):
        numbers = ", ".join(trimmed(float(v), 4) for v in axis)
        return f"The part is turned by {turn} about the direction ({numbers}) of {first.name}."
    sense = "" if math.pi - angle < tolerance.ANGLE or axis[along] > 0.0 else "minus "
    kept = f"{AXES[along]} points along the part as before"
    return f"The part is turned by {turn} about {sense}{AXES[along]} of {first.name}; {kept}."


def zero_words(space: SetupSpace) -> str:
    """Return in words where a setup's zero lies from the finished part, for the blank's own edges may be cut away by then."""
    graph = space.part.graph()
    points = space.setup.frame.to_local(
        np.vstack([graph.start, graph.middle, graph.end, graph.sample_point])
    )
    low, high = points.min(axis=0), points.max(axis=0)
    words = [_beside(axis, float(low[k]), float(high[k])) for k, axis in enumerate(AXES[:2])] + [
        _height(float(low[2]), float(high[2]))
    ]
    return f"{space.setup.work_offset} of {space.setup.name}, from the finished part: {', '.join(words)}."


def turned(first: SetupSpace, second: SetupSpace) -> Finding:
    """Return the note on how the part is turned for a setup, and how that one's zero is found."""
    return info(
        TURNED_OVER,
        f"{second.setup.name}: {turn_words(first.setup, second.setup)} {zero_words(second)}",
        second.setup.name,
        remedy="find the zero by probing faces that are finished or were not touched",
    )


def _beside(axis: str, low: float, high: float) -> str:
    """Return where zero lies along an axis from the sides of a part that reaches from low to high."""
    if math.isclose(low + high, 0.0, abs_tol=tolerance.SEW):
        return f"{axis} in the middle of its {trimmed(high - low, 3)} mm"
    side, away = ("smallest", low) if abs(low) <= abs(high) else ("largest", -high)
    if abs(away) < tolerance.SEW:
        return f"{axis} at its side of {side} {axis}"
    where = "outside" if away > 0.0 else "inside"
    return f"{axis} {trimmed(abs(away), 3)} mm {where} its side of {side} {axis}"


def _height(low: float, high: float) -> str:
    """Return where zero lies in height: at the face that is up, else from the one that the part lies on, which is finished by then."""
    if abs(high) < tolerance.SEW:
        return "Z at the face that is up"
    if abs(low) < tolerance.SEW:
        return "Z at the face that it lies on"
    return (
        f"Z {trimmed(abs(low), 3)} mm {'over' if low < 0.0 else 'below'} the face that it lies on"
    )
