"""Drilling cycles: one block with its parameters, and the plain motions that it stands for.

The motions are those of RS274/NGC (T. Kramer, F. Proctor, E. Messina, The NIST RS274NGC Interpreter, NISTIR 6556, 2000, section 3.5.16) and
of LinuxCNC for chip breaking and tapping. Heights are along the tool axis from the retract plane: above it positive.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats

BACK_OFF = 0.254
"""mm: how far a peck ends above the one before in its rapid, and chips are broken by: RS274/NGC has a hundredth of an inch."""
MOST_PECKS = 1000
"""Pecks of one hole: more is a slip of the hand."""


class CycleKind(StrEnum):
    """How a hole is cut in one block."""

    DRILL = "drill"
    DWELL = "dwell"
    """Drilling with a wait at the bottom, for flat ones."""
    PECK = "peck"
    """Deep drilling: after each peck out to the retract plane."""
    CHIP_BREAK = "chip-break"
    """Deep drilling: after each peck back by a little."""
    REAM = "ream"
    """In and out to the retract plane at the feed."""
    BORE = "bore"
    """In, a wait, and out at the feed."""
    TAP = "tap"
    """In at a pitch a revolution, out with the spindle reversed."""


PECKING = (CycleKind.PECK, CycleKind.CHIP_BREAK)
WAITING = (CycleKind.DWELL, CycleKind.BORE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A drilling cycle. `depth` mm from the retract plane to the bottom; `lift` mm above the retract plane where it ends.

    `peck` mm of one stroke, `dwell` s at the bottom, `pitch` mm of the thread: each of its own kinds, else 0.
    """

    kind: CycleKind
    depth: float
    lift: float = 0.0
    peck: float = 0.0
    dwell: float = 0.0
    pitch: float = 0.0

    def __post_init__(self) -> None:
        if wrong := self._wrong():
            raise ValueError(f"cycle {self.kind}: {wrong}")

    def _wrong(self) -> str:
        """Return what its numbers lack, or nothing."""
        if self.depth <= 0.0 or self.lift < 0.0:
            return "its depth is above 0 and it ends at or above the retract plane"
        if (self.kind in PECKING) != (self.peck != 0.0):
            return "deep drilling has a peck, and nothing else"
        if self.kind in PECKING and self.peck <= BACK_OFF:
            return f"a peck is deeper than the back-off of {BACK_OFF:g} mm"
        if self.pecks > MOST_PECKS:
            return f"{self.pecks} pecks are more than {MOST_PECKS}"
        if self.dwell < 0.0 or (self.dwell > 0.0 and self.kind not in WAITING):
            return "only dwell drilling and boring wait at the bottom"
        if self.kind is CycleKind.DWELL and self.dwell == 0.0:
            return "its dwell is above 0"
        if (self.kind is CycleKind.TAP) != (self.pitch > 0.0):
            return "tapping has a pitch above 0, and nothing else"
        return ""

    @property
    def pecks(self) -> int:
        """How many strokes it goes down in."""
        if self.peck <= 0.0:
            return 1
        return max(1, math.ceil((self.depth - tolerance.COINCIDENT) / self.peck))


class Stroke(NamedTuple):
    """One move along the axis to a height in mm above the retract plane, and how long the tool waits there, s."""

    height: float
    rapid: bool
    dwell: float = 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Expansion:
    """The plain moves k of a cycle: position (k, 3) mm at the end of each, rapid (k,), dwell (k,) s at its end."""

    position: Floats
    rapid: Bools
    dwell: Floats

    def __len__(self) -> int:
        return len(self.rapid)


def strokes(cycle: Cycle) -> Iterator[Stroke]:
    """Yield the moves of a cycle along its axis from the retract plane on."""
    for k in range(1, cycle.pecks):
        yield Stroke(-k * cycle.peck, False)
        if cycle.kind is CycleKind.PECK:
            yield Stroke(0.0, True)
        yield Stroke(BACK_OFF - k * cycle.peck, True)
    yield Stroke(-cycle.depth, False, cycle.dwell)
    if cycle.kind is CycleKind.REAM:
        yield Stroke(0.0, False)
    yield Stroke(cycle.lift, cycle.kind not in (CycleKind.BORE, CycleKind.TAP))


def expanded(cycle: Cycle, start: Floats, top: Floats, axis: Floats) -> Expansion:
    """Return the plain moves of a cycle on a hole whose axis (3,) meets the retract plane at `top` (3,), from a start (3,).

    A start below the retract plane is left straight up to it; then over the hole, down to the retract plane, and the strokes. A rapid that
    goes nowhere is left out.
    """
    height = float((start - top) @ axis)
    above = max(height, 0.0)
    moves = [(start + (above - height) * axis, True, 0.0)]
    moves += [(top + above * axis, True, 0.0), (top, True, 0.0)]
    moves += [(top + s.height * axis, s.rapid, s.dwell) for s in strokes(cycle)]
    kept, at = [], start
    for move in moves:
        if not move[1] or np.linalg.norm(move[0] - at) > tolerance.COINCIDENT:
            kept.append(move)
            at = move[0]
    position, rapid, dwell = zip(*kept, strict=True)
    return Expansion(
        position=np.array(position), rapid=np.array(rapid, bool), dwell=np.array(dwell)
    )
