"""XML in and out: no entities, no DTD, no network, limits on size; one line says what is wrong and where."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from lxml import etree

from trunnion.findings import BadInput

LARGEST_XML = 256 * 1024 * 1024
"""Bytes of one XML document that are read."""


def parse(data: bytes, where: str) -> Any:
    """Return the root of a document; raise `BadInput` for entities, a DTD, another encoding than UTF-8, or damage."""
    if len(data) > LARGEST_XML:
        raise BadInput(
            f"{where}: {len(data)} bytes of XML are more than the {LARGEST_XML} that are read"
        )
    if b"\0" in data or data[:2] in (b"\xfe\xff", b"\xff\xfe"):
        raise BadInput(f"{where}: must be UTF-8 text")
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise BadInput(
            f"{where}: holds a document type or entities, which are never read; remove them"
        )
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        remove_comments=True,
        remove_pis=True,
        huge_tree=False,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as reason:
        raise BadInput(f"{where}: damaged XML: {str(reason).splitlines()[0]}") from None
    encoding = root.getroottree().docinfo.encoding
    if encoding is not None and encoding.upper() not in ("UTF-8", "ASCII", "US-ASCII"):
        raise BadInput(f"{where}: must be UTF-8 text, not {encoding}")
    return root


def written(root: Any) -> bytes:
    """Return a document as UTF-8 text, indented, the same bytes for the same tree."""
    etree.indent(root, space="  ")
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


@cache
def _schema(name: str) -> Any:
    source = files("trunnion_resources") / "schemas" / f"{name}.xsd"
    return etree.XMLSchema(etree.fromstring(source.read_bytes()))


def validated(root: Any, schema: str, where: str) -> Any:
    """Return the root when it fits a schema of the resources; raise `BadInput` with the line of the first thing that doesn't."""
    checker = _schema(schema)
    if not checker.validate(root):
        first = checker.error_log[0]
        raise BadInput(f"{where}, line {first.line}: {first.message}")
    return root
