"""Files of other programs, read with limits: their size, how much JSON holds, what an archive may unpack to."""

from __future__ import annotations

import json
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import Any, NoReturn

from trunnion.findings import BadInput

LARGEST = 32 * 1024**2
"""Bytes of one file, opened: far above the largest tool libraries that makers give away."""
MOST_BRACKETS = 2_000_000
"""Objects and lists in one JSON file."""
MOST_TOOLS = 20_000
"""Tools in one library."""
MOST_MEMBERS = 1_000
"""Members of an archive."""


def read_bytes(path: Path) -> bytes:
    """Return a file's bytes; raise `BadInput` when it can't be read or is too large."""
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as reason:
        raise BadInput(f"{path}: can't be read: {reason.strerror or reason}") from None
    if len(data) > LARGEST:
        raise BadInput(f"{path}: larger than the {LARGEST // 1024**2} MB that are read")
    return data


def text_in(data: bytes, source: object) -> str:
    """Return the text in UTF-8 that bytes are; raise `BadInput` for others."""
    try:
        found = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise BadInput(f"{source}: not a text in UTF-8: save it in that encoding") from None
    if "\0" in found:
        raise BadInput(f"{source}: not a text: it holds bytes of value 0")
    return found


def json_in(data: bytes, source: object) -> dict[str, Any]:
    """Return the object that bytes of JSON hold; raise `BadInput` for other bytes, NaN among them."""
    words = text_in(data, source)
    if words.count("{") + words.count("[") > MOST_BRACKETS:
        raise BadInput(f"{source}: more than the {MOST_BRACKETS} objects and lists that are read")

    def refuse(word: str) -> NoReturn:
        raise ValueError(f"{word} is no number")

    try:
        found = json.loads(words, parse_constant=refuse)
    except RecursionError:
        raise BadInput(f"{source}: not a tool library: its lists are nested too deep") from None
    except ValueError as reason:
        raise BadInput(f"{source}: not in JSON: {reason}") from None
    if not isinstance(found, dict):
        raise BadInput(f"{source}: not a tool library: it must be one object")
    return found


def listed(found: dict[str, Any], word: str, source: object) -> list[dict[str, Any]]:
    """Return a list of objects that an object holds under a word; raise `BadInput` for anything else, and for too many."""
    items = found.get(word)
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise BadInput(f"{source}: not a tool library: it must hold a list of objects, {word}")
    if len(items) > MOST_TOOLS:
        raise BadInput(f"{source}: {len(items)} tools are more than the {MOST_TOOLS} that are read")
    return items


def table(found: dict[str, Any], word: str, source: object) -> dict[str, Any]:
    """Return the object that an object holds under a word, an empty one where it has none; raise `BadInput` for anything else."""
    inner = found.get(word)
    if inner is None:
        return {}
    if not isinstance(inner, dict):
        raise BadInput(f"{source}: {word} must be an object")
    return inner


def member_of(path: Path, name: str) -> bytes:
    """Return one member of a zip archive; raise `BadInput` for no archive, unsafe names, or a member that is missing or too large."""
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            _check(path, entries, name)
            with archive.open(name) as member:
                data = member.read(LARGEST + 1)
    except OSError as reason:
        raise BadInput(f"{path}: can't be read: {reason.strerror or reason}") from None
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as reason:
        raise BadInput(f"{path}: damaged, or not a zip archive: {reason}") from None
    if len(data) > LARGEST:
        raise BadInput(
            f"{path}: {name} in it is larger than the {LARGEST // 1024**2} MB that are read"
        )
    return data


def _check(path: Path, entries: list[zipfile.ZipInfo], name: str) -> None:
    if len(entries) > MOST_MEMBERS:
        raise BadInput(
            f"{path}: {len(entries)} members are more than the {MOST_MEMBERS} that are read"
        )
    for entry in entries:
        inner = PurePosixPath(entry.filename.replace("\\", "/"))
        if inner.is_absolute() or ".." in inner.parts or ":" in entry.filename:
            raise BadInput(f"{path}: a name in it leaves the archive: {entry.filename[:80]!r}")
    found = [entry for entry in entries if entry.filename == name]
    if len(found) != 1:
        raise BadInput(f"{path}: it must hold {name} once; it holds it {len(found)} times")
    if found[0].file_size > LARGEST:
        raise BadInput(
            f"{path}: {name} in it is larger than the {LARGEST // 1024**2} MB that are read"
        )
