"""Straight moves while the modal state stays: most lines of a long program say no more than where the tool goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import AnyTool
from trunnion.post.readers.sections import NOWHERE, CuttingState, Pace, Point, Sections
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.rotary import Rotary


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PositionLines:
    """Moves a tool that is ready by lines of a position alone (`ControlLanguage.positions`), in rapid where `pace` is None.

    `units` are the mm of a written X, Y and Z. It holds until a line changes the modal state.
    """

    sections: Sections
    rotary: Rotary
    tool: AnyTool
    cutting: CuttingState
    pace: Pace | None
    units: tuple[float, float, float]

    def move(self, block: Block) -> None:
        """Move as a line says; raise `BadInput` for a turn that is not understood."""
        at = self.sections.local
        assert at is not None
        angle = self.rotary.step(block, at[3:])
        point = end_of(block.words, at, self.units, angle)
        if self.pace is None:
            self.sections.rapid(block.line, point, self.tool, self.cutting)
        else:
            self.sections.feed(
                block.line, Motion.LINE, point, NOWHERE, self.pace, self.tool, self.cutting
            )


def end_of(
    words: Mapping[str, float],
    at: Point,
    units: tuple[float, float, float],
    angle: Sequence[float],
) -> Point:
    """Return the end of a move from a point, with the rotary axes at an angle after it; a number that is left out stays."""
    x, y, z = words.get("X"), words.get("Y"), words.get("Z")
    return (
        at[0] if x is None else x * units[0],
        at[1] if y is None else y * units[1],
        at[2] if z is None else z * units[2],
        *angle,
    )
