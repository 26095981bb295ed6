"""What the machine allows: travel, rotary axes, feed and spindle speed."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error
from trunnion.model.material import Axis, Machine
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.verify.machine.kinematics import SLACK, UP, AxisPositions, angle_between
from trunnion.verify.machine.times import LINEAR
from trunnion.verify.motion import Moves


def limit_findings(
    setup: str,
    sections: Sequence[ProgramSection],
    moves: Moves,
    axis_positions: AxisPositions,
    machine: Machine,
) -> list[Finding]:
    """Return an error for every limit of the machine that the sections of a setup exceed."""
    found = _travel(setup, axis_positions, machine)
    for k, s in enumerate(sections):
        fastest = float(s.path.feed.max(initial=0.0))
        if fastest > machine.feed_max * (1 + tolerance.COINCIDENT):
            found.append(
                error(
                    "verify.feed",
                    f"{s.operation} feeds at {fastest:.0f} mm/min, {machine.title} allows {machine.feed_max:.0f}",
                    s.operation,
                    remedy="lower the feed",
                )
            )
        if s.tool.locked:
            found += _locked_findings(s)
        elif s.spindle_stopped:
            found += _spindle_findings(s)
        elif (
            not machine.spindle_low
            <= s.spindle
            <= machine.spindle_high * (1 + tolerance.COINCIDENT)
        ):
            found.append(
                error(
                    "verify.spindle",
                    f"{s.operation} turns the spindle at {s.spindle:.0f} 1/min, {machine.title} has "
                    f"{machine.spindle_low:.0f} to {machine.spindle_high:.0f}",
                    s.operation,
                    remedy="change the spindle speed",
                )
            )
        found += _rotary(s, k, moves, axis_positions, machine)
    return found


def _spindle_findings(section: ProgramSection) -> list[Finding]:
    """Return an error when a section feeds while its spindle stands; rapids may."""
    feeds = np.flatnonzero(section.path.motion != Motion.RAPID)
    if not len(feeds):
        return []
    block = int(feeds[0])
    where = (
        f"line {section.block_lines[block]}"
        if block < len(section.block_lines)
        else f"block {block}"
    )
    return [
        error(
            "verify.spindle-stands",
            f"{section.operation} feeds the cutter with the spindle standing still "
            f"(S{section.spindle:g}) from {where} on",
            section.operation,
            where,
            remedy="give the spindle speed before the cut",
        )
    ]


def _locked_findings(section: ProgramSection) -> list[Finding]:
    """Return an error when a turning insert turns with its spindle."""
    if section.spindle_stopped:
        return []
    return [
        error(
            "verify.spindle",
            f"{section.operation} turns {section.tool.name}, a turning insert, at {section.spindle:.0f} 1/min",
            section.operation,
            remedy="lock the spindle",
        )
    ]


def _travel(setup: str, axis_positions: AxisPositions, machine: Machine) -> list[Finding]:
    if not len(axis_positions.move):
        return []
    found = []
    for name, needed in zip(LINEAR, np.ptp(axis_positions.linear, axis=0), strict=True):
        axis = machine.axis(name)
        if needed > axis.high - axis.low:
            found.append(
                error(
                    "verify.travel",
                    f"setup {setup} needs {needed:.0f} mm of {name}, {machine.title} has "
                    f"{axis.high - axis.low:.0f} mm",
                    setup,
                    remedy="choose a larger machine or turn the part",
                )
            )
    return found


def _rotary(
    section: ProgramSection,
    index: int,
    moves: Moves,
    axis_positions: AxisPositions,
    machine: Machine,
) -> list[Finding]:
    rows = moves.section == index
    lost = np.flatnonzero(rows & ~axis_positions.reached)
    if len(lost):
        axes = np.vstack([moves.start_axis[lost], moves.end_axis[lost]])
        lean = math.degrees(float(angle_between(axes, np.broadcast_to(UP, axes.shape)).max()))
        has = (
            f"has {' and '.join(a.name for a in machine.rotary)} only"
            if machine.rotary
            else "has no rotary axes"
        )
        return [
            error(
                "verify.rotary",
                f"{section.operation} leans the tool axis by {lean:.1f} degrees where {machine.title} {has} "
                "and can't",
                section.operation,
                remedy="choose a machine with five axes, or a setup that this axis is upright in",
            )
        ]
    poses = rows[axis_positions.move]
    return [
        _outside(
            section,
            axis,
            axis_positions.rotary[poses, k].min(initial=0.0),
            axis_positions.rotary[poses, k].max(initial=0.0),
            machine,
        )
        for k, axis in enumerate(machine.rotary)
        if axis_positions.rotary[poses, k].min(initial=0.0) < math.radians(axis.low) - SLACK
        or axis_positions.rotary[poses, k].max(initial=0.0) > math.radians(axis.high) + SLACK
    ]


def _outside(
    section: ProgramSection, axis: Axis, low: float, high: float, machine: Machine
) -> Finding:
    return error(
        "verify.rotary",
        f"{section.operation} needs {axis.name} from {math.degrees(low):.1f} to {math.degrees(high):.1f} "
        f"degrees, {machine.title} has {axis.low:g} to {axis.high:g}",
        section.operation,
        remedy="lean the tool less or another way, turn the part in its setup, or choose another machine",
    )
