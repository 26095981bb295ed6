"""How long the machine takes: feeds, rapids, accelerations, and rotary axes that have to keep up.

Blocks are measured in the way that all axes go together: mm for the linear ones, and for a rotary one the mm in which a linear axis would
gain as much speed. Where no axis turns that is the tip's own way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.material import Machine
from trunnion.units import SECONDS_PER_MINUTE
from trunnion.verify.kernels.timing import block_times
from trunnion.verify.machine.kinematics import AxisPositions, axis_positions
from trunnion.verify.motion import Moves

LINEAR = ("X", "Y", "Z")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MachineTimes:
    """Machining time of moves n, tool changes not in it: seconds (n,); speed (n,) mm/s of the tip, the greatest that it reaches."""

    seconds: Floats
    speed: Floats


def times_of(moves: Moves, axis_positions: AxisPositions, machine: Machine) -> MachineTimes:
    """Return the machining time of every move, with accelerations."""
    n = len(moves)
    seconds, top = np.zeros(n), np.zeros(n)
    if not n:
        return MachineTimes(seconds=seconds, speed=top)
    slowest = min(a.acceleration for a in machine.axes if a.kind == "linear")
    weight = np.array([slowest / np.radians(a.acceleration) for a in machine.rotary])
    axes = np.column_stack([axis_positions.linear, axis_positions.rotary * weight])
    first, last, distance = _distances(axes, axis_positions.move, n)
    arc = moves.sweep != 0.0
    if arc.any():
        first[arc], last[arc] = _tangents(axis_positions, axes, np.flatnonzero(arc))
    length = np.where(axis_positions.turns, distance, moves.length)
    rates = (
        np.array(
            [machine.axis(name).rapid for name in LINEAR]
            + [np.radians(a.rapid) for a in machine.rotary]
        )
        / SECONDS_PER_MINUTE
    )
    fastest = _axis_seconds(
        np.column_stack([axis_positions.linear, axis_positions.rotary]),
        rates,
        axis_positions.move,
        n,
    )
    wanted = np.divide(
        moves.length, moves.feed / SECONDS_PER_MINUTE, out=np.zeros(n), where=~moves.rapid
    )
    least = np.maximum(wanted, np.where(moves.rapid | axis_positions.turns, fastest, 0.0))
    speed = np.divide(length, least, out=np.zeros(n), where=least > 0.0)
    speed[arc] = np.minimum(speed[arc], np.sqrt(slowest * _radii(moves, arc)))
    turn = np.concatenate([[0.0], (first[1:] * last[:-1]).sum(axis=1)])
    block_times(length, speed, turn, slowest, seconds, top)
    return MachineTimes(
        seconds=seconds,
        speed=top * np.divide(moves.length, length, out=np.ones(n), where=length > 0.0),
    )


def seconds_of(moves: Moves, machine: Machine, foot: Floats) -> Floats:
    """Return the machining time of every move in s (n,); `foot` (3,) stands on the middle of the table, in the setup frame."""
    return times_of(moves, axis_positions(moves, machine, foot), machine).seconds


def _distances(axes: Floats, move: Ints, n: int) -> tuple[Floats, Floats, Floats]:
    """Return the unit directions (n, a) at the beginning and the end of every move, and how far its axes go (n,)."""
    step = np.diff(axes, axis=0)
    inner = np.flatnonzero(move[1:] == move[:-1])
    step, owner = step[inner], move[inner]
    begin = np.searchsorted(owner, np.arange(n))
    end = np.searchsorted(owner, np.arange(n), side="right") - 1
    distance = np.bincount(owner, np.linalg.norm(step, axis=1), n).astype(np.float64)
    return _unit(step[begin]), _unit(step[end]), distance


def _tangents(axis_positions: AxisPositions, axes: Floats, rows: Ints) -> tuple[Floats, Floats]:
    """Return the directions at the beginning and the end of arcs: those of the circle through the first and the last three poses."""
    begin = np.searchsorted(axis_positions.move, rows)
    end = np.searchsorted(axis_positions.move, rows, side="right") - 1
    middle = np.minimum(begin + 2, end)
    first = _unit(4.0 * axes[begin + 1] - 3.0 * axes[begin] - axes[middle])
    middle = np.maximum(end - 2, begin)
    last = _unit(3.0 * axes[end] - 4.0 * axes[end - 1] + axes[middle])
    return first, last


def _axis_seconds(axes: Floats, rates: Floats, move: Ints, n: int) -> Floats:
    """Return the seconds (n,) that the axes' own greatest rates require."""
    step = np.abs(np.diff(axes, axis=0)) / rates
    inner = np.flatnonzero(move[1:] == move[:-1])
    return np.asarray(np.bincount(move[inner], step[inner].max(axis=1), n))


def _radii(moves: Moves, arc: Bools) -> Floats:
    out, axis = moves.start[arc] - moves.centre[arc], moves.start_axis[arc]
    return np.asarray(np.linalg.norm(out - (out * axis).sum(axis=1, keepdims=True) * axis, axis=1))


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0)
