"""Triangles over the development of a cylinder or cone: cut finer until straight pieces stand for what bends when it is laid flat."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.development import Development

CHORD = 8e-3
"""mm: how far an edge that is straight in space may be from its straight stand-in over the plane; more than bent faces' meshes are off."""
HALVINGS = 18
"""Times that triangles are cut in two: of edges of 1 m pieces of 4 mm are left, as there are two long ones in each."""


def developed_triangles(
    corners: Floats, development: Development, lowest: float, margin: float
) -> Floats:
    """Return the corners (m, 3, 3) over the plane of triangles (t, 3, 3) in the part's coordinates.

    Those wholly below `lowest` mm are left out. Half a turn from the plane's middle and up to `margin` rad beyond, what is round there
    comes again, so that nothing ends where the plane does.
    """
    flat, turn = _laid(corners, development)
    kept = flat[:, :, 2].max(axis=1) > lowest
    corners, flat, turn = corners[kept], flat[kept], turn[kept]
    done, turns = [], []
    for n in range(HALVINGS + 1):
        long = _bends(turn, flat, development)
        if n == HALVINGS:
            long[:] = False
        done.append(flat[~long])
        turns.append(turn[~long])
        if not long.any():
            break
        corners = _halved(corners[long], turn[long])
        flat, turn = _laid(corners, development)
    flat, turn = np.concatenate(done), np.concatenate(turns)
    found = [flat]
    for sense in (-1.0, 1.0):
        again = turn + 2.0 * np.pi * sense
        inside = np.abs(again).min(axis=1) < np.pi + margin
        found.append(_moved(flat[inside], turn[inside], again[inside], development))
    return np.concatenate(found)


def _laid(corners: Floats, development: Development) -> tuple[Floats, Floats]:
    """Return the corners over the plane and their angles, all of a triangle on one side of where the plane ends."""
    local = development.frame.to_local(corners)
    turn = np.arctan2(local[..., 1], local[..., 0]) - development.middle
    turn = np.mod(turn + np.pi, 2.0 * np.pi) - np.pi
    first = turn[:, :1]
    turn = first + np.mod(turn - first + np.pi, 2.0 * np.pi) - np.pi
    radius = np.hypot(local[..., 0], local[..., 1])
    return development.from_cylindrical(radius, turn, local[..., 2]), turn


def _bends(turn: Floats, flat: Floats, development: Development) -> Bools:
    """Return which triangles have an edge that leaves its straight stand-in by more than the chord error: r t^2 / 8 for an angle t."""
    wide = np.ptp(turn, axis=1)
    radius = development.radius_at(flat[:, :, 1]).max(axis=1) + flat[:, :, 2].max(axis=1)
    return np.asarray(radius * wide**2 / 8.0 > CHORD)


def _halved(corners: Floats, turn: Floats) -> Floats:
    """Return triangles cut in two at the middle of the edge that goes furthest about the axis: what goes along the axis bends nowhere."""
    wide = np.abs(np.roll(turn, -1, axis=1) - turn)
    first = (np.argmax(wide, axis=1)[:, None] + np.arange(3)) % 3
    a, b, c = np.moveaxis(np.take_along_axis(corners, first[:, :, None], axis=1), 1, 0)
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _moved(flat: Floats, turn: Floats, again: Floats, development: Development) -> Floats:
    """Return triangles over the plane turned on about the axis."""
    world = development.to_world(flat)
    local = development.frame.to_local(world)
    return development.from_cylindrical(
        np.hypot(local[..., 0], local[..., 1]), again, local[..., 2]
    )
