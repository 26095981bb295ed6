"""The entities of an IGES file as its text lists them, and what trimmed surfaces are made of (IGES 5.3, fixed format).

An entity is named by its first line in the directory section, as parameters refer to it: 1, 3, 5, ...
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from trunnion.part.read.text import IGES_COLUMNS

FIELD = 8
"""Columns of a field of the directory."""
PARAMETER_COLUMNS = 64
"""Columns of a parameter line; behind them it names its entity."""


@dataclass(frozen=True, slots=True, kw_only=True)
class IgesEntity:
    """An entity: its first line in the directory, type and form numbers, and the lines of the entities that it is made of.

    Those are known of trimmed and bounded surfaces, their boundaries and composite curves; of other types there are none.
    """

    line: int
    type: int
    form: int
    parts: tuple[int, ...] = ()


def iges_entities(data: bytes) -> dict[int, IgesEntity]:
    """Return the entities of a text that was checked (`check_iges`) by their lines, in the order of the file; what can't be read is left
    out."""
    sections: dict[bytes, list[bytes]] = {letter: [] for letter in (b"S", b"G", b"D", b"P", b"T")}
    for line in re.split(rb"\r\n|\n|\r", data):
        sections.get(line[IGES_COLUMNS : IGES_COLUMNS + 1], []).append(line)
    ends = _delimiters(b"".join(line[:IGES_COLUMNS] for line in sections[b"G"]))
    directory, parameters = sections[b"D"], sections[b"P"]
    found = {}
    for n in range(0, len(directory) - 1, 2):
        first, second = _fields(directory[n]), _fields(directory[n + 1])
        if first[0] is None:
            continue
        at, count = first[1] or 0, second[3] or 0
        own = parameters[at - 1 : at - 1 + count] if at > 0 else []
        numbers = _numbers(b"".join(line[:PARAMETER_COLUMNS] for line in own), *ends)
        found[n + 1] = IgesEntity(
            line=n + 1, type=first[0], form=second[4] or 0, parts=_parts(first[0], numbers)
        )
    return found


def _fields(line: bytes) -> list[int | None]:
    """Return the whole numbers in a line's fields, None where there is none."""
    words = [line[k * FIELD : (k + 1) * FIELD].strip() for k in range(IGES_COLUMNS // FIELD)]
    return [int(w) if re.fullmatch(rb"[-+]?\d+", w) else None for w in words]


def _delimiters(text: bytes) -> tuple[bytes, bytes]:
    """Return what parts parameters and what ends them; the global section begins with both, as texts of one letter or left out."""
    own = text.startswith(b"1H")
    parting, rest = (text[2:3], text[4:]) if own else (b",", text[1:])
    return parting, rest[2:3] if rest.startswith(b"1H") else b";"


def _numbers(text: bytes, parting: bytes, ending: bytes) -> list[int]:
    """Return the parameters behind the type number as whole numbers; 0 where one is none."""
    words = [w.strip() for w in text.split(ending, 1)[0].split(parting)]
    return [int(w) if re.fullmatch(rb"[-+]?\d+", w) else 0 for w in words[1:]]


def _listed(numbers: Sequence[int], at: int) -> list[int]:
    """Return the entities of a list whose length stands at a place."""
    return list(numbers[at + 1 : at + 1 + numbers[at]])


def _trimmed(numbers: Sequence[int]) -> list[int]:
    return [numbers[0], numbers[3], *numbers[4 : 4 + numbers[2]]]


def _bounded(numbers: Sequence[int]) -> list[int]:
    return [numbers[1], *_listed(numbers, 2)]


def _on_surface(numbers: Sequence[int]) -> list[int]:
    return list(numbers[2:4])


def _boundary(numbers: Sequence[int]) -> list[int]:
    found, at = [], 4
    for _ in range(numbers[3]):
        curves = numbers[at + 2]
        found += [numbers[at], *numbers[at + 3 : at + 3 + curves]]
        at += 3 + curves
    return found


def _composite(numbers: Sequence[int]) -> list[int]:
    return _listed(numbers, 0)


def _face(numbers: Sequence[int]) -> list[int]:
    return [numbers[0], *numbers[3 : 3 + numbers[1]]]


_MADE_OF: dict[int, Callable[[Sequence[int]], list[int]]] = {
    102: _composite,
    141: _boundary,
    142: _on_surface,
    143: _bounded,
    144: _trimmed,
    510: _face,
}
"""Where the parameters of a type name the entities that it is made of."""


def _parts(type: int, numbers: Sequence[int]) -> tuple[int, ...]:
    try:
        found = _MADE_OF[type](numbers) if type in _MADE_OF else []
    except IndexError:
        return ()
    return tuple(line for line in found if line > 0)
