"""Speeds and feeds of drills, reamers, boring bars and taps, by group of materials or by material: every number stands with its source."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from trunnion.model.material import DrillingTable, TappingTable
from trunnion.shop.reading import CatalogueEntry, by_name, entries

_FASTEST = 2000.0
"""m/min: no drill cuts faster."""
_LARGEST = 200.0
"""mm: no drill of the catalogue is larger."""
_LARGEST_FEED = 5.0
"""mm a revolution: no drill is fed faster."""


def load_drilling(user_folder: Path | None) -> dict[str, DrillingTable]:
    """Return the tables by their names, ISO 513 groups or materials; a user's replaces the program's of the same name as a whole."""
    return {
        name: _table(entry) for name, entry in by_name(entries("drilling", user_folder)).items()
    }


def load_reaming(user_folder: Path | None) -> dict[str, DrillingTable]:
    """Return the tables of reamers by their names, as `load_drilling` does those of drills; they have an allowance as well."""
    return _finishing("reaming", user_folder)


def load_boring(user_folder: Path | None) -> dict[str, DrillingTable]:
    """Return the tables of boring bars by their names, as `load_reaming` does those of reamers."""
    return _finishing("boring", user_folder)


def _finishing(folder: str, user_folder: Path | None) -> dict[str, DrillingTable]:
    return {
        name: _table(entry, finishes=True)
        for name, entry in by_name(entries(folder, user_folder)).items()
    }


def load_tapping(user_folder: Path | None) -> dict[str, TappingTable]:
    """Return the tables of taps by their names, as `load_drilling` does those of drills; they have a speed and nothing else."""
    found = {}
    for name, entry in by_name(entries("tapping", user_folder)).items():
        title, (value, source) = entry.text("title"), _speed(entry)
        entry.done()
        found[name] = TappingTable(name=name, title=title, speed=value, source=f"speed: {source}")
    return found


def _speed(entry: CatalogueEntry) -> tuple[float, str]:
    speed = entry.table("speed")
    value, source = speed.number("value", 0.1, _FASTEST), speed.text("source")
    speed.done()
    return value, source


def _table(entry: CatalogueEntry, *, finishes: bool = False) -> DrillingTable:
    title, (value, speed_source) = entry.text("title"), _speed(entry)
    feeds = entry.table("feeds")
    rows = tuple((d, low, high) for d, low, high in feeds.rows("rows", 3, 0.0, _LARGEST))
    in_order = all(a[0] < b[0] for a, b in pairwise(rows))
    if not in_order or not all(0.0 < low <= high <= _LARGEST_FEED for _, low, high in rows):
        raise feeds.wrong("rows must be (diameter, smallest f, largest f) with growing diameters")
    share, feed_source = feeds.number("share", 0.0, 1.0), feeds.text("source")
    feeds.done()
    source = f"speed: {speed_source}; feeds: {feed_source}"
    allowances: tuple[tuple[float, float, float], ...] = ()
    if finishes:
        allowances, allowance_source = _allowances(entry.table("allowance"))
        source += f"; allowance: {allowance_source}"
    entry.done()
    return DrillingTable(
        name=entry.name,
        title=title,
        speed=value,
        feeds=rows,
        feed_share=share,
        source=source,
        allowances=allowances,
    )


def _allowances(entry: CatalogueEntry) -> tuple[tuple[tuple[float, float, float], ...], str]:
    rows = tuple((d, low, high) for d, low, high in entry.rows("rows", 3, 0.0, _LARGEST))
    in_order = all(a[0] < b[0] for a, b in pairwise(rows))
    if not in_order or not all(0.0 < low <= high < d for d, low, high in rows):
        raise entry.wrong("rows must be (diameter up to, least, most), with growing diameters")
    source = entry.text("source")
    entry.done()
    return rows, source
