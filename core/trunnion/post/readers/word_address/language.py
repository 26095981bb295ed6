"""The words of a control in word-address format as its reader looks them up, and why it refuses others."""

from __future__ import annotations

import math
from collections.abc import Iterable

from trunnion.findings import BadInput
from trunnion.model.motion.cycle import PECKING, WAITING, CycleKind
from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import AnyTool
from trunnion.post.iso_words import IsoWords, by_code
from trunnion.post.readers.numbers import COUNT, LENGTH, LINE_NUMBER, NumberRange
from trunnion.post.readers.word_address.blocks import Block
from trunnion.shop.kinematics import SLACK, WorkPosition
from trunnion.units import MM_PER_INCH

_LETTERS = "NFSTXYZIJ"
"""Letters that mean the same on all controls."""
_ROTARY = "ABC"
_UNITS = {"mm": 1.0, "inch": MM_PER_INCH}
_TAKEN_BY = {
    "dwell": "dwell",
    "tolerance": "path tolerance",
    "joining": "path tolerance",
    "length": "length",
    "highest": "surface speed",
}
"""The meaning of the code that takes a letter of each role."""
NO_LIMITS = (math.inf, -math.inf)
"""Ends of a range that no number is in."""
_NEEDED = {"dwell": "dwell", "path tolerance": "tolerance", "surface speed": "highest"}
"""The role without whose letter a meaning says nothing."""


class ControlLanguage:
    """The codes and letters that a text may have, for the axes of a machine.

    `meanings` says what each known code makes the control do; `motions`, `units` (mm), `coolants` what those of one kind mean. `letters`
    are those of all words, `ranges` the numbers after them, `limits` their ends; `moves` are letters of a move, `arc` of an arc, `states`
    those that change the modal state without a code, `positions` those that say where a straight move ends and nothing else; `takers` are
    the codes that take a letter. A code or letter is "" where the control has none of its kind. `known` are the meanings that the control
    understands.
    """

    def __init__(
        self, words: IsoWords, work_position: WorkPosition | None, known: Iterable[str]
    ) -> None:
        self.words = words
        self.motions = {code: Motion(n) for n, code in enumerate(words.motions)}
        self.units = {words.units[name]: unit for name, unit in _UNITS.items()}
        self.coolants = {code: name for name, code in words.coolant.items()}
        self.cycles = {code: CycleKind(kind) for kind, code in words.cycles.items()}
        levels = dict(zip(words.return_levels, ("initial level", "retract plane"), strict=True))
        self.refused = by_code(words.refused)
        meanings = self._checked(tuple(known))
        self.meanings = {
            **dict.fromkeys(self.motions, "motion"),
            **dict.fromkeys(self.units, "units"),
            **dict.fromkeys(self.coolants, "coolant"),
            **dict.fromkeys(words.work_offsets, "work offset"),
            **dict.fromkeys(self.cycles, "cycle"),
            **{code: meaning for code, meaning in levels.items() if code},
            **meanings,
        }
        self.dwell, self.length, self.tool_change = (
            self._first(m) for m in ("dwell", "length", "tool change")
        )
        self.machine, self.inverse, self.spindle = (
            self._first(m) for m in ("machine", "inverse time", "spindle")
        )
        self.locked_spindle = self._first("locked spindle")
        self.turning_plane, self.milling_plane = (
            self._first(m) for m in ("turning plane", "milling plane")
        )
        self.ends = tuple(code for code, meaning in meanings.items() if meaning == "end")
        self.groups = (
            (*self.motions, *self.cycles, *(c for c, m in meanings.items() if m == "no motion")),
            tuple(self.units),
            words.work_offsets,
            *(tuple(group.split()) for group in words.groups),
        )
        self._find_letters(words.letters, work_position)

    def _checked(self, known: tuple[str, ...]) -> dict[str, str]:
        """Return the meanings of codes as the words give them; raise `BadInput` for an unknown one, or a letter that is missing."""
        meanings = by_code(self.words.codes)
        for code, meaning in meanings.items():
            if meaning not in known:
                raise BadInput(
                    f"dialect {self.words.title}: {code}: {meaning!r} is no meaning of a code; known: {', '.join(known)}"
                )
            if meaning in _NEEDED and _NEEDED[meaning] not in self.words.letters:
                raise BadInput(
                    f"dialect {self.words.title}: letters needs an entry {_NEEDED[meaning]} for {code}"
                )
        return meanings

    def _find_letters(self, role: dict[str, str], work_position: WorkPosition | None) -> None:
        """Find out which letters a text may have, what numbers follow them, and which codes take those that need one."""
        self.rotary = work_position.names if work_position else ""
        self.radius, self.turns, self.length_letter = (
            role["radius"],
            role.get("turns", ""),
            role.get("length", ""),
        )
        self.arc = frozenset(("I", "J", self.radius))
        self.directions = self.words.directions if work_position else ()
        self.moves = self.arc | set("XYZ") | set(self.rotary) | set(self.directions)
        self.takers: dict[str, tuple[str, ...]] = {}
        for name, meaning in _TAKEN_BY.items():
            if name in role and (
                codes := tuple(code for code, m in self.meanings.items() if m == meaning)
            ):
                if name == "length":
                    codes += tuple(c for c, m in self.meanings.items() if m == "tip control")
                self.takers[role[name]] = (*self.takers.get(role[name], ()), *codes)
        for name, kinds in (("peck", PECKING), ("dwell", WAITING)):
            if codes := tuple(code for code, kind in self.cycles.items() if kind in kinds):
                self.takers[role[name]] = (*self.takers.get(role[name], ()), *codes)
        self.retract = role.get("retract", "") if self.cycles else ""
        self.turns_work = work_position is None and "turning plane" in self.meanings.values()
        self.moves |= set(self.retract) | ({"K"} if self.turns_work else set())
        self.states = frozenset("FST") | (
            {self.length_letter} if self.length_letter and not self.length else set()
        )
        self.letters = (
            frozenset(_LETTERS)
            | self.moves
            | self.takers.keys()
            | self.states
            | ({self.turns} if self.turns else set())
            | ({self.retract} if self.retract else set())
        )
        self.ranges = {
            **dict.fromkeys((*"XYZIJK", self.radius, *self.retract), LENGTH),
            "T": COUNT,
            "N": LINE_NUMBER,
        }
        if self.length_letter:
            self.ranges[self.length_letter] = COUNT
        if work_position is not None:
            self.ranges |= {
                a.name: NumberRange(a.low, a.high, "degrees", math.degrees(SLACK))
                for a in work_position.machine.rotary
            }
        positions = frozenset((*"NXYZ", *self.directions))
        self.positions = positions - self.takers.keys() - self.states
        self.limits = {
            letter: self.ranges[letter].limits if letter in self.ranges else (-math.inf, math.inf)
            for letter in self.letters
        }

    def _first(self, meaning: str) -> str:
        return next((code for code, m in self.meanings.items() if m == meaning), "")

    def why_not(self, code: str) -> str:
        """Return why a code is refused, and what to write for it."""
        if code in self.refused:
            return f"{code}: {self.refused[code].replace('{code}', code)}"
        return f"{code} is not understood; remove it or write what it does in known words"

    def refuse_word(self, line: int, letter: str, value: float) -> None:
        """Raise `BadInput` for a word beyond its `limits`: no word of this program begins with its letter, or it is out of range."""
        if letter not in self.letters:
            axes = (
                f"a program for the axes XYZ{self.rotary}"
                if self.rotary
                else "a three-axis program"
            )
            raise BadInput(f"line {line}: the word {letter} is not understood by {axes}; remove it")
        self.ranges[letter].check(line, letter, value)

    def refuse_two_of_a_group(self, line: int, codes: list[str]) -> None:
        """Raise `BadInput` for two codes of one modal group."""
        for group in self.groups:
            found = [c for c in codes if c in group]
            if len(found) > 1:
                raise BadInput(
                    f"line {line}: {' and '.join(found)} can't stand in one line; keep one"
                )

    def refuse_stray_letters(self, block: Block) -> None:
        """Raise `BadInput` for a letter without the code or the arc that takes it, and for one that two codes of the line would take."""
        for letter, takers in self.takers.items():
            if letter in block.words and not self._is_taken(letter, takers, block):
                raise BadInput(
                    f"line {block.line}: {self._stray(letter, takers, block.words[letter])}"
                )
        if len(block.codes) > 1:
            for letter, takers in self.takers.items():
                found = [c for c in takers if c in block.codes]
                if len(found) > 1:
                    raise BadInput(
                        f"line {block.line}: {' and '.join(found)} in one line: whose {letter} it is is not clear; "
                        "write two lines"
                    )

    def _is_taken(self, letter: str, takers: tuple[str, ...], block: Block) -> bool:
        by_arc = letter == self.turns and ("I" in block.words or "J" in block.words)
        return by_arc or any(code in block.codes for code in takers)

    def _stray(self, letter: str, takers: tuple[str, ...], value: float) -> str:
        if letter == self.length_letter:
            return f"{letter} without {self.length}; write {self.length} {letter}{value:g}"
        return f"{letter} without {listed((*takers, 'an arc') if letter == self.turns else takers)}; remove it"

    def refuse_lonely_codes(self, block: Block) -> None:
        """Raise `BadInput` for a dwell with a move, and for machine coordinates without one."""
        words, codes, line = block.words, block.codes, block.line
        if self.dwell in codes and not (self.moves | set(_ROTARY)).isdisjoint(words):
            raise BadInput(
                f"line {line}: a dwell {self.dwell} and a move in one line; write two lines"
            )
        if self.machine in codes and words.keys().isdisjoint("XYZ"):
            raise BadInput(f"line {line}: {self.machine} without a move")

    def length_of(self, tool: AnyTool) -> str:
        """Return the words that switch the length of a tool on."""
        return self.words.tool_length.format(tool=tool.number)

    @property
    def spoken_change(self) -> str:
        """What changes the tool, as a sentence names it."""
        return f"T and {self.tool_change}" if self.tool_change else "T"


def listed(words: Iterable[str]) -> str:
    """Return words as a sentence lists them.

    >>> listed(("G0", "G1", "G2"))
    'G0, G1 or G2'
    """
    *others, last = words
    return f"{', '.join(others)} or {last}" if others else last
