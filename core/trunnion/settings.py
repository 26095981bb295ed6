"""Settings declared once: a frozen dataclass whose fields carry default, unit, range, label and help.

From one declaration come the panel's widgets, the command line's `--set`, the XML, the documentation and the message
for a wrong value. Constructors only store; `checked` validates in one place before a step runs.

    @settings("panel.rough")
    class RoughingSettings:
        stepover: float = setting(0.4, unit="of diameter", low=0.05, high=0.95, label="Stepover", help="Width of cut.")
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, dataclass_transform, get_type_hints

from trunnion.findings import BadInput

_META = "trunnion"
_YES, _NO = ("true", "yes", "on", "1"), ("false", "no", "off", "0")
Value = float | int | bool | str
T = TypeVar("T")


@dataclass(frozen=True, slots=True, kw_only=True)
class Declared:
    """One declared setting: `key` is `GROUP.NAME`, `kind` one of float, int, bool, str."""

    key: str
    name: str
    kind: type
    default: Value
    unit: str
    low: float | None
    high: float | None
    label: str
    help: str
    choices: tuple[str, ...]
    catalogue: str
    """The catalogue whose names may be given: materials, machines, tools or plans; empty for anything else."""
    files: tuple[str, ...] = ()
    """Endings of the files that may be named, with their dots; empty where it is no file."""

    def allowed(self) -> str:
        """Return in words what values may be given."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        if self.kind is bool:
            return "true or false"
        bounds = [
            f"from {self.low:g}" if self.low is not None else "",
            f"to {self.high:g}" if self.high is not None else "",
        ]
        words = " ".join(b for b in bounds if b)
        return (
            f"{words} {self.unit}".strip()
            if words
            else {float: "a number", int: "a whole number"}.get(self.kind, "a text")
        )

    def parse(self, text: Value) -> Value:
        """Return the value that a text (or a value of the right type) stands for, checked; raise `BadInput` otherwise."""
        try:
            value = _read(self.kind, text)
        except (TypeError, ValueError):
            raise BadInput(
                f"{self.label} ({self.key}) must be {self.allowed()}; got {text}"
            ) from None
        outside = (self.choices and value not in self.choices) or (
            not isinstance(value, (str, bool))
            and (
                (self.low is not None and value < self.low)
                or (self.high is not None and value > self.high)
                or value != value
            )
        )
        if outside:
            raise BadInput(f"{self.label} ({self.key}) must be {self.allowed()}; got {text}")
        return value


def setting(
    default: Value,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    label: str,
    help: str,
    choices: tuple[str, ...] = (),
    catalogue: str = "",
    files: tuple[str, ...] = (),
) -> Any:
    """Return the dataclass field of one setting. A number needs `unit` ("" where it counts), `low` and `high`.

    A name of a thing in a catalogue (`materials`, `machines`, `tools`, `plans`) says which, and forms offer what there is;
    the name of a file says by `files` which endings it may have, and forms let a person choose it.
    """
    return dataclasses.field(
        default=default,
        metadata={
            _META: {
                "unit": unit,
                "low": low,
                "high": high,
                "label": label,
                "help": help,
                "choices": choices,
                "catalogue": catalogue,
                "files": files,
            }
        },
    )


GROUPS: dict[str, type] = {}
"""Every declared group of settings by its name; filled by `@settings` when a module is imported."""


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(setting,))
def settings(group: str) -> Callable[[type[T]], type[T]]:
    """Make a class a frozen group of settings named `group` (dotted, as it stands before `.NAME` in `--set`)."""

    def make(cls: type[T]) -> type[T]:
        made = dataclass(frozen=True, slots=True, kw_only=True)(cls)
        made.GROUP = group  # type: ignore[attr-defined]
        known = GROUPS.get(group)
        if known is not None and known.__qualname__ != made.__qualname__:
            raise ValueError(
                f"two groups of settings are named {group}: {known.__qualname__} and {made.__qualname__}"
            )
        GROUPS[group] = made
        return made

    return make


def declared(cls: type) -> tuple[Declared, ...]:
    """Return the settings that a group declares, in their order."""
    group: Any = cls
    return _declared(group)


@cache
def _declared(cls: Any) -> tuple[Declared, ...]:
    kinds = get_type_hints(cls)
    found = []
    for field in dataclasses.fields(cls):
        meta = field.metadata.get(_META)
        if meta is not None:
            found.append(
                Declared(
                    key=f"{cls.GROUP}.{field.name}",
                    name=field.name,
                    kind=kinds[field.name],
                    default=field.default,  # type: ignore[arg-type]
                    **meta,
                )
            )
    return tuple(found)


def checked(group: T) -> T:
    """Return the group when every value is allowed; raise `BadInput` naming the first that is not."""
    values = {d.name: d.parse(getattr(group, d.name)) for d in declared(type(group))}
    return dataclasses.replace(group, **values)  # type: ignore[type-var]


def choose(cls: type[T], words: Mapping[str, Value]) -> T:
    """Return a group with the values that `words` gives by full key (`panel.rough.stepover`) or by name; others keep defaults.

    Keys of other groups are passed over, so that one mapping serves every step.
    """
    values: dict[str, Value] = {}
    for d in declared(cls):
        for key in (d.name, d.key):
            if key in words:
                values[d.name] = d.parse(words[key])
    return cls(**values)


def digest(*things: Any) -> str:
    """Return a short stable digest of groups of settings, texts, numbers, and tuples and mappings of them."""
    return hashlib.sha256(
        json.dumps([_plain(t) for t in things], sort_keys=True).encode()
    ).hexdigest()[:16]


def added(default: Any, *, written: bool = True) -> Any:
    """Return a dataclass field that older files don't have: at its default it is no part of a digest, so theirs stay what they were.

    With `written=False` it is left out of files and JSON too where it has its default (`unwritten`).
    """
    return dataclasses.field(default=default, metadata={_ADDED: True, _WRITTEN: written})


def unwritten(thing: Any) -> frozenset[str]:
    """Return the names of a dataclass's fields that files and JSON leave out: those that say so and have their default."""
    kind: Any = type(thing)
    return frozenset(
        name for name, default in _sometimes(kind) if _is_same(getattr(thing, name), default)
    )


_ADDED, _WRITTEN = "added", "written"


@cache
def _sometimes(cls: Any) -> tuple[tuple[str, Any], ...]:
    return tuple(
        (f.name, f.default) for f in dataclasses.fields(cls) if not f.metadata.get(_WRITTEN, True)
    )


def _is_same(value: Any, default: Any) -> bool:
    return value is default or (default is not None and bool(value == default))


@cache
def _digested(cls: Any) -> tuple[tuple[str, bool, Any], ...]:
    """Return the fields of a dataclass that a digest is made of: name, whether older files don't have it, and its default."""
    # A field that is not given at construction is a cache: it may be there or not yet.
    return tuple(
        (f.name, _ADDED in f.metadata, f.default) for f in dataclasses.fields(cls) if f.init
    )


_PLAIN = frozenset({str, int, float, bool, type(None)})


def _plain(thing: Any) -> Any:
    kind = type(thing)
    if kind in _PLAIN:
        return thing
    if dataclasses.is_dataclass(kind):
        own: dict[str, Any] = {"": kind.__qualname__}
        for name, is_added, default in _digested(kind):
            value = getattr(thing, name)
            if not (is_added and _is_same(value, default)):
                own[name] = _plain(value)
        return own
    if isinstance(thing, Mapping):
        return {str(k): _plain(v) for k, v in thing.items()}
    if isinstance(thing, (list, tuple, set, frozenset)):
        parts = [_plain(t) for t in thing]
        return sorted(parts, key=repr) if isinstance(thing, (set, frozenset)) else parts
    if hasattr(thing, "tobytes"):
        return hashlib.sha256(thing.tobytes()).hexdigest()
    if isinstance(thing, (str, int, float)):
        return thing
    raise TypeError(f"no digest of a {kind.__name__}")


def _read(kind: type, text: Value) -> Value:
    if kind is bool:
        return text if isinstance(text, bool) else _truth(str(text).strip().lower())
    if kind is int:
        if isinstance(text, bool) or (isinstance(text, float) and text != int(text)):
            return _wrong()
        return int(text)
    if kind is float:
        return _wrong() if isinstance(text, bool) else float(text)
    return text if isinstance(text, str) else _wrong()


def _truth(word: str) -> bool:
    if word not in _YES + _NO:
        raise ValueError(word)
    return word in _YES


def _wrong() -> Value:
    raise ValueError
