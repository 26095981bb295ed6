"""Heidenhain TNC 640 in Klartext: blocks with words for what they do, five axes by vectors under TCPM and by PLANE SPATIAL.

All it writes is in its words, `dialects/heidenhain.toml`; how it is said is in `writer/klartext.py`, what is read in `readers/klartext/`.
"""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.header import Header
from trunnion.post.klartext_words import klartext_words
from trunnion.post.settings import PostSettings
from trunnion.post.words import check_one_setup
from trunnion.post.writer.klartext import KlartextTipWriter, KlartextWriter, klartext_stamp
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions


class HeidenhainDialect:
    """Writes one setup as a Klartext program and reads it back; see `trunnion.post.contract.Dialect`."""

    name = "heidenhain"

    def __init__(self) -> None:
        self.words = klartext_words(self.name)
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
        rotary = work_position is not None and bool(work_position.machine.rotary)
        writer_class = KlartextTipWriter if rotary else KlartextWriter
        writer = writer_class(self.words, programs[0], settings, work_position)
        return "\n".join(writer.lines(header)) + "\n"

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines: the first block, and comments."""
        return klartext_stamp(self.words, program, header)

    def read(
        self,
        text: str,
        tools: Sequence[AnyTool],
        setups: Sequence[Setup],
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> tuple[Program, ...]:
        """Return the program of the one setup."""
        from trunnion.post.readers.klartext.interpreter import read_klartext

        check_one_setup(self.words.title, setups)
        work_position = work_positions.get(setups[0].name)
        return (read_klartext(text, tools, setups[0], work_position, self.words),)
