"""The words of a control in Klartext, Heidenhain's conversational format, as its writer and its reader share them."""

from __future__ import annotations

from dataclasses import dataclass, field

from trunnion.findings import BadInput
from trunnion.model.motion.cycle import CycleKind
from trunnion.post.iso_words import CALL, IsoWords, check_braces, check_directions
from trunnion.post.words import dialect_words

_IN_BRACES = {
    "start": ("units", "tolerance", "offset"),
    "tool_change": ("tool", "name", "spindle"),
    "speed": ("spindle",),
    "plane": ("a", "b", "c", "side"),
    "dwell": ("seconds",),
}
"""What may stand in braces in the lines of a word; in those of others nothing may."""
_MOTIONS = ("L", "L", "C", "C")
_WITHOUT = ("top", "end", "spindle", "tip_control", "no_tip_control", "no_plane")
OWN_CALL = ("depth", "whole", "lift", "pecks")
"""What may stand in braces in a cycle beside `iso_words.CALL`: its depth below the plane (negative) and without a sign, how far above the
plane it ends, how many pecks it takes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KlartextWords(IsoWords):
    """The words of `dialects/NAME.toml`, as `IsoWords` has them but for the letters and codes of a word-address format.

    `work_offsets` stand in the order of their presets, from 1. `speed` is said in place of a tool change where the tool stays; `spindle`
    turns it. `turns_a_block` is how many turns a helix has at most in one block, `dwell` the lines that wait, `sides` what a plane says of
    the axis that leans the tool where that is negative and positive. `refused` has the first word of a block, or another in it.
    """

    speed: str
    sides: tuple[str, str]
    turns_a_block: int
    dwell: tuple[str, ...]
    tool_length: str = ""
    restart: str = ""
    motions: tuple[str, str, str, str] = _MOTIONS
    centres: str = "start"
    whole_turns: str = "CP"
    groups: tuple[str, ...] = ()
    letters: dict[str, str] = field(default_factory=dict)
    codes: dict[str, str] = field(default_factory=dict)


def klartext_words(name: str) -> KlartextWords:
    """Return the words of a control, read from our resources; raise `BadInput` for wrong ones."""
    words = dialect_words(KlartextWords, name)
    for word, known in (*_IN_BRACES.items(), *((w, ()) for w in _WITHOUT)):
        value = getattr(words, word)
        check_braces(name, word, (value,) if isinstance(value, str) else value, known)
    for kind in words.cycle_calls:
        if kind not in list(CycleKind):
            raise BadInput(f"dialect {name}: cycles knows {', '.join(CycleKind)}; got {kind}")
    calls = tuple(words.cycle_calls.values())
    check_braces(name, "cycle_calls", calls, (*CALL, *OWN_CALL))
    check_directions(name, words)
    if words.turns_a_block < 1:
        raise BadInput(f"dialect {name}: turns_a_block must be above 0; got {words.turns_a_block}")
    return words
