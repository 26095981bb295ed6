"""Drilling cycles of Sinumerik: what each does at a hole, stroke by stroke (Programming Manual "Cycles", chapter drilling)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.motion.cycle import MOST_PECKS
from trunnion.post.readers.hole_strokes import HoleStroke
from trunnion.post.readers.numbers import DWELL, FEED, SPINDLE
from trunnion.post.readers.sinumerik.calls import CallParameters

CHIP_BREAK = 1.0
"""mm: how far CYCLE83 backs off to break chips where VRT is left out."""
SHALLOW, SHALLOW_LIMIT, DEEP_SHARE, DEEP_LIMIT = 30.0, 0.6, 50.0, 7.0
"""mm: how far above the last depth CYCLE83 begins to feed again where DIS1 is left out: 0.6 for holes to 30, else a fiftieth, at most 7."""
CLOCKWISE = 3.0
"""The number of M3, as parameters say it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CycleCall:
    """A drilling cycle as a call says it: the strokes at each hole; a `tap` has a spindle speed in 1/min of its own, else 0."""

    name: str
    strokes: tuple[HoleStroke, ...]
    spindle: float = 0.0


class _Heights(NamedTuple):
    """Z in mm: where the cycle ends, where it begins to feed, the reference plane, the bottom."""

    end: float
    plane: float
    reference: float
    bottom: float


def cycle_of_call(given: CallParameters, unit: float) -> CycleCall:
    """Return what a call makes the tool do at a hole, lengths of `unit` mm; raise `BadInput` for what makes none."""
    heights = _heights(given, unit)
    strokes = [HoleStroke(heights.plane, None), *_STROKES[given.name](given, heights, unit)]
    spindle = given.number("SST", 0.0) if given.name == "CYCLE84" else 0.0
    return CycleCall(name=given.name, strokes=tuple(strokes), spindle=spindle)


def _heights(given: CallParameters, unit: float) -> _Heights:
    end, reference = given.number("RTP") * unit, given.number("RFP") * unit
    plane = reference + abs(given.number("SDIS", 0.0)) * unit
    if bool(given.text("DP")) == bool(given.text("DPR")):
        raise BadInput(
            f"line {given.line}: {given.name} needs its depth once: DP, or DPR below the reference plane"
        )
    bottom = (
        given.number("DP") * unit
        if given.text("DP")
        else reference - abs(given.number("DPR")) * unit
    )
    if bottom >= plane:
        raise BadInput(
            f"line {given.line}: {given.name} with its depth at or above the plane where it begins to feed; check RFP, SDIS and DP"
        )
    if end < plane - tolerance.PARAMETRIC:
        raise BadInput(
            f"line {given.line}: {given.name} with its retraction plane RTP below the plane where it begins to feed; check RTP"
        )
    return _Heights(end, plane, reference, bottom)


def _out(at: _Heights) -> Iterator[HoleStroke]:
    """Yield the rapid to where the cycle ends, where the tool is not there already."""
    if at.end > at.plane:
        yield HoleStroke(at.end, None)


def _dwell(given: CallParameters, name: str = "DTB") -> float:
    seconds = given.number(name, 0.0)
    DWELL.check(given.line, f"{given.name} {name} ", seconds)
    return seconds


def _drill(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    yield HoleStroke(at.bottom, 0.0, _dwell(given))
    yield HoleStroke(at.end, None)


def _peck(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    """Yield the strokes of deep drilling, without degression: out to the plane after each (VARI 1), or back a little (VARI 0)."""
    given.only(
        {
            "DAM": (0.0,),
            "DTB": (0.0,),
            "FRF": (1.0, 0.0),
            "VARI": (0.0, 1.0),
            "AXN": (3.0, 0.0),
            "MDEP": (0.0,),
        }
    )
    depth = at.reference - at.bottom
    if given.text("FDEP"):
        first = at.plane - given.number("FDEP") * unit
    else:
        first = at.plane - at.reference + abs(given.number("FDPR")) * unit
    breaks = given.number("VARI", 0.0) == 0.0
    back = given.number("VRT", 0.0) * unit or CHIP_BREAK
    if not breaks:
        limit = SHALLOW_LIMIT if depth <= SHALLOW else min(depth / DEEP_SHARE, DEEP_LIMIT)
        back = given.number("DIS1", 0.0) * unit or limit
    if first <= back or back <= 0.0:
        raise BadInput(
            f"line {given.line}: {given.name} with a first depth of {first:g} mm, not deeper than the {back:g} mm it backs off by"
        )
    pecks = max(1, math.ceil((at.plane - at.bottom - tolerance.COINCIDENT) / first))
    if pecks > MOST_PECKS:
        raise BadInput(
            f"line {given.line}: {given.name} with {pecks} pecks, at most {MOST_PECKS} are understood"
        )
    above = _dwell(given, "DTS")
    for k in range(1, pecks):
        yield HoleStroke(at.plane - k * first, 0.0)
        if not breaks:
            yield HoleStroke(at.plane, None, above)
        yield HoleStroke(at.plane - k * first + back, 0.0 if breaks else None)
    yield HoleStroke(at.bottom, 0.0, _dwell(given, "DTD"))
    yield HoleStroke(at.end, None)


def _ream(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    yield HoleStroke(at.bottom, _feed(given, "FFR", unit), _dwell(given))
    yield HoleStroke(at.plane, _feed(given, "RFF", unit))
    yield from _out(at)


def _bore(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    yield HoleStroke(at.bottom, 0.0, _dwell(given))
    yield HoleStroke(at.plane, 0.0)
    yield from _out(at)


def _bore_aside(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    """Yield the strokes of boring with a spindle that stops in a position: the tool leaves the wall before it goes out."""
    given.only({"SDIR": (CLOCKWISE,)})
    aside = (given.number("RPA", 0.0) * unit, given.number("RPO", 0.0) * unit)
    yield HoleStroke(at.bottom, 0.0, _dwell(given))
    if any(aside) or given.number("RPAP", 0.0):
        yield HoleStroke(at.bottom + given.number("RPAP", 0.0) * unit, None, 0.0, aside)
    yield HoleStroke(at.plane, None, 0.0, aside)
    yield HoleStroke(at.end, None)


def _tap(given: CallParameters, at: _Heights, unit: float) -> Iterator[HoleStroke]:
    """Yield the strokes of rigid tapping: in and out to the plane at the pitch a revolution, the spindle reversed."""
    given.only({"SDAC": (CLOCKWISE, 5.0), "MPIT": (0.0,)})
    pitch, turns = given.number("PIT") * unit, given.number("SST")
    back = given.number("SST1", 0.0) or turns
    for name, value in (("SST", turns), ("SST1", back)):
        SPINDLE.check(given.line, f"{given.name} {name} ", value)
    if pitch <= 0.0 or turns <= 0.0:
        raise BadInput(
            f"line {given.line}: {given.name} needs PIT and SST above zero; threads to the left are not understood"
        )
    yield HoleStroke(at.bottom, pitch * turns, _dwell(given))
    yield HoleStroke(at.plane, pitch * back)
    yield from _out(at)


def _feed(given: CallParameters, name: str, unit: float) -> float:
    feed = given.number(name, 0.0)
    if feed:
        FEED.check(given.line, f"{given.name} {name} ", feed)
    return feed * unit


_STROKES: Mapping[str, Callable[[CallParameters, _Heights, float], Iterator[HoleStroke]]] = {
    "CYCLE81": _drill,
    "CYCLE82": _drill,
    "CYCLE83": _peck,
    "CYCLE84": _tap,
    "CYCLE85": _ream,
    "CYCLE86": _bore_aside,
    "CYCLE89": _bore,
}
