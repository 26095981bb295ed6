"""The words of a control in word-address format (ISO 6983, "G code"), as its writer and its reader share them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from string import Formatter

from trunnion.findings import BadInput
from trunnion.model.motion.cycle import PECKING, WAITING, CycleKind
from trunnion.post.words import dialect_words

CENTRES = ("start", "absolute")
"""Where I and J of an arc count from: its start, or the zero of the work offset."""
ROLES = ("radius", "length", "dwell", "turns", "tolerance", "joining", "highest", "retract", "peck")
"""What a control may have letters for, beside N, F, S, T, X, Y, Z, I and J which are the same on all."""
_IN_BRACES = {
    "opening": ("program",),
    "start": ("units", "tolerance", "offset"),
    "restart": ("offset",),
    "tool_change": ("tool", "name"),
    "tool_length": ("tool",),
    "spindle": ("spindle",),
    "surface_speed": ("highest", "speed"),
    "spindle_speed": ("spindle",),
    "top": (),
    "end": (),
    "tip_control": ("tool",),
    "no_tip_control": (),
    "plane": ("a", "b", "c", "side"),
    "no_plane": (),
    "cycle_end": (),
}
"""What may stand in braces in the lines of a word."""
CALL = (
    "end",
    "plane",
    "bottom",
    "first",
    "peck",
    "back_off",
    "dwell",
    "feed",
    "pitch",
    "spindle",
)
"""What may stand in braces in a cycle call."""
PLANE_ORDERS = ("XYZ", "ZXZ", "ZYX")
"""About which axes a tilted plane is turned, one after the other, each as the ones before have left it."""
_KEYS = {"units": ("mm", "inch"), "coolant": ("off",), "letters": ("radius",)}
"""Entries that a table must have."""


@dataclass(frozen=True, slots=True, kw_only=True)
class IsoWords:
    """The words of `dialects/NAME.toml`.

    `opening` are lines without number below the header; `start`, `restart`, `tool_change`, `tool_length`, `spindle`, `top` (straight up
    to the top of the machine) and `end` are lines with what stands in braces filled in. `codes` and `refused` have one or several codes
    as keys: what the control does at them (`readers.language.MEANINGS` and the dialect's own), and why the reader refuses them. Without
    `inverse_time` the control has no rotary axes, without `per_revolution` no feeds by the revolution, without `surface_speed` no
    constant surface speed; `spindle_speed` is `spindle` where one may have been in force. `cycles` are the codes of drilling cycles by
    their kind, and `return_levels` those that end them at the level where they began and at the retract plane; `cycle_calls` are lines
    that say a cycle for the positions after them, up to `cycle_end`. With `directions`, words of the three numbers of a tool axis, the
    control follows the tip by itself between `tip_control` and `no_tip_control`; `plane` tilts the plane of the program, by
    `plane_order`, and `no_plane` takes that back. `closing` are lines without number at the end; `point` ends whole numbers;
    `dwell_parts` are counted a second; cycles of the kinds `fed_to_plane` go out at the feed to the retract plane alone; `rises_first`
    1: a cycle begun below its plane rises to it before it goes across. `whole_turns` is the word of a helix for turns beside its last.
    `turning` chooses the plane ZX with X as a diameter, without it the control does not turn work; `milling` is said in the other
    sections of a program that does.
    """

    title: str
    suffix: str
    comment: tuple[str, str]
    line_length: int
    start: tuple[str, ...]
    restart: str
    tool_change: tuple[str, ...]
    tool_length: str
    spindle: str
    top: str
    end: tuple[str, ...]
    work_offsets: tuple[str, ...]
    motions: tuple[str, str, str, str]
    centres: str
    feed_decimals: int
    extra_decimals_inch: int
    groups: tuple[str, ...]
    units: dict[str, str]
    coolant: dict[str, str]
    letters: dict[str, str]
    codes: dict[str, str]
    refused: dict[str, str]
    opening: tuple[str, ...] = ()
    angle_decimals: int = 0
    per_minute: str = ""
    inverse_time: str = ""
    per_revolution: str = ""
    revolution_decimals: int = 0
    surface_speed: str = ""
    spindle_speed: str = ""
    turning: str = ""
    milling: str = ""
    whole_turns: str = ""
    closing: tuple[str, ...] = ()
    point: str = ""
    dwell_parts: int = 1
    fed_to_plane: tuple[str, ...] = ()
    rises_first: int = 0
    return_levels: tuple[str, str] = ("", "")
    cycles: dict[str, str] = field(default_factory=dict)
    cycle_calls: dict[str, str] = field(default_factory=dict)
    cycle_end: str = ""
    directions: tuple[str, ...] = ()
    direction_decimals: int = 0
    tip_control: tuple[str, ...] = ()
    no_tip_control: str = ""
    plane: tuple[str, ...] = ()
    plane_order: str = "XYZ"
    plane_decimals: int = 0
    no_plane: str = ""


def iso_words(name: str, package: str = "") -> IsoWords:
    """Return the words of a control, read from our resources or from `NAME.toml` in a package; raise `BadInput` for wrong ones."""
    return checked_iso_words(name, dialect_words(IsoWords, name, package))


def checked_iso_words(name: str, words: IsoWords) -> IsoWords:
    """Return the words of a control; raise `BadInput` where they miss an entry, or name a position or a role that is not known."""
    if words.centres not in CENTRES:
        raise BadInput(
            f"dialect {name}: centres must be one of {', '.join(CENTRES)}; got {words.centres!r}"
        )
    for word in (f.name for f in fields(IsoWords)):
        value = getattr(words, word)
        if word in _KEYS:
            _check_keys(name, word, value)
        if word in _IN_BRACES:
            lines = (value,) if isinstance(value, str) else value
            check_braces(name, word, lines, _IN_BRACES[word])
    for role, letter in words.letters.items():
        if role not in ROLES or not (len(letter) == 1 or letter.endswith("=")):
            raise BadInput(
                f"dialect {name}: letters must be one letter each, or a word with =, for some of {', '.join(ROLES)}; "
                f"got {role} = {letter!r}"
            )
    _check_cycles(name, words)
    check_directions(name, words)
    return words


def by_code(table: Mapping[str, str]) -> dict[str, str]:
    """Return a table whose keys name one or several codes with one key a code.

    >>> by_code({"M30 M2": "end"})
    {'M30': 'end', 'M2': 'end'}
    """
    return {code: value for codes, value in table.items() for code in codes.split()}


def code_of(words: IsoWords, meaning: str) -> str:
    """Return the first code by which a control does what a meaning says, empty where it has none."""
    return next((code for code, m in by_code(words.codes).items() if m == meaning), "")


def _check_keys(name: str, word: str, table: Mapping[str, str]) -> None:
    for key in _KEYS[word]:
        if key not in table:
            raise BadInput(f"dialect {name}: {word} needs an entry {key}")


def _check_cycles(name: str, words: IsoWords) -> None:
    """Raise `BadInput` for cycles that are none, or that a control's other words leave nothing to say with."""
    for kind in (*words.cycles, *words.cycle_calls):
        if kind not in list(CycleKind):
            raise BadInput(f"dialect {name}: cycles knows {', '.join(CycleKind)}; got {kind}")
    check_braces(name, "cycle_calls", tuple(words.cycle_calls.values()), CALL)
    for kind in words.cycles:
        needed = ["retract", *(["peck"] * (kind in PECKING)), *(["dwell"] * (kind in WAITING))]
        missing = [role for role in needed if role not in words.letters]
        if missing or "" in words.return_levels:
            what = f"letters needs an entry {missing[0]}" if missing else "return_levels is missing"
            raise BadInput(f"dialect {name}: {what} for the cycle {kind}")


def check_directions(name: str, words: IsoWords) -> None:
    """Raise `BadInput` for words of five axes that leave out what the others need."""
    if not words.directions:
        return
    needed = ("tip_control", "no_tip_control", "plane", "no_plane")
    missing = [word for word in needed if not getattr(words, word)]
    if len(words.directions) != 3 or words.plane_order not in PLANE_ORDERS or missing:
        what = f"{missing[0]} is missing" if missing else "directions must be three words"
        if words.plane_order not in PLANE_ORDERS:
            what = (
                f"plane_order must be one of {', '.join(PLANE_ORDERS)}; got {words.plane_order!r}"
            )
        raise BadInput(f"dialect {name}: {what}")


def check_braces(name: str, word: str, lines: tuple[str, ...], known: tuple[str, ...]) -> None:
    try:
        field_names = [
            field_name
            for line in lines
            for _, field_name, _, _ in Formatter().parse(line)
            if field_name is not None
        ]
    except ValueError as reason:
        raise BadInput(f"dialect {name}: {word}: {reason}; write braces as {{{{ and }}}}") from None
    for field_name in field_names:
        if field_name not in known:
            listed = ", ".join(known) or "none"
            raise BadInput(
                f"dialect {name}: {word}: {{{field_name}}} is not known; known: {listed}"
            )
