"""The types of tools that Fusion has: what the geometry of each says in our fields."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from trunnion.model.tool import BORING_BAR, REAMER, T_SLOT, TAP, THREAD_MILL
from trunnion.shop.cutters import END_MILL
from trunnion.shop.exchange.cone import give_cone
from trunnion.shop.exchange.description import ToolDescription, count, number
from trunnion.shop.exchange.scaling import scaled, without_noise


class EntryGeometry:
    """The geometry of an entry, whose keys are taken out as they are read; lengths come in mm."""

    def __init__(self, values: dict[str, Any], source: str, scale: float) -> None:
        self.values, self.source, self.scale = values, source, scale

    def length(self, word: str) -> float:
        """Return a length in mm, 0 where there is none."""
        return scaled(self.number(word), self.scale)

    def number(self, word: str) -> float:
        """Return a number, 0 where there is none."""
        value = self.values.pop(word, None)
        return 0.0 if value is None else number(value, self.source, word)


def _flat(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values |= {"form": END_MILL, "corner_radius": geometry.length("RE")}
    geometry.values.pop("tip-diameter", None)
    _taper_or_none(tool, geometry)


def _ball(tool: ToolDescription, geometry: EntryGeometry) -> None:
    geometry.length("RE")
    tool.values |= {"form": END_MILL, "corner_radius": tool.values.get("diameter", 0.0) / 2}
    geometry.values.pop("tip-diameter", None)
    _taper_or_none(tool, geometry)


def _taper_or_none(tool: ToolDescription, geometry: EntryGeometry) -> None:
    if geometry.number("TA") != 0.0:
        tool.refusal = "its flank is tapered, which the catalogue has no such kind for"


def _face(tool: ToolDescription, geometry: EntryGeometry) -> None:
    """Read a face mill: a flat or bull end, or a taper where its edges are at an angle."""
    angle, corner = geometry.number("TA"), geometry.length("RE")
    for word in ("tip-diameter", "DCX"):
        geometry.values.pop(word, None)
    tool.values |= {"form": END_MILL, "corner_radius": corner, "use": ("face",)}
    if angle:
        tool.values |= {"form": "taper", "taper_angle": angle}


def _taper(tool: ToolDescription, geometry: EntryGeometry) -> None:
    """Read a tapered mill, whose DC is where the flank would meet the plane of its tip."""
    angle, corner = geometry.number("TA"), geometry.length("RE")
    geometry.values.pop("tip-diameter", None)
    if not 0.0 < angle < 90.0:
        tool.refusal = f"its taper angle must be between 0 and 90 degrees; got {angle:g}"
        return
    end = tool.values.get("diameter", 0.0) + corner_excess(corner, angle)
    tool.values |= {"form": "taper", "taper_angle": angle, "corner_radius": corner}
    tool.values["diameter"] = without_noise(end)


def corner_excess(corner: float, angle: float) -> float:
    """Return by how much the end of a taper, out to its corner, is wider in mm than its flank where that would meet the plane of the
    tip: the corner, tangent to both, touches the plane r tan((90 - a) / 2) inside of there and is r wide: 2 r (1 - tan((90 - a) / 2))."""
    return 2.0 * corner * (1.0 - math.tan(math.radians((90.0 - angle) / 2.0)))


def _slot(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values |= {"form": T_SLOT, "corner_radius": geometry.length("RE")}
    geometry.values.pop("tip-diameter", None)


def _drill(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values["form"] = "drill"
    angle = geometry.number("SIG")
    if angle:
        tool.values["point_angle"] = angle


def _spot_drill(tool: ToolDescription, geometry: EntryGeometry) -> None:
    _drill(tool, geometry)
    tool.values["use"] = ("spot",)


def _reamer(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values["form"] = REAMER


def _boring_bar(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values["form"] = BORING_BAR


def _tap(tool: ToolDescription, geometry: EntryGeometry) -> None:
    tool.values |= {"form": TAP, "pitch": geometry.length("TP")}


def _thread_mill(tool: ToolDescription, geometry: EntryGeometry) -> None:
    """Read a comb by its pitch, or a single tooth by the pitches that it cuts."""
    tool.values["form"] = THREAD_MILL
    pitch, low, high = (geometry.length(word) for word in ("TP", "TPN", "TPX"))
    single = count(geometry.values.pop("NT", 1), tool.source, "NT") <= 1
    for word in ("tip-diameter", "thread-tip-type"):
        geometry.values.pop(word, None)
    if single and low > 0.0 and high > 0.0:
        tool.values |= {"pitch_low": low, "pitch_high": high}
    elif pitch > 0.0:
        tool.values["pitch"] = pitch


def _countersink(tool: ToolDescription, geometry: EntryGeometry) -> None:
    give_cone(tool, geometry.length("tip-diameter"), geometry.number("SIG"))


def _chamfer_mill(tool: ToolDescription, geometry: EntryGeometry) -> None:
    """Read a chamfer mill, whose angle is to one side."""
    give_cone(tool, geometry.length("tip-diameter"), 2.0 * geometry.number("TA"))


def _oval(tool: ToolDescription, geometry: EntryGeometry) -> None:
    """Read an oval circle segment mill: a ball at the tip, and a flank of a large radius that is tangent to it."""
    tool.values |= {
        "form": "barrel",
        "corner_radius": geometry.length("lower-radius"),
        "barrel_radius": geometry.length("profile-radius"),
    }
    geometry.values.pop("tip-diameter", None)


READERS: Mapping[str, Callable[[ToolDescription, EntryGeometry], None]] = {
    "flat end mill": _flat,
    "bull nose end mill": _flat,
    "ball end mill": _ball,
    "face mill": _face,
    "tapered mill": _taper,
    "circle segment oval": _oval,
    "slot mill": _slot,
    "drill": _drill,
    "spot drill": _spot_drill,
    "reamer": _reamer,
    "boring bar": _boring_bar,
    "tap right hand": _tap,
    "tap left hand": _tap,
    "thread mill": _thread_mill,
    "counter sink": _countersink,
    "chamfer mill": _chamfer_mill,
}
"""What each type of tool is here; other types are left out."""
