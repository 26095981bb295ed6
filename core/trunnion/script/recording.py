"""The acts of a session as lines of Python: run from the same folder, the script does the same again."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar

from trunnion.findings import BadInput

P = ParamSpec("P")
T = TypeVar("T")
HEAD = '"""Recorded by Trunnion: run it in the folder it was recorded in, and the same is done again."""\n\nimport trunnion\n'
"""How a script begins."""
NAME = "program"
"""What the opened part is called in scripts."""


class Recording:
    """The lines of one opened part, kept in memory and, from `to_file` on, appended to a script as they come."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._file: Path | None = None
        self._n_written = 0

    def opened(self, path: str | Path, options: Mapping[str, Any]) -> None:
        """Record the opening of a part with the options that are not at their defaults."""
        self._add(f"\n{NAME} = trunnion.open{_call((path,), options)}")

    def act(self, method: str, arguments: tuple[Any, ...], options: Mapping[str, Any]) -> None:
        """Record the call of a method."""
        self._add(f"{NAME}.{method}{_call(arguments, options)}")

    def text(self) -> str:
        """Return the whole script."""
        return HEAD + "".join(f"{line}\n" for line in self._lines)

    def to_file(self, file: Path) -> None:
        """Append to a script from now on what was recorded and what will be; a script that is not there is begun.

        Nothing is written before the first act: opening alone changes nothing. Raises `BadInput` for a file that can't be written.
        """
        self._file = file

    def _add(self, line: str) -> None:
        self._lines.append(line)
        if self._file is None or len(self._lines) == 1:
            return
        new = "".join(f"{line}\n" for line in self._lines[self._n_written :])
        try:
            begins = not self._file.exists() or not self._file.stat().st_size
            with self._file.open("a", encoding="utf-8") as script:
                script.write(HEAD + new if begins else new)
        except OSError as reason:
            raise BadInput(f"{self._file}: can't be written: {reason.strerror or reason}") from None
        self._n_written = len(self._lines)


class _Recorded(Protocol):
    """Something whose acts are recorded."""

    recording: Recording


S = TypeVar("S", bound=_Recorded)


def recorded(method: Callable[Concatenate[S, P], T]) -> Callable[Concatenate[S, P], T]:
    """Make a method record its calls, once they have succeeded."""

    def call(self: S, /, *arguments: P.args, **options: P.kwargs) -> T:
        # Iterators would be used up by the call.
        given = tuple(map(_lasting, arguments))
        named = {name: _lasting(value) for name, value in options.items()}
        result = method(self, *given, **named)
        self.recording.act(method.__name__, given, named)
        return result

    return wraps(method)(call)


def _lasting(value: Any) -> Any:
    if isinstance(value, (str, Path, Mapping)) or not isinstance(value, Iterable):
        return value
    return tuple(value)


def _call(arguments: Iterable[Any], options: Mapping[str, Any]) -> str:
    words = [*map(literal, arguments), *(f"{k}={literal(v)}" for k, v in options.items())]
    return f"({', '.join(words)})"


def literal(value: Any) -> str:
    """Return a value as it is written in a script: paths as texts, numbers of arrays as plain ones.

    >>> literal(Path("a b.step")), literal((1, 2.5)), literal({"plane.rough.layer": 2.0})
    ("'a b.step'", '[1, 2.5]', "{'plane.rough.layer': 2.0}")
    """
    if isinstance(value, Path):
        return repr(str(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{literal(k)}: {literal(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(literal, value))}]"
    return repr(value.item() if hasattr(value, "item") else value)
