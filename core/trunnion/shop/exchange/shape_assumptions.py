"""What is assumed of a tool's shape: what only its form has, flutes, neck and shank."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from trunnion.model.tool import BORING_BAR, REAMER, T_SLOT, TAP, THREAD_MILL
from trunnion.model.tool.drill import point_height
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.shop.cutters import (
    WITHOUT_CORNER,
)
from trunnion.shop.exchange.contract import (
    Plain,
)
from trunnion.shop.exchange.fields import plain
from trunnion.shop.exchange.scaling import without_noise

FLUTES = 2.0
"""Flute length of drills, reamers and taps over their diameter: stub drills have no shorter ones (DIN 1897)."""
MILL_FLUTES, MOST_MILL_FLUTES = 1.0, 10.0
"""Flute length of mills over their diameter, shorter than that of stub end mills (DIN 6527), and the most that is taken, mm: that of
inserts of face mills."""
POINT_ANGLE = 118.0
"""Degrees: the longest of the usual points of drills (type N, DIN 1414)."""
REAMER_LEAD = 0.16
"""Lead of a reamer over its diameter: the longest in the catalogue, of reamers of 3 mm."""
TAP_LEAD = 5.0
"""Lead of a tap in pitches: that of form B (DIN 2197), the longest of machine taps."""
TAP_LEAD_SHARE = 0.5
"""The most that a lead takes of a tap's thread."""
NOSE = 0.2
"""mm: the nose of a boring bar's insert, ISO 1832 corner 02."""
BAR = 0.9
"""Thickness of a boring bar, and of a tap's neck, over the bore that it goes into."""
FIT = "H7"
"""The class of holes that reamers are usually made for (DIN 1420)."""


@dataclass(slots=True)
class Filling:
    """The values of one tool while what is missing is filled in."""

    values: dict[str, Any]
    assumed: dict[str, tuple[Plain, str]]

    def has(self, name: str) -> bool:
        return name in self.values

    def fill(self, name: str, value: Any, why: str) -> None:
        """Assume a value for a field that is missing."""
        if name not in self.values:
            self.correct(name, value, why)

    def correct(self, name: str, value: Any, why: str) -> None:
        """Assume a value for a field, whatever stands there."""
        self.values[name] = value
        self.assumed[name] = (plain(value), why)

    def length(self, name: str) -> float:
        return float(self.values[name])


_AXIAL = ("drill", REAMER, TAP)
"""Forms that cut along their axis."""
UNSAID = "the file doesn't say it"


def fill_shape(filling: Filling) -> str:
    """Fill in what only one kind has; return what no assumption is safe for, or nothing."""
    kind = str(filling.values["form"])
    if kind not in WITHOUT_CORNER:
        filling.fill("corner_radius", 0.0, f"{UNSAID}; taken for a sharp corner")
    own: dict[str, Callable[[Filling], str]] = {
        "taper": lambda f: "" if f.has("taper_angle") else "it gives no taper angle",
        "barrel": lambda f: "" if f.has("barrel_radius") else "it gives no radius of its flank",
        T_SLOT: lambda f: "" if f.has("flute_length") else "it gives no thickness of its disc",
        "form": lambda f: "" if f.has("outline") else "it gives no outline",
        "drill": _fill_drill,
        REAMER: _fill_reamer,
        BORING_BAR: _fill_boring_bar,
        TAP: _fill_tap,
        THREAD_MILL: _fill_thread_mill,
    }
    return own[kind](filling) if kind in own else ""


def _fill_drill(filling: Filling) -> str:
    filling.fill("point_angle", POINT_ANGLE, UNSAID)
    return ""


def _fill_reamer(filling: Filling) -> str:
    filling.fill("lead", REAMER_LEAD * filling.length("diameter"), UNSAID)
    filling.fill("fit", FIT, f"{UNSAID}; usual for reamers")
    return ""


def _fill_boring_bar(filling: Filling) -> str:
    filling.fill(
        "smallest", filling.length("diameter"), f"{UNSAID}; taken for set to its diameter alone"
    )
    filling.fill("lead", NOSE, UNSAID)
    return ""


def _fill_tap(filling: Filling) -> str:
    if not filling.has("pitch") or not filling.length("pitch") > 0.0:
        return "it gives no pitch"
    lead = TAP_LEAD * filling.length("pitch")
    if filling.has("flute_length"):
        lead = min(lead, TAP_LEAD_SHARE * filling.length("flute_length"))
    filling.fill("lead", lead, f"{UNSAID}; a long one, that of form B after DIN 2197")
    return ""


def _fill_thread_mill(filling: Filling) -> str:
    ranged = filling.has("pitch_low") and filling.has("pitch_high")
    return "" if filling.has("pitch") or ranged else "it gives no pitch"


def fill_lengths(filling: Filling) -> None:
    """Fill in flutes, neck and shank; lengths that contradict each other are set right on the short side."""
    values, diameter = filling.values, filling.length("diameter")
    least = _least_flutes(values)
    axial = values["form"] in _AXIAL
    usual = FLUTES * diameter if axial else min(MILL_FLUTES * diameter, MOST_MILL_FLUTES)
    filling.fill("flute_length", max(usual, least), f"{UNSAID}; short for a tool of its diameter")
    flutes = filling.length("flute_length")
    filling.fill("neck_length", flutes, f"{UNSAID}; taken for no neck")
    if filling.length("neck_length") < flutes:
        filling.correct("neck_length", flutes, "the file's neck ends below its flutes")
    if not filling.has("neck_diameter"):
        if values["form"] == THREAD_MILL and filling.length("neck_length") > flutes:
            filling.correct("neck_length", flutes, "the file doesn't say how thick its neck is")
        filling.fill("neck_diameter", _neck(values), UNSAID)
    filling.fill("shank_diameter", diameter, f"{UNSAID}; taken for as thick as its diameter")


def _least_flutes(values: dict[str, Any]) -> float:
    """Return how long flutes must be at least for what is known of a tool's end."""
    diameter = float(values["diameter"])
    if values["form"] == "drill" and 0.0 < float(values["point_angle"]) <= 180.0:
        return point_height(diameter, float(values["point_angle"])) + diameter
    if values["form"] == "form":
        return float(values["outline"][-1][1])
    return float(values.get("corner_radius", 0.0))


def _neck(values: dict[str, Any]) -> float:
    diameter = float(values["diameter"])
    if values["form"] == TAP:
        core = basic_minor_diameter(diameter, float(values["pitch"]))
        return without_noise(BAR * max(core, 0.0))
    if values["form"] == BORING_BAR:
        return without_noise(BAR * float(values["smallest"]))
    return diameter
