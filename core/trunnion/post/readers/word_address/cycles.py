"""Drilling cycles of a text: what its words say of a hole, and what is refused because no control would drill it."""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.motion.cycle import PECKING, WAITING, Cycle, CycleKind
from trunnion.model.spindle import FeedMode, per_revolution
from trunnion.post.readers.numbers import DWELL
from trunnion.post.readers.sections import Point
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.language import ControlLanguage
from trunnion.post.readers.word_address.state import ModalCycle, ModalState

UP = np.array([0.0, 0.0, 1.0])
"""The direction that a control drills along: the program's Z."""


def hole_of(
    block: Block, mode: ModalCycle, state: ModalState, language: ControlLanguage, start: Point
) -> tuple[Cycle, Point]:
    """Return the cycle of a hole and where its axis meets the retract plane, mm; what the line leaves out stays as it was.

    Raises `BadInput` for what is missing, or makes no cycle.
    """
    line, code, words = block.line, mode.code, block.words
    if words.keys().isdisjoint("XYZ") or not words.keys().isdisjoint("IJK"):
        raise BadInput(
            f"line {line}: a hole of {code} is given by X, Y or Z; I, J and K are of arcs"
        )
    take_words(block, mode, state.unit, language)
    if mode.bottom is None or mode.retract is None:
        raise BadInput(
            f"line {line}: {code} needs Z, the bottom, and {language.retract}, the plane"
        )
    if mode.bottom >= mode.retract:
        raise BadInput(
            f"line {line}: {code} with its bottom Z at or above its plane {language.retract}; check them"
        )
    if mode.level is None:
        mode.level = start[2]
    lift = max(mode.level - mode.retract, 0.0) if state.returns_to_level else 0.0
    x, y = words.get("X"), words.get("Y")
    top = (
        start[0] if x is None else x * state.x_unit,
        start[1] if y is None else y * state.unit,
        mode.retract,
    )
    try:
        return Cycle(
            kind=mode.kind,
            depth=mode.retract - mode.bottom,
            lift=lift,
            peck=mode.peck,
            dwell=mode.dwell or 0.0,
            pitch=_pitch(state, top) if mode.kind is CycleKind.TAP else 0.0,
        ), top
    except ValueError as reason:
        raise BadInput(f"line {line}: {code}: {reason}") from None


def path_over(mode: ModalCycle, start: Point, top: Point, cycle: Cycle) -> list[Point]:
    """Return the ends of the rapids that bring a tool over a hole, mm; those that go nowhere are left out.

    As LinuxCNC 2.9 does: where the series began below the retract plane, first straight to that plane, up or down; then to the hole at the
    tool's height, or, where that is not above the retract plane, on the way up to where the cycle ends.
    """
    x, y, plane = top
    at, over = start[:3], []
    if mode.level is not None and mode.level < plane:
        over.append((at[0], at[1], plane))
        at = over[-1]
    over.append((x, y, at[2] if at[2] > plane else plane + cycle.lift))
    before = [start[:3], *over]
    return [end for end, last in zip(over, before, strict=False) if end != last]


def _pitch(state: ModalState, top: Point) -> float:
    """Return the pitch in mm that the feed is at the spindle's speed; 0 where that stands."""
    turns = state.turns_at(top[0])
    if state.feed_mode is FeedMode.REVOLUTION or turns <= 0.0:
        return state.feed if turns > 0.0 else 0.0
    return per_revolution(state.feed, turns)


def take_words(block: Block, mode: ModalCycle, unit: float, language: ControlLanguage) -> None:
    """Take over what a line says of a cycle; raise `BadInput` for a peck or a dwell that is missing or out of range."""
    words, letters, line = block.words, language.words.letters, block.line
    if "Z" in words:
        mode.bottom = words["Z"] * unit
    if language.retract in words:
        mode.retract = words[language.retract] * unit
    if mode.kind in PECKING:
        mode.peck = words.get(letters["peck"], mode.peck / unit) * unit
        if mode.peck <= 0.0:
            raise BadInput(f"line {line}: {mode.code} needs {letters['peck']} above zero, its peck")
    if mode.kind in WAITING:
        seconds = words.get(letters["dwell"], mode.dwell)
        if seconds is None:
            raise BadInput(
                f"line {line}: {mode.code} needs {letters['dwell']}, seconds at the bottom"
            )
        DWELL.check(line, letters["dwell"], seconds)
        mode.dwell = seconds
