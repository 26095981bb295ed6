"""Work materials of the catalogue: every number stands with its source."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from trunnion.model.material import Material, TaylorLife
from trunnion.shop.cutters import ISO_GROUPS
from trunnion.shop.reading import CatalogueEntry, by_name, entries

_DENSEST = 25.0
_FASTEST = 5000.0
_LARGEST_FEED = 10.0
_STRONGEST = 10000.0
_LONGEST_LIFE = 10000.0


def load_materials(user_folder: Path | None) -> dict[str, Material]:
    """Return the materials by name; a user's replaces the program's of the same name as a whole."""
    return {
        name: _material(entry) for name, entry in by_name(entries("materials", user_folder)).items()
    }


def _material(entry: CatalogueEntry) -> Material:
    sources: dict[str, str] = {}

    def sourced(name: str) -> CatalogueEntry:
        table = entry.table(name)
        sources[name.replace("_", " ")] = table.text("source")
        return table

    def value(name: str, low: float, high: float) -> float:
        table = sourced(name)
        number = table.number("value", low, high)
        table.done()
        return number

    title, group = entry.text("title"), entry.text("iso_group")
    if group not in ISO_GROUPS:
        raise entry.wrong(f"iso_group must be one of {', '.join(ISO_GROUPS)}; got {group!r}")
    feeds = sourced("feeds")
    rows = tuple((d, low, high) for d, low, high in feeds.rows("rows", 3, 0.0, _STRONGEST))
    in_order = all(a[0] < b[0] for a, b in pairwise(rows))
    if not in_order or not all(0.0 < low <= high <= _LARGEST_FEED for _, low, high in rows):
        raise feeds.wrong("rows must be (diameter, smallest fz, largest fz) with growing diameters")
    share = feeds.number("share", 0.0, 1.0)
    shares = feeds.numbers("range", 0.0, 1.0) if feeds.has("range") else (0.0, share)
    if len(shares) != 2 or not shares[0] <= share <= shares[1]:
        raise feeds.wrong(
            "range must be two shares, the smallest and the largest, with share between them"
        )
    feeds.done()
    force = sourced("force")
    strength, exponent = force.number("value", 1.0, _STRONGEST), force.number("exponent", 0.0, 1.0)
    force.done()
    material = Material(
        name=entry.name,
        title=title,
        iso_group=group,
        density=value("density", 0.1, _DENSEST),
        speed_rough=value("speed_rough", 1.0, _FASTEST),
        speed_finish=value("speed_finish", 1.0, _FASTEST),
        feeds=rows,
        feed_share=share,
        feed_range=(shares[0], shares[1]),
        force=strength,
        force_exponent=exponent,
        depth_factor=value("depth_factor", 0.01, 5.0),
        width_factor=value("width_factor", 0.01, 1.0),
        entry_angle=value("entry_angle", 0.1, 45.0) if entry.has("entry_angle") else 0.0,
        slot_factor=value("slot_factor", 0.01, 5.0) if entry.has("slot_factor") else 0.0,
        layer_width_factor=value("layer_width_factor", 0.01, 1.0)
        if entry.has("layer_width_factor")
        else 0.0,
        engaged_depth_factor=value("engaged_depth_factor", 0.01, 5.0)
        if entry.has("engaged_depth_factor")
        else 0.0,
        engaged_width_factor=value("engaged_width_factor", 0.01, 1.0)
        if entry.has("engaged_width_factor")
        else 0.0,
        shallow_width_factor=value("shallow_width_factor", 0.01, 1.0)
        if entry.has("shallow_width_factor")
        else 0.0,
        speed_range=_speed_range(sourced("speed_range")) if entry.has("speed_range") else None,
        life=_life(sourced("tool_life")) if entry.has("tool_life") else None,
        source="; ".join(f"{name}: {words}" for name, words in sources.items()),
    )
    entry.done()
    return material


def _speed_range(entry: CatalogueEntry) -> tuple[float, float]:
    low, high = entry.number("low", 1.0, _FASTEST), entry.number("high", 1.0, _FASTEST)
    if low > high:
        raise entry.wrong(f"low must not be above high; got {low:g} and {high:g}")
    entry.done()
    return low, high


def _life(entry: CatalogueEntry) -> TaylorLife:
    widths = entry.numbers("widths", 0.01, 1.0) if entry.has("widths") else (0.01, 1.0)
    if len(widths) != 2 or widths[0] > widths[1]:
        raise entry.wrong("widths must be the smallest and the largest ae over D that were tried")
    life = TaylorLife(
        minutes=entry.number("minutes", 0.1, _LONGEST_LIFE),
        speed=entry.number("speed", 1.0, _FASTEST),
        exponent=entry.number("exponent", 0.05, 1.0),
        width=entry.number("width", 0.01, 1.0, 1.0),
        width_exponent=entry.number("width_exponent", 0.0, 5.0, 0.0),
        widths=(widths[0], widths[1]),
    )
    entry.done()
    return life


def feed_at(rows: Sequence[tuple[float, float]], diameter: float) -> float:
    """Return the feed per tooth in mm at a diameter, from rows of diameter and feed: straight between the rows, in proportion below them,
    the last above."""
    if diameter <= rows[0][0]:
        return rows[0][1] * diameter / rows[0][0]
    for (d0, f0), (d1, f1) in pairwise(rows):
        if diameter <= d1:
            return f0 + (f1 - f0) * (diameter - d0) / (d1 - d0)
    return rows[-1][1]
