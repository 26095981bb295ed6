"""Reads APT CL text into motions: ours, or edited by hand with the same words. Anything else is refused with its line."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.readers.apt.feeds import fedrat
from trunnion.post.readers.apt.moves import arc, delay, go_rapid, goto
from trunnion.post.readers.apt.state import AptState
from trunnion.post.readers.apt.statements import statements
from trunnion.post.readers.apt.tools import coolnt, cutter, load, spindl
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.sections import Sections, TiltedPoses, operation_of
from trunnion.post.readers.tools import by_number, check_tool
from trunnion.units import MM_PER_INCH

_SETUP = re.compile(r"SETUP\s+(\S+)\s+WORK OFFSET\s+(\S+)$", re.IGNORECASE)


def read_apt(text: str, tools: Sequence[AnyTool], setups: Sequence[Setup]) -> tuple[Program, ...]:
    """Return the program of each setup that a CL text names; raise `BadInput` naming the line of what isn't understood.

    A text that names no setup belongs to the only one given.
    """
    state = AptState(by_number(tools), setups)
    for line, word, arguments in statements(text):
        _run(state, line, word, arguments)
    return _finished(state)


def _run(state: AptState, line: int, word: str, rest: str) -> None:
    """Do one statement."""
    if state.ended:
        raise BadInput(f"line {line}: {shown(word)} stands after FINI; remove it")
    if word not in _WORDS:
        raise BadInput(
            f"line {line}: {shown(word)} is not understood; known are {', '.join(_WORDS)}"
        )
    if state.circle is not None and word != "GOTO":
        raise BadInput(
            f"line {line}: after CIRCLE comes the GOTO that ends the arc, not {shown(word)}"
        )
    _WORDS[word](state, line, rest)


def _finished(state: AptState) -> tuple[Program, ...]:
    """Return the programs; raise `BadInput` when the text has no end."""
    if not state.ended:
        raise BadInput("the text has no FINI: is it complete?")
    state.close()
    return tuple(state.programs)


def _text(state: AptState, line: int, rest: str) -> None:
    if found := _SETUP.match(rest):
        _next_setup(state, line, found.group(1), found.group(2))
    elif (operation := operation_of(rest)) is not None:
        state.sections.operation(operation)
    else:
        check_tool(line, rest, state.tools)


def _next_setup(state: AptState, line: int, name: str, offset: str) -> None:
    if name not in state.setups:
        raise BadInput(
            f"line {line}: setup {shown(name)} is not in the plan; it has {', '.join(state.setups)}"
        )
    if state.setups[name].work_offset != offset.upper():
        raise BadInput(
            f"line {line}: {shown(offset)} is not the work offset of setup {name}, {state.setups[name].work_offset}"
        )
    if state.named:
        state.close()
    if any(p.setup.name == name for p in state.programs):
        raise BadInput(f"line {line}: setup {name} comes twice; put its operations together")
    state.setup, state.named, state.tool = state.setups[name], True, None
    state.sections = Sections(TiltedPoses(state.setup.clearance))


def _units(state: AptState, line: int, rest: str) -> None:
    if rest not in ("MM", "INCHES"):
        raise BadInput(f"line {line}: UNITS/{shown(rest)} is not understood; use MM or INCHES")
    unit = MM_PER_INCH if rest == "INCHES" else 1.0
    if state.unit not in (0.0, unit):
        raise BadInput(f"line {line}: the units change in the middle of the text; keep one")
    state.unit = unit


def _multax(state: AptState, line: int, rest: str) -> None:
    if rest not in ("ON", "OFF", ""):
        raise BadInput(f"line {line}: MULTAX/{shown(rest)} is not understood; use ON or OFF")
    state.leans = rest != "OFF"


def _pause(state: AptState, line: int, rest: str) -> None:
    if rest:
        raise BadInput(f"line {line}: END takes nothing after it")


def _fini(state: AptState, line: int, rest: str) -> None:
    _pause(state, line, rest)
    state.ended = True


_WORDS: Mapping[str, Callable[[AptState, int, str], None]] = {
    "PARTNO": _text,
    "PPRINT": _text,
    "REMARK": _text,
    "UNITS": _units,
    "MULTAX": _multax,
    "LOADTL": load,
    "CUTTER": cutter,
    "SPINDL": spindl,
    "COOLNT": coolnt,
    "RAPID": go_rapid,
    "FEDRAT": fedrat,
    "GOTO": goto,
    "CIRCLE": arc,
    "DELAY": delay,
    "END": _pause,
    "FINI": _fini,
}
"""Major words and what each statement of them does."""
