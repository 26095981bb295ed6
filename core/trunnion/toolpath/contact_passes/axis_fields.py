"""Tool axis fields: the lead and tilt that a tool should have at its contacts, before clearance is queried.

A field takes contact points, outward unit normals and unit feed directions (k, 3) and returns unit axes (k, 3), from tip to spindle.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, unit

AxisField = Callable[[Floats, Floats, Floats], Floats]
_AT_VECTOR = 1e-9
"""mm: a contact this close to the position of a vector has that vector."""


def leaning(lead: float, tilt: float) -> AxisField:
    """Return the field that leans from the normal: by `lead` towards the feed, then by `tilt` (rad) to its left, seen from outside."""

    def field(point: Floats, normal: Floats, feed: Floats) -> Floats:
        forward = math.cos(lead) * normal + math.sin(lead) * feed
        return np.asarray(math.cos(tilt) * forward + math.sin(tilt) * np.cross(normal, feed))

    return field


def fixed(direction: ArrayLike) -> AxisField:
    """Return the field that is the same everywhere."""
    axis = unit(direction, "tool axis")

    def field(point: Floats, normal: Floats, feed: Floats) -> Floats:
        return np.tile(axis, (len(point), 1))

    return field


def from_point(position: ArrayLike, away: bool = True) -> AxisField:
    """Return the field of axes that point away from a position (3,), as spokes do, or towards it."""
    point = np.asarray(position, dtype=np.float64)
    return from_curve(np.stack([point, point]), away)


def from_curve(curve: ArrayLike, away: bool = True) -> AxisField:
    """Return the field of axes that point away from the nearest point of a polyline (m, 3), m at least 2, or towards it."""
    points = np.asarray(curve, dtype=np.float64)

    def field(point: Floats, normal: Floats, feed: Floats) -> Floats:
        ray = point - nearest(points, point)
        size = np.linalg.norm(ray, axis=1, keepdims=True)
        if (size <= _AT_VECTOR).any():
            raise BadInput(
                "the tool axis can't point away from a place where the tool touches: choose one off the faces"
            )
        return ray / (size if away else -size)

    return field


def interpolated(positions: ArrayLike, axes: ArrayLike) -> AxisField:
    """Return the field between chosen vectors: axes (m, 3) at positions (m, 3), weighed by the inverse square of the distance to each."""
    where, directions = (
        np.asarray(positions, dtype=np.float64).reshape(-1, 3),
        unit(axes, "tool axis").reshape(-1, 3),
    )

    def field(point: Floats, normal: Floats, feed: Floats) -> Floats:
        away = np.linalg.norm(point[:, None] - where[None], axis=2)
        weight = 1.0 / np.maximum(away, _AT_VECTOR) ** 2
        mean = (weight / weight.sum(axis=1, keepdims=True)) @ directions
        size = np.linalg.norm(mean, axis=1, keepdims=True)
        # Vectors that cancel each other say nothing: the nearest one counts.
        return np.where(
            size > math.sqrt(_AT_VECTOR),
            mean / np.maximum(size, _AT_VECTOR),
            directions[np.argmin(away, axis=1)],
        )

    return field


def nearest(curve: Floats, point: Floats) -> Floats:
    """Return the nearest point (k, 3) of a polyline (m, 3) to each point (k, 3)."""
    start, direction = curve[:-1], np.diff(curve, axis=0)
    square = (direction * direction).sum(axis=1)
    share = ((point[:, None] - start) * direction).sum(axis=2) / np.where(square > 0.0, square, 1.0)
    on = start + np.clip(share, 0.0, 1.0)[:, :, None] * direction
    row = np.argmin(np.linalg.norm(point[:, None] - on, axis=2), axis=1)
    return on[np.arange(len(point)), row]


def eased(axis: Floats, reach: float) -> Floats:
    """Return axes (k, 3) at even steps of a path, each the mean of those about it, weighed by a bell curve `reach` steps wide (one sigma).

    What turns at a rate keeps to it: the mean of turns is no faster than the fastest of them.
    """
    if len(axis) < 2 or reach <= 0.0:
        return axis
    half = max(1, math.ceil(3.0 * reach))
    weight = np.exp(-0.5 * (np.arange(-half, half + 1) / reach) ** 2)
    # Mirrored through its ends, which therefore stay.
    before = (
        2.0 * (axis[:1] * axis[1 : half + 1]).sum(axis=1, keepdims=True) * axis[:1]
        - axis[1 : half + 1]
    )
    after = (
        2.0 * (axis[-1:] * axis[-half - 1 : -1]).sum(axis=1, keepdims=True) * axis[-1:]
        - axis[-half - 1 : -1]
    )
    padded = np.vstack([_filled(before[::-1], half, True), axis, _filled(after[::-1], half, False)])
    mean = np.column_stack(
        [np.convolve(padded[:, c], weight / weight.sum(), mode="valid") for c in range(3)]
    )
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))


def _filled(rows: Floats, count: int, in_front: bool) -> Floats:
    """Return rows filled up to a count with the outermost one."""
    missing = count - len(rows)
    if missing <= 0:
        return rows
    more = np.repeat(rows[:1] if in_front else rows[-1:], missing, axis=0)
    return np.vstack([more, rows]) if in_front else np.vstack([rows, more])
