"""Pieces that the features and the process-tree XML share: scalars as attributes, frames, findings, typed values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from enum import Enum
from typing import Any

import numpy as np
from lxml import etree

from trunnion.findings import Finding
from trunnion.geometry.frame import Frame
from trunnion.settings import unwritten
from trunnion.store.mapping import hints_of

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_SCALARS = (bool, int, float, str)


def _is_scalar(kind: Any) -> bool:
    return kind in _SCALARS or (isinstance(kind, type) and issubclass(kind, Enum))


_TYPES = {bool: "truth", int: "integer", float: "number", str: "text", tuple: "list"}


def text_of(value: Any) -> str:
    """Return a scalar as XML text; floats so that they come back to the last digit."""
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(float(value)).replace("inf", "INF").replace("nan", "NaN")
    return str(value)


def attributes(data: Any) -> dict[str, str]:
    """Return the scalar fields of a dataclass as XML attributes, without those that files leave out."""
    hints, omitted = hints_of(type(data)), unwritten(data)
    return {
        name.replace("_", "-"): xml_text(text_of(hint(getattr(data, name))))
        for name, hint in hints.items()
        if _is_scalar(hint) and name not in omitted
    }


def add(parent: Any, tag: str, text: str = "", /, **words: str) -> Any:
    """Add a child with attributes (`_` becomes `-`) and a text; return it."""
    child = etree.SubElement(
        parent, tag, {name.replace("_", "-"): xml_text(word) for name, word in words.items()}
    )
    if text:
        child.text = xml_text(text)
    return child


def xml_text(text: str) -> str:
    """Return a text with the replacement character where XML can't hold one, such as a byte of a file name that is no UTF-8."""
    return _NOT_IN_XML.sub("\ufffd", text)


def add_frame(parent: Any, frame: Frame) -> None:
    """Add a frame as three points or directions."""
    element = add(parent, "frame")
    for name, vector in (("origin", frame.origin), ("x", frame.x), ("z", frame.z)):
        add(
            element,
            name,
            x=text_of(float(vector[0])),
            y=text_of(float(vector[1])),
            z=text_of(float(vector[2])),
        )


def add_findings(parent: Any, findings: Iterable[Finding]) -> None:
    """Add findings."""
    for finding in findings:
        element = add(parent, "finding", severity=finding.severity.value, code=finding.code)
        add(element, "text", finding.text)
        for where in finding.where:
            add(element, "where", where)
        if finding.remedy:
            add(element, "remedy", finding.remedy)


def add_values(parent: Any, tag: str, key: str, values: Mapping[str, Any]) -> None:
    """Add a mapping, an element a value: `<size name="depth" type="number">20.0</size>`."""
    for name, value in values.items():
        plain = (
            value.item()
            if isinstance(value, np.generic)
            else tuple(value)
            if isinstance(value, list)
            else value
        )
        text = (
            " ".join(text_of(float(v)) for v in plain)
            if isinstance(plain, tuple)
            else text_of(plain)
        )
        add(parent, tag, text, **{key: name, "type": _TYPES[type(plain)]})
