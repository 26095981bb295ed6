"""What codes and states do to the modal state of a control: units, feed, tool, spindle, coolant, offsets, dwell."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.spindle import FeedMode
from trunnion.post.readers.numbers import (
    DWELL,
    FEED,
    FEED_PER_REVOLUTION,
    INVERSE_TIME,
    SPINDLE,
)
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.language import ControlLanguage
from trunnion.post.readers.word_address.state import ModalCycle, ModalState
from trunnion.units import METRES_PER_FOOT

FEED_RANGES = {
    FeedMode.MINUTE: FEED,
    FeedMode.REVOLUTION: FEED_PER_REVOLUTION,
    FeedMode.INVERSE: INVERSE_TIME,
}
BEFORE_SPEEDS = {
    "units": "change_units",
    "inverse time": "feed_by_time",
    "per minute": "feed_a_minute",
    "per revolution": "feed_a_revolution",
    "surface speed": "keep_surface_speed",
    "spindle speed": "keep_spindle_speed",
}
AFTER_SPEEDS = {
    "tool change": "change_tool",
    "spindle": "start_spindle",
    "no spindle": "stop_spindle",
    "locked spindle": "lock_spindle",
    "coolant": "switch_coolant",
    "work offset": "set_offset",
    "length": "set_length",
    "no length": "drop_length",
    "path tolerance": "check_path_tolerance",
    "dwell": "wait",
    "no motion": "cancel_motion",
    "motion": "set_motion",
    "cycle": "set_cycle",
    "milling plane": "mill_in_xy",
    "turning plane": "turn_in_zx",
    "diameters": "take_diameters",
    "radii": "take_radii",
    "initial level": "return_to_level",
    "retract plane": "return_to_plane",
}
"""The methods of `Modes` by the meanings of codes, in the order in which a line is worked off; speeds come between the two."""
ELSEWHERE = ("machine", "end", "nothing")
"""Meanings that change no modal state: a move in machine coordinates, the end, and what is so already."""
MEANINGS = (*BEFORE_SPEEDS, *AFTER_SPEEDS, *ELSEWHERE)
"""What a control can do at a code. Without `tool change` the T word changes the tool; without `length` the letter of the length alone
switches it on, and off with 0."""


class Modes:
    """Works off the codes and states of lines. A control's own codes are methods of a class derived from this, named in its `own`."""

    own: dict[str, str] = {}
    """Methods by meaning of what only this control does; after all others."""

    def __init__(self, language: ControlLanguage, state: ModalState) -> None:
        self.language, self.state = language, state
        self.before = [(meaning, getattr(self, name)) for meaning, name in BEFORE_SPEEDS.items()]
        self.after = [
            (meaning, getattr(self, name)) for meaning, name in {**AFTER_SPEEDS, **self.own}.items()
        ]

    def run(self, block: Block) -> None:
        """Do what the codes and states of a line say, all but moves and the end."""
        given = {self.language.meanings[code] for code in block.codes}
        for meaning, step in self.before:
            if meaning in given:
                step(block)
        self.speeds(block)
        for meaning, step in self.after:
            if meaning in given:
                step(block)

    def speeds(self, block: Block) -> None:
        """Take over F, S and T, and the tool's length where its letter alone switches it on."""
        line, words = block.line, block.words
        if "F" in words:
            self.set_feed(line, words["F"])
        if "S" in words:
            if words["S"] < 0.0:
                raise BadInput(f"line {line}: the spindle speed S must not be negative")
            self.set_speed(line, words["S"])
        if "T" in words:
            self.choose_tool(block)
        if (letter := self.language.length_letter) in words and not self.language.length:
            self.set_length(block) if words[letter] else self.drop_length(block)

    def set_feed(self, line: int, feed: float) -> None:
        """Take over F in the units of the feed mode."""
        if feed <= 0.0:
            raise BadInput(f"line {line}: the feed F must be above zero")
        mode = self.state.feed_mode
        FEED_RANGES[mode].check(line, "F", feed)
        self.state.feed = feed if mode is FeedMode.INVERSE else feed * self.state.unit

    def set_speed(self, line: int, speed: float) -> None:
        """Take over S: the spindle's speed, or the surface's while that is kept."""
        state = self.state
        SPINDLE.check(line, "S", speed)
        if state.keeps_surface:
            state.surface_speed = speed * (METRES_PER_FOOT if state.unit != 1.0 else 1.0)
        else:
            state.spindle = speed
        state.speed_given = True

    def choose_tool(self, block: Block) -> None:
        """Take over T; on a control without a code for it the tool comes into the spindle now."""
        number, tools = block.words["T"], self.state.tools
        tool = tools.get(int(number))
        if tool is None or number != int(number):
            known = ", ".join(str(t) for t in sorted(tools))
            raise BadInput(
                f"line {block.line}: T{number:g} is not in the tool list; it has {known}"
            )
        self.state.next_tool = tool
        if not self.language.tool_change:
            self.change_tool(block)

    def change_units(self, block: Block) -> None:
        """Set what a written length is; not in the middle of a program."""
        state = self.state
        unit = next(unit for code, unit in self.language.units.items() if code in block.codes)
        if state.feed and unit != state.unit:
            raise BadInput(
                f"line {block.line}: the units change in the middle of the program; keep one"
            )
        if "F" in block.words:
            raise BadInput(
                f"line {block.line}: F and a change of units in one line: the feed's unit is not clear; write two lines"
            )
        state.unit, state.units_given = unit, True

    def feed_by_time(self, block: Block) -> None:
        """Feed in inverse time from here on; F must be given."""
        self.state.feed_mode, self.state.feed = FeedMode.INVERSE, 0.0

    def feed_a_minute(self, block: Block) -> None:
        """Feed in units a minute from here on; after another mode F must be given."""
        if self.state.feed_mode is not FeedMode.MINUTE:
            self.state.feed_mode, self.state.feed = FeedMode.MINUTE, 0.0

    def feed_a_revolution(self, block: Block) -> None:
        """Feed in units a revolution from here on; after another mode F must be given."""
        if self.state.feed_mode is not FeedMode.REVOLUTION:
            self.state.feed_mode, self.state.feed = FeedMode.REVOLUTION, 0.0

    def keep_surface_speed(self, block: Block) -> None:
        """Keep the speed of the work's surface from here on, with a highest spindle speed: S and that must be given."""
        letter = self.language.words.letters.get("highest", "")
        highest, line = block.words.get(letter), block.line
        code = next(c for c in block.codes if self.language.meanings[c] == "surface speed")
        if not highest or "S" not in block.words or block.words["S"] <= 0.0:
            raise BadInput(
                f"line {line}: {code} needs S above zero, the speed of the surface, and {letter or 'a word for the highest'} above "
                "zero, the highest spindle speed"
            )
        if not self.state.units_given:
            raise BadInput(
                f"line {line}: {code} before the unit is said; put {' or '.join(self.language.units)} first"
            )
        SPINDLE.check(line, letter, highest)
        self.state.spindle, self.state.keeps_surface = highest, True

    def keep_spindle_speed(self, block: Block) -> None:
        """Keep the spindle's speed from here on; after a constant surface speed S must be given."""
        if self.state.keeps_surface and "S" not in block.words:
            code = next(c for c in block.codes if self.language.meanings[c] == "spindle speed")
            raise BadInput(
                f"line {block.line}: {code} without S; give the spindle speed in its line"
            )
        self.state.keeps_surface = False

    def change_tool(self, block: Block) -> None:
        """Bring the chosen tool into the spindle; its length is off, the spindle stands."""
        state = self.state
        if state.next_tool is None:
            raise BadInput(
                f"line {block.line}: {self.language.tool_change} without a T word before it; say which tool"
            )
        state.sections.change_tool()
        state.tool, state.length_on, state.turning, state.over = state.next_tool, False, False, None
        state.locked = False

    def start_spindle(self, block: Block) -> None:
        """Turn the spindle clockwise."""
        if not self.state.speed_given:
            raise BadInput(
                f"line {block.line}: {self.language.spindle} without a spindle speed; give S"
            )
        self.state.turning, self.state.locked = True, False

    def stop_spindle(self, block: Block) -> None:
        """Stop the spindle."""
        self.state.turning = self.state.locked = False

    def lock_spindle(self, block: Block) -> None:
        """Stop the spindle and hold it at its angle; its speed must be given again."""
        state = self.state
        state.turning, state.locked = False, True
        state.spindle, state.speed_given = 0.0, False

    def switch_coolant(self, block: Block) -> None:
        """Set the coolant; of two in one line the later in the table of words counts."""
        for code, coolant in self.language.coolants.items():
            if code in block.codes:
                self.state.coolant = coolant

    def set_offset(self, block: Block) -> None:
        """Take the work offset, which must be the setup's."""
        setup = self.state.setup
        for code in block.codes:
            if self.language.meanings[code] == "work offset":
                if code != setup.work_offset:
                    raise BadInput(
                        f"line {block.line}: {code} is not the work offset of setup {setup.name}, {setup.work_offset}; use that"
                    )
                self.state.offset = code

    def set_length(self, block: Block) -> None:
        """Count the length of the tool in the spindle, never of another."""
        letter, tool = self.language.length_letter, self.state.tool
        number = block.words.get(letter)
        if tool is None:
            raise BadInput(
                f"line {block.line}: {self.language.length or letter} before a tool is in the spindle; "
                f"put {self.language.spoken_change} first"
            )
        if number is not None and number != tool.number:
            raise BadInput(
                f"line {block.line}: {letter}{number:g} is the length of another tool than T{tool.number} in the spindle; "
                f"use {letter}{tool.number}"
            )
        self.state.length_on = True

    def drop_length(self, block: Block) -> None:
        """Count the tool's length no longer."""
        self.state.length_on = False

    def check_path_tolerance(self, block: Block) -> None:
        """Check how far the control may leave the path: at corners, and where it joins lines into one."""
        line, words, unit, roles = (
            block.line,
            block.words,
            self.state.unit,
            self.language.words.letters,
        )
        code = next(c for c in block.codes if self.language.meanings[c] == "path tolerance")
        letter, joining = roles["tolerance"], roles.get("joining", "")
        limit, joined = words.get(letter), words.get(joining, 0.0)
        if limit is None:
            raise BadInput(
                f"line {line}: {code} without {letter} rounds corners off without a limit; give {letter}"
            )
        if not 0.0 <= limit * unit <= tolerance.GOUGE:
            raise BadInput(
                f"line {line}: {code} {letter}{limit:g} rounds corners off by more than {tolerance.GOUGE:g} mm; "
                f"give a smaller {letter}"
            )
        if not 0.0 <= joined * unit <= tolerance.GOUGE:
            raise BadInput(
                f"line {line}: {code} {joining}{joined:g} joins lines that are more than {tolerance.GOUGE:g} mm apart; "
                f"give a smaller {joining}"
            )

    def wait(self, block: Block) -> None:
        """Dwell for as many seconds as the line says."""
        letter = self.language.words.letters["dwell"]
        seconds = block.words.get(letter)
        if seconds is None:
            raise BadInput(
                f"line {block.line}: {self.language.dwell} without {letter}; say how many seconds"
            )
        DWELL.check(block.line, letter, seconds)
        self.state.sections.dwell(seconds)

    def cancel_motion(self, block: Block) -> None:
        """Move no more until a motion is given."""
        self.state.motion = self.state.cycle = None

    def set_motion(self, block: Block) -> None:
        """Take over how positions are reached."""
        self.state.motion = next(
            motion for code, motion in self.language.motions.items() if code in block.codes
        )
        self.state.cycle = None

    def set_cycle(self, block: Block) -> None:
        """Drill at each position from here on; a cycle that is in force already goes on, another keeps the level where the first began."""
        state = self.state
        code = next(c for c in block.codes if c in self.language.cycles)
        if state.cycle is None or state.cycle.code != code:
            level = None if state.cycle is None else state.cycle.level
            state.cycle = ModalCycle(code=code, kind=self.language.cycles[code], level=level)
            state.motion = None

    def mill_in_xy(self, block: Block) -> None:
        """Have arcs in the plane XY: the tool rotates."""
        self.state.in_zx = False

    def turn_in_zx(self, block: Block) -> None:
        """Have arcs in the plane ZX: the work turns."""
        self.state.in_zx = True

    def take_diameters(self, block: Block) -> None:
        """Take X as a diameter from here on; I stays a radius."""
        self.state.diameters = True

    def take_radii(self, block: Block) -> None:
        """Take X as the distance from the work's axis from here on."""
        self.state.diameters = False

    def return_to_level(self, block: Block) -> None:
        """End cycles at the level where they began."""
        self.state.returns_to_level = True

    def return_to_plane(self, block: Block) -> None:
        """End cycles at their retract plane."""
        self.state.returns_to_level = False
