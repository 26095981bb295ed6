"""What the blocks of a Klartext set: tools and spindle, cycles, tilted planes, tip control."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.post.klartext_words import KlartextWords
from trunnion.post.readers.klartext.blocks import KlartextBlock, number_after, parameters
from trunnion.post.readers.klartext.cycles import CycleWords, strokes_of
from trunnion.post.readers.klartext.moves import KlartextMover
from trunnion.post.readers.klartext.state import KlartextState
from trunnion.post.readers.numbers import DWELL, FEED, SPINDLE, shown
from trunnion.post.readers.tilted_sections import TiltedSections

MOST_LEAN = 0.05
"""Degrees that rotary axes may stray by in cycle 32 (TA): over 100 mm of a cutter less than a tenth of a millimetre."""


class KlartextModes:
    """Works off the blocks that move nothing by themselves.

    `needed` is the part of an older cycle that must come next, as 9.1 after 9.0.
    """

    def __init__(self, words: KlartextWords, state: KlartextState, moves: KlartextMover) -> None:
        self.words, self.state, self.moves = words, state, moves
        self.needed = ""

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
        side = ("SEQ+" in rest) - ("SEQ-" in rest)
        tilted.turn_to(line, "PLANE SPATIAL", _spatial(a, b, c), self.words.top, side)

    def function(self, block: KlartextBlock) -> None:
        """Follow the tip from here on, or no longer (`FUNCTION TCPM`, `FUNCTION RESET TCPM`)."""
        line, words = block.line, " ".join(block.words)
        tilted = self.tilted(line, "FUNCTION TCPM")
        self.state.pole = self.state.over = None
        if words == self.words.no_tip_control:
            tilted.follows = False
        elif words.removesuffix(" REFPNT TIP-TIP") == self.words.tip_control[0]:
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
