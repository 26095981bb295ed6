"""A control in word-address format: runs the lines of a text, and refuses with its line what it doesn't understand; nothing is skipped.

The order of work inside a line: feed, spindle speed, tool, spindle and coolant, units and offsets, motion, end. On a machine with rotary
axes the words are positions of its axes; what the tool does is reckoned from where the work stands.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import IsoWords
from trunnion.post.readers.sections import Sections, UprightPoses, operation_of
from trunnion.post.readers.tools import check_tool, check_work_position
from trunnion.post.readers.word_address.blocks import Block, split_line
from trunnion.post.readers.word_address.joints import Joints
from trunnion.post.readers.word_address.language import NO_LIMITS, ControlLanguage, listed
from trunnion.post.readers.word_address.modes import MEANINGS, Modes
from trunnion.post.readers.word_address.moves import ToolMover
from trunnion.post.readers.word_address.position_lines import PositionLines
from trunnion.post.readers.word_address.rotary import Rotary
from trunnion.post.readers.word_address.state import ModalState
from trunnion.shop.kinematics import WorkPosition


class Control:
    """The control of one text. What only one control does is in a class derived from this.

    `modes_class` works off its codes, `mover_class` moves the tool; `brackets` says that comments stand in brackets too,
    beside those after a semicolon.
    """

    modes_class: ClassVar[type[Modes]] = Modes
    mover_class: ClassVar[type[ToolMover]] = ToolMover
    brackets: ClassVar[bool] = True

    def __init__(
        self,
        words: IsoWords,
        tools: Mapping[int, AnyTool],
        setup: Setup,
        work_position: WorkPosition | None,
    ) -> None:
        if work_position is not None and not words.inverse_time:
            raise BadInput(
                f"setup {setup.name}: {words.title} has no words for the rotary axes of {work_position.machine.title}; "
                "choose another control or machine"
            )
        self.work_position = work_position
        self.language = ControlLanguage(words, work_position, (*MEANINGS, *self.modes_class.own))
        self.state = ModalState(tools=tools, setup=setup, sections=self.sections_of(setup))
        self.modes = self.modes_class(self.language, self.state)
        self.moves = self.mover_class(self.language, self.state, self.rotary_axes())
        self.straight: PositionLines | None = None
        self.last_n = -1.0
        self.begun = self.ended = False

    def sections_of(self, setup: Setup) -> Sections:
        """Return what gathers the motions: words are tips, on a machine with rotary axes positions of its axes."""
        if self.work_position is None:
            return Sections(UprightPoses(setup.clearance))
        return Sections(Joints(self.work_position, setup.clearance))

    def rotary_axes(self) -> Rotary:
        """Return what keeps the rotary axes while the text is read."""
        return Rotary(self.language.rotary, self.language.inverse)

    def split(self, number: int, line: str) -> tuple[Block | None, tuple[str, ...]]:
        """Return the words of a line, None when it has none, and its comments."""
        return split_line(number, line, self.brackets)

    def read(self, text: str) -> Program:
        """Return the motions of a text; raise `BadInput` naming the line of what isn't understood."""
        for number, line in enumerate(text.split("\n"), 1):
            self.read_line(number, line)
        if not self.ended:
            raise BadInput(
                f"the program has no end ({listed(self.language.ends)}): is the text complete?"
            )
        setup = self.state.setup
        return Program(name=setup.name, setup=setup, sections=self.state.sections.finished())

    def read_line(self, number: int, line: str) -> None:
        """Take the comments of a line, then do what its words say."""
        block, comments = self.split(number, line)
        for comment in comments:
            self.remark(number, comment)
        if block is not None:
            self.run(block)

    def remark(self, line: int, comment: str) -> None:
        """Take a comment: those of operations and of our own header mean something."""
        if (operation := operation_of(comment)) is not None:
            self.state.sections.operation(operation)
        elif comment.startswith("TOOL "):
            check_tool(line, comment, self.state.tools)
        elif comment.startswith("STANDS "):
            check_work_position(line, comment, self.state.setup, self.work_position)

    def run(self, block: Block) -> None:
        """Do what one line says."""
        words, codes, language = block.words, block.codes, self.language
        if not codes and words.keys() <= language.positions and len(words) > ("N" in words):
            if self.straight is None and not self.ended:
                self.straight = self.moves.straight()
            if self.straight is not None:
                self.check_words(block.line, words)
                self.straight.move(block)
                return
        self.straight = None
        self.begun = True
        self.check(block)
        if len(codes) > 1 or (codes and codes[0] not in language.motions):
            self.modes.run(block)
        else:
            if not language.states.isdisjoint(words):
                self.modes.speeds(block)
            if codes:
                self.state.motion, self.state.cycle = language.motions[codes[0]], None
        if not language.moves.isdisjoint(words):
            self.moves.move(block)
        if codes and any(code in codes for code in language.ends):
            self.ended = True

    def check(self, block: Block) -> None:
        """Refuse what can't be understood or stands in a wrong position."""
        line, words, codes = block.line, block.words, block.codes
        if self.ended:
            raise BadInput(
                f"line {line}: stands after the end of the program; remove it or the {self.language.ends[0]} before it"
            )
        for code in codes:
            if code not in self.language.meanings:
                raise BadInput(f"line {line}: {self.language.why_not(code)}")
        self.check_words(line, words)
        if len(codes) > 1:
            self.language.refuse_two_of_a_group(line, codes)
        if not self.language.takers.keys().isdisjoint(words) or len(codes) > 1:
            self.language.refuse_stray_letters(block)
        if codes:
            self.language.refuse_lonely_codes(block)

    def check_words(self, line: int, words: Mapping[str, float]) -> None:
        """Refuse letters that no word of this program begins with, numbers out of range, and lines out of order."""
        limits = self.language.limits
        for letter, value in words.items():
            low, high = limits.get(letter, NO_LIMITS)
            if not low <= value <= high:
                self.language.refuse_word(line, letter, value)
        n = words.get("N")
        if n is not None:
            if n <= self.last_n:
                raise BadInput(
                    f"line {line}: N{n:.10g} comes after N{self.last_n:.10g}: lines are out of order; put them back or renumber "
                    "them"
                )
            self.last_n = n
