"""A control of a package of one's own, for the tests: words unlike LinuxCNC's, and a % line with the program's name."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.post.iso import IsoDialect
from trunnion.post.readers.word_address.interpreter import Control


class KestrelControl(Control):
    """A control without comments in brackets, whose programs begin with their name after a %."""

    brackets = False
    named = False

    def read_line(self, number: int, line: str) -> None:
        """Take the line with the program's name, or one of words and comments."""
        if line.startswith("%"):
            self.name(number)
        else:
            super().read_line(number, line)

    def name(self, line: int) -> None:
        """Take the name: it comes once, before all blocks."""
        if self.named or self.begun:
            raise BadInput(
                f"line {line}: a program's name stands once, before its first block; remove it"
            )
        self.named = True


class KestrelDialect(IsoDialect):
    """Writes one setup as a Kestrel program and reads it back."""

    name, package = "kestrel", "kestrel"

    def control(self) -> type[Control]:
        """Return the Kestrel's own control."""
        return KestrelControl
