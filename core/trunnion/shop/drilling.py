"""Speeds and feeds of drills, by group of materials or by material: every number stands with its source."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from trunnion.model.material import DrillingTable
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


def _table(entry: CatalogueEntry) -> DrillingTable:
    title, speed = entry.text("title"), entry.table("speed")
    value, speed_source = speed.number("value", 0.1, _FASTEST), speed.text("source")
    speed.done()
    feeds = entry.table("feeds")
    rows = tuple((d, low, high) for d, low, high in feeds.rows("rows", 3, 0.0, _LARGEST))
    in_order = all(a[0] < b[0] for a, b in pairwise(rows))
    if not in_order or not all(0.0 < low <= high <= _LARGEST_FEED for _, low, high in rows):
        raise feeds.wrong("rows must be (diameter, smallest f, largest f) with growing diameters")
    share, feed_source = feeds.number("share", 0.0, 1.0), feeds.text("source")
    feeds.done()
    entry.done()
    return DrillingTable(
        name=entry.name,
        title=title,
        speed=value,
        feeds=rows,
        feed_share=share,
        source=f"speed: {speed_source}; feeds: {feed_source}",
    )
