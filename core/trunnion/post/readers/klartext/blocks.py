"""Blocks of a Klartext as words. Knows the form of a block, not what its words mean."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from trunnion.findings import BadInput
from trunnion.post.readers.numbers import LINE_NUMBER, shown

NUMBER = r"[-+]?(?:[0-9]{1,9}\.?[0-9]{0,12}|\.[0-9]{1,12})"
_BLOCK_NUMBER = re.compile(r"[0-9]{1,8}")
_WORD = re.compile(rf"(I?P?[ABCXYZ]|T[XYZ]|F|M)({NUMBER})")
_PARAMETER = re.compile(rf"Q([0-9]{{1,4}})=({NUMBER})")
_INCREMENTAL = re.compile(rf"I[XYZABC]{NUMBER}")
_TITLE = re.compile(r"[A-Z.&/-]+")
_TURNS = {"DR+": 1, "DR-": -1}


@dataclass(frozen=True, slots=True)
class KlartextBlock:
    """A block: its first line in the text and its words in capitals, without its number and comments."""

    line: int
    words: tuple[str, ...]


@dataclass(slots=True, kw_only=True)
class PathWords:
    """What a block says of a move: `numbers` by word, `feed` as it is written or None, whether it is a `rapid`, the sense in which an arc
    `turns` (1 anticlockwise, -1, 0 for none), and its M functions."""

    numbers: dict[str, float] = field(default_factory=dict)
    feed: float | None = None
    rapid: bool = False
    turns: int = 0
    functions: list[str] = field(default_factory=list)


def blocks_of(text: str) -> Iterator[KlartextBlock | tuple[int, str]]:
    """Yield the blocks of a text, and before each its comments with their lines; raise `BadInput` for a wrong form.

    A line that ends with `~` goes on in the next; what follows `;` is a comment, and a line that begins with `*` is one.
    """
    last, begun, words = -1.0, 0, [""]
    for number, line in enumerate(text.split("\n"), 1):
        code, _, comment = line.partition(";")
        code, comment = code.strip(), comment.strip()
        goes_on = (comment or code).endswith("~")
        if goes_on and not comment:
            code = code[:-1]
        found = code.upper().split()
        if not begun:
            if found and _BLOCK_NUMBER.fullmatch(found[0]):
                last = _counted(number, float(found.pop(0)), last)
            if found and found[0] == "*":
                found, comment = [], code.partition("*")[2].strip(" -")
            words = []
        if comment and not goes_on and not begun:
            yield number, comment
        begun = begun or number
        words += found
        if goes_on:
            continue
        if words:
            yield KlartextBlock(begun, tuple(words))
        begun = 0
    if begun:
        raise BadInput(
            f"line {begun}: a block that goes on (~) after the last line: is the text complete?"
        )


def _counted(line: int, number: float, last: float) -> float:
    LINE_NUMBER.check(line, "block ", number)
    if number <= last:
        raise BadInput(
            f"line {line}: block {number:g} comes after block {last:g}: blocks are out of order; put them back or renumber them"
        )
    return number


def path_words(
    block: KlartextBlock, known: tuple[str, ...], refused: Mapping[str, str]
) -> PathWords:
    """Return what a block says after its first word, of numbers those that are `known`; raise `BadInput` for anything else."""
    found, line = PathWords(), block.line
    for word in block.words[1:]:
        if word == "R0":
            continue
        if word == "FMAX":
            found.rapid = True
        elif word in _TURNS and not found.turns:
            found.turns = _TURNS[word]
        elif (match := _WORD.fullmatch(word)) is not None:
            _take(line, match.group(1), match.group(2), word, found, known, refused)
        else:
            raise BadInput(f"line {line}: {why_not(word, refused)}")
    if found.rapid and found.feed is not None:
        raise BadInput(f"line {line}: F and FMAX in one block; keep one")
    return found


def _take(
    line: int,
    letter: str,
    number: str,
    word: str,
    found: PathWords,
    known: tuple[str, ...],
    refused: Mapping[str, str],
) -> None:
    # Zero has no sign here: -0 + 0 is 0.
    value = float(number) + 0.0
    if letter == "M":
        found.functions.append(function_of(line, word, refused))
    elif letter == "F" and found.feed is None:
        found.feed = value
    elif letter in found.numbers or letter == "F":
        raise BadInput(f"line {line}: two {letter} words; keep one")
    elif letter not in known and _INCREMENTAL.fullmatch(word):
        raise BadInput(f"line {line}: {why_not(word, refused)}")
    elif letter not in known:
        raise BadInput(
            f"line {line}: {shown(word)} is not understood in this block; known are {', '.join(known)}"
        )
    else:
        found.numbers[letter] = value


def function_of(line: int, word: str, refused: Mapping[str, str]) -> str:
    """Return an M function as it is listed, without zeros before its number; raise `BadInput` for one that is refused."""
    digits = word[1:]
    if not digits.isdigit():
        raise BadInput(f"line {line}: {shown(word)} is no function of this control")
    name = f"M{int(digits)}"
    if name in refused:
        raise BadInput(f"line {line}: {why_not(name, refused)}")
    return name


def parameters(block: KlartextBlock, words: tuple[str, ...]) -> dict[int, float]:
    """Return the Q words of a cycle by their numbers, after its title; raise `BadInput` for anything else."""
    found: dict[int, float] = {}
    for word in words:
        match = _PARAMETER.fullmatch(word)
        if match is None:
            if not found and _TITLE.fullmatch(word):
                continue
            raise BadInput(
                f"line {block.line}: {shown(word)} is not understood in a cycle; write Q, its number, = and a number"
            )
        number = int(match.group(1))
        if number in found:
            raise BadInput(f"line {block.line}: two Q{number} words; keep one")
        found[number] = float(match.group(2)) + 0.0
    return found


def number_after(block: KlartextBlock, letters: str, word: str) -> float | None:
    """Return the number of a word that begins with some letters, None for another word."""
    found = re.fullmatch(rf"{letters}({NUMBER})", word)
    return None if found is None else float(found.group(1)) + 0.0


def why_not(word: str, refused: Mapping[str, str]) -> str:
    """Return why a word is not understood, by the whole of it or by its letters."""
    letters = re.match(r"[A-Z]*", word)
    for key in (word, letters.group(0) if letters else ""):
        if key in refused:
            return f"{shown(word)}: {refused[key].format(word=shown(word))}"
    if "Q" in refused and re.fullmatch(r"[A-Z]+[-+]?Q[LRS]?[0-9]+", word):
        return f"{shown(word)}: {refused['Q']}"
    if _INCREMENTAL.fullmatch(word):
        return f"{shown(word)}: incremental moves are not understood; write absolute positions"
    return f"{shown(word)} is not understood; remove it or write what it does by other words"
