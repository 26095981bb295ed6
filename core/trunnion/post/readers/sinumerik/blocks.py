"""Lines of Sinumerik text as words: addresses, words with `=`, names, and one call with its arguments. Knows the form of a line alone."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion.post.readers.numbers import shown
from trunnion.post.readers.word_address.blocks import Block, code_text

_NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
_STRING = r'"[^"]*"'
_WORD = re.compile(
    rf"""\s*(?:
    (?P<call>[A-Z_][A-Z0-9_]+)\((?P<arguments>(?:{_STRING}|[^()"])*)\)
    |(?P<set>[A-Z][A-Z0-9_]*)\s*=\s*(?:(?P<value>{_NUMBER})(?![A-Z0-9_.(*/])|(?P<text>{_STRING}))
    |(?P<name>[A-Z][A-Z_]+[0-9]*)(?![A-Z0-9_=(])
    |(?P<letter>[A-Z])(?P<number>{_NUMBER})(?![=(])
    )""",
    re.VERBOSE,
)
_SIMPLE_WORD = re.compile(rf"(?<!\S)([A-QS-Z][0-9]=|[A-Z])({_NUMBER})(?!\S)")
"""A letter and its number, or a word like A3= and its number, between spaces: most lines have no others."""
_ARGUMENT = re.compile(rf"\s*({_STRING}|[^,\"]*)\s*(?:,|$)")
ALIASES = {"G53": "SUPA", "G153": "SUPA", "G71": "G710"}
"""Codes that say here what another one does: of frames that are suppressed only Z0 is understood, and feeds are metric anyway."""
DWELL_WORD = "G4 F"
"""F in the line of a dwell is its seconds."""


@dataclass(frozen=True, slots=True)
class CallBlock(Block):
    """A line with a call: `name` is among its codes, `arguments` are texts, empty where none is given."""

    name: str
    arguments: tuple[str, ...]


def split_sinumerik_line(
    line: int, text: str, number_of: Callable[[int, str], float]
) -> tuple[Block | None, tuple[str, ...]]:
    """Return the words of a line (None when it has none) and its comment; raise `BadInput` for anything else that stands in it.

    `number_of` returns the number of a tool that T calls by its name.
    """
    program, comment = _without_comment(text)
    comments = (comment.strip(),) if comment is not None else ()
    program = program.strip()
    if not program:
        return None, comments
    if program.startswith("/"):
        raise BadInput(
            f"line {line}: block skip (/): whether the line runs depends on a switch; remove the / or the line"
        )
    return _block(line, program, number_of), comments


def _block(line: int, program: str, number_of: Callable[[int, str], float]) -> Block:
    upper = _upper(program)
    call, simple = None, _SIMPLE_WORD.findall(upper)
    if len(simple) == len(upper.split()):
        codes, words = _simple_words(line, simple)
    else:
        codes, words, call = _all_words(line, upper, number_of)
    if "G4" in codes:
        if "S" in words:
            raise BadInput(f"line {line}: a dwell of turns (G4 S) is not understood; use G4 F")
        if "F" in words:
            words[DWELL_WORD] = words.pop("F")
    if call is None:
        return Block(line, codes, words)
    if set(words) - {"N"} or set(codes) - {call[0], "MCALL"}:
        raise BadInput(f"line {line}: {call[0]} with other words in its line; write two lines")
    return CallBlock(line, codes, words, *call)


def _simple_words(line: int, found: list[tuple[str, str]]) -> tuple[list[str], dict[str, float]]:
    """Return the codes and the words of a line of simple words, each with its number, as `_all_words` does."""
    codes: list[str] = []
    words: dict[str, float] = {}
    for key, number in found:
        if key in "GM":
            code = code_text(line, key, number)
            codes.append(ALIASES.get(code, code))
        elif key in words:
            raise BadInput(f"line {line}: two {key} words; keep one")
        else:
            words[key] = float(number) + 0.0
    return codes, words


def _all_words(
    line: int, upper: str, number_of: Callable[[int, str], float]
) -> tuple[list[str], dict[str, float], tuple[str, tuple[str, ...]] | None]:
    """Return the codes and the words of any line, and its call by name and arguments."""
    codes: list[str] = []
    words: dict[str, float] = {}
    call: tuple[str, tuple[str, ...]] | None = None
    at = 0
    while at < len(upper):
        found = _WORD.match(upper, at)
        if found is None:
            raise BadInput(f"line {line}: {_why_not(upper[at:].strip())}")
        part, at = found.groupdict(), found.end()
        if part["call"]:
            if call is not None:
                raise BadInput(f"line {line}: two calls; write two lines")
            call = part["call"], _arguments(line, part["call"], part["arguments"])
            codes.append(part["call"])
        elif part["name"]:
            codes.append(part["name"])
        elif part["text"]:
            if part["set"] != "T":
                raise BadInput(f"line {line}: {shown(part['set'])}= takes no text; give a number")
            _set(line, words, "T", number_of(line, part["text"].strip('"')))
        elif part["letter"] and part["letter"] in "GM":
            code = code_text(line, part["letter"], part["number"])
            codes.append(ALIASES.get(code, code))
        elif part["letter"]:
            _set(line, words, part["letter"], float(part["number"]) + 0.0)
        else:
            name = part["set"]
            if re.fullmatch(r"R[0-9]+", name):
                raise BadInput(
                    f"line {line}: parameters ({name}=) are not understood; write the numbers themselves"
                )
            _set(line, words, name if len(name) == 1 else name + "=", float(part["value"]) + 0.0)
    return codes, words, call


def _set(line: int, words: dict[str, float], key: str, value: float) -> None:
    if key in words:
        raise BadInput(f"line {line}: two {key} words; keep one")
    words[key] = value


def _arguments(line: int, name: str, text: str) -> tuple[str, ...]:
    """Return the arguments of a call, without their spaces."""
    if not text.strip():
        return ()
    found, at = [], 0
    while at <= len(text):
        part = _ARGUMENT.match(text, at)
        if part is None:
            raise BadInput(
                f"line {line}: the arguments of {name} are not understood; part them by commas"
            )
        found.append(part.group(1).strip())
        if part.end() == len(text) and not part.group(0).endswith(","):
            break
        at = part.end()
    return tuple(found)


def _upper(text: str) -> str:
    """Return a text in capitals, names between quotes as they are."""
    if '"' not in text:
        return text.upper()
    return "".join(
        part if part.startswith('"') else part.upper() for part in re.split(rf"({_STRING})", text)
    )


def _without_comment(text: str) -> tuple[str, str | None]:
    """Return a line before its semicolon and what comes after it, None where there is none; one between quotes is no comment."""
    if ";" not in text:
        return text, None
    quoted = False
    for n, c in enumerate(text):
        quoted ^= c == '"'
        if c == ";" and not quoted:
            return text[:n], text[n + 1 :]
    return text, None


def _why_not(rest: str) -> str:
    if re.match(r"[A-Z_][A-Z0-9_]*\s*=", rest) or re.match(r"R[0-9]+\s*=", rest):
        word = rest.split("=")[0].strip()
        return f"{shown(word)}= is not followed by a number; parameters and expressions are not understood, write the number itself"
    if rest.startswith(("$", "R", "DEF", "IF")):
        return f"{shown(rest.split()[0])} is not understood; parameters and jumps are not, write the motions out"
    if "(" in rest or ")" in rest:
        return "brackets that are no call with its arguments; write comments after a semicolon"
    word = rest.split()[0] if rest.split() else rest
    return f"{shown(word if word.isprintable() else repr(word))} is not understood; a word is a letter and a number, or a name"
