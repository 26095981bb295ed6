"""From text back to motions: what the proof reads is what the control will read."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion import registry
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions


def read_program(
    dialect: str,
    text: str,
    tools: Sequence[AnyTool],
    setup: Setup,
    work_positions: WorkPositions = NO_WORK_POSITIONS,
) -> Program:
    """Return the program of one setup that a text in a dialect says; raise `BadInput` with the line of what isn't understood."""
    (program,) = registry.get("dialects", dialect)().read(text, tools, [setup], work_positions)
    return program
