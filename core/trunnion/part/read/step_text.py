"""The entities of a STEP file as its text writes them (ISO 10303-21, clear text encoding), those of some types only.

One pass over the text finds where entities begin and end; a body is parsed once it is looked at. So a file of millions of entities costs
that one pass, and damage in one of them is met where it is needed and nowhere else.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

_ENTITY = re.compile(rb"#(\d{1,18})\s*=\s*([A-Z0-9_]*)((?:[^';]++|'[^']*+')*+);")
"""Number, type (none where several records stand in brackets) and the rest; an end mark in a text ends nothing. Possessive: an entity
without an end is not searched through again. No number has more digits than 64 bits hold."""
_TEXT_OR_REMARK = re.compile(rb"('[^']*+')|/\*.*?\*/", re.DOTALL)
_TOKEN = re.compile(
    rb"""\s*(?:
      \#(?P<reference>\d{1,18})
    | '(?P<text>(?:[^']|'')*+)'
    | (?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[Ee][-+]?\d+)?)
    | \.(?P<word>[A-Za-z0-9_]+)\.
    | (?P<nothing>[$*])
    | (?P<keyword>!?[A-Za-z_][A-Za-z0-9_]*)\s*\(
    | "(?P<binary>[0-9A-Fa-f]*)"
    | (?P<mark>[(),])
    )""",
    re.VERBOSE,
)
_WIDE = {b"2": ("utf-16-be", 4), b"4": ("utf-32-be", 8)}
"""Encoding and hexadecimal digits of a character behind the sign `X2` or `X4`."""
_SIGN = re.compile(
    r"''|\\\\|\\X([24])\\([0-9A-Fa-f]*)\\X0\\|\\X\\([0-9A-Fa-f]{2})|\\S\\(.)|\\P[A-I]\\",
    re.DOTALL,
)
_UPPER_HALF = 128
"""What `S` adds to a character's code (ISO 8859)."""


class BadEntity(Exception):
    """An entity that is not in the text or can't be parsed; the message names it."""


@dataclass(frozen=True, slots=True)
class EntityNumber:
    """The number of another entity."""

    number: int


@dataclass(frozen=True, slots=True)
class StepWord:
    """A word between dots: `.MILLI.`, `.T.`."""

    word: str


@dataclass(frozen=True, slots=True)
class EntityRecord:
    """A type with its parameters: texts decoded, numbers as floats, lists as tuples, a value of a named type as a record, None for `$` and
    `*`."""

    type: str
    parameters: tuple[object, ...]


@dataclass(frozen=True, slots=True)
class StepEntity:
    """An entity's number and its records: one, or several of an entity of several types."""

    number: int
    records: tuple[EntityRecord, ...]

    @property
    def types(self) -> tuple[str, ...]:
        """The types of its records."""
        return tuple(r.type for r in self.records)

    def parameters(self, *types: str) -> tuple[object, ...] | None:
        """Return the parameters of its first record of one of some types that has any, None where it has no such record."""
        own = [r.parameters for r in self.records if r.type in types]
        return next((p for p in own if p), own[0] if own else None)


class StepText:
    """The entities of some types in a STEP text; of entities of `located` types only their position among all is known.

    `count` is how many entities the text has, `positions` the 1-based positions of those of located types by number, `damage` what was said
    of those that were looked for by their type and can't be parsed.
    """

    def __init__(self, data: bytes, types: Iterable[str], located: Iterable[str] = ()) -> None:
        if b"/*" in data:
            data = _TEXT_OR_REMARK.sub(lambda found: found[1] or b" ", data)
        wanted = {t.encode() for t in types}
        only_located = {t.encode() for t in located}
        several = re.compile(rb"\b(?:" + b"|".join(sorted(wanted)) + rb")\s*\(")
        self.count = 0
        self.positions: dict[int, int] = {}
        self.damage: dict[int, str] = {}
        self._bodies: dict[int, bytes] = {}
        self._parsed: dict[int, StepEntity] = {}
        for found in _ENTITY.finditer(data):
            self.count += 1
            type = found[2]
            if type in wanted or (not type and several.search(found[3])):
                self._bodies[int(found[1])] = type + found[3]
            elif type in only_located:
                self.positions[int(found[1])] = self.count

    def __contains__(self, number: int) -> bool:
        """Return whether there is an entity of one of the types with a number, damaged or not."""
        return number in self._bodies

    def entity(self, number: int) -> StepEntity:
        """Return an entity of one of the types; raise `BadEntity` where there is none, or it can't be parsed."""
        if number not in self._parsed:
            if number not in self._bodies:
                raise BadEntity(f"#{number} is not in the file, or of another type")
            self._parsed[number] = StepEntity(number, _records(number, self._bodies[number]))
        return self._parsed[number]

    def of_types(self, *types: str) -> list[StepEntity]:
        """Return the entities of some types in the order of the text; those that can't be parsed are left out and
        noted in `damage`."""
        found = []
        words = tuple(t.encode() for t in types)
        for number, body in self._bodies.items():
            if any(w in body for w in words):
                try:
                    entity = self.entity(number)
                except BadEntity as reason:
                    self.damage[number] = str(reason)
                    continue
                if entity.parameters(*types) is not None:
                    found.append(entity)
        return found

    def links(self, source: int, target: int | None, *types: str) -> dict[int, list[int]]:
        """Return what entities of some types link, by the numbers that one parameter names: those that another names, or the entities
        themselves where there is no other; 0 is the first parameter."""
        found: dict[int, list[int]] = {}
        for entity in self.of_types(*types):
            parameters = entity.parameters(*types) or ()
            if len(parameters) > max(source, target or 0):
                named = [entity.number] if target is None else numbers_in(parameters[target])
                for number in numbers_in(parameters[source]):
                    found.setdefault(number, []).extend(named)
        return found

    def items(self, number: int, *types: str) -> list[int]:
        """Return the numbers of the items of a representation of one of some types; none where it is missing or damaged."""
        try:
            parameters = self.entity(number).parameters(*types) or ()
        except BadEntity:
            return []
        return numbers_in(parameters[1]) if len(parameters) > 1 else []


def numbers_in(parameter: object) -> list[int]:
    """Return the numbers of the entities that a parameter names, in lists and typed values too, in their order."""
    found, waiting = [], [parameter]
    # A damaged file may nest lists deeper than functions can call each other.
    while waiting:
        value = waiting.pop()
        if isinstance(value, EntityNumber):
            found.append(value.number)
        elif isinstance(value, EntityRecord):
            waiting += reversed(value.parameters)
        elif isinstance(value, tuple):
            waiting += reversed(value)
    return found


def _records(number: int, body: bytes) -> tuple[EntityRecord, ...]:
    """Return the records of an entity's body."""
    values = _values(number, body)
    if len(values) == 1 and isinstance(values[0], tuple):
        values = list(values[0])
    records = tuple(v for v in values if isinstance(v, EntityRecord))
    if not records or len(records) != len(values):
        raise BadEntity(f"#{number} can't be understood")
    return records


def _values(number: int, body: bytes) -> list[object]:
    """Return what stands in a body; the stack holds the lists that are open, each with the type that it belongs to ("": a plain list)."""
    stack: list[tuple[str, list[object]]] = [("", [])]
    at, end = 0, len(body.rstrip())
    while at < end:
        token = _TOKEN.match(body, at)
        if token is None:
            raise BadEntity(f"#{number} can't be understood")
        at = token.end()
        kind, word = token.lastgroup, token[token.lastgroup or 0]
        if kind == "keyword" or word == b"(":
            stack.append((word.decode() if kind == "keyword" else "", []))
        elif word == b")" and kind == "mark":
            type, values = stack.pop()
            if not stack:
                raise BadEntity(f"#{number} has a bracket too many")
            stack[-1][1].append(EntityRecord(type, tuple(values)) if type else tuple(values))
        elif kind != "mark":
            stack[-1][1].append(_value(kind, word))
    if len(stack) > 1:
        raise BadEntity(f"#{number} has a bracket too few")
    return stack[0][1]


def _value(kind: str | None, word: bytes) -> object:
    if kind == "reference":
        return EntityNumber(int(word))
    if kind == "number":
        return float(word)
    if kind == "word":
        return StepWord(word.decode().upper())
    return None if kind == "nothing" else decoded(word)


def decoded(text: bytes) -> str:
    """Return a text without its quotes as a person reads it: with the signs of ISO 10303-21, 6.4.3 for other letters resolved.

    >>> decoded(rb"\\X2\\00D8\\X0\\12 H7")
    'Ø12 H7'
    """
    try:
        plain = text.decode("utf-8")
    except UnicodeDecodeError:
        plain = text.decode("latin-1")
    return _SIGN.sub(_letter, plain.replace("\r", "").replace("\n", ""))


def _letter(sign: re.Match[str]) -> str:
    wide, digits, code, upper = sign.groups()
    if wide:
        encoding, size = _WIDE[wide.encode()]
        whole = digits[: len(digits) // size * size]
        return bytes.fromhex(whole).decode(encoding, errors="replace")
    if code:
        return chr(int(code, 16))
    if upper:
        return chr(ord(upper) % _UPPER_HALF + _UPPER_HALF)
    return sign[0][0] if sign[0] in ("''", "\\\\") else ""
