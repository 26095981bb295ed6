"""Screw threads of the catalogue: metric ones by size and pitch, unified inch ones by their series."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.model.screw_thread import ScrewThread
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.shop.reading import CatalogueEntry, by_name, entries
from trunnion.units import MM_PER_INCH, trimmed

MM_PER_MICROMETRE = 1e-3
_LARGEST_DIAMETER, _LARGEST_PITCH = 300.0, 8.0
"""mm: no thread of ISO 261 is larger."""
_LARGEST_INCH, _MOST_PER_INCH = 6.0, 100.0
_LARGEST_TOLERANCE = 2000.0
"""um: no tolerance of a minor diameter is larger."""
_SAME = 1e-6
"""mm: diameters and pitches that differ by less are one."""
_DECIMALS = 3
"""Limits of minor diameters are rounded to 0.001 mm, as ISO 965-2 tables them."""
METRIC_CLASS, INCH_CLASS = "6H", "2B"
"""The classes whose limits the tables have."""

_SIZE = r"(\d+(?:\.\d+)?)"
_METRIC = re.compile(rf"M\s*{_SIZE}(?:\s*[x*]\s*{_SIZE})?(?:\s*-\s*(\w+))?", re.IGNORECASE)
_INCH = re.compile(
    r"(?:#|No\.?)?\s*(\d+(?:/\d+)?)\s*\"?\s*-\s*(\d+)\s*-?\s*([A-Z]+)(?:\s*-\s*(\w+))?",
    re.IGNORECASE,
)
_ANTICLOCKWISE = re.compile(r"(?:\b|(?<=\d))LH\b|left", re.IGNORECASE)


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadTables:
    """Metric threads as (diameter, pitch, whether a size without a pitch means it), the tolerance TD1 in mm by pitch, and inch threads by
    their names."""

    metric: tuple[tuple[float, float, bool], ...] = ()
    tolerances: tuple[tuple[float, float], ...] = ()
    inch: Mapping[str, ScrewThread] = field(default_factory=dict)

    def thread(self, text: str) -> ScrewThread:
        """Return the thread that a text names: "M6", "M6x0.75", "M6x1-6H", "1/4-20 UNC", "#10-32 UNF-2B".

        Raises `BadInput` for left-hand threads, other classes, unknown sizes, and what is no thread, with what is known.
        """
        plain = " ".join(text.replace("\u00d7", "x").split())
        if _ANTICLOCKWISE.search(plain):
            raise BadInput(
                f"thread {text!r}: left-hand threads are not programmed, taps and their cycles turn right; make it by hand"
            )
        metric, inch = _METRIC.fullmatch(plain), _INCH.fullmatch(plain)
        if metric is not None:
            _known_class(text, metric[3], METRIC_CLASS)
            return self._metric(text, float(metric[1]), metric[2])
        if inch is not None:
            _known_class(text, inch[4], INCH_CLASS)
            return self._inch(text, inch[1], inch[2], inch[3].upper())
        raise BadInput(
            f"thread {text!r}: known are metric threads such as M6 or M6x0.75, and inch ones such as 1/4-20 UNC or #10-32 UNF"
        )

    def _metric(self, text: str, diameter: float, pitch: str | None) -> ScrewThread:
        sizes = [(p, first) for d, p, first in self.metric if abs(d - diameter) <= _SAME]
        if not sizes:
            known = ", ".join(f"M{trimmed(d, 3)}" for d in sorted({row[0] for row in self.metric}))
            raise BadInput(f"thread {text!r}: known sizes are {known}")
        found = [
            (p, first)
            for p, first in sizes
            if (first if pitch is None else abs(p - float(pitch)) <= _SAME)
        ]
        if not found:
            known = ", ".join(trimmed(p, 3) for p, _ in sizes)
            raise BadInput(
                f"thread {text!r}: M{trimmed(diameter, 3)} is known with pitches of {known} mm"
            )
        exact, first = found[0]
        tolerance = next((t for p, t in self.tolerances if abs(p - exact) <= _SAME), None)
        if tolerance is None:
            raise BadInput(
                f"thread {text!r}: the tolerance of its minor diameter is not known; add pitch {trimmed(exact, 3)} to the threads folder"
            )
        name = f"M{trimmed(diameter, 3)}"
        minor = round(basic_minor_diameter(diameter, exact), _DECIMALS)
        return ScrewThread(
            name=name if first else f"{name}x{trimmed(exact, 3)}",
            diameter=diameter,
            pitch=exact,
            core_low=minor,
            core_high=round(minor + tolerance, _DECIMALS),
        )

    def _inch(self, text: str, size: str, per_inch: str, series: str) -> ScrewThread:
        for written in (size, f"#{size}"):
            thread = self.inch.get(f"{written}-{per_inch} {series}")
            if thread is not None:
                return thread
        known = [name for name in self.inch if name.endswith(f" {series}")] or list(self.inch)
        raise BadInput(f"thread {text!r}: known are {', '.join(known) or 'no inch threads'}")


def load_threads(user_folder: Path | None) -> ThreadTables:
    """Return the tables of threads; a user's table replaces the program's of the same name as a whole."""
    metric: list[tuple[float, float, bool]] = []
    tolerances: list[tuple[float, float]] = []
    inch: dict[str, ScrewThread] = {}
    for entry in by_name(entries("threads", user_folder)).values():
        kind = entry.text("kind")
        entry.text("title")
        entry.text("source")
        if kind == "metric":
            metric += _sizes(entry)
        elif kind == "tolerance":
            tolerances += _tolerances(entry)
        elif kind == "inch":
            inch.update({thread.name: thread for thread in _inch_threads(entry)})
        else:
            raise entry.wrong(f"kind knows metric, tolerance, inch; got {kind!r}")
        entry.done()
    return ThreadTables(metric=tuple(metric), tolerances=tuple(tolerances), inch=inch)


def _known_class(text: str, given: str | None, known: str) -> None:
    if given is not None and given != known:
        raise BadInput(
            f"thread {text!r}: the limits of class {given} are not known, those of {known} are: write {known} or no class"
        )


def _sizes(entry: CatalogueEntry) -> list[tuple[float, float, bool]]:
    first = entry.flag("first")
    rows = entry.rows("sizes", 2, 0.0, _LARGEST_DIAMETER)
    for diameter, pitch in rows:
        if not 0.0 < pitch <= _LARGEST_PITCH or basic_minor_diameter(diameter, pitch) <= 0.0:
            raise entry.wrong(f"sizes are (diameter, pitch) in mm; got {[diameter, pitch]}")
    return [(diameter, pitch, first) for diameter, pitch in rows]


def _tolerances(entry: CatalogueEntry) -> list[tuple[float, float]]:
    rows = entry.rows("rows", 2, 0.0, _LARGEST_TOLERANCE)
    if any(a[0] >= b[0] for a, b in pairwise(rows)) or rows[-1][0] > _LARGEST_PITCH:
        raise entry.wrong("rows are (pitch in mm, tolerance in um), with growing pitches")
    return [(pitch, value * MM_PER_MICROMETRE) for pitch, value in rows]


def _inch_threads(entry: CatalogueEntry) -> list[ScrewThread]:
    if not (entry.name.isascii() and entry.name.isalpha() and entry.name.isupper()):
        raise entry.wrong("a table of inch threads is named by its series, such as UNEF")
    found = []
    for size in entry.tables("sizes"):
        per_inch = size.count("threads_per_inch", 1, int(_MOST_PER_INCH))
        diameter = size.number("diameter", 0.0, _LARGEST_INCH)
        minor = size.numbers("minor", 0.0, _LARGEST_INCH)
        if len(minor) != 2 or not 0.0 < minor[0] < minor[1] < diameter:
            raise size.wrong("minor is the lower and the upper limit of the minor diameter, inches")
        found.append(
            ScrewThread(
                name=f"{size.text('size')}-{per_inch} {entry.name}",
                diameter=round(diameter * MM_PER_INCH, _DECIMALS + 1),
                pitch=MM_PER_INCH / per_inch,
                core_low=round(minor[0] * MM_PER_INCH, _DECIMALS),
                core_high=round(minor[1] * MM_PER_INCH, _DECIMALS),
            )
        )
        size.done()
    return found
