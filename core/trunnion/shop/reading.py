"""Catalogue files: TOML read strictly, with one clear line for what is wrong: file, entry, field."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from trunnion.findings import BadInput
from trunnion.registry import resource_folders
from trunnion.units import seconds_of

SUFFIX = ".toml"


@dataclass(slots=True, kw_only=True)
class CatalogueEntry:
    """One table of a catalogue file. Fields are read by name and checked; `done` refuses those that were not read."""

    file: str
    name: str
    fields: dict[str, Any]
    _read: set[str] = field(default_factory=set)

    def wrong(self, what: str) -> BadInput:
        """Return the error that names the file and this entry."""
        return BadInput(f"{self.file}: {self.name}: {what}")

    def has(self, name: str) -> bool:
        """Return whether a field is given."""
        return name in self.fields

    def text(self, name: str, default: str | None = None) -> str:
        """Return a text that is not empty."""
        value = self._get(name, default)
        if not isinstance(value, str) or (not value and default is None):
            raise self.wrong(f"{name} must be a text; got {value!r}")
        return value

    def flag(self, name: str, default: bool | None = None) -> bool:
        """Return true or false."""
        value = self._get(name, default)
        if not isinstance(value, bool):
            raise self.wrong(f"{name} must be true or false; got {value!r}")
        return value

    def number(self, name: str, low: float, high: float, default: float | None = None) -> float:
        """Return a number within bounds."""
        return self._number(name, self._get(name, default), low, high)

    def count(self, name: str, low: int, high: int) -> int:
        """Return a whole number within bounds."""
        value = self._get(name, None)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.wrong(f"{name} must be a whole number from {low} to {high}; got {value!r}")
        return value

    def texts(
        self, name: str, default: tuple[str, ...] | None = None, known: tuple[str, ...] = ()
    ) -> tuple[str, ...]:
        """Return a list of texts, each one of `known` when that is given."""
        value = self._get(name, default)
        if not isinstance(value, (list, tuple)) or not all(isinstance(v, str) for v in value):
            raise self.wrong(f"{name} must be a list of texts; got {value!r}")
        strange = [v for v in value if known and v not in known]
        if strange:
            raise self.wrong(f"{name} knows {', '.join(known)}; got {strange[0]!r}")
        return tuple(value)

    def numbers(
        self, name: str, low: float, high: float, *, may_be_empty: bool = False
    ) -> tuple[float, ...]:
        """Return a list of numbers within bounds, at least one unless it may be empty."""
        value = self._get(name, None)
        if not isinstance(value, list) or not (value or may_be_empty):
            raise self.wrong(f"{name} must be a list of numbers; got {value!r}")
        return tuple(self._number(name, v, low, high) for v in value)

    def rows(self, name: str, width: int, low: float, high: float) -> tuple[tuple[float, ...], ...]:
        """Return rows of `width` numbers within bounds, at least one row."""
        value = self._get(name, None)
        if (
            not isinstance(value, list)
            or not value
            or not all(isinstance(row, list) and len(row) == width for row in value)
        ):
            raise self.wrong(f"{name} must be rows of {width} numbers; got {value!r}")
        return tuple(tuple(self._number(name, v, low, high) for v in row) for row in value)

    def seconds(self, name: str, low: float, high: float) -> float:
        """Return a time in s within bounds: a number of seconds, or words such as `2 h 16 min 02 s`."""
        value = self._get(name, None)
        if isinstance(value, str):
            try:
                value = seconds_of(value)
            except ValueError as reason:
                raise self.wrong(f"{name} {reason}") from None
        return self._number(name, value, low, high)

    def table(self, name: str) -> CatalogueEntry:
        """Return a table inside this entry."""
        value = self._get(name, None)
        if not isinstance(value, dict):
            raise self.wrong(f"{name} must be a table; got {value!r}")
        return CatalogueEntry(file=self.file, name=f"{self.name}: {name}", fields=value)

    def tables(self, name: str) -> tuple[CatalogueEntry, ...]:
        """Return the tables of a list inside this entry, at least one."""
        value = self._get(name, None)
        if not isinstance(value, list) or not value or not all(isinstance(v, dict) for v in value):
            raise self.wrong(f"{name} must be a list of tables; got {value!r}")
        return tuple(
            CatalogueEntry(file=self.file, name=f"{self.name}: {name} {n}", fields=v)
            for n, v in enumerate(value, 1)
        )

    def done(self) -> None:
        """Raise `BadInput` when a field is given that was not read: mostly a misspelt one."""
        strange = sorted(set(self.fields) - self._read)
        if strange:
            raise self.wrong(
                f"{strange[0]} is not a field here; known: {', '.join(sorted(self._read))}"
            )

    def _get(self, name: str, default: Any) -> Any:
        self._read.add(name)
        if name not in self.fields:
            if default is None:
                raise self.wrong(f"{name} is missing")
            return default
        return self.fields[name]

    def _number(self, name: str, value: Any, low: float, high: float) -> float:
        if (
            isinstance(value, bool)
            or not isinstance(value, (int, float))
            or not math.isfinite(value)
            or not low <= value <= high
        ):
            raise self.wrong(f"{name} must be a number from {low:g} to {high:g}; got {value!r}")
        return float(value)


def folders(kind: str, user_folder: Path | None) -> tuple[Traversable, ...]:
    """Return where a kind of catalogue (`tools`, `materials`, ...) lies: the program's own folder, those of registered packages, then
    the user's when there is one."""
    own = resource_folders(kind)
    return own if user_folder is None else (*own, user_folder / kind)


def entries(kind: str, user_folder: Path | None) -> Iterator[tuple[int, CatalogueEntry]]:
    """Yield the top tables of every file of a kind in the order of file names, with the number of the folder: 0 for the program's."""
    for layer, folder in enumerate(folders(kind, user_folder)):
        if folder.is_dir():
            for path in sorted(
                (p for p in folder.iterdir() if p.name.endswith(SUFFIX)), key=lambda p: p.name
            ):
                label = f"{kind}/{path.name}" if layer == 0 else str(path)
                yield from ((layer, entry) for entry in file_entries(path, label))


def file_entries(path: Traversable, label: str) -> Iterator[CatalogueEntry]:
    """Yield the top tables of one file, in their order; `label` names it in messages. Raises `BadInput` for what is no such file."""
    for name, table in _parsed(path, label).items():
        if not isinstance(table, dict):
            raise BadInput(f"{label}: {name} must be a table, written as [{name}]")
        yield CatalogueEntry(file=label, name=name, fields=table)


def by_name(found: Iterable[tuple[int, CatalogueEntry]]) -> dict[str, CatalogueEntry]:
    """Return entries by name, those of later folders over those of earlier ones; raise `BadInput` when one folder gives a name twice."""
    latest: dict[str, tuple[int, CatalogueEntry]] = {}
    for layer, entry in found:
        earlier = latest.get(entry.name)
        if earlier is not None and earlier[0] == layer:
            raise entry.wrong(f"the name is given before in {earlier[1].file}")
        latest[entry.name] = (layer, entry)
    return {name: entry for name, (_, entry) in latest.items()}


def _parsed(path: Traversable, label: str) -> dict[str, Any]:
    try:
        return _tables(path.read_bytes().decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise BadInput(f"{label}: not a text in UTF-8") from None
    except tomllib.TOMLDecodeError as reason:
        raise BadInput(f"{label}: {reason}") from None
    except OSError as reason:
        raise BadInput(f"{label}: {reason.strerror}") from None


@lru_cache(maxsize=64)
def _tables(text: str) -> dict[str, Any]:
    """Return what a text of TOML says, which nobody changes: a shop is loaded again when a tool is put into a machine, its other files the
    same."""
    return tomllib.loads(text)
