"""Words and formats of a dialect as data: read from the resources, checked once, never repaired by guess."""

from __future__ import annotations

import tomllib
import unicodedata
from collections.abc import Container, Sized
from dataclasses import MISSING, fields
from functools import cache
from importlib.resources import files
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from trunnion.findings import BadCall, BadInput, Refused
from trunnion.model.motion.program import STOPPED, ProgramSection
from trunnion.model.spindle import per_minute

T = TypeVar("T")


@cache
def dialect_words(cls: type[T], name: str, package: str = "") -> T:
    """Return the words of a dialect as the dataclass that lists them; raise `BadInput` for a missing, unknown or wrong one.

    They are read from our resources, or from `NAME.toml` in the package that brings the dialect.
    """
    folder = files(package) if package else files("trunnion_resources") / "dialects"
    try:
        table = tomllib.loads((folder / f"{name}.toml").read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as reason:
        raise BadInput(f"dialect {name}: its words can't be read: {reason}") from None
    return checked_words(cls, name, table)


def checked_words(cls: type[T], name: str, table: dict[str, Any]) -> T:
    """Return a table of words as a dataclass whose fields are texts, whole numbers, tuples of texts and mappings of texts.

    Words whose fields have a default may be missing.
    """
    hints = get_type_hints(cls)
    optional = {
        f.name: f.default is not MISSING or f.default_factory is not MISSING
        for f in fields(cls)  # type: ignore[arg-type]
    }
    wanted = list(optional)
    for key in table:
        if key not in wanted:
            raise BadInput(f"dialect {name}: unknown word {key}; known: {', '.join(wanted)}")
    values = {}
    for key in wanted:
        if key not in table and not optional[key]:
            raise BadInput(f"dialect {name}: the word {key} is missing")
        if key in table:
            values[key] = _checked(hints[key], table[key], f"dialect {name}: {key}")
    return cls(**values)


def _checked(kind: Any, value: Any, what: str) -> Any:
    shape = get_origin(kind) or kind
    if (
        shape is tuple
        and isinstance(value, list)
        and value
        and all(isinstance(v, str) for v in value)
    ):
        fixed = [k for k in get_args(kind) if k is not Ellipsis]
        if Ellipsis in get_args(kind) or len(fixed) == len(value):
            return tuple(value)
    is_table = (
        shape is dict
        and isinstance(value, dict)
        and value
        and all(isinstance(v, str) for v in value.values())
    )
    if is_table or (shape in (str, int) and type(value) is shape and value != ""):
        return value
    words = {
        str: "a text",
        int: "a whole number",
        tuple: "a list of texts",
        dict: "a table of texts",
    }[shape]
    raise BadInput(f"{what} must be {words}; got {value!r}")


def check_one_setup(title: str, given: Sized) -> None:
    """Raise `BadCall` unless there is one program, or one setup, of a control whose texts hold one."""
    if len(given) != 1:
        raise BadCall(f"a {title} program holds one setup; got {len(given)}")


def plain(text: str, longest: int) -> str:
    """Return a text that any control takes as a comment: ASCII, one line, without brackets, at most `longest` characters.

    >>> plain("Träger (links)", 40)
    'Trager [links]'
    """
    ascii_text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    swapped = ascii_text.translate(str.maketrans("()", "[]", ";$"))
    line = " ".join("".join(c if c.isprintable() else " " for c in swapped).split())
    return line if len(line) <= longest else line[: longest - 4].rstrip() + " ..."


def refuse_unwritable(section: ProgramSection, title: str, coolant: Container[str]) -> None:
    """Raise `Refused` for an operation that can't be written: an id that no comment holds, coolant or speed, no motion."""
    id = section.operation
    if not id or id != plain(id, len(id)) or " " in id:
        raise Refused(
            f"operation {id}: its id can't stand in a comment; use letters, digits, points and dashes"
        )
    if section.coolant not in coolant:
        raise Refused(f"operation {id}: {title} has no coolant {section.coolant}")
    if section.spindle_stopped != section.tool.locked:
        if section.tool.locked:
            raise Refused(
                f"operation {id}: {section.tool.name} is a turning insert in a locked spindle: that turns at {section.spindle:g} 1/min"
            )
        raise Refused(f"operation {id}: a spindle speed of {section.spindle:g} turns nothing")
    if not len(section.path):
        raise Refused(f"operation {id} has no motion: nothing to write")
    if section.path.work_turns == section.tool.rotates:
        what = "can't turn work" if section.tool.rotates else "cuts only work that turns"
        raise Refused(f"operation {id}: {section.tool.name} {what}; choose another tool")
    if section.surface_speed > 0.0 and not section.path.work_turns:
        raise Refused(
            f"operation {id}: a constant surface speed is of work that turns; give a spindle speed"
        )
    refuse_another_pitch(section)


def refuse_another_pitch(section: ProgramSection) -> None:
    """Raise `Refused` for tapping at another feed than the pitch a revolution, but for what a written spindle speed is rounded by."""
    for block in section.path.cycles:
        pitch, feed = (
            block.cycle.pitch,
            float(section.path.feed[block.first : block.last + 1].max()),
        )
        if pitch > 0.0 and abs(feed - per_minute(pitch, section.spindle)) > pitch * STOPPED:
            raise Refused(
                f"operation {section.operation}: tapping at {feed:g} mm/min is not {pitch:g} mm a revolution at "
                f"{section.spindle:g} 1/min; feed at {per_minute(pitch, section.spindle):g}"
            )
