"""What the worker does with the shop: rows of the catalogues with outlines, tool cribs, libraries read and written. No Qt."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

from trunnion.findings import Finding
from trunnion.model.tool import Tool, TurningTool
from trunnion.progress import Progress
from trunnion.shop.crib import Crib
from trunnion.shop.cutters import Cutter
from trunnion_gui.worker.requests import SendEvent, writes_files

ARC_STEPS = 12
"""Chords that an arc of a cutter's outline is drawn with."""
Fields = tuple[tuple[str, str], ...]
"""Names and values of an entry of the catalogue, as words."""


@dataclass(frozen=True, slots=True)
class OutlinePart:
    """A part of a tool that is drawn in one colour: `kind` is cutter, shank or holder, `points` its outline (radius, height over the tip)
    from below, mm."""

    kind: str
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class ToolRow:
    """A tool of the catalogue: what its line in the table has, all of its fields, and its outline; mm.

    Turning tools have no diameter, flutes and stickout (0), and no outline; their corner radius is that of the nose.
    """

    name: str
    title: str
    form: str
    diameter: float
    corner_radius: float
    flute_length: float
    stickout: float
    gauge_length: float
    suits: tuple[str, ...]
    use: tuple[str, ...]
    holder: str
    fields: Fields
    outline: tuple[OutlinePart, ...] = ()

    @property
    def searched(self) -> str:
        """The words that a search looks through, in small letters."""
        return " ".join((self.name, self.title, self.form, self.holder, *self.use)).lower()


@dataclass(frozen=True, slots=True)
class CatalogueRow:
    """A machine or a material: its name, title, a word that tells its kind, and all of its fields."""

    name: str
    title: str
    kind: str
    fields: Fields


@dataclass(frozen=True, slots=True)
class FormatRow:
    """A format of tool libraries: what a person calls it, and the ends of its files' names."""

    title: str
    suffixes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ShopView:
    """The catalogues as the window shows them, and the cribs by machine."""

    tools: tuple[ToolRow, ...]
    machines: tuple[CatalogueRow, ...]
    materials: tuple[CatalogueRow, ...]
    formats: tuple[FormatRow, ...]
    cribs: Mapping[str, Crib]


@dataclass(frozen=True, slots=True)
class LibraryExchange:
    """A tool library that was read, taken over or written: file, format, names of the tools, and findings on what was lost."""

    path: str
    format: str
    names: tuple[str, ...]
    findings: tuple[Finding, ...]


def view(engine: Any, _progress: Progress, _send_event: SendEvent) -> ShopView:
    """Return the catalogues and cribs as they are now."""
    from trunnion import registry

    shop = engine.shop
    formats = (
        registry.get(registry.TOOL_FORMATS, n) for n in registry.names(registry.TOOL_FORMATS)
    )
    return ShopView(
        tools=(*map(_cutter_row, shop.cutters), *map(_turning_row, shop.turning)),
        machines=tuple(
            CatalogueRow(m.name, m.title, m.control, _fields(m)) for m in shop.machines.values()
        ),
        materials=tuple(
            CatalogueRow(m.name, m.title, m.iso_group, _fields(m)) for m in shop.materials.values()
        ),
        formats=tuple(FormatRow(f.title, f.suffixes) for f in formats),
        cribs=shop.cribs,
    )


@writes_files
def put(
    engine: Any,
    progress: Progress,
    send_event: SendEvent,
    machine: str,
    name: str,
    number: int,
    pocket: int,
) -> Mapping[str, Crib]:
    """Put a tool into a machine (number 0: the lowest free one) and return the cribs."""
    from trunnion.store.tool_crib import put_tool

    put_tool(engine.folder, engine.shop, machine, name, number=number, pocket=pocket)
    return _cribs(engine)


@writes_files
def take(
    engine: Any, progress: Progress, send_event: SendEvent, machine: str, name: str
) -> Mapping[str, Crib]:
    """Take a tool out of a machine and return the cribs."""
    from trunnion.store.tool_crib import take_tool

    take_tool(engine.folder, machine, name)
    return _cribs(engine)


@writes_files
def wear(
    engine: Any,
    progress: Progress,
    send_event: SendEvent,
    machine: str,
    name: str,
    length: float,
    radius: float,
) -> Mapping[str, Crib]:
    """Keep the wear in mm of a tool in a machine and return the cribs."""
    from trunnion.store.tool_crib import set_wear

    set_wear(engine.folder, machine, name, length, radius)
    return _cribs(engine)


def read_library(
    engine: Any, _progress: Progress, _send_event: SendEvent, path: str, unit: str
) -> LibraryExchange:
    """Return what taking a tool library over would bring and lose; nothing is written."""
    return _imported(engine, path, unit, None)


@writes_files
def take_library(
    engine: Any, _progress: Progress, _send_event: SendEvent, path: str, unit: str
) -> LibraryExchange:
    """Take a tool library over into the user's folder and read the catalogues again."""
    taken = _imported(engine, path, unit, engine.folder)
    engine.reload_shop()
    return taken


@writes_files
def write_library(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    names: Sequence[str],
    path: str,
    machine: str,
) -> LibraryExchange:
    """Write tools of the catalogue as a library of another program, those in a machine with their T numbers there."""
    from trunnion.shop.exchange import findings_of
    from trunnion.store.tool_library import exchange_context, export_tools

    crib, wanted = engine.shop.crib(machine), frozenset(names)
    cutters = [_numbered(c, crib) for c in engine.shop.cutters if c.tool.name in wanted]
    written = export_tools(cutters, Path(path), exchange_context(engine.folder))
    found = tuple(c.tool.name for c in cutters)
    return LibraryExchange(path, written.format, found, findings_of(written.losses))


def _numbered(cutter: Cutter, crib: Crib) -> Cutter:
    loaded = crib.tool(cutter.tool.name)
    return replace(cutter, tool=replace(cutter.tool, number=loaded.number)) if loaded else cutter


def _cribs(engine: Any) -> Mapping[str, Crib]:
    engine.reload_shop()
    return dict(engine.shop.cribs)


def _imported(engine: Any, path: str, unit: str, folder: Path | None) -> LibraryExchange:
    from trunnion.shop.exchange import findings_of
    from trunnion.store.tool_library import exchange_context, import_tools

    found = import_tools(Path(path), exchange_context(engine.folder, unit=unit), output=folder)
    names = tuple(c.tool.name for c in found.cutters)
    return LibraryExchange(path, found.format, names, findings_of(found.losses))


def _cutter_row(cutter: Cutter) -> ToolRow:
    from trunnion.shop.exchange.fields import fields_of

    tool = cutter.tool
    hidden = ("number", "name", "title", "holder_rows")
    return ToolRow(
        name=tool.name,
        title=tool.description,
        form=tool.form,
        diameter=tool.diameter,
        corner_radius=tool.corner_radius,
        flute_length=tool.flute_length,
        stickout=tool.stickout,
        gauge_length=tool.gauge_length,
        suits=cutter.suits,
        use=cutter.use,
        holder=tool.holder.name,
        fields=tuple((n, _words(v)) for n, v in fields_of(cutter).items() if n not in hidden),
        outline=outline(tool),
    )


def _turning_row(tool: TurningTool) -> ToolRow:
    return ToolRow(
        name=tool.name,
        title=tool.description,
        form=tool.form,
        diameter=0.0,
        corner_radius=tool.insert.nose_radius,
        flute_length=0.0,
        stickout=0.0,
        gauge_length=tool.gauge_length,
        suits=(),
        use=("turn",),
        holder=tool.holder_name,
        fields=_fields(tool),
    )


def outline(tool: Tool) -> tuple[OutlinePart, ...]:
    """Return the parts of a tool from its tip upwards, as the proof sees them."""
    from trunnion.verify.cutter import outline_of

    points = [(0.0, 0.0)]
    for r0, z0, r1, z1, rc, zc, radius in outline_of(tool):
        points.append((r0, z0))
        if radius:
            points += _arc((r0, z0), (r1, z1), (rc, zc))
        points.append((r1, z1))
    parts = [OutlinePart("cutter", tuple(points))]
    for z0, r0, z1, r1 in tool.profile():
        parts.append(OutlinePart("shank" if z0 < tool.stickout else "holder", ((r0, z0), (r1, z1))))
    return tuple(parts)


def _arc(
    begin: tuple[float, float], end: tuple[float, float], centre: tuple[float, float]
) -> list[tuple[float, float]]:
    """Return points between both ends of an arc of less than half a turn."""
    rc, zc = centre
    radius = math.hypot(begin[0] - rc, begin[1] - zc)
    first = math.atan2(begin[1] - zc, begin[0] - rc)
    turn = math.remainder(math.atan2(end[1] - zc, end[0] - rc) - first, 2.0 * math.pi)
    angles = (first + turn * k / ARC_STEPS for k in range(1, ARC_STEPS))
    return [(rc + radius * math.cos(a), zc + radius * math.sin(a)) for a in angles]


def _fields(entry: Any, under: str = "") -> Fields:
    """Return the fields of an entry of the catalogue as words; those of what stands in it under its name."""
    found: list[tuple[str, str]] = []
    for field in fields(entry):
        value = getattr(entry, field.name)
        name = f"{under} {field.name}".strip()
        if field.name in ("name", "title", "number", "description") and not under:
            continue
        if is_dataclass(value):
            found += _fields(value, name)
        elif isinstance(value, tuple) and value and is_dataclass(value[0]):
            for inner in value:
                found += _fields(inner, f"{name} {getattr(inner, 'name', '')}".strip())
        elif value != field.default and value is not None:
            found.append((name, _words(value)))
    return tuple((n, w) for n, w in found if not n.endswith(" name"))


def _words(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple):
        inner = "; " if value and isinstance(value[0], tuple) else ", "
        return inner.join(_words(v) for v in value)
    return str(value)
