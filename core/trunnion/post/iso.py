"""A dialect in word-address format (ISO 6983, "G code"): one setup a text, words as data, and a control that reads them.

A dialect of this kind derives from `IsoDialect` and gives a name, words, and a reader's control where the shared one doesn't know all that
its own does.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.header import Header
from trunnion.post.iso_words import iso_words
from trunnion.post.settings import PostSettings
from trunnion.post.words import check_one_setup
from trunnion.post.writer.program import ProgramWriter, comment
from trunnion.post.writer.tip_control import TipWriter
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions

if TYPE_CHECKING:
    from trunnion.post.readers.word_address.interpreter import Control


class IsoDialect:
    """Writes one setup as a program and reads it back; see `trunnion.post.contract.Dialect`.

    `package` is the package that has the words as `NAME.toml`; empty for our own resources.
    """

    name: ClassVar[str]
    package: ClassVar[str] = ""

    def __init__(self) -> None:
        self.words = iso_words(self.name, self.package)
        self.suffix = self.words.suffix

    def write(
        self,
        programs: Sequence[Program],
        header: Header,
        settings: PostSettings,
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> str:
        """Return the text of one setup's program."""
        check_one_setup(self.words.title, programs)
        work_position = work_positions.get(programs[0].setup.name)
        follows = self.words.directions and work_position and work_position.machine.rotary
        writer_class = TipWriter if follows else ProgramWriter
        writer = writer_class(self.words, programs[0], settings, work_position)
        return "\n".join(writer.lines(header)) + "\n"

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines as comments."""
        return tuple(comment(self.words, line) for line in header.stamp(program))

    def read(
        self,
        text: str,
        tools: Sequence[AnyTool],
        setups: Sequence[Setup],
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> tuple[Program, ...]:
        """Return the program of the one setup."""
        from trunnion.post.readers.iso import read_iso

        check_one_setup(self.words.title, setups)
        return (
            read_iso(
                text,
                tools,
                setups[0],
                work_positions.get(setups[0].name),
                self.words,
                self.control(),
            ),
        )

    def control(self) -> type[Control]:
        """Return the control that reads the dialect's texts."""
        from trunnion.post.readers.word_address.interpreter import Control

        return Control
