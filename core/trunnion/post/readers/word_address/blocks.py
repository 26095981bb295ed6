"""Lines of RS274 text as words. Knows the form of a line, not what its words mean."""

from __future__ import annotations

import re
from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion.post.readers.numbers import shown

_WORD = re.compile(r"([A-Z])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")
_COMMENT = re.compile(r"\(([^()]*)\)")
_MOST_CODE = 1000.0
"""G and M codes stay below."""
_SPACE = str.maketrans("", "", " \t\r")
_REFUSED = {
    "#": "parameters (#) are not understood; write the numbers themselves",
    "[": "expressions are not understood; write the numbers themselves",
    "]": "expressions are not understood; write the numbers themselves",
    "O": "subprograms and loops (O words) are not understood; write the motions out",
    "/": "block delete (/): whether the line runs depends on a switch; remove the / or the line",
}


@dataclass(frozen=True, slots=True)
class Block:
    """One line: `codes` its G and M words in order as texts (`G0`, `M6`, `G59.1`), `words` the others by letter."""

    line: int
    codes: list[str]
    words: dict[str, float]


def split_line(line: int, text: str, brackets: bool = True) -> tuple[Block | None, tuple[str, ...]]:
    """Return the words of a line (None when it has none) and its comments; raise `BadInput` for anything else that stands in it.

    Comments stand after a semicolon and, where the control has them so, in brackets.
    """
    comments: tuple[str, ...] = ()
    if ";" in text:
        text, comments = _without_end_comment(text, brackets)
    if "(" in text or ")" in text:
        if not brackets:
            raise BadInput(
                f"line {line}: brackets are not understood on this control; write comments after a semicolon"
            )
        text, inside = _without_comments(line, text)
        comments = inside + comments
    packed = text.translate(_SPACE).upper()
    if not packed:
        return None, comments
    return _words(line, packed), comments


def _words(line: int, packed: str) -> Block:
    codes: list[str] = []
    words: dict[str, float] = {}
    length = 0
    for letter, number in _WORD.findall(packed):
        length += 1 + len(number)
        if letter in "GM":
            codes.append(code_text(line, letter, number))
        elif letter in words:
            raise BadInput(f"line {line}: two {letter} words; keep one")
        else:
            # Zero has no sign here: -0 + 0 is 0.
            words[letter] = float(number) + 0.0
    if length != len(packed):
        raise BadInput(f"line {line}: {_why(packed)}")
    return Block(line, codes, words)


def code_text(line: int, letter: str, number: str) -> str:
    """Return a G or M word as a text; raise `BadInput` for a number that no code has.

    >>> code_text(1, "G", "01"), code_text(1, "G", "59.1")
    ('G1', 'G59.1')
    """
    value = round(float(number), 1)
    if value != float(number) or not 0.0 <= value < _MOST_CODE:
        raise BadInput(f"line {line}: {letter}{shown(number)} is no code of this control")
    return f"{letter}{int(value)}" if value == int(value) else f"{letter}{value}"


def _why(packed: str) -> str:
    for sign, why in _REFUSED.items():
        if sign in packed:
            return why
    rest = _WORD.sub(" ", packed).split()
    return f"{shown(rest[0] if rest[0].isprintable() else repr(rest[0]))} is not understood; a word is a letter and a number"


def _without_end_comment(text: str, brackets: bool) -> tuple[str, tuple[str, ...]]:
    if not brackets:
        words, _, comment = text.partition(";")
        return words, (comment.strip(),)
    depth = 0
    for n, c in enumerate(text):
        depth += (c == "(") - (c == ")" and depth > 0)
        if c == ";" and not depth:
            return text[:n], (text[n + 1 :].strip(),)
    return text, ()


def _without_comments(line: int, text: str) -> tuple[str, tuple[str, ...]]:
    inside = tuple(found.strip() for found in _COMMENT.findall(text))
    rest = _COMMENT.sub(" ", text)
    if "(" in rest or ")" in rest:
        raise BadInput(
            f"line {line}: a comment's brackets don't match, or one comment stands inside another"
        )
    return rest, inside
