"""What a library says of one tool, in our fields, before what is missing is assumed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from trunnion.findings import BadInput
from trunnion.shop.exchange.contract import Loss, LossKind, Plain
from trunnion.shop.exchange.fields import plain

_EMPTY: tuple[Any, ...] = (None, "", 0, 0.0, False, [], {})
"""Values of a foreign field that say nothing."""


@dataclass(slots=True, kw_only=True)
class ToolDescription:
    """One tool of a library.

    `source` names it in messages (a file with a line or an entry). `values` has our fields (`fields.fields_of`) as far as the file gives
    them, lengths in mm and angles in degrees; `holder` is a `Holder` there, and `holder_rows` is not used. `assumed` are those of them
    that the file doesn't say outright, with the reason. `refusal` says why the tool can't be taken at all.
    """

    source: str
    values: dict[str, Any] = field(default_factory=dict)
    assumed: dict[str, tuple[Plain, str]] = field(default_factory=dict)
    foreign: list[tuple[str, Any, str]] = field(default_factory=list)
    refusal: str = ""

    @property
    def name(self) -> str:
        """What the file calls it, else its place in the file."""
        return str(self.values.get("name") or self.values.get("title") or self.source)

    def assume(self, name: str, value: Any, why: str) -> None:
        """Note a value that the file doesn't say outright."""
        self.values[name] = value
        self.assumed[name] = (plain(value), why)

    def ignore(self, word: str, value: Any, why: str = "the catalogue has no place for it") -> None:
        """Note a field of the other program that is not taken over, unless it says nothing."""
        if value not in _EMPTY:
            self.foreign.append((word, value, why))

    def ignored(self, name: str) -> tuple[Loss, ...]:
        """Return what was ignored, of the tool under the name that it gets."""
        return tuple(
            Loss(kind=LossKind.IGNORED, tool=name, field=word, value=plain(value), why=why)
            for word, value, why in self.foreign
        )


def number(value: Any, source: str, word: str) -> float:
    """Return a number that a file gives, which must be finite; raise `BadInput` with its place and word."""
    try:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise TypeError
        found = float(value)
    except (TypeError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise BadInput(f"{source}: {word} must be a number; got {_short(value)}")
    return found


def count(value: Any, source: str, word: str) -> int:
    """Return a whole number that a file gives; raise `BadInput` with its place and word."""
    found = number(value, source, word)
    if found != int(found):
        raise BadInput(f"{source}: {word} must be a whole number; got {_short(value)}")
    return int(found)


def text(value: Any, source: str, word: str) -> str:
    """Return a text that a file gives, on one line and without what no text file may hold; raise `BadInput` for what is no text."""
    if not isinstance(value, str):
        raise BadInput(f"{source}: {word} must be a text; got {_short(value)}")
    if len(value) > LONGEST_TEXT:
        raise BadInput(f"{source}: {word} is longer than {LONGEST_TEXT} characters")
    encoded = value.encode("utf-8", "replace").decode("utf-8")
    return " ".join("".join(c if c.isprintable() else " " for c in encoded).split())


LONGEST_TEXT = 2000
"""Characters of a name or title."""
_SHOWN = 40
"""Characters of a wrong value that a message shows."""


def _short(value: Any) -> str:
    words = (
        repr(value)
        if not isinstance(value, int)
        else f"{type(value).__name__} {value:.3g}"
        if abs(value) < 10**15
        else "a number that is too large"
    )
    return words if len(words) <= _SHOWN else f"{words[:_SHOWN]}..."
