"""Turning tools of the catalogue, a holder with each insert that fits it, and the data of turning. The tools stand apart from the cutters
that milling chooses from."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from trunnion.model.material import TurningTable
from trunnion.model.tool import Insert, TurningTool
from trunnion.shop.reading import CatalogueEntry, by_name, entries

INSERT, TOOL, DATA = "insert", "tool", "data"
KINDS = (INSERT, TOOL, DATA)
_FASTEST = 5000.0
"""m/min: no insert cuts faster."""
_LARGEST = 1000.0
"""mm: no length of a turning tool is larger."""
_HALF_TURN = 180.0


def load_turning(user_folder: Path | None) -> tuple[TurningTool, ...]:
    """Return the turning tools by name, `HOLDER INSERT`; their numbers are 0.

    A file holds `[insert.NAME]`, `[tool.NAME]` and `[data.NAME]` tables; a user's replaces the program's of the same name. Raises
    `BadInput` with file, entry and field of the first fault.
    """
    known = _known(user_folder)
    inserts = {
        name.split(" ", 1)[1]: _insert(entry, name.split(" ", 1)[1])
        for name, entry in known.items()
        if name.startswith("insert ")
    }
    tools = [
        tool
        for name, entry in known.items()
        if name.startswith("tool ")
        for tool in _tools(entry, name.split(" ", 1)[1], inserts)
    ]
    return tuple(sorted(tools, key=lambda t: t.name))


def load_turning_data(user_folder: Path | None) -> dict[str, TurningTable]:
    """Return the tables `[data.NAME]` by their names, ISO 513 groups or materials."""
    return {
        name.split(" ", 1)[1]: _data(entry, name.split(" ", 1)[1])
        for name, entry in _known(user_folder).items()
        if name.startswith(f"{DATA} ")
    }


def _known(user_folder: Path | None) -> dict[str, CatalogueEntry]:
    """Return the inner tables of all files by kind and name."""
    found: list[tuple[int, CatalogueEntry]] = []
    for layer, group in entries("turning", user_folder):
        if group.name not in KINDS:
            raise group.wrong("tables are named [insert.NAME] or [tool.NAME]")
        for name in group.fields:
            inner = group.table(name)
            full = f"{group.name} {name}"
            found.append((layer, CatalogueEntry(file=inner.file, name=full, fields=inner.fields)))
    return by_name(found)


def _data(entry: CatalogueEntry, name: str) -> TurningTable:
    made = TurningTable(
        name=name,
        title=entry.text("title"),
        source=entry.text("source"),
        **{key: entry.number(key, 0.0, _FASTEST) for key in ("speed_rough", "speed_finish")},
        **{
            key: entry.number(key, 0.0, _LARGEST)
            for key in ("feed_rough", "feed_finish", "depth_rough", "depth_finish")
        },
    )
    entry.done()
    return made


def _insert(entry: CatalogueEntry, name: str) -> Insert:
    try:
        made = Insert(
            designation=name,
            inscribed_circle=entry.number("inscribed_circle", 0.0, _LARGEST),
            thickness=entry.number("thickness", 0.0, _LARGEST),
            nose_radius=entry.number("nose_radius", 0.0, _LARGEST),
            grade=entry.text("grade", ""),
        )
    except ValueError as reason:
        raise entry.wrong(str(reason)) from None
    entry.done()
    return made


def _tools(entry: CatalogueEntry, name: str, inserts: Mapping[str, Insert]) -> list[TurningTool]:
    lengths = {
        key: entry.number(key, 0.0, _LARGEST)
        for key in ("shank_height", "shank_width", "functional_length", "functional_width")
    }
    angle, hand = entry.number("edge_angle", 0.0, _HALF_TURN), entry.text("hand")
    inside, head = entry.flag("inside", False), entry.number("head_length", 0.0, _LARGEST, 0.0)
    title, names = entry.text("title"), entry.texts("inserts", known=tuple(inserts))
    entry.done()
    try:
        return [
            TurningTool(
                number=0,
                name=f"{name} {own}",
                insert=inserts[own],
                edge_angle=angle,
                hand=hand,
                holder_name=name,
                description=title,
                inside=inside,
                head_length=head,
                **lengths,
            )
            for own in names
        ]
    except ValueError as reason:
        raise entry.wrong(str(reason)) from None
