"""Reads LinuxCNC text, ours or edited by hand, into motions. Its own are the lines of % that may open and end a text."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import iso_words
from trunnion.post.readers.iso import read_iso
from trunnion.post.readers.word_address.interpreter import Control
from trunnion.shop.kinematics import WorkPosition


def read_linuxcnc(
    text: str, tools: Sequence[AnyTool], setup: Setup, work_position: WorkPosition | None = None
) -> Program:
    """Return the motions of one setup's text; see `read_iso`."""
    return read_iso(text, tools, setup, work_position, iso_words("linuxcnc"), LinuxCncControl)


class LinuxCncControl(Control):
    """A control for which a % line opens the text and the next ends it."""

    def read_line(self, number: int, line: str) -> None:
        """Take a line of % or one of words and comments."""
        if line.strip() == "%":
            self.percent(number)
        else:
            super().read_line(number, line)

    def percent(self, line: int) -> None:
        """Take a line of %: it must not stand in the middle of the program."""
        if self.begun and not self.ended:
            raise BadInput(
                f"line {line}: a % in the middle of the program ends it there; remove it"
            )
        self.begun = True
