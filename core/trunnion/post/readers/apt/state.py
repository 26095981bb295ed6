"""The modal state of APT CL text while it is read, and the numbers of its statements; lengths in mm."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode
from trunnion.model.tool import AnyTool
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.sections import CuttingState, Sections, TiltedPoses

_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:E[-+]?[0-9]+)?")


class AptState:
    """What is in force at a statement: setup, tool, unit, feed, spindle, coolant and a CIRCLE whose arc is still to end.

    `unit` is mm per unit of length, 0 until UNITS; `feed` mm/min or mm/rev by `feed_mode`; `surface_speed` m/min, 0 unless kept constant;
    `circle` the numbers of a CIRCLE in mm.
    """

    def __init__(self, tools: dict[int, AnyTool], setups: Sequence[Setup]) -> None:
        self.tools, self.setups = tools, {s.name: s for s in setups}
        self.programs: list[Program] = []
        self.setup: Setup | None = setups[0] if len(setups) == 1 else None
        self.sections = Sections(TiltedPoses(self.setup.clearance if self.setup else 0.0))
        self.named = self.rapid = self.ended = self.leans = self.spindle_on = self.locked = False
        self.tool: AnyTool | None = None
        self.unit, self.feed, self.spindle, self.coolant = 0.0, 0.0, 0.0, "off"
        self.surface_speed, self.feed_mode = 0.0, FeedMode.MINUTE
        self.circle: list[float] | None = None

    def close(self) -> None:
        """Add the program of the setup that was read."""
        if self.setup is not None:
            self.programs.append(
                Program(name=self.setup.name, setup=self.setup, sections=self.sections.finished())
            )

    def cutting(self) -> CuttingState:
        """Return what a move runs with."""
        return CuttingState(self.spindle, self.coolant, self.surface_speed)

    def scale(self, line: int) -> float:
        """Return mm per unit of length; raise `BadInput` before UNITS."""
        if self.unit == 0.0:
            raise BadInput(
                f"line {line}: a length before its unit is said; put UNITS/MM or UNITS/INCHES first"
            )
        return self.unit

    def numbers(self, line: int, rest: str, *counts: int) -> list[float]:
        """Return the numbers after a word, zero without a sign; raise `BadInput` unless they are of an allowed count and finite."""
        words = rest.split(",")
        if not all(_NUMBER.fullmatch(w) for w in words):
            raise BadInput(f"line {line}: {shown(rest)} is not a list of numbers")
        values = [float(w) + 0.0 for w in words]
        if len(values) not in counts or not all(math.isfinite(v) for v in values):
            raise BadInput(
                f"line {line}: {shown(rest)} must be {' or '.join(str(c) for c in counts)} numbers"
            )
        return values
