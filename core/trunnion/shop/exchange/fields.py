"""The fields of a catalogue cutter by name: what a library can give or lose.

They are the fields of a `[tool.NAME]` table, and with them `name`, `number` on a machine (0: none), `gauge_length` and the
`holder_rows` that the name of a holder stands for.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from trunnion import tolerance
from trunnion.model.tool import BORING_BAR, REAMER, TAP, THREAD_MILL
from trunnion.model.tool.thread_mill import is_comb
from trunnion.shop.cutters import END_MILL, WITHOUT_CORNER, Cutter
from trunnion.shop.exchange.contract import Plain

_ENDS = ("flat", "bull", "ball")
_OWN: Mapping[str, tuple[str, ...]] = {
    "taper": ("taper_angle",),
    "barrel": ("barrel_radius",),
    "drill": ("point_angle",),
    REAMER: ("lead", "fit"),
    BORING_BAR: ("lead", "smallest"),
    TAP: ("pitch", "lead"),
    "form": ("outline",),
}
"""Fields that only one kind has; a thread mill has a pitch or a range of them."""
ONLY: Mapping[str, tuple[str, ...]] = {
    "corner_radius": (END_MILL, "taper", "barrel", "t-slot", "button"),
    "taper_angle": ("taper",),
    "barrel_radius": ("barrel",),
    "point_angle": ("drill",),
    "lead": (REAMER, BORING_BAR, TAP),
    "fit": (REAMER,),
    "smallest": (BORING_BAR,),
    "pitch": (TAP, THREAD_MILL),
    "pitch_low": (THREAD_MILL,),
    "pitch_high": (THREAD_MILL,),
    "outline": ("form",),
}
"""Fields of a table that only some kinds have."""
OUTSIDE = ("name", "number", "gauge_length", "holder_rows")
"""Fields that don't stand in the table of a cutter."""


def kind_of(form: str) -> str:
    """Return the kind that a catalogue file gives for a form: `end mill` for those that the corner radius decides."""
    return END_MILL if form in _ENDS else form


def fields_of(cutter: Cutter) -> dict[str, Any]:
    """Return the fields of a cutter that its kind has, lengths in mm and angles in degrees, in the order that losses are listed in."""
    tool = cutter.tool
    kind = kind_of(tool.form)
    fields: dict[str, Any] = {
        "number": tool.number,
        "name": tool.name,
        "title": tool.description,
        "form": kind,
        "diameter": tool.diameter,
    }
    if kind not in WITHOUT_CORNER:
        fields["corner_radius"] = tool.corner_radius
    own = _OWN.get(kind, ())
    if kind == THREAD_MILL:
        own = ("pitch",) if is_comb(tool) else ("pitch_low", "pitch_high")
    if kind == BORING_BAR and tool.fit:
        own = (*own, "fit")
    fields |= {name: getattr(tool, name) for name in own}
    for name in (
        *("flute_length", "neck_diameter", "neck_length", "shank_diameter", "stickout"),
        *("gauge_length", "teeth", "helix_angle", "centre_cutting"),
    ):
        fields[name] = getattr(tool, name)
    return fields | {
        "holder": tool.holder.name,
        "holder_rows": tool.holder.rows,
        "suits": cutter.suits,
        "use": cutter.use,
    }


def entry_of(cutter: Cutter) -> dict[str, Any]:
    """Return the fields of a cutter's table in a catalogue file. A boring bar that is set loses what it is set for."""
    omitted = (*OUTSIDE, "fit") if cutter.tool.form == BORING_BAR else OUTSIDE
    return {name: value for name, value in fields_of(cutter).items() if name not in omitted}


def is_same(value: Any, other: Any) -> bool:
    """Return whether two values of a field are the same: numbers within rounding of a change of units, rows row by row."""
    if isinstance(value, tuple) and isinstance(other, tuple):
        return len(value) == len(other) and all(map(is_same, value, other))
    if isinstance(value, float) and isinstance(other, float):
        return math.isclose(value, other, rel_tol=0.0, abs_tol=tolerance.COINCIDENT)
    return bool(value == other)


def plain(value: Any) -> Plain:
    """Return a value as a loss has it."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (tuple, list)):
        texts = [str(plain(v)) for v in value]
        return ", ".join(
            f"({t})" if isinstance(v, (tuple, list)) else t
            for v, t in zip(value, texts, strict=True)
        )
    return str(value)
