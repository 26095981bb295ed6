"""Moves of APT CL text: GOTO, and CIRCLE before the GOTO that ends its arc; RAPID and DELAY."""

from __future__ import annotations

import math

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.post.readers.apt.feeds import pace
from trunnion.post.readers.apt.state import AptState
from trunnion.post.readers.numbers import DWELL, LENGTH
from trunnion.post.readers.sections import NOWHERE, Point
from trunnion.post.readers.word_address.arcs import refuse_nearly_closed, refuse_no_radius

_UP = (0.0, 0.0, 1.0)
_UNIT = 1e-4
"""How far the length of a tool axis may be from 1: other systems write four decimals."""


def go_rapid(state: AptState, line: int, rest: str) -> None:
    """Let the next GOTO be a rapid."""
    if rest:
        raise BadInput(f"line {line}: RAPID takes nothing after it")
    state.rapid = True


def goto(state: AptState, line: int, rest: str) -> None:
    """Add a rapid, a feed or the arc of the CIRCLE before it."""
    x, y, z, *axis = state.numbers(line, rest, 3, 6)
    for value in (x, y, z):
        LENGTH.check(line, "GOTO ", value)
    tool, scale = state.tool, state.scale(line)
    if state.setup is None:
        raise BadInput(
            f"line {line}: a move before its setup; put PPRINT/SETUP name WORK OFFSET word first"
        )
    if tool is None:
        raise BadInput(f"line {line}: a move before a tool is loaded; put LOADTL first")
    point = (x * scale, y * scale, z * scale, *_axis(state, line, axis))
    if not tool.rotates and point[1:2] + point[3:] != (0.0, *_UP):
        raise BadInput(
            f"line {line}: tool {tool.number} turns work in the plane of X and Z; Y must be 0, and no axis given"
        )
    if state.rapid and state.circle is None:
        state.sections.rapid(line, point, tool, state.cutting())
        state.rapid = False
        return
    state.rapid = False
    if tool.locked != state.locked:
        wanted = "SPINDL/LOCK" if tool.locked else "SPINDL/RPM,speed,CLW"
        raise BadInput(f"line {line}: a feed move of tool {tool.number} needs {wanted} before it")
    if not (state.spindle_on or state.locked):
        raise BadInput(f"line {line}: a feed move while the spindle stands; put SPINDL first")
    if state.feed <= 0.0:
        raise BadInput(f"line {line}: a feed move without a feed; put FEDRAT first")
    if state.surface_speed > 0.0 and tool.rotates:
        raise BadInput(
            f"line {line}: a constant surface speed with tool {tool.number}, which rotates; give the spindle speed"
        )
    motion, centre = _motion(state, line, point)
    state.sections.feed(
        line, motion, point, centre, pace(state, line, point[0]), tool, state.cutting()
    )


def arc(state: AptState, line: int, rest: str) -> None:
    """Remember a CIRCLE for the GOTO that ends its arc."""
    numbers, scale = state.numbers(line, rest, 7), state.scale(line)
    for value in (*numbers[:3], numbers[6]):
        LENGTH.check(line, "CIRCLE ", value)
    if state.rapid:
        raise BadInput(f"line {line}: RAPID before an arc; put FEDRAT instead")
    if numbers[3:6] not in ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]):
        raise BadInput(f"line {line}: an arc about another axis than Z is not understood")
    state.circle = [v * scale for v in numbers[:3]] + numbers[3:6] + [numbers[6] * scale]


def delay(state: AptState, line: int, rest: str) -> None:
    """Add a dwell in seconds."""
    seconds = state.numbers(line, rest, 1)[0]
    DWELL.check(line, "DELAY ", seconds)
    state.sections.dwell(seconds)


def _axis(state: AptState, line: int, numbers: list[float]) -> tuple[float, ...]:
    """Return the unit tool axis that a GOTO says: z where it says none or three axes are on; raise `BadInput` for what can't be."""
    if not numbers:
        return _UP
    length = math.hypot(*numbers)
    if abs(length - 1.0) > _UNIT:
        raise BadInput(
            f"line {line}: the tool axis has the length {length:.4f}; it must be a unit vector"
        )
    axis = tuple(v / length for v in numbers)
    if math.hypot(*axis[:2]) <= tolerance.PARAMETRIC and axis[2] > 0.0:
        return _UP
    if not state.leans:
        if math.dist(axis, _UP) > tolerance.ANGLE:
            raise BadInput(f"line {line}: a tilted tool axis after MULTAX/OFF; put MULTAX/ON first")
        return _UP
    return axis


def _motion(state: AptState, line: int, end: Point) -> tuple[Motion, Point]:
    """Return how the move goes, and the centre of the arc when a CIRCLE came before it."""
    start = state.sections.at
    if state.circle is None or start is None:
        state.circle = None
        return Motion.LINE, NOWHERE
    (x, y, z, _, _, sense, radius), state.circle = state.circle, None
    if state.tool is not None and not state.tool.rotates:
        raise BadInput(
            f"line {line}: an arc of a tool that turns work is not understood; write lines"
        )
    if start[3:] != _UP or end[3:] != _UP:
        raise BadInput(f"line {line}: an arc of a tool that leans is not understood; write lines")
    first, last = math.dist((x, y), start[:2]), math.dist((x, y), end[:2])
    refuse_no_radius(line, radius)
    if (
        max(abs(first - radius), abs(last - radius)) > tolerance.ARC_RADIUS
        or abs(z - start[2]) > tolerance.WRITTEN
    ):
        raise BadInput(
            f"line {line}: the arc of radius {radius:.4f} starts at radius {first:.4f} and ends at {last:.4f} mm; "
            "check CIRCLE"
        )
    refuse_no_radius(line, min(first, last))
    refuse_nearly_closed(line, start, end)
    return (Motion.ARC_CCW if sense > 0.0 else Motion.ARC_CW), (x, y, start[2])
