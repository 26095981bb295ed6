"""Holders and cutters of the catalogue. A cutter has number 0 until a plan gives it a position."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from trunnion.model.tool import BORING_BAR, BUTTON, REAMER, TAP, THREAD_MILL, Holder, Tool
from trunnion.shop.reading import CatalogueEntry, by_name, entries
from trunnion.units import MM_PER_INCH, trimmed

USES = (
    "face",
    "rough",
    "finish",
    "surface",
    "undercut",
    "drill",
    "spot",
    "countersink",
    "ream",
    "bore",
    "tap_through",
    "tap_blind",
    "thread_mill",
    "hole_mill",
    "narrow",
    "interrupted",
)
END_MILL = "end mill"
"""A form that the corner radius decides: flat, bull or ball."""
KINDS = (
    END_MILL,
    "taper",
    "barrel",
    "t-slot",
    "drill",
    REAMER,
    BORING_BAR,
    TAP,
    THREAD_MILL,
    BUTTON,
    "form",
)
WITHOUT_CORNER = ("drill", REAMER, BORING_BAR, TAP, THREAD_MILL, "form")
"""Forms whose entries give no corner radius."""
_USE = {
    "taper": ("surface",),
    "barrel": ("surface",),
    "t-slot": ("undercut",),
    "drill": ("drill",),
    REAMER: ("ream",),
    BORING_BAR: ("bore",),
    THREAD_MILL: ("thread_mill",),
    BUTTON: ("interrupted",),
}
"""What a form is for unless its entry says so; that of a tap says which holes it is for."""
_USE_ALONE = ("face", "rough", "finish")
"""The same of other forms, of a cutter that belongs to no series."""
ISO_GROUPS = ("P", "M", "K", "N", "S", "H")
LARGEST = 1000.0
"""mm: no length of a cutter or holder is larger."""
_FEWEST, _MOST_TEETH = 1, 20
_STEEPEST_HELIX = 60.0
_MOST_LEAD_THREADS, _MOST_PER_INCH = 20.0, 200.0
_HALF_TURN, _QUARTER_TURN = 180.0, 90.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Cutter:
    """A catalogue cutter with what it is made for: ISO 513 groups and uses.

    Uses are `face`, `rough` and `finish` of plane work, `surface` (curved faces), `undercut`, `drill`, `spot`, `countersink`, `ream`,
    `tap_through` and `tap_blind` (taps for holes that are open below, or that end), `thread_mill`, `hole_mill` (end mills for small
    holes), `narrow` (end mills for slots and pockets that no other one gets into) and `interrupted` (turning in the gaps between bosses).
    An end mill for `hole_mill` or `narrow` alone is taken only where no other serves.
    """

    tool: Tool
    suits: tuple[str, ...]
    use: tuple[str, ...]


def load_holders(user_folder: Path | None) -> dict[str, Holder]:
    """Return the holders by name."""
    return {
        name: holder_of(entry) for name, entry in by_name(entries("holders", user_folder)).items()
    }


def load_cutters(holders: Mapping[str, Holder], user_folder: Path | None) -> tuple[Cutter, ...]:
    """Return the cutters, sorted by diameter, corner radius, reach and name.

    A file of tools holds `[tool.NAME]` tables of one cutter each and `[series.NAME]` tables whose `sizes` give one cutter for each
    diameter and corner radius, named `SERIES D12 R3` and what else its form needs: a taper's angle (A3), a barrel's radius (B85), how
    thick a T-slot cutter is (H6); a drill is `SERIES D8.5`, a reamer `SERIES D8`. A tap is named by its thread, `SERIES M6x1`, or
    `SERIES UNC 1/4-20` where its size says `thread = "1/4-20 UNC"`, a thread mill by its diameter and pitch, `SERIES D6x1`, or by its
    range, `SERIES D12 P1-2.5`, a boring bar by its range, `SERIES D20-26`. `form` is one of `KINDS`. A user's series or tool replaces the
    program's of the same name.
    """
    found: list[tuple[int, CatalogueEntry]] = []
    for layer, group in entries("tools", user_folder):
        if group.name not in ("tool", "series"):
            raise group.wrong("tables are named [tool.NAME] or [series.NAME]")
        for name in group.fields:
            inner = group.table(name)
            found.append(
                (
                    layer,
                    CatalogueEntry(
                        file=inner.file, name=f"{group.name} {name}", fields=inner.fields
                    ),
                )
            )
    cutters: dict[str, Cutter] = {}
    for full, entry in by_name(found).items():
        kind, name = full.split(" ", 1)
        for cutter in (
            [cutter_of(entry, name, holders)] if kind == "tool" else _series(entry, name, holders)
        ):
            if cutter.tool.name in cutters:
                raise entry.wrong(f"the cutter {cutter.tool.name} is given twice")
            cutters[cutter.tool.name] = cutter
    return tuple(
        sorted(
            cutters.values(),
            key=lambda c: (c.tool.diameter, c.tool.corner_radius, c.tool.reach, c.tool.name),
        )
    )


def holder_of(entry: CatalogueEntry) -> Holder:
    """Return the holder of a table [NAME]; raise `BadInput` with the first fault."""
    entry.text("title")
    rows = entry.rows("rows", 4, 0.0, LARGEST)
    entry.done()
    if (
        rows[0][0] != 0.0
        or any(row[2] <= row[0] for row in rows)
        or any(a[2] != b[0] for a, b in pairwise(rows))
    ):
        raise entry.wrong(
            "rows must start at the nose (0) and follow each other upwards without a gap"
        )
    return Holder(name=entry.name, rows=tuple((z0, r0, z1, r1) for z0, r0, z1, r1 in rows))


def cutter_of(entry: CatalogueEntry, name: str, holders: Mapping[str, Holder]) -> Cutter:
    """Return the cutter of a table [tool.NAME]; raise `BadInput` with the first fault."""
    kind = _kind(entry, END_MILL)
    corner = 0.0 if kind in WITHOUT_CORNER else entry.number("corner_radius", 0.0, LARGEST)
    tool = _tool(entry, entry, kind, name, corner, holders)
    cutter = Cutter(
        tool=tool,
        suits=_suits(entry),
        use=_use(entry, kind, _USE_ALONE),
    )
    entry.done()
    return cutter


def _series(entry: CatalogueEntry, name: str, holders: Mapping[str, Holder]) -> list[Cutter]:
    kind = _kind(entry)
    suits, use = _suits(entry), _use(entry, kind, ("rough", "finish"))
    made = []
    for size in entry.tables("sizes"):
        diameter = size.number("diameter", 0.0, LARGEST)
        corners = (0.0,) if kind in WITHOUT_CORNER else size.numbers("corner_radii", 0.0, LARGEST)
        for corner in corners:
            tool = _tool(entry, size, kind, f"{name} D{trimmed(diameter, 3)}", corner, holders)
            full = _full_name(name, size, tool)
            made.append(Cutter(tool=replace(tool, name=full), suits=suits, use=use))
        size.done()
    entry.done()
    return made


def _kind(entry: CatalogueEntry, default: str | None = None) -> str:
    kind = entry.text("form", default)
    if kind not in KINDS:
        raise entry.wrong(f"form knows {', '.join(KINDS)}; got {kind!r}")
    return kind


def _size_name(tool: Tool) -> str:
    """Return what distinguishes a size from others of its series and diameter."""
    corner = f" R{trimmed(tool.corner_radius, 3)}"
    return {
        "taper": f"{corner} A{trimmed(tool.taper_angle, 3)}",
        "barrel": f"{corner} B{trimmed(tool.barrel_radius, 3)}",
        "t-slot": f"{corner} H{trimmed(tool.flute_length, 3)}",
        **dict.fromkeys(WITHOUT_CORNER, ""),
        THREAD_MILL: _pitch_name(tool),
    }.get(tool.form, corner)


def _full_name(series: str, size: CatalogueEntry, tool: Tool) -> str:
    """Return the name of a cutter of a series: by its thread, the range that it is set in, or its diameter and what else distinguishes
    it."""
    if tool.form == TAP:
        return f"{series} {_thread_name(size, tool)}"
    if tool.form == BORING_BAR:
        return f"{series} D{trimmed(tool.smallest, 3)}-{trimmed(tool.diameter, 3)}"
    return tool.name + _size_name(tool)


def _pitch_name(tool: Tool) -> str:
    """Return what distinguishes a thread mill from others of its diameter: its pitch, or the range of it."""
    if tool.pitch > 0.0:
        return f"x{trimmed(tool.pitch, 3)}"
    return f" P{trimmed(tool.pitch_low, 3)}-{trimmed(tool.pitch_high, 3)}"


def _thread_name(size: CatalogueEntry, tool: Tool) -> str:
    """Return what a tap's size is called: its series and size in inches where that is given, else diameter and pitch in mm."""
    thread = size.text("thread", "")
    if not thread:
        return f"M{trimmed(tool.diameter, 3)}x{trimmed(tool.pitch, 3)}"
    inches, _, series = thread.rpartition(" ")
    if not inches:
        raise size.wrong(f"thread is a size and its series, such as 1/4-20 UNC; got {thread!r}")
    return f"{series} {inches}"


def usual_use(kind: str) -> tuple[str, ...]:
    """Return what a cutter of a kind is for when its entry doesn't say it; nothing for a tap, whose entry must."""
    return () if kind == TAP else _USE.get(kind, _USE_ALONE)


def _use(entry: CatalogueEntry, kind: str, default: tuple[str, ...]) -> tuple[str, ...]:
    return entry.texts("use", None if kind == TAP else _USE.get(kind, default), USES)


def _suits(entry: CatalogueEntry) -> tuple[str, ...]:
    return entry.texts("suits", ISO_GROUPS, ISO_GROUPS)


def _tool(
    series: CatalogueEntry,
    size: CatalogueEntry,
    kind: str,
    name: str,
    corner: float,
    holders: Mapping[str, Holder],
) -> Tool:
    """Return one cutter: what all sizes share from `series`, its lengths from `size`."""
    holder_name = size.text("holder")
    if holder_name not in holders:
        raise size.wrong(f"holder {holder_name!r} is not in the catalogue of holders")
    holder, stickout = holders[holder_name], size.number("stickout", 0.0, LARGEST)
    diameter = size.number("diameter", 0.0, LARGEST)
    end = "flat" if corner == 0.0 else "ball" if 2 * corner == diameter else "bull"
    try:
        return Tool(
            number=0,
            name=name,
            form=end if kind == END_MILL else kind,
            diameter=diameter,
            corner_radius=corner,
            flute_length=size.number("flute_length", 0.0, LARGEST),
            neck_diameter=size.number("neck_diameter", 0.0, LARGEST),
            neck_length=size.number("neck_length", 0.0, LARGEST),
            shank_diameter=size.number("shank_diameter", 0.0, LARGEST),
            stickout=stickout,
            gauge_length=stickout + holder.length,
            teeth=_given(series, size, "teeth").count("teeth", _FEWEST, _MOST_TEETH),
            centre_cutting=series.flag("centre_cutting"),
            helix_angle=series.number("helix_angle", 0.0, _STEEPEST_HELIX),
            holder=holder,
            description=series.text("title"),
            **_shape(series, size, kind),
        )
    except ValueError as reason:
        raise size.wrong(str(reason)) from None


def _shape(series: CatalogueEntry, size: CatalogueEntry, kind: str) -> dict[str, Any]:
    """Return the fields that only one form has; a size's own go before those of its series."""
    if kind == "taper":
        return {
            "taper_angle": _given(series, size, "taper_angle").number(
                "taper_angle", 0.0, _QUARTER_TURN
            )
        }
    if kind == "barrel":
        return {
            "barrel_radius": _given(series, size, "barrel_radius").number(
                "barrel_radius", 0.0, LARGEST
            )
        }
    if kind == "drill":
        return {
            "point_angle": _given(series, size, "point_angle").number(
                "point_angle", 0.0, _HALF_TURN
            )
        }
    if kind == REAMER:
        return {
            "lead": _given(series, size, "lead").number("lead", 0.0, LARGEST),
            "fit": _given(series, size, "fit").text("fit"),
        }
    if kind == BORING_BAR:
        return {
            "lead": _given(series, size, "lead").number("lead", 0.0, LARGEST),
            "smallest": size.number("smallest", 0.0, LARGEST),
        }
    if kind == TAP:
        return _tap_shape(series, size)
    if kind == THREAD_MILL:
        return _thread_mill_shape(size)
    if kind == "form":
        return {"outline": size.rows("outline", 3, -1.0, LARGEST)}
    return {}


def _tap_shape(series: CatalogueEntry, size: CatalogueEntry) -> dict[str, Any]:
    """Return pitch and lead of a tap: the pitch in mm or as threads per inch, the lead in mm or as so many threads."""
    pitch = _pitch(size, "tap")
    given = _given(series, size, "lead")
    if given.has("lead"):
        return {"pitch": pitch, "lead": given.number("lead", 0.0, LARGEST)}
    threads = _given(series, size, "lead_threads").number("lead_threads", 0.0, _MOST_LEAD_THREADS)
    return {"pitch": pitch, "lead": threads * pitch}


def _thread_mill_shape(size: CatalogueEntry) -> dict[str, Any]:
    """Return the pitch of a thread mill's comb, or the range of pitches that its single tooth cuts."""
    if size.has("pitch_low") or size.has("pitch_high"):
        return {
            "pitch_low": size.number("pitch_low", 0.0, LARGEST),
            "pitch_high": size.number("pitch_high", 0.0, LARGEST),
        }
    return {"pitch": _pitch(size, "thread mill")}


def _pitch(size: CatalogueEntry, kind: str) -> float:
    """Return the pitch of a tool of a kind in mm, which an entry gives in mm or as threads per inch."""
    if size.has("threads_per_inch") == size.has("pitch"):
        raise size.wrong(f"a {kind} gives its pitch, either as pitch in mm or as threads_per_inch")
    if size.has("threads_per_inch"):
        return MM_PER_INCH / size.number("threads_per_inch", 1.0, _MOST_PER_INCH)
    return size.number("pitch", 0.0, LARGEST)


def _given(series: CatalogueEntry, size: CatalogueEntry, field: str) -> CatalogueEntry:
    return size if size.has(field) else series
