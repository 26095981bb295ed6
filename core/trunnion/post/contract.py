"""What a dialect is. A user's own package adds one by an entry point `trunnion.dialects`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions


class Dialect(Protocol):
    """Writes programs as text and reads text back. Same programs, header and settings: same bytes.

    `suffix` is the file name's end; the first `STAMP_LINES` lines of every text are its stamp. Where the machine of a setup has rotary
    axes, `work_positions` says where its work stands on it.
    """

    name: str
    suffix: str

    def write(
        self,
        programs: Sequence[Program],
        header: Header,
        settings: PostSettings,
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> str:
        """Return the text; raise `Refused` for what the control can't do."""
        ...

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines as this dialect writes them."""
        ...

    def read(
        self,
        text: str,
        tools: Sequence[AnyTool],
        setups: Sequence[Setup],
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> tuple[Program, ...]:
        """Return the programs that a text says; raise `BadInput` with the line of anything that isn't understood."""
        ...
