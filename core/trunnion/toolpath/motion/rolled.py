"""Paths laid over the development of a cylinder or cone, rolled back onto it: the axis of the tool is the surface's normal everywhere."""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.development import Development
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.curve import turn
from trunnion.model.motion.toolpath import Motion, Toolpath

RAPID_CHORD = 0.3
"""mm: how far a rapid may cut a corner off the circle it follows, far less than it stays over everything."""
MOST_TURN = math.radians(5.0)
"""Largest turn of the axis in one block."""


def rolled(path: Toolpath, development: Development, frame: Frame, chord: float) -> Toolpath:
    """Return a path over the plane of a development, its tool upright, as a path in a frame; feeds leave their circles by at most `chord`
    mm, below them.

    Raises `Refused` for drilling cycles: a hole has an axis of its own.
    """
    if path.cycles:
        raise Refused("holes are not drilled over a development; give each its own direction")
    if not len(path):
        return path
    start = path.starts()
    start[0] = path.position[0]
    count = _pieces(path, start, development, chord)
    row, piece = items_of(count)
    flat = _positions(path, start, row, (piece + 1) / count[row])
    n = len(row)
    return Toolpath(
        position=frame.to_local(development.to_world(flat)),
        axis=frame.local_direction(development.normals(flat)),
        motion=np.where(path.motion[row] == Motion.RAPID, Motion.RAPID, Motion.LINE),
        centre=np.full((n, 3), np.nan),
        feed=path.feed[row],
        mark=path.mark[row],
        dwell=None,
    )


def laid_flat(path: Toolpath, development: Development, frame: Frame) -> Toolpath:
    """Return a rolled path as straight moves over the plane."""
    flat = development.to_local(frame.to_world(path.position))
    upright = np.tile([0.0, 0.0, 1.0], (len(path), 1))
    # Where the path goes on past half a turn it comes in again at the other side: the jump is no cut.
    jumps = np.zeros(len(path), dtype=bool)
    jumps[1:] = np.abs(np.diff(development.turns(flat))) > math.pi
    return Toolpath(
        position=flat,
        axis=upright,
        motion=np.where(jumps, Motion.RAPID, path.motion),
        centre=np.full((len(path), 3), np.nan),
        feed=np.where(jumps, 0.0, path.feed),
        mark=path.mark,
    )


def _pieces(path: Toolpath, start: Floats, development: Development, chord: float) -> Ints:
    """Return in how many straight pieces each block goes: a chord over an angle t leaves its circle of radius r by r t^2 / 8."""
    arcs = path.motion >= Motion.ARC_CW
    sweep, arm = np.abs(path.sweeps()), np.full(len(path), chord)
    arm[arcs] = np.linalg.norm(start[arcs, :2] - path.centre[arcs, :2], axis=1)
    step = 2.0 * np.arccos(np.clip(1.0 - chord / np.maximum(arm, chord), -1.0, 1.0))
    count = np.where(arcs, np.maximum(np.ceil(sweep / step), 1), 1).astype(np.int64)
    # An arc leaves the chord between its ends by r (1 - cos(t / 2)): where it may go on a cone the ground is no narrower than there.
    off = np.where(arcs, arm * (1.0 - np.cos(0.5 * np.minimum(sweep, 2.0 * math.pi))), 0.0)
    ground = np.minimum(
        development.radius_at(np.minimum(path.position[:, 1], start[:, 1]) - off),
        development.radius_at(np.maximum(path.position[:, 1], start[:, 1]) + off),
    )
    ground = np.maximum(ground, chord)
    wide = np.where(
        arcs,
        sweep * arm / ground,
        np.abs(development.turns(path.position) - development.turns(start)),
    )
    high = np.maximum(path.position[:, 2], start[:, 2])
    radius = np.maximum(
        development.radius_at(path.position[:, 1]), development.radius_at(start[:, 1])
    ) + np.maximum(high, 0.0)
    most = np.where(path.motion == Motion.RAPID, RAPID_CHORD, chord)
    turned = np.minimum(np.sqrt(8.0 * most / radius), MOST_TURN)
    return np.maximum(count, np.ceil(wide / turned).astype(np.int64))


def _positions(path: Toolpath, start: Floats, row: Ints, share: Floats) -> Floats:
    points = start[row] + share[:, None] * (path.position[row] - start[row])
    arcs = np.flatnonzero(path.motion[row] >= Motion.ARC_CW)
    at = row[arcs]
    ray = start[at, :2] - path.centre[at, :2]
    points[arcs, :2] = path.centre[at, :2] + turn(ray, share[arcs] * path.sweeps()[at])
    # The end of a block is written as it is, whatever rounding the arc brings.
    last = share == 1.0
    points[last] = path.position[row[last]]
    return points
