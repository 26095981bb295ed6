"""Holders and cutters of the catalogue. A cutter has number 0 until a plan gives it a place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from trunnion.model.tool import Holder, Tool
from trunnion.shop.reading import Entry, by_name, entries
from trunnion.units import trimmed

USES = ("face", "rough", "finish")
ISO_GROUPS = ("P", "M", "K", "N", "S", "H")
_LARGEST = 1000.0
"""mm: no length of a cutter or holder is larger."""
_FEWEST, _MOST_TEETH = 1, 20
_STEEPEST_HELIX = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Cutter:
    """A catalogue cutter with what it is made for: ISO 513 groups and uses (`face`, `rough`, `finish`)."""

    tool: Tool
    suits: tuple[str, ...]
    use: tuple[str, ...]


def load_holders(user_folder: Path | None) -> dict[str, Holder]:
    """Return the holders by name."""
    return {name: _holder(entry) for name, entry in by_name(entries("holders", user_folder)).items()}


def load_cutters(holders: Mapping[str, Holder], user_folder: Path | None) -> tuple[Cutter, ...]:
    """Return the cutters, sorted by diameter, corner radius, reach and name.

    A file of tools holds `[tool.NAME]` tables of one cutter each and `[series.NAME]` tables whose `sizes` give one cutter for each
    diameter and corner radius, named `SERIES D12 R3`. A user's series or tool replaces the program's of the same name.
    """
    found: list[tuple[int, Entry]] = []
    for layer, group in entries("tools", user_folder):
        if group.name not in ("tool", "series"):
            raise group.wrong("tables are named [tool.NAME] or [series.NAME]")
        for name in group.fields:
            inner = group.table(name)
            found.append((layer, Entry(file=inner.file, name=f"{group.name} {name}", fields=inner.fields)))
    cutters: dict[str, Cutter] = {}
    for full, entry in by_name(found).items():
        kind, name = full.split(" ", 1)
        for cutter in [_single(entry, name, holders)] if kind == "tool" else _series(entry, name, holders):
            if cutter.tool.name in cutters:
                raise entry.wrong(f"the cutter {cutter.tool.name} is given twice")
            cutters[cutter.tool.name] = cutter
    return tuple(sorted(cutters.values(), key=lambda c: (c.tool.diameter, c.tool.corner_radius, c.tool.reach, c.tool.name)))


def _holder(entry: Entry) -> Holder:
    entry.text("title")
    rows = entry.rows("rows", 4, 0.0, _LARGEST)
    entry.done()
    if rows[0][0] != 0.0 or any(row[2] <= row[0] for row in rows) or any(a[2] != b[0] for a, b in pairwise(rows)):
        raise entry.wrong("rows must start at the nose (0) and follow each other upwards without a gap")
    return Holder(name=entry.name, rows=tuple((z0, r0, z1, r1) for z0, r0, z1, r1 in rows))


def _single(entry: Entry, name: str, holders: Mapping[str, Holder]) -> Cutter:
    corner = entry.number("corner_radius", 0.0, _LARGEST)
    tool = _tool(entry, entry, name, corner, holders)
    cutter = Cutter(tool=tool, suits=_suits(entry), use=entry.texts("use", USES, USES))
    entry.done()
    return cutter


def _series(entry: Entry, name: str, holders: Mapping[str, Holder]) -> list[Cutter]:
    entry.text("form")
    suits, use = _suits(entry), entry.texts("use", ("rough", "finish"), USES)
    made = []
    for size in entry.tables("sizes"):
        diameter = size.number("diameter", 0.0, _LARGEST)
        for corner in size.numbers("corner_radii", 0.0, _LARGEST):
            full = f"{name} D{trimmed(diameter, 3)} R{trimmed(corner, 3)}"
            made.append(Cutter(tool=_tool(entry, size, full, corner, holders), suits=suits, use=use))
        size.done()
    entry.done()
    return made


def _suits(entry: Entry) -> tuple[str, ...]:
    return entry.texts("suits", ISO_GROUPS, ISO_GROUPS)


def _tool(series: Entry, size: Entry, name: str, corner: float, holders: Mapping[str, Holder]) -> Tool:
    """Return one cutter: what all sizes share from `series`, its lengths from `size`."""
    holder_name = size.text("holder")
    if holder_name not in holders:
        raise size.wrong(f"holder {holder_name!r} is not in the catalogue of holders")
    holder, stickout = holders[holder_name], size.number("stickout", 0.0, _LARGEST)
    diameter = size.number("diameter", 0.0, _LARGEST)
    form = "flat" if corner == 0.0 else "ball" if 2 * corner == diameter else "bull"
    try:
        return Tool(number=0, name=name, form=form, diameter=diameter, corner_radius=corner,
                    flute_length=size.number("flute_length", 0.0, _LARGEST), neck_diameter=size.number("neck_diameter", 0.0, _LARGEST),
                    neck_length=size.number("neck_length", 0.0, _LARGEST), shank_diameter=size.number("shank_diameter", 0.0, _LARGEST),
                    stickout=stickout, gauge_length=stickout + holder.length, teeth=series.count("teeth", _FEWEST, _MOST_TEETH),
                    centre_cutting=series.flag("centre_cutting"), helix_angle=series.number("helix_angle", 0.0, _STEEPEST_HELIX),
                    holder=holder, description=series.text("title"))
    except ValueError as reason:
        raise size.wrong(str(reason)) from None
