"""A control in Klartext: runs the blocks of a text, and refuses with its line what it doesn't understand; nothing is skipped."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import by_code
from trunnion.post.klartext_words import KlartextWords
from trunnion.post.readers.klartext.blocks import (
    KlartextBlock,
    blocks_of,
    function_of,
    path_words,
    why_not,
)
from trunnion.post.readers.klartext.modes import KlartextModes
from trunnion.post.readers.klartext.moves import AXES, ROTARY, KlartextMover
from trunnion.post.readers.klartext.state import KlartextState
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.sections import Sections, UprightPoses, operation_of
from trunnion.post.readers.tilted_sections import TiltedSections, TipPoses
from trunnion.post.readers.tools import by_number, check_tool, check_work_position
from trunnion.shop.kinematics import WorkPosition
from trunnion.units import MM_PER_INCH

BEFORE = ("M3", "M7", "M8")
"""M functions that work before the move of their block; the others work after it, M91 in it."""
FUNCTIONS = (*BEFORE, "M0", "M1", "M2", "M5", "M9", "M30", "M91", "M99")
_NOTHING = ("BLK", "STOP")
"""Words of blocks that move nothing and change nothing: the picture of the blank, a stop."""


def read_klartext(
    text: str,
    tools: Sequence[AnyTool],
    setup: Setup,
    work_position: WorkPosition | None,
    words: KlartextWords,
) -> Program:
    """Return the motions of one setup's text, with the line of each block; raise `BadInput` naming the line of what isn't understood."""
    rotary = work_position if work_position is not None and work_position.machine.rotary else None
    return KlartextControl(words, by_number(tools), setup, rotary).read(text)


class KlartextControl:
    """The control of one text. `blocks` is what each kind of block does, by its first word; `opened` are the program's name and unit."""

    def __init__(
        self,
        words: KlartextWords,
        tools: Mapping[int, AnyTool],
        setup: Setup,
        work_position: WorkPosition | None,
    ) -> None:
        self.words, self.refused = words, by_code(words.refused)
        self.work_position = work_position
        sections = (
            Sections(UprightPoses(setup.clearance))
            if work_position is None
            else TiltedSections(TipPoses(work_position, setup.clearance))
        )
        self.state = KlartextState(tools=tools, setup=setup, sections=sections)
        self.moves = KlartextMover(words, self.state)
        self.modes = modes = KlartextModes(words, self.state, self.moves)
        self.blocks: dict[str, Callable[[KlartextBlock], None]] = {
            "BEGIN": self.begin,
            "END": self.end,
            "TOOL": modes.tool,
            "CYCL": modes.cycle,
            "L": self.line,
            "LN": self.line,
            "CC": self.pole,
            "C": self.arc,
            "CP": self.arc,
            "PLANE": modes.plane,
            "FUNCTION": modes.function,
        }
        self.coolants = {code: coolant for coolant, code in words.coolant.items()}
        self.opened: tuple[str, ...] = ()
        self.closed = self.ended = False

    def read(self, text: str) -> Program:
        """Return the motions of a text."""
        for block in blocks_of(text):
            if isinstance(block, KlartextBlock):
                self.run(block)
            else:
                self.remark(*block)
        if not self.closed:
            raise BadInput("the program has no end (END PGM): is the text complete?")
        setup = self.state.setup
        return Program(name=setup.name, setup=setup, sections=self.state.sections.finished())

    def remark(self, line: int, comment: str) -> None:
        """Take a comment: those of operations and of our own header mean something."""
        if (operation := operation_of(comment)) is not None:
            self.state.sections.operation(operation)
        elif comment.startswith("TOOL "):
            check_tool(line, comment, self.state.tools)
        elif comment.startswith("STANDS "):
            check_work_position(line, comment, self.state.setup, self.work_position)

    def changes_nothing(self, block: KlartextBlock) -> bool:
        """Return whether a block changes nothing that counts here: the picture of the blank, a stop, and on three axes what takes back a
        plane or a tip control."""
        taken_back = (self.words.no_plane, self.words.no_tip_control)
        upright = self.work_position is None and " ".join(block.words) in taken_back
        return block.words[0] in _NOTHING or upright

    def run(self, block: KlartextBlock) -> None:
        """Do what one block says."""
        line, words = block.line, block.words
        first = words[0]
        if self.closed or (self.ended and first != "END"):
            raise BadInput(f"line {line}: stands after the end of the program; remove it")
        if first != "BEGIN" and not self.opened:
            raise BadInput(f"line {line}: a block before BEGIN PGM; put that first")
        if self.modes.needed and words[:3] != ("CYCL", "DEF", self.modes.needed):
            raise BadInput(f"line {line}: CYCL DEF {self.modes.needed} must come here")
        if self.changes_nothing(block):
            return
        if first in self.blocks:
            self.blocks[first](block)
        elif first[0] == "M" and first[1:].isdigit():
            self.functions(line, [function_of(line, word, self.refused) for word in words], True)
        else:
            raise BadInput(f"line {line}: {why_not(first, self.refused)}")

    def begin(self, block: KlartextBlock) -> None:
        """Take the program's name and unit (`BEGIN PGM`)."""
        units = {self.words.units["mm"]: 1.0, self.words.units["inch"]: MM_PER_INCH}
        if (
            self.opened
            or len(block.words) != 4
            or block.words[1] != "PGM"
            or block.words[3] not in units
        ):
            raise BadInput(
                f"line {block.line}: a program begins with BEGIN PGM, its name, and {' or '.join(units)}, once"
            )
        self.opened, self.state.unit = block.words[2:], units[block.words[3]]

    def end(self, block: KlartextBlock) -> None:
        """Take the last block (`END PGM`)."""
        if block.words[1:] != ("PGM", *self.opened):
            raise BadInput(
                f"line {block.line}: the program ends with END PGM {shown(' '.join(self.opened))}"
            )
        self.closed = True

    def line(self, block: KlartextBlock) -> None:
        """Go along a line (`L`, `LN`)."""
        is_vector = block.words[0] == "LN"
        known = (*AXES, *(self.words.directions if is_vector else ROTARY))
        given = path_words(block, known, self.refused)
        self.functions(block.line, [f for f in given.functions if f in BEFORE], False)
        self.moves.line(block.line, given, is_vector)
        self.functions(block.line, [f for f in given.functions if f not in (*BEFORE, "M91")], False)

    def pole(self, block: KlartextBlock) -> None:
        """Take the centre of arcs (`CC`)."""
        self.moves.set_pole(block.line, path_words(block, AXES[:2], self.refused))

    def arc(self, block: KlartextBlock) -> None:
        """Go along an arc (`C`, `CP`)."""
        is_helix = block.words[0] == "CP"
        given = path_words(block, ("IPA", "IZ") if is_helix else AXES, self.refused)
        self.functions(block.line, [f for f in given.functions if f in BEFORE], False)
        (self.moves.helix if is_helix else self.moves.arc)(block.line, given)
        self.functions(block.line, [f for f in given.functions if f not in BEFORE], False)

    def functions(self, line: int, names: list[str], alone: bool) -> None:
        """Do what M functions say."""
        state = self.state
        for name in names:
            if name not in FUNCTIONS or name == "M91" or (alone and name == "M99"):
                where = " without L" if name in FUNCTIONS else ""
                raise BadInput(f"line {line}: {name}{where} is not understood; remove it")
            if name == "M3":
                if state.tool is None or state.spindle <= 0.0:
                    raise BadInput(
                        f"line {line}: M3 without a tool and a spindle speed; put TOOL CALL with S first"
                    )
                state.turning = True
            elif name == "M5":
                state.turning = False
            elif name == "M99":
                self.moves.cut_cycle(line)
        for code, coolant in self.coolants.items():
            if code in names:
                state.coolant = coolant
        self.ended = self.ended or "M30" in names or "M2" in names
