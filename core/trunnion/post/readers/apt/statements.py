"""Statements of APT CL text. Knows the form of a text, not what its words mean."""

from __future__ import annotations

from collections.abc import Iterator

from trunnion.findings import BadInput

_TEXT_WORDS = ("PARTNO", "PPRINT", "REMARK")
"""Words after which the rest of the line is text."""


def statements(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield the line, major word and rest of each statement, lines that end in $ joined, comments ($$) left out; raise `BadInput` when the
    last goes on."""
    joined, first = "", 0
    for line, raw in enumerate(text.split("\n"), 1):
        part = raw.strip()
        is_text = not joined and part.upper().startswith(_TEXT_WORDS)
        if not is_text:
            part = part.split("$$", 1)[0].rstrip()
        first = first if joined else line
        if part.endswith("$") and not is_text:
            joined += part[:-1]
            continue
        statement, joined = joined + part, ""
        if statement:
            yield first, *_parted(statement, is_text)
    if joined:
        raise BadInput(
            f"line {first}: the statement goes on after the last line: is the text complete?"
        )


def _parted(statement: str, is_text: bool) -> tuple[str, str]:
    if is_text:
        word = next(w for w in _TEXT_WORDS if statement.upper().startswith(w))
        return word, statement[len(word) :].removeprefix("/").strip()
    word, _, rest = statement.upper().partition("/")
    return word.strip(), "".join(rest.split())
