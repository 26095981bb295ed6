"""A control in Klartext: runs the blocks of a text, and refuses with its line what it doesn't understand; nothing is skipped."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import by_code
from trunnion.post.klartext_words import KlartextWords
from trunnion.post.readers.klartext.blocks import (
    KlartextBlock,
    blocks_of,
    function_of,
    number_after,
    parameters,
    path_words,
    why_not,
)
from trunnion.post.readers.klartext.cycles import CycleWords, strokes_of
from trunnion.post.readers.klartext.moves import AXES, ROTARY, KlartextMover
from trunnion.post.readers.klartext.state import KlartextState
from trunnion.post.readers.numbers import DWELL, FEED, SPINDLE, shown
from trunnion.post.readers.sections import Sections, UprightPoses, operation_of
from trunnion.post.readers.tilted_sections import TiltedSections, TipPoses
from trunnion.post.readers.tools import by_number, check_tool, check_work_position
from trunnion.shop.kinematics import WorkPosition
from trunnion.units import MM_PER_INCH

BEFORE = ("M3", "M7", "M8")
"""M functions that work before the move of their block; the others work after it, M91 in it."""
FUNCTIONS = (*BEFORE, "M0", "M1", "M2", "M5", "M9", "M30", "M91", "M99")
MOST_LEAN = 0.05
"""Degrees that rotary axes may stray by in cycle 32 (TA): over 100 mm of a cutter less than a tenth of a millimetre."""
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
    """The control of one text. `name` is the program's, empty before its first block; `expected` the parts that the next block of an older
    cycle may be, e.g. 9.1."""

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
        self.coolants = {code: coolant for coolant, code in words.coolant.items()}
        self.opened: tuple[str, ...] = ()
        self.closed = self.ended = False
        self.needed = ""

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
        if self.needed and words[:3] != ("CYCL", "DEF", self.needed):
            raise BadInput(f"line {line}: CYCL DEF {self.needed} must come here")
        if self.changes_nothing(block):
            return
        if first in self.blocks:
            self.blocks[first](self, block)
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

    def tool(self, block: KlartextBlock) -> None:
        """Change the tool, or the spindle's speed (`TOOL CALL`); `TOOL DEF` chooses a tool for later."""
        line, state = block.line, self.state
        if block.words[1:2] == ("DEF",):
            return
        if block.words[1:2] != ("CALL",):
            raise BadInput(f"line {line}: TOOL is understood with CALL or DEF after it")
        if self.moves.follows:
            raise BadInput(
                f"line {line}: TOOL CALL under tip control is not understood; put {self.words.no_tip_control} first"
            )
        rest = list(block.words[2:])
        if rest and rest[0].isdigit():
            self.change_tool(line, rest.pop(0))
            if not rest or rest.pop(0) != "Z":
                raise BadInput(f"line {line}: TOOL CALL needs Z after the tool's number, its axis")
        for word in rest:
            if (speed := number_after(block, "S", word)) is not None:
                SPINDLE.check(line, "S", speed)
                state.spindle = speed
            elif (feed := number_after(block, "F", word)) is not None:
                FEED.check(line, "F", feed)
                state.feed = feed * state.feed_unit
            elif number_after(block, "D[LR]", word) != 0.0:
                raise BadInput(
                    f"line {line}: {shown(word)} is not understood in TOOL CALL; call a tool by its number, Z and S"
                )

    def change_tool(self, line: int, number: str) -> None:
        """Bring a tool into the spindle, which stands then."""
        state = self.state
        tool = state.tools.get(int(number)) if len(number) < 9 else None
        if tool is None:
            known = ", ".join(str(t) for t in sorted(state.tools))
            raise BadInput(
                f"line {line}: tool {shown(number)} is not in the tool list; it has {known}"
            )
        state.sections.change_tool()
        state.tool, state.turning, state.over, state.cycle = tool, False, None, ()

    def cycle(self, block: KlartextBlock) -> None:
        """Take over a cycle (`CYCL DEF`), or cut a hole (`CYCL CALL`)."""
        line, words = block.line, block.words
        if words[1:] == ("CALL",):
            self.moves.cut_cycle(line)
            return
        if len(words) < 3 or words[1] != "DEF":
            raise BadInput(
                f"line {line}: CYCL is understood with DEF and a cycle's number after it, or with CALL alone"
            )
        self.needed, number = "", words[2]
        if number in ("9.0", "32.0"):
            self.needed = number.replace(".0", ".1")
        elif number == "9.1":
            self.wait(block)
        elif number in ("32.1", "32.2"):
            self.check_tolerance(block)
        elif number == "247":
            self.set_preset(block)
        elif number.isdigit() and len(number) < 5:
            state = self.state
            given = CycleWords(
                line=line,
                number=int(number),
                values=parameters(block, words[3:]),
                unit=state.unit,
                feed_unit=state.feed_unit,
                spindle=state.spindle,
            )
            state.cycle = strokes_of(given)
        else:
            raise BadInput(
                f"line {line}: CYCL DEF {shown(number)} is not understood; write the moves out"
            )

    def wait(self, block: KlartextBlock) -> None:
        """Dwell for as many seconds as the block says."""
        rest = block.words[3:]
        seconds = (
            number_after(block, "", rest[1]) if len(rest) == 2 and rest[0] == "DWELL" else None
        )
        if seconds is None:
            raise BadInput(f"line {block.line}: CYCL DEF 9.1 needs DWELL and how many seconds")
        DWELL.check(block.line, "DWELL ", seconds)
        self.state.sections.dwell(seconds)

    def check_tolerance(self, block: KlartextBlock) -> None:
        """Check how far the control may leave the path (cycle 32)."""
        line = block.line
        for word in block.words[3:]:
            if (limit := number_after(block, "T", word)) is not None:
                if not 0.0 <= limit * self.state.unit <= tolerance.GOUGE:
                    raise BadInput(
                        f"line {line}: cycle 32 with {shown(word)} rounds corners off by more than {tolerance.GOUGE:g} mm; give a smaller T"
                    )
            elif (lean := number_after(block, "TA", word)) is not None:
                if not 0.0 <= lean <= MOST_LEAN:
                    raise BadInput(
                        f"line {line}: cycle 32 with {shown(word)} lets the tool lean by more than {MOST_LEAN:g} degrees; give a smaller TA"
                    )
            elif word not in ("HSC-MODE:0", "HSC-MODE:1"):
                raise BadInput(
                    f"line {line}: {shown(word)} is not understood in cycle 32; give T, HSC-MODE and TA"
                )

    def set_preset(self, block: KlartextBlock) -> None:
        """Take the preset, which must be that of the setup's work offset."""
        setup, known = self.state.setup, self.words.work_offsets
        given = parameters(block, block.words[3:])
        wanted = known.index(setup.work_offset) + 1 if setup.work_offset in known else 0
        if given != {339: float(wanted)} or not wanted:
            raise BadInput(
                f"line {block.line}: cycle 247 must set the preset of setup {setup.name}: {setup.work_offset} is Q339=+{wanted}"
                if wanted
                else f"line {block.line}: setup {setup.name} has no preset for {setup.work_offset}; known are {', '.join(known)}"
            )
        self.state.preset = True

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
            if name not in FUNCTIONS or (alone and name in ("M91", "M99")):
                where = " without a move" if name in FUNCTIONS else ""
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

    def plane(self, block: KlartextBlock) -> None:
        """Tilt the plane of the program, or take it back (`PLANE`)."""
        line, words = block.line, block.words
        tilted = self.tilted(line, "PLANE")
        if tilted.follows:
            raise BadInput(
                f"line {line}: PLANE under tip control is not understood; put {self.words.no_tip_control} first"
            )
        self.state.pole = self.state.over = None
        if words[1:] == ("RESET", "STAY"):
            tilted.level_out()
            return
        if words[1:2] != ("SPATIAL",):
            raise BadInput(
                f"line {line}: this PLANE is not understood; use PLANE SPATIAL or PLANE RESET STAY"
            )
        angles, rest = (
            [number_after(block, f"SP{n}", w) for n, w in zip("ABC", words[2:5], strict=False)],
            words[5:],
        )
        if len(angles) != 3 or None in angles:
            raise BadInput(f"line {line}: PLANE SPATIAL needs SPA, SPB and SPC, in this order")
        turns = rest[:2] == ("TURN", "FMAX")
        if (
            not turns
            or set(rest[2:]) - {"SEQ+", "SEQ-", "SYM+", "SYM-", "TABLE", "ROT"}
            or rest[-2:] != ("TABLE", "ROT")
        ):
            raise BadInput(
                f"line {line}: of PLANE SPATIAL only TURN FMAX, SEQ or SYM, and TABLE ROT are understood"
            )
        a, b, c = (math.radians(v or 0.0) for v in angles)
        tilted.turn_to(line, "PLANE SPATIAL", _spatial(a, b, c), self.words.top)

    def function(self, block: KlartextBlock) -> None:
        """Follow the tip from here on, or no longer (`FUNCTION TCPM`, `FUNCTION RESET TCPM`)."""
        line, said = block.line, " ".join(block.words)
        tilted = self.tilted(line, "FUNCTION TCPM")
        self.state.pole = self.state.over = None
        if said == self.words.no_tip_control:
            tilted.follows = False
        elif said.removesuffix(" REFPNT TIP-TIP") == self.words.tip_control[0]:
            tilted.follow(line, "FUNCTION TCPM", self.words.no_plane)
        else:
            raise BadInput(
                f"line {line}: this FUNCTION is not understood; use {self.words.tip_control[0]} or {self.words.no_tip_control}"
            )

    def tilted(self, line: int, word: str) -> TiltedSections:
        """Return the sections of a machine with rotary axes; raise `BadInput` for a machine without."""
        sections = self.state.sections
        if not isinstance(sections, TiltedSections):
            raise BadInput(
                f"line {line}: {word} on {self.state.setup.machine}, a machine without rotary axes; remove it"
            )
        return sections

    blocks = {
        "BEGIN": begin,
        "END": end,
        "TOOL": tool,
        "CYCL": cycle,
        "L": line,
        "LN": line,
        "CC": pole,
        "C": arc,
        "CP": arc,
        "PLANE": plane,
        "FUNCTION": function,
    }
    """What each kind of block does, by its first word."""


def _spatial(a: float, b: float, c: float) -> Floats:
    """Return the axes (3, 3), columns, of a plane turned about Z by c, about the new Y by b, about the new X by a: the same as about the
    fixed X, Y and Z one after the other."""
    x = np.array(
        [[1.0, 0.0, 0.0], [0.0, math.cos(a), -math.sin(a)], [0.0, math.sin(a), math.cos(a)]]
    )
    y = np.array(
        [[math.cos(b), 0.0, math.sin(b)], [0.0, 1.0, 0.0], [-math.sin(b), 0.0, math.cos(b)]]
    )
    z = np.array(
        [[math.cos(c), -math.sin(c), 0.0], [math.sin(c), math.cos(c), 0.0], [0.0, 0.0, 1.0]]
    )
    return np.asarray(z @ y @ x)
