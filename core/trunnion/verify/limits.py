"""What the machine allows and how long it takes: travel, feed, spindle speed, and the time with accelerations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error
from trunnion.geometry.arrays import Floats
from trunnion.model.material import Machine
from trunnion.model.program import ProgramSection
from trunnion.verify.kernels import strips as columns
from trunnion.verify.kernels.timing import block_times
from trunnion.verify.motion import Moves

AXES = ("X", "Y", "Z")


def limit_findings(setup: str, sections: Sequence[ProgramSection], machine: Machine) -> list[Finding]:
    """Return an error for every limit of the machine that the sections of a setup exceed."""
    found = []
    positions = [s.path.position for s in sections if len(s.path)]
    if positions:
        travel = np.ptp(np.vstack(positions), axis=0)
        for name, needed in zip(AXES, travel, strict=True):
            axis = machine.axis(name)
            if needed > axis.high - axis.low:
                found.append(error("verify.travel", f"setup {setup} needs {needed:.0f} mm of {name}, {machine.title} has "
                                   f"{axis.high - axis.low:.0f} mm", setup, remedy="choose a larger machine or turn the part"))
    for s in sections:
        fastest = float(s.path.feed.max(initial=0.0))
        if fastest > machine.feed_max * (1 + tolerance.COINCIDENT):
            found.append(error("verify.feed", f"{s.operation} feeds at {fastest:.0f} mm/min, {machine.title} allows {machine.feed_max:.0f}",
                               s.operation, remedy="lower the feed"))
        if not machine.spindle_low <= s.spindle <= machine.spindle_high * (1 + tolerance.COINCIDENT):
            found.append(error("verify.spindle", f"{s.operation} turns the spindle at {s.spindle:.0f} 1/min, {machine.title} has "
                               f"{machine.spindle_low:.0f} to {machine.spindle_high:.0f}", s.operation, remedy="change the spindle speed"))
    return found


def times_of(moves: Moves, machine: Machine) -> Floats:
    """Return the machining time of every move (n,) in s, with accelerations; tool changes are not in it."""
    times = np.zeros(len(moves))
    if not len(moves):
        return times
    first, last = _directions(moves)
    slowest = min(a.acceleration for a in machine.axes if a.kind == "linear")
    run = np.abs(np.column_stack([moves.row[:, columns.X1] - moves.row[:, columns.X0], moves.row[:, columns.Y1] - moves.row[:, columns.Y0],
                                  moves.row[:, columns.Z_END] - moves.row[:, columns.Z_START]]))
    rapid_rates = np.array([machine.axis(name).rapid for name in AXES])
    longest = (run / rapid_rates).max(axis=1)
    rapid_speed = np.divide(moves.length, longest, out=np.zeros(len(moves)), where=longest > 0.0)
    speed = np.where(moves.rapid, rapid_speed, moves.feed) / 60.0
    turn = np.concatenate([[0.0], (first[1:] * last[:-1]).sum(axis=1)])
    block_times(moves.length, speed, turn, slowest, times)
    return times


def _directions(moves: Moves) -> tuple[Floats, Floats]:
    """Return the unit directions at the beginning and the end of every move (n, 3)."""
    row = moves.row
    ends = np.column_stack([row[:, columns.X1] - row[:, columns.X0], row[:, columns.Y1] - row[:, columns.Y0],
                            row[:, columns.Z_END] - row[:, columns.Z_START]])
    first, last = ends.copy(), ends.copy()
    arc = row[:, columns.KIND] != 0.0
    swept = np.abs(row[arc, columns.RADIUS] * row[arc, columns.SWEEP])
    for out, angle in ((first, row[arc, columns.START_ANGLE]), (last, row[arc, columns.START_ANGLE] + row[arc, columns.SWEEP])):
        turn = np.sign(row[arc, columns.SWEEP])
        out[arc, 0], out[arc, 1] = -turn * np.sin(angle) * swept, turn * np.cos(angle) * swept
    return _unit(first), _unit(last)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0)
