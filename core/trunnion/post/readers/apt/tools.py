"""Statements of APT CL text about tools, spindle and coolant: LOADTL, CUTTER, SPINDL, COOLNT."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.post.readers.apt.state import AptState
from trunnion.post.readers.numbers import SPINDLE, shown
from trunnion.units import METRES_PER_FOOT

SURFACE_WORDS = {"SMM": 1.0, "SFM": METRES_PER_FOOT}
"""Words of a constant surface speed, and m/min of their units."""


def load(state: AptState, line: int, rest: str) -> None:
    """Load a tool by its number, its length compared where it is given."""
    number, *more = rest.split(",")
    tool = next((t for n, t in state.tools.items() if str(n) == number), None)
    if tool is None:
        known = ", ".join(str(n) for n in sorted(state.tools))
        raise BadInput(f"line {line}: tool {shown(number)} is not in the tool list; it has {known}")
    if more and (len(more) != 2 or more[0] != "LENGTH"):
        raise BadInput(
            f"line {line}: LOADTL/{shown(rest)} is not understood; write LOADTL/number,LENGTH,length"
        )
    if more and not _same(state, line, more[1], tool.gauge_length):
        raise BadInput(
            f"line {line}: length {shown(more[1])} is not that of tool {number}, {tool.gauge_length:g} mm"
        )
    state.sections.change_tool()
    state.tool, state.spindle, state.spindle_on, state.surface_speed = tool, 0.0, False, 0.0
    state.locked = False


def cutter(state: AptState, line: int, rest: str) -> None:
    """Compare a cutter's sizes with the loaded tool."""
    sizes = rest.split(",")
    tool = state.tool
    if tool is None:
        raise BadInput(f"line {line}: CUTTER before LOADTL; load the tool first")
    if (
        len(sizes) != 2
        or not _same(state, line, sizes[0], tool.cutter_sizes[0])
        or not _same(state, line, sizes[1], tool.cutter_sizes[1])
    ):
        raise BadInput(
            f"line {line}: CUTTER/{shown(rest)} is not tool {tool.number}, "
            f"CUTTER/{tool.cutter_sizes[0]:g},{tool.cutter_sizes[1]:g} in mm"
        )


def spindl(state: AptState, line: int, rest: str) -> None:
    """Take over the spindle's speed or a constant surface speed."""
    if rest in ("OFF", "LOCK"):
        state.spindle, state.surface_speed, state.spindle_on = 0.0, 0.0, False
        state.locked = rest == "LOCK"
        return
    given = rest.split(",")
    if any(w in given for w in SURFACE_WORDS):
        _keep_surface_speed(state, line, rest)
        return
    words = [w for w in given if w not in ("RPM", "CLW")]
    if len(words) != 1:
        raise BadInput(
            f"line {line}: SPINDL/{shown(rest)} is not understood; write SPINDL/RPM,speed,CLW or SPINDL/OFF"
        )
    speed = state.numbers(line, words[0], 1)[0]
    SPINDLE.check(line, "SPINDL ", speed)
    state.spindle, state.surface_speed, state.spindle_on = speed, 0.0, True
    state.locked = False


def coolnt(state: AptState, line: int, rest: str) -> None:
    """Take over the coolant."""
    if rest not in ("FLOOD", "MIST", "OFF", "ON"):
        raise BadInput(
            f"line {line}: COOLNT/{shown(rest)} is not understood; use FLOOD, MIST or OFF"
        )
    state.coolant = "flood" if rest == "ON" else rest.lower()


def _keep_surface_speed(state: AptState, line: int, rest: str) -> None:
    """Take over a constant surface speed with the highest spindle speed."""
    unit_word = "SMM" if state.scale(line) == 1.0 else "SFM"
    words = [w for w in rest.split(",") if w != "CLW"]
    if len(words) != 4 or words[0] != unit_word or words[2] != "MAXRPM":
        raise BadInput(
            f"line {line}: SPINDL/{shown(rest)} is not understood; write SPINDL/{unit_word},speed,CLW,MAXRPM,speed"
        )
    speed, highest = state.numbers(line, f"{words[1]},{words[3]}", 2)
    for value in (speed, highest):
        SPINDLE.check(line, "SPINDL ", value)
        if value <= 0.0:
            raise BadInput(f"line {line}: a constant surface speed and its MAXRPM are above zero")
    state.spindle, state.spindle_on, state.locked = highest, True, False
    state.surface_speed = speed * SURFACE_WORDS[unit_word]


def _same(state: AptState, line: int, word: str, length: float) -> bool:
    return abs(state.numbers(line, word, 1)[0] * state.scale(line) - length) <= tolerance.WRITTEN
