"""Part 21 files written: entities in clear text (ISO 10303-21), each with the number that others name it by."""

from __future__ import annotations

from trunnion.part.read.step_text import EntityNumber

Parameter = str | EntityNumber | tuple["Parameter", ...] | None
_ASCII = range(0x20, 0x7F)
_PLANE = 0x10000
"""The first character that needs more than 16 bits."""


class EntityFile:
    """A file of one schema that grows entity by entity. It has no time of its own: same entities, same bytes."""

    def __init__(self, name: str, schema: str, program: str) -> None:
        self._head = (name, schema, program)
        self._lines: list[str] = []

    def add(self, type: str, *parameters: Parameter) -> EntityNumber:
        """Add an entity and return its number; None stands for a parameter that is not given."""
        number = len(self._lines) + 1
        self._lines.append(f"#{number}={type}({','.join(map(_written, parameters))});")
        return EntityNumber(number)

    def bytes(self) -> bytes:
        """Return the file."""
        name, schema, program = map(_text, self._head)
        lines = [
            "ISO-10303-21;",
            "HEADER;",
            "FILE_DESCRIPTION((''),'2;1');",
            f"FILE_NAME({name},'',(''),(''),{program},{program},'');",
            f"FILE_SCHEMA(({schema}));",
            "ENDSEC;",
            "DATA;",
            *self._lines,
            "ENDSEC;",
            "END-ISO-10303-21;",
        ]
        return ("\n".join(lines) + "\n").encode("ascii")


def _written(parameter: Parameter) -> str:
    if parameter is None:
        return "$"
    if isinstance(parameter, EntityNumber):
        return f"#{parameter.number}"
    if isinstance(parameter, tuple):
        return f"({','.join(map(_written, parameter))})"
    return _text(parameter)


def _text(words: str) -> str:
    """Return a text in quotes, other letters than those of ASCII by their code (ISO 10303-21, 6.4.3)."""
    return f"'{''.join(map(_letter, words))}'"


def _letter(letter: str) -> str:
    code = ord(letter)
    if letter in ("'", "\\"):
        return letter * 2
    if code in _ASCII:
        return letter
    return f"\\X2\\{code:04X}\\X0\\" if code < _PLANE else f"\\X4\\{code:08X}\\X0\\"
