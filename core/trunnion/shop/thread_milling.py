"""Speeds, feeds and radial passes of thread mills, by group of materials or by material: every number stands with its source."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from trunnion.model.material import ThreadMillingTable
from trunnion.shop.reading import CatalogueEntry, by_name, entries

_FASTEST = 2000.0
"""m/min: no thread mill cuts faster."""
_LARGEST = 200.0
"""mm: no thread mill and no pitch of the catalogue is larger, and no pass is counted farther."""
_LARGEST_FEED = 2.0
"""mm a tooth: no thread mill is fed faster."""
_MOST_PASSES = 20


def load_thread_milling(user_folder: Path | None) -> dict[str, ThreadMillingTable]:
    """Return the tables by their names, ISO 513 groups or materials; a user's replaces the program's of the same name as a whole."""
    found = by_name(entries("thread_milling", user_folder))
    return {name: _table(entry) for name, entry in found.items()}


def _table(entry: CatalogueEntry) -> ThreadMillingTable:
    title, speed = entry.text("title"), entry.table("speed")
    value, speed_source = speed.number("value", 0.1, _FASTEST), speed.text("source")
    speed.done()
    feeds, passes = entry.table("feeds"), entry.table("passes")
    feed_rows, pass_rows = _rows(feeds), _rows(passes)
    if not all(0.0 < f <= _LARGEST_FEED for _, f in feed_rows):
        raise feeds.wrong("rows must be (diameter, feed a tooth) with growing diameters")
    if not all(n.is_integer() and 1 <= n <= _MOST_PASSES for _, n in pass_rows):
        raise passes.wrong("rows must be (coarsest pitch, whole number of passes)")
    source = (
        f"speed: {speed_source}; feeds: {feeds.text('source')}; passes: {passes.text('source')}"
    )
    feeds.done()
    passes.done()
    entry.done()
    return ThreadMillingTable(
        name=entry.name,
        title=title,
        speed=value,
        feeds=feed_rows,
        pass_rows=tuple((pitch, int(n)) for pitch, n in pass_rows),
        source=source,
    )


def _rows(entry: CatalogueEntry) -> tuple[tuple[float, float], ...]:
    """Return rows of two numbers above 0, the first ones growing."""
    rows = tuple((float(a), float(b)) for a, b in entry.rows("rows", 2, 0.0, _LARGEST))
    if rows[0][0] <= 0.0 or not all(a[0] < b[0] for a, b in pairwise(rows)):
        raise entry.wrong("the first numbers of rows must be above 0 and grow from row to row")
    return rows
