"""From poses of the tool to positions of the machine's axes, with blocks put in so that the tool goes where it was meant to.

Between two blocks the control moves all axes evenly. Meanwhile the tip leaves its straight way and the tool axis its even turn; where that
is more than allowed, poses of the planned motion come between. Two things are looked at one after the other: the tool axis, which strays
near the pole of the rotary axes, then the tip, which strays with every turn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.shop.kinematics import (
    SLACK,
    UPRIGHT,
    WorkPosition,
    axes_of,
    poses_of,
    rotary_solutions,
    spindle_of,
    words_of,
)
from trunnion.shop.rotary_angles import TURN, beyond, followed

HALVINGS = 40
"""A block through the pole itself is halved until what is left of its lean is below the tolerance: far fewer times than this."""
SHARES = (0.25, 0.5, 0.75)
"""Where a piece of a block is compared with what was planned."""
MARGIN = 0.9
"""Share of the tolerance that a piece is made for: what comes between its samples stays below the whole."""
MOST_TURN = math.radians(30.0)
"""Turn of an axis in one piece, beyond which the samples would not see how far it strays."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PathTolerance:
    """How far the tool may leave its planned motion between blocks, mm: its tip, and by its lean as much again over the flutes (in rapids
    over the whole tool)."""

    feed: float
    rapid: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointPath:
    """Positions of a machine's axes, m blocks: words (m, 3) mm and centre (m, 3) of X, Y, Z; angle (m, a) rad; motion (m,); feed (m,)
    mm/min of the tip, 0 for rapids; dwell (m,) s at the ends, None where there is none."""

    words: Floats
    angle: Floats
    motion: Ints
    centre: Floats
    feed: Floats
    dwell: Floats | None


def joint_path(
    path: Toolpath,
    tool: Tool,
    work_position: WorkPosition,
    start_angle: Floats | None,
    path_tolerance: PathTolerance,
    operation: str,
) -> JointPath:
    """Return the positions of the axes along a path.

    `start_angle` (a,) rad are the angles that the rotary axes have; the path goes on from there when it can, else it begins with others.
    None: it may begin with any. Raises `Refused` for what the machine can't hold or can't follow.
    """
    angle = followed(
        path.axis,
        work_position,
        start_angle,
        MARGIN * path_tolerance.feed / tool.flute_length,
        operation,
    )
    path, angle = _arcs_opened(path, angle, work_position, path_tolerance)
    return _between(path, angle, tool, work_position, path_tolerance, operation)


def arc_points(path: Toolpath, rows: Ints, within: float) -> tuple[Ints, Floats]:
    """Return points along arcs, their ends included, whose chords stay within a distance: row (k,) in order, position (k, 3)."""
    sweep, axis, centre = path.sweeps()[rows], path.axis[rows], path.centre[rows]
    start, end = path.starts()[rows], path.position[rows]
    radius = np.linalg.norm(np.cross(end - centre, axis), axis=1)
    step = 2.0 * np.arccos(np.clip(1.0 - within / np.maximum(radius, within), -1.0, 1.0))
    n = np.maximum(1, np.ceil(np.abs(sweep) / step)).astype(np.int64)
    owner, share = _shares(n)
    axis, out = axis[owner], (start - centre)[owner]
    height = (out * axis).sum(axis=1, keepdims=True) * axis
    climb = ((end - start)[owner] * axis).sum(axis=1, keepdims=True) * axis
    out = out - height
    turn = (share * sweep[owner])[:, None]
    points = (
        centre[owner]
        + height
        + share[:, None] * climb
        + np.cos(turn) * out
        + np.sin(turn) * np.cross(axis, out)
    )
    points[share == 1.0] = end
    return np.repeat(rows, n), points


def lines_for_arcs(path: Toolpath, rows: Ints, within: float) -> tuple[Toolpath, Ints]:
    """Return a path whose arcs in some rows are lines within a distance of them, and the row (m,) that each block comes from."""
    if not len(rows):
        return path, np.arange(len(path))
    owner, points = arc_points(path, rows, within)
    count = np.ones(len(path), np.int64)
    count[rows] = np.bincount(owner, minlength=len(path))[rows]
    row = np.repeat(np.arange(len(path)), count)
    opened = np.zeros(len(path), bool)
    opened[rows] = True
    position, motion, centre = (
        path.position[row],
        np.array(path.motion[row]),
        np.array(path.centre[row]),
    )
    position[opened[row]] = points
    motion[opened[row]], centre[opened[row]] = Motion.LINE, np.nan
    return Toolpath(
        position=position,
        axis=path.axis[row],
        motion=motion,
        centre=centre,
        feed=path.feed[row],
        mark=path.mark[row],
        dwell=path.dwell_of(row),
        work_turns=path.work_turns,
    ), row


def _arcs_opened(
    path: Toolpath, angle: Floats, work_position: WorkPosition, path_tolerance: PathTolerance
) -> tuple[Toolpath, Floats]:
    """Return a path without the arcs that don't lie across the machine's Z, and its angles."""
    arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
    if not len(arcs):
        return path, angle
    is_off_axis = np.linalg.norm(spindle_of(work_position, angle[arcs])[:, :2], axis=1) > UPRIGHT
    turned = np.abs(angle[arcs] - angle[arcs - 1]).max(axis=1, initial=0.0) > SLACK
    opened, row = lines_for_arcs(path, arcs[is_off_axis | turned], MARGIN * path_tolerance.feed)
    return opened, angle[row]


@dataclass(slots=True, eq=False)
class _Pieces:
    """Pieces of blocks: block (p,), shares of it from and to (p,), angles (p, a) at both ends."""

    block: Ints
    start: Floats
    end: Floats
    first: Floats
    last: Floats

    def of(self, keep: Bools | Ints) -> _Pieces:
        return _Pieces(
            self.block[keep], self.start[keep], self.end[keep], self.first[keep], self.last[keep]
        )


def _between(
    path: Toolpath,
    angle: Floats,
    tool: Tool,
    work_position: WorkPosition,
    path_tolerance: PathTolerance,
    operation: str,
) -> JointPath:
    """Return the positions of the axes at a path's poses and at those that must come between them."""
    turning = np.zeros(len(path), bool)
    turning[1:] = np.abs(np.diff(angle, axis=0)).max(axis=1, initial=0.0) > 0.0
    rapid = path.motion == Motion.RAPID
    allowed = np.where(rapid, path_tolerance.rapid, path_tolerance.feed)
    reach = np.where(rapid, tool.gauge_length, tool.flute_length)
    block = np.flatnonzero(turning)
    pieces = _Pieces(
        block, np.zeros(len(block)), np.ones(len(block)), angle[block - 1], angle[block]
    )
    pieces = _axis_held(path, pieces, allowed / reach, work_position, operation)
    still = np.flatnonzero(~turning)
    row, share, inner = _tip_held(path, pieces, allowed, tool.gauge_length, work_position)
    order = np.lexsort((np.concatenate([np.ones(len(still)), share]), np.concatenate([still, row])))
    row = np.concatenate([still, row])[order]
    share = np.concatenate([np.ones(len(still)), share])[order]
    angle = np.vstack([angle[still], inner])[order]
    words = words_of(work_position, _tips(path, row, share), angle, tool.gauge_length)
    centre = np.full_like(words, np.nan)
    arcs = np.flatnonzero(path.motion[row] >= Motion.ARC_CW)
    if len(arcs):
        centre[arcs] = words_of(
            work_position, path.centre[row[arcs]], angle[arcs], tool.gauge_length
        )
    return JointPath(
        words=words,
        angle=angle,
        motion=path.motion[row],
        centre=centre,
        feed=path.feed[row],
        dwell=path.dwell_of(row),
    )


def _axis_held(
    path: Toolpath, pieces: _Pieces, allowed: Floats, work_position: WorkPosition, operation: str
) -> _Pieces:
    """Return pieces halved until the tool axis stays within `allowed` (n,) rad of its even turn; mid poses take the way that is nearer."""
    done: list[_Pieces] = []
    for _ in range(HALVINGS):
        strays = _axis_strays(path, pieces, work_position) > MARGIN * allowed[pieces.block]
        strays |= np.abs(pieces.last - pieces.first).max(axis=1, initial=0.0) > np.pi
        done.append(pieces.of(~strays))
        if not strays.any():
            return _ordered(done)
        pieces = _halved(path, pieces.of(strays), work_position)
        low, high = work_position.limits
        outside = ((pieces.first < low - SLACK) | (pieces.first > high + SLACK)).any(axis=1)
        if outside.any():
            k = int(np.argmax(outside))
            raise Refused(
                f"operation {operation}, block {pieces.block[k] + 1}: {beyond(pieces.first[k : k + 1], work_position)}"
            )
    raise Refused(
        f"operation {operation}, block {pieces.block[0] + 1}: {work_position.machine.title} must turn back {work_position.names} here "
        "because of their limits, and can't while it moves; part the operation or choose another machine"
    )


def _ordered(parts: list[_Pieces]) -> _Pieces:
    whole = _Pieces(
        *(
            np.concatenate([getattr(p, name) for p in parts])
            for name in ("block", "start", "end", "first", "last")
        )
    )
    return whole.of(np.lexsort((whole.start, whole.block)))


def _axis_strays(path: Toolpath, pieces: _Pieces, work_position: WorkPosition) -> Floats:
    """Return by how much (p,) rad the tool axis leaves its even turn in pieces whose axes go evenly."""
    most = np.zeros(len(pieces.block))
    for share in SHARES:
        planned = turned(path, pieces.block, pieces.start + share * (pieces.end - pieces.start))
        done = axes_of(work_position, pieces.first + share * (pieces.last - pieces.first))
        most = np.maximum(most, np.linalg.norm(planned - done, axis=1))
    return most


def _halved(path: Toolpath, pieces: _Pieces, work_position: WorkPosition) -> _Pieces:
    middle = 0.5 * (pieces.start + pieces.end)
    between = 0.5 * (pieces.first + pieces.last)
    angles, free, _ = rotary_solutions(work_position.machine, turned(path, pieces.block, middle))
    angles = angles + TURN * np.round((between[:, None] - angles) / TURN)
    angles = np.where(free, between[:, None], angles)
    solution = np.abs(angles - between[:, None]).sum(axis=2).argmin(axis=1)
    nearest = angles[np.arange(len(solution)), solution]
    return _ordered(
        [
            _Pieces(pieces.block, pieces.start, middle, pieces.first, nearest),
            _Pieces(pieces.block, middle, pieces.end, nearest, pieces.last),
        ]
    )


def _tip_held(
    path: Toolpath, pieces: _Pieces, allowed: Floats, gauge: float, work_position: WorkPosition
) -> tuple[Ints, Floats, Floats]:
    """Return the ends of blocks (row, share of it, angles) along which the tip stays within `allowed` (n,) mm of its straight way."""
    turn = np.abs(pieces.last - pieces.first).max(axis=1, initial=0.0)
    pieces = _parted(pieces, np.maximum(1, np.ceil(turn / MOST_TURN - SLACK)).astype(np.int64))
    done: list[_Pieces] = []
    while len(pieces.block):
        strays = _tip_strays(path, pieces, gauge, work_position) / allowed[pieces.block]
        done.append(pieces.of(strays <= 1.0))
        far = strays > 1.0
        pieces = _parted(pieces.of(far), np.ceil(np.sqrt(strays[far] / MARGIN)).astype(np.int64))
    whole = _ordered([pieces, *done])
    return whole.block, whole.end, whole.last


def _parted(pieces: _Pieces, n: Ints) -> _Pieces:
    """Return each piece in n (p,) equal ones."""
    owner, share = _shares(n)
    before = share - 1.0 / n[owner]
    whole = pieces.of(owner)
    run, turn = whole.end - whole.start, whole.last - whole.first
    last = np.where((share == 1.0)[:, None], whole.last, whole.first + share[:, None] * turn)
    end = np.where(share == 1.0, whole.end, whole.start + share * run)
    return _Pieces(
        whole.block, whole.start + before * run, end, whole.first + before[:, None] * turn, last
    )


def _tip_strays(
    path: Toolpath, pieces: _Pieces, gauge: float, work_position: WorkPosition
) -> Floats:
    """Return by how much (p,) mm the tip leaves its straight way in pieces whose axes go evenly."""
    first = words_of(work_position, _tips(path, pieces.block, pieces.start), pieces.first, gauge)
    last = words_of(work_position, _tips(path, pieces.block, pieces.end), pieces.last, gauge)
    most = np.zeros(len(first))
    for share in SHARES:
        done, _ = poses_of(
            work_position,
            first + share * (last - first),
            pieces.first + share * (pieces.last - pieces.first),
            gauge,
        )
        planned = _tips(path, pieces.block, pieces.start + share * (pieces.end - pieces.start))
        most = np.maximum(most, np.linalg.norm(done - planned, axis=1))
    return most


def _tips(path: Toolpath, block: Ints, share: Floats) -> Floats:
    """Return the tips (k, 3) at shares (k,) of straight blocks."""
    start = path.starts()[block]
    return np.where(
        (share == 1.0)[:, None],
        path.position[block],
        start + share[:, None] * (path.position[block] - start),
    )


def turned(path: Toolpath, block: Ints, share: Floats) -> Floats:
    """Return the tool axes (k, 3) at shares (k,) of blocks: an even turn in the plane of both ends."""
    return even_turn(path.axis[np.maximum(block - 1, 0)], path.axis[block], share)


def even_turn(first: Floats, last: Floats, share: Floats) -> Floats:
    """Return the directions (k, 3) at shares (k,) of the even turn from first to last (k, 3)."""
    angle = 2.0 * np.arctan2(
        np.linalg.norm(first - last, axis=1), np.linalg.norm(first + last, axis=1)
    )
    still = angle < UPRIGHT
    sine = np.where(still, 1.0, np.sin(angle))
    a = np.where(still, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    b = np.where(still, share, np.sin(share * angle) / sine)
    return np.asarray(a[:, None] * first + b[:, None] * last)


def _shares(n: Ints) -> tuple[Ints, Floats]:
    """Return for things parted in n (p,) which each part belongs to (k,), and the share (k,) of it where the part ends, 1 exactly last."""
    owner, number = items_of(n)
    count = number + 1
    return owner, count / n[owner]
