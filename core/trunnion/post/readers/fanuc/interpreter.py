"""Reads Fanuc text, ours or edited by hand, into motions."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.cycle import Cycle, CycleKind, Expansion, expanded
from trunnion.model.motion.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import IsoWords
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.sections import Point
from trunnion.post.readers.tilted_sections import TiltedSections
from trunnion.post.readers.tip_modes import TipControl, TipModes
from trunnion.post.readers.tip_moves import TipMover
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.cycles import UP
from trunnion.post.readers.word_address.state import ModalCycle
from trunnion.shop.kinematics import WorkPosition

DIRECTIONS = ("vector I", "vector J", "vector K")
"""What I, J and K are under G43.5: not the centre of an arc."""
MILLISECONDS = 1000.0
_POINTLESS = re.compile(r"([XYZABCIJKRQ])[-+]?0*[1-9][0-9]*(?![0-9.])")
_NAME = re.compile(r"O[0-9]{1,8}\s*(\([^()]*\))?\s*")
_COMMENT = re.compile(r"\([^()]*\)")


@dataclass(frozen=True, slots=True)
class PlaneBlock(Block):
    """A line with G68.2: the `angles` (I, J, K) of its plane in degrees."""

    angles: tuple[float, float, float]


class FanucModes(TipModes):
    """Works off the codes of a Fanuc text. `pending` is the plane of a G68.2 to which G53.1 has still to turn the tool."""

    own = {
        "tip control": "follow_tip",
        "plane": "set_plane",
        "turn to plane": "turn_to_plane",
        "level plane": "level_plane",
    }
    pending: Floats | None = None

    def follow_tip(self, block: Block) -> None:
        """Follow the tip from here on, with the length of the tool (G43.5)."""
        self.set_length(block)
        self.follow(block, "G43.5")

    def drop_length(self, block: Block) -> None:
        """Count the tool's length no longer, and follow the tip no longer."""
        super().drop_length(block)
        self.leave_tip(block)

    def set_plane(self, block: Block) -> None:
        """Take over the angles of a plane (G68.2)."""
        assert isinstance(block, PlaneBlock)
        self.refuse_following(block, "G68.2")
        first, second, third = (math.radians(v) for v in block.angles)
        self.pending = _about_z(first) @ _about_x(second) @ _about_z(third)

    def turn_to_plane(self, block: Block) -> None:
        """Turn the tool along z of the plane of G68.2 (G53.1)."""
        if self.pending is None:
            raise BadInput(f"line {block.line}: G53.1 without a plane; put G68.2 before it")
        matrix, self.pending = self.pending, None
        self.tilt(block, "G53.1", matrix)

    def level_plane(self, block: Block) -> None:
        """Take the plane of the setup again (G69)."""
        self.pending = None
        if isinstance(self.state.sections, TiltedSections):
            self.level(block, "G69")


class FanucMover(TipMover):
    """Moves the tool of a Fanuc text."""

    def drill(self, block: Block, mode: ModalCycle) -> None:
        """Drill a hole as the cycle in force says: from above its plane, along z of the plane of the program."""
        start, retract = self.at, block.words.get(self.language.retract)
        unit = self.state.unit
        plane = mode.retract if retract is None else retract * unit
        if start is not None and start[3:] not in ((), (0.0, 0.0, 1.0)):
            raise BadInput(
                f"line {block.line}: {mode.code} of a tool that leans is not understood; use G68.2 and G53.1"
            )
        begun = mode.level
        if start is not None and (begun is None or not self.state.returns_to_level):
            mode.level = start[2]
        low = min(mode.level, start[2]) if start is not None and mode.level is not None else None
        if low is not None and plane is not None and low < plane:
            raise BadInput(
                f"line {block.line}: {mode.code} begins below its plane {self.language.retract}; lift the tool first"
            )
        super().drill(block, mode)
        mode.level = mode.level if begun is None else begun

    def path_to_hole(self, mode: ModalCycle, start: Point, top: Point, cycle: Cycle) -> list[Point]:
        """Return the ends of the rapids that bring a tool over a hole: across at its height."""
        over = (top[0], top[1], start[2])
        return [] if over == start[:3] else [over]

    def expansion(self, cycle: Cycle, start: Point, top: Point) -> Expansion:
        """Return the moves of a cycle: boring and tapping go out at the feed to the retract plane, further in rapid."""
        if cycle.kind not in (CycleKind.BORE, CycleKind.TAP) or cycle.lift == 0.0:
            return super().expansion(cycle, start, top)
        low = expanded(replace(cycle, lift=0.0), np.array(start[:3]), np.array(top), UP)
        return Expansion(
            position=np.vstack([low.position, np.array(top) + cycle.lift * UP]),
            rapid=np.append(low.rapid, True),
            dwell=np.append(low.dwell, 0.0),
        )


class FanucControl(TipControl):
    """A Fanuc: a program between two % whose number comes first, numbers with points, G43.5 and G68.2."""

    modes_class = FanucModes
    mover_class = FanucMover
    named = False
    percents = 0

    def __init__(
        self,
        words: IsoWords,
        tools: Mapping[int, AnyTool],
        setup: Setup,
        work_position: WorkPosition | None,
    ) -> None:
        super().__init__(replace(words, directions=DIRECTIONS), tools, setup, work_position)

    def read(self, text: str) -> Program:
        """Return the motions of a text; one that a % opens is ended by another."""
        program = super().read(text)
        if self.percents == 1:
            raise BadInput("the program has no closing %: is the text complete?")
        return program

    def read_line(self, number: int, line: str) -> None:
        """Take a line of %, the program's number, or a line of words and comments."""
        if line.strip() == "%":
            self.percents += 1
            if self.begun and not self.ended:
                raise BadInput(
                    f"line {number}: a % in the middle of the program ends it there; remove it"
                )
        elif _NAME.fullmatch(line.strip().upper()):
            if self.named or self.begun:
                raise BadInput(
                    f"line {number}: a program's number stands once, before its first block; remove it"
                )
            self.named = True
        else:
            super().read_line(number, line)

    def split(self, number: int, line: str) -> tuple[Block | None, tuple[str, ...]]:
        """Return the words of a line and its comments: dwells in seconds, vectors and planes by names of their own."""
        block, comments = super().split(number, line)
        if block is None:
            return None, comments
        bare = line.partition(";")[0]
        if "(" in bare:
            bare = _COMMENT.sub(" ", bare)
        bare = "".join(bare.split()).upper()
        if found := _POINTLESS.search(bare):
            word = found.group(0)
            raise BadInput(
                f"line {number}: {shown(word)} without a point counts in the least increment; write {shown(word)}."
            )
        words = block.words
        if "G43.5" in block.codes and words.pop("P", 0.0) != 1.0:
            raise BadInput(
                f"line {number}: G43.5 without P1 turns the tool another way between blocks; write G43.5 H P1"
            )
        if "G68.2" in block.codes:
            return self.plane_of(block), comments
        if "P" in words:
            words["P"] /= MILLISECONDS
        if "G4" in block.codes and "X" in words and "P" not in words:
            words["P"] = words.pop("X")
        sections = self.state.sections
        follows = isinstance(sections, TiltedSections) and sections.follows
        if follows or "G43.5" in block.codes:
            for letter, name in zip("IJK", DIRECTIONS, strict=True):
                if letter in words:
                    words[name] = words.pop(letter)
        return block, comments

    def plane_of(self, block: Block) -> PlaneBlock:
        """Return a line with G68.2, which holds nothing else; its zero is that of the work offset."""
        words = dict(block.words)
        angles = tuple(words.pop(letter, 0.0) for letter in "IJK")
        if any(words.pop(letter, 0.0) for letter in "XYZ") or set(words) - {"N"}:
            raise BadInput(
                f"line {block.line}: of G68.2 only X0. Y0. Z0. and the angles I, J and K are understood"
            )
        if len(block.codes) > 1:
            raise BadInput(
                f"line {block.line}: G68.2 with other codes in its line; write two lines"
            )
        left = {"N": block.words["N"]} if "N" in block.words else {}
        return PlaneBlock(block.line, block.codes, left, (angles[0], angles[1], angles[2]))

    def run(self, block: Block) -> None:
        """Do what one line says; between G68.2 and G53.1 nothing moves."""
        modes = self.modes
        assert isinstance(modes, FanucModes)
        moves = not self.language.moves.isdisjoint(block.words)
        if modes.pending is not None and moves:
            raise BadInput(f"line {block.line}: a move after G68.2 without G53.1; put G53.1 first")
        super().run(block)


def _about_z(angle: float) -> Floats:
    """Return the turn (3, 3) about z: its columns are where the axes go."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _about_x(angle: float) -> Floats:
    """Return the turn (3, 3) about x."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
