"""One mechanism between frozen dataclasses and XML: it walks fields and type hints, so a new field needs no line here.

A dataclass is an element with a child a field, and the class's name as its type where the hint allows several and it is not the first; a
tuple holds `item` children, a mapping `item` children with a `key`. A scalar says its type only when the hint leaves it open or it differs
from the hint, so every value comes back as the type it was: digests stay equal.
Small arrays stand in the text, large ones and long texts are members of the archive.
"""

from __future__ import annotations

import dataclasses
import io
import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np
from lxml import etree

from trunnion.findings import BadInput
from trunnion.settings import unwritten

SMALL_ARRAY = 16
LONG_TEXT = 2000
_SCALARS: dict[type, str] = {bool: "bool", int: "int", float: "float", str: "str"}
_BY_NAME = {name: kind for kind, name in _SCALARS.items()}
_ARRAY_TYPES = ("<f8", "<i8", "|b1", "<f4", "<i4", "|u1")


@dataclass(slots=True)
class Members:
    """The files of an archive beside the XML, by name."""

    files: dict[str, bytes] = field(default_factory=dict)

    def add(self, folder: str, suffix: str, data: bytes) -> str:
        """Keep some bytes and return their name."""
        name = f"{folder}/{len(self.files) + 1:05d}.{suffix}"
        self.files[name] = data
        return name

    def get(self, name: str, where: str) -> bytes:
        """Return the bytes of a member; raise `BadInput` when it is missing."""
        if name not in self.files:
            raise BadInput(f"{where}: the archive has no member {name}")
        return self.files[name]


def to_xml(value: Any, hint: Any, tag: str, members: Members) -> etree._Element:
    """Return a value of a hinted type as an element."""
    element = etree.Element(tag)
    _write(element, value, hint, members)
    return element


def from_xml(element: etree._Element, hint: Any, members: Members) -> Any:
    """Return the value that an element says; raise `BadInput` with its line when it doesn't fit the type."""
    try:
        return _read(element, hint, members)
    except (ValueError, KeyError) as reason:
        raise BadInput(
            f"line {element.sourceline}: <{element.tag}> can't be read: {reason}"
        ) from None


def hints_of(cls: Any) -> dict[str, Any]:
    """Return the type hints of a dataclass's fields, resolved; a field that is not given at construction follows from the others."""
    return _hints(cls)


@cache
def _hints(cls: Any) -> dict[str, Any]:
    hints = get_type_hints(cls)
    return {f.name: hints[f.name] for f in dataclasses.fields(cls) if f.init}


def _choices(hint: Any) -> tuple[Any, ...]:
    """Return the types that a hint allows, a union opened."""
    return get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)


def _is_data(hint: Any) -> bool:
    return isinstance(hint, type) and dataclasses.is_dataclass(hint)


def _kind(hint: Any) -> Any:
    """Return what a hint is made with: tuple, Mapping, np.ndarray, or the class itself."""
    origin = get_origin(hint)
    if origin in (tuple, np.ndarray):
        return origin
    return Mapping if origin is not None and issubclass(origin, Mapping) else hint


# ------------------------------------------------------------------------------------------------------------------ writing


def _write(element: etree._Element, value: Any, hint: Any, members: Members) -> None:
    choices = _choices(hint)
    if value is None and type(None) in choices:
        element.set("type", "none")
        return
    if isinstance(value, np.generic):
        value = value.item()
    picked = _pick(value, choices)
    if isinstance(value, Enum):
        element.text = str(value.value)
    elif type(value) in _SCALARS:
        _write_scalar(element, value, picked if len(choices) == 1 else None, members)
    elif isinstance(value, np.ndarray):
        _write_array(element, value, members)
    elif dataclasses.is_dataclass(value):
        if picked is not _first_data(choices):
            element.set("type", picked.__name__)
        omitted = unwritten(value)
        for name, own in hints_of(picked).items():
            if name in omitted:
                continue
            _write(
                etree.SubElement(element, name.replace("_", "-")),
                getattr(value, name),
                own,
                members,
            )
    else:
        if len(choices) > 1:
            element.set("type", "tuple" if isinstance(value, (tuple, list)) else "mapping")
        for key, item, own in _items(value, picked):
            child = etree.SubElement(element, "item")
            if key is not None:
                child.set("key", key)
            _write(child, item, own, members)


def _pick(value: Any, choices: tuple[Any, ...]) -> Any:
    """Return the hint among the choices that a value fits; raise `TypeError` when none does (the program's own fault)."""
    for choice in choices:
        kind = _kind(choice)
        if kind is tuple and isinstance(value, (tuple, list)):
            return choice
        if (
            isinstance(kind, type)
            and isinstance(value, kind)
            and not (kind is int and isinstance(value, bool))
        ):
            return choice
    if float in choices and type(value) in (int, bool):
        return float
    raise TypeError(
        f"a {type(value).__name__} stands where {' or '.join(str(c) for c in choices)} belongs"
    )


def _first_data(choices: tuple[Any, ...]) -> Any:
    """Return the dataclass that an element is of where it doesn't say, or None: the first one allowed."""
    return next((c for c in choices if _is_data(c)), None)


def _items(value: Any, hint: Any) -> Iterator[tuple[str | None, Any, Any]]:
    args = get_args(hint)
    if isinstance(value, Mapping):
        yield from ((key, item, args[1]) for key, item in value.items())
    elif Ellipsis in args:
        yield from ((None, item, args[0]) for item in value)
    else:
        yield from ((None, item, own) for item, own in zip(value, args, strict=True))


def _write_scalar(element: etree._Element, value: Any, hint: Any, members: Members) -> None:
    if type(value) is not hint:
        element.set("type", _SCALARS[type(value)])
    if not isinstance(value, str):
        element.text = repr(value).lower() if isinstance(value, bool) else repr(value)
    elif len(value) > LONG_TEXT:
        element.set("member", members.add("texts", "txt", value.encode("utf-8", "surrogatepass")))
    elif _xml_safe(value):
        element.text = value
    else:
        element.set("escaped", "true")
        element.text = value.encode("unicode_escape").decode("ascii")


def _xml_safe(text: str) -> bool:
    return text == text.strip() and all(
        c >= " " and not "\ud800" <= c <= "\udfff" and c not in "\ufffe\uffff" for c in text
    )


def _write_array(element: etree._Element, value: np.ndarray, members: Members) -> None:
    if value.dtype.str not in _ARRAY_TYPES:
        raise TypeError(f"an array of {value.dtype} can't be kept")
    if value.size <= SMALL_ARRAY:
        element.set("shape", " ".join(str(n) for n in value.shape))
        element.set("dtype", value.dtype.str)
        element.text = " ".join(repr(v) for v in value.ravel().tolist())
        return
    file = io.BytesIO()
    np.lib.format.write_array(file, np.ascontiguousarray(value), version=(1, 0), allow_pickle=False)
    element.set("member", members.add("arrays", "npy", file.getvalue()))


# ------------------------------------------------------------------------------------------------------------------ reading


def _read(element: etree._Element, hint: Any, members: Members) -> Any:
    choices = _choices(hint)
    type_name = element.get("type")
    if type_name == "none" and type(None) in choices:
        return None
    if type_name in _BY_NAME:
        _allow(element, _BY_NAME[type_name], choices)
        return _read_scalar(element, _BY_NAME[type_name], members)
    named = {c.__name__: c for c in choices if _is_data(c)}
    wanted = {"tuple": tuple, "mapping": Mapping, **named}.get(type_name or "")
    picked = next(
        (c for c in choices if c is not type(None) and (wanted is None or _kind(c) is wanted)), None
    )
    kind = _kind(picked)
    if picked is None:
        raise BadInput(
            f"line {element.sourceline}: <{element.tag}> says type {type_name}, which doesn't belong there"
        )
    if kind in _SCALARS:
        return _read_scalar(element, kind, members)
    if kind is np.ndarray:
        return _read_array(element, members)
    if kind is Mapping:
        return _read_mapping(element, get_args(picked)[1], members)
    if kind is tuple:
        return _read_tuple(element, get_args(picked), members)
    if _is_data(kind):
        return _read_data(element, kind, members)
    return _read_enum(element, kind)


def _allow(element: etree._Element, kind: type, choices: tuple[Any, ...]) -> None:
    if kind not in choices and not (float in choices and kind in (int, bool)):
        raise BadInput(
            f"line {element.sourceline}: <{element.tag}> holds a {_SCALARS[kind]}, which doesn't belong there"
        )


def _read_scalar(element: etree._Element, kind: type, members: Members) -> Any:
    text = element.text or ""
    if kind is str:
        if (name := element.get("member")) is not None:
            return members.get(name, f"line {element.sourceline}").decode("utf-8", "surrogatepass")
        return (
            text.encode("ascii").decode("unicode_escape")
            if element.get("escaped") == "true"
            else text
        )
    if kind is bool:
        return {"true": True, "false": False}[text.strip()]
    return kind(text)


def _read_enum(element: etree._Element, kind: Any) -> Any:
    text = element.text or ""
    return kind(int(text)) if issubclass(kind, int) else kind(text)


def _read_array(element: etree._Element, members: Members) -> np.ndarray:
    if (name := element.get("member")) is not None:
        array = load_array(members.get(name, f"line {element.sourceline}"), name)
    else:
        dtype, shape = (
            element.get("dtype", ""),
            tuple(int(n) for n in element.get("shape", "").split()),
        )
        if dtype not in _ARRAY_TYPES:
            raise ValueError(f"an array of {dtype or 'no type'} is not known")
        words = (element.text or "").split()
        values: list[Any] = (
            [w == "True" for w in words]
            if dtype == "|b1"
            else [float(w) if "f" in dtype else int(w) for w in words]
        )
        array = np.array(values, dtype=dtype).reshape(shape)
    array.setflags(write=False)
    return array


def load_array(data: bytes, name: str) -> np.ndarray:
    """Return the array of a `.npy` member; raise `BadInput` when its header lies, or declares anything but plain numbers."""
    file = io.BytesIO(data)
    try:
        if np.lib.format.read_magic(file) != (1, 0):
            raise ValueError("an unknown version")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
    except (ValueError, SyntaxError, EOFError) as reason:
        raise BadInput(f"{name}: not an array that was written here: {reason}") from None
    count = int(np.prod(shape, dtype=object)) if shape else 1
    rest = len(data) - file.tell()
    if fortran or dtype.str not in _ARRAY_TYPES or count * dtype.itemsize != rest:
        raise BadInput(f"{name}: the array's header doesn't fit its {rest} bytes")
    return np.frombuffer(data, dtype=dtype, offset=file.tell()).reshape(shape).copy()


def _read_mapping(element: etree._Element, hint: Any, members: Members) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for child in element:
        key = child.get("key")
        if key is None or key in found:
            raise BadInput(
                f"line {child.sourceline}: an item without a key, or with one that stands twice"
            )
        found[key] = from_xml(child, hint, members)
    return found


def _read_tuple(
    element: etree._Element, args: tuple[Any, ...], members: Members
) -> tuple[Any, ...]:
    if Ellipsis in args:
        return tuple(from_xml(child, args[0], members) for child in element)
    return tuple(from_xml(child, own, members) for child, own in zip(element, args, strict=True))


def _read_data(element: etree._Element, cls: type, members: Members) -> Any:
    hints = hints_of(cls)
    values: dict[str, Any] = {}
    for child in element:
        name = str(child.tag).replace("-", "_")
        if name not in hints or name in values:
            raise BadInput(
                f"line {child.sourceline}: <{child.tag}> is not known in <{element.tag}>, or stands twice"
            )
        values[name] = from_xml(child, hints[name], members)
    try:
        made = cls(**values)
    except (ValueError, TypeError) as reason:
        raise BadInput(
            f"line {element.sourceline}: <{element.tag}> can't be used: {reason}"
        ) from None
    for name, value in values.items():
        if isinstance(
            value, np.ndarray
        ):  # a constructor may make a unit vector again and move its last digit: keep what was saved
            object.__setattr__(made, name, value)
    return made
