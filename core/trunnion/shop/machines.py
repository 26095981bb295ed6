"""Machines of the catalogue: axes with their travel and how they turn, spindle with its power curve."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

from trunnion import registry
from trunnion.model.material import CONTROL, Axis, Machine, WorkSpindle
from trunnion.shop.reading import CatalogueEntry, by_name, entries
from trunnion.units import FARTHEST, FASTEST

AXIS_KINDS = ("linear", "rotary")
CARRIES = ("tool", "work")
MOST_ROTARY = 2
ENDLESS = 1e7
"""degrees: the limits of a rotary axis that turns for ever; no program winds it up by so many turns."""
_SHORTEST = 1e-6
_LEAST_BETWEEN = 1e-3
_STRONGEST = 1_000.0


def load_machines(user_folder: Path | None) -> dict[str, Machine]:
    """Return the machines by name; a user's replaces the program's of the same name as a whole."""
    return {
        name: _machine(entry) for name, entry in by_name(entries("machines", user_folder)).items()
    }


def _machine(entry: CatalogueEntry) -> Machine:
    spindle = entry.table("spindle")
    low, high, power = _speeds(spindle)
    spindle.done()
    axes = tuple(_axis(table) for table in entry.tables("axes"))
    missing = {"X", "Y", "Z"} - {a.name for a in axes}
    if missing or len({a.name for a in axes}) < len(axes):
        raise entry.wrong("axes must name X, Y and Z, each once")
    _check_rotary(entry, axes)
    machine = Machine(
        name=entry.name,
        title=entry.text("title"),
        axes=axes,
        spindle_low=low,
        spindle_high=high,
        power=power,
        feed_max=entry.number("feed_max", 1.0, FASTEST),
        tool_change_s=entry.number("tool_change_s", 0.0, FASTEST),
        tool_places=entry.count("tool_places", 1, 10_000),
        control=_control(entry),
        work_spindle=_work_spindle(entry),
    )
    entry.done()
    return machine


Power = tuple[tuple[float, float], ...]


def _speeds(spindle: CatalogueEntry) -> tuple[float, float, Power]:
    """Return the least and the highest speed of a spindle, and its power curve."""
    low, high = spindle.number("low", 0.0, FASTEST), spindle.number("high", 1.0, FASTEST)
    power = tuple((n, kw) for n, kw in spindle.rows("power", 2, 0.0, FASTEST))
    if (
        low >= high
        or any(a[0] >= b[0] for a, b in pairwise(power))
        or not all(n > 0.0 and 0.0 < kw <= _STRONGEST for n, kw in power)
    ):
        raise spindle.wrong(
            "low must be below high, and the power curve rows [1/min, kW] must grow in speed"
        )
    return low, high, power


def _work_spindle(entry: CatalogueEntry) -> WorkSpindle | None:
    """Return the spindle that turns the work, None on a machine that doesn't turn."""
    if "work_spindle" not in entry.fields:
        return None
    spindle = entry.table("work_spindle")
    low, high, power = _speeds(spindle)
    made = WorkSpindle(
        low=low,
        high=high,
        power=power,
        largest_diameter=spindle.number("largest_diameter", 1.0, FARTHEST),
    )
    spindle.done()
    return made


def _control(entry: CatalogueEntry) -> str:
    """Return the name of the dialect that a machine is programmed in."""
    control, known = entry.text("control", CONTROL), registry.names("dialects")
    if control not in known:
        raise entry.wrong(f"control must be one of {', '.join(known)}; got {control!r}")
    return control


def _axis(entry: CatalogueEntry) -> Axis:
    kind = entry.text("kind")
    if kind not in AXIS_KINDS:
        raise entry.wrong(f"kind must be one of {', '.join(AXIS_KINDS)}; got {kind!r}")
    turning = _turning(entry) if kind == "rotary" else {}
    farthest = ENDLESS if kind == "rotary" else FARTHEST
    low, high = (entry.number(end, -farthest, farthest) for end in ("low", "high"))
    axis = Axis(
        name=entry.text("name"),
        kind=kind,
        low=low,
        high=high,
        rapid=entry.number("rapid", 1.0, FASTEST),
        acceleration=entry.number("acceleration", 1.0, FASTEST),
        **turning,
    )
    if axis.low >= axis.high or (kind == "rotary" and not axis.low <= 0.0 <= axis.high):
        raise entry.wrong("low must be below high, and a rotary axis must be able to stand at 0")
    entry.done()
    return axis


def _turning(entry: CatalogueEntry) -> dict[str, Any]:
    """Return what a rotary axis says beyond a linear one."""
    carries = entry.text("carries")
    if carries not in CARRIES:
        raise entry.wrong(f"carries must be one of {', '.join(CARRIES)}; got {carries!r}")
    direction, point = (
        entry.numbers("direction", -1.0, 1.0),
        entry.numbers("point", -FARTHEST, FARTHEST),
    )
    length = math.hypot(*direction)
    if len(direction) != 3 or len(point) != 3 or length < _SHORTEST:
        raise entry.wrong(
            "direction and point must be three numbers each, and a direction must not be 0"
        )
    return {"carries": carries, "direction": tuple(v / length for v in direction), "point": point}


def _check_rotary(entry: CatalogueEntry, axes: tuple[Axis, ...]) -> None:
    turning = [a for a in axes if a.kind == "rotary"]
    if len(turning) > MOST_ROTARY:
        raise entry.wrong(f"{len(turning)} rotary axes: at most {MOST_ROTARY} are understood")
    if len(turning) == MOST_ROTARY:
        (ax, ay, az), (bx, by, bz) = (a.direction for a in turning)
        if math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx) < _LEAST_BETWEEN:
            raise entry.wrong(
                f"rotary axes {turning[0].name} and {turning[1].name} must not be parallel"
            )
