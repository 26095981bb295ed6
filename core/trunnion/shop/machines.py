"""Machines of the catalogue: axes with their travel, spindle with its power curve."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from trunnion.model.material import Axis, Machine
from trunnion.shop.reading import Entry, by_name, entries

AXIS_KINDS = ("linear", "rotary")
_FAR = 100_000.0
_FASTEST = 500_000.0
_STRONGEST = 1_000.0


def load_machines(user_folder: Path | None) -> dict[str, Machine]:
    """Return the machines by name; a user's replaces the program's of the same name as a whole."""
    return {name: _machine(entry) for name, entry in by_name(entries("machines", user_folder)).items()}


def _machine(entry: Entry) -> Machine:
    spindle = entry.table("spindle")
    low, high = spindle.number("low", 0.0, _FASTEST), spindle.number("high", 1.0, _FASTEST)
    power = tuple((n, kw) for n, kw in spindle.rows("power", 2, 0.0, _FASTEST))
    if low >= high or any(a[0] >= b[0] for a, b in pairwise(power)) or not all(n > 0.0 and 0.0 < kw <= _STRONGEST for n, kw in power):
        raise spindle.wrong("low must be below high, and the power curve rows [1/min, kW] must grow in speed")
    spindle.done()
    axes = tuple(_axis(table) for table in entry.tables("axes"))
    missing = {"X", "Y", "Z"} - {a.name for a in axes}
    if missing or len({a.name for a in axes}) < len(axes):
        raise entry.wrong("axes must name X, Y and Z, each once")
    machine = Machine(name=entry.name, title=entry.text("title"), axes=axes, spindle_low=low, spindle_high=high, power=power,
                      feed_max=entry.number("feed_max", 1.0, _FASTEST), tool_change_s=entry.number("tool_change_s", 0.0, _FASTEST),
                      tool_places=entry.count("tool_places", 1, 10_000))
    entry.done()
    return machine


def _axis(entry: Entry) -> Axis:
    axis = Axis(name=entry.text("name"), kind=entry.text("kind"),
                low=entry.number("low", -_FAR, _FAR), high=entry.number("high", -_FAR, _FAR),
                rapid=entry.number("rapid", 1.0, _FASTEST), acceleration=entry.number("acceleration", 1.0, _FASTEST))
    if axis.kind not in AXIS_KINDS or axis.low >= axis.high:
        raise entry.wrong(f"kind must be one of {', '.join(AXIS_KINDS)} and low must be below high")
    entry.done()
    return axis
