"""The codes of ISO 13399 that a tool is read from and written with, and their values in mm and degrees."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from trunnion.findings import BadInput
from trunnion.model.tool import REAMER
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.cone import cone_of
from trunnion.shop.exchange.contract import ExchangeContext
from trunnion.shop.exchange.description import text
from trunnion.shop.exchange.fields import fields_of
from trunnion.shop.exchange.formats.iso_13399.items import ToolItem
from trunnion.shop.exchange.scaling import scaled, unscaled
from trunnion.units import MM_PER_INCH, MM_PER_METRE

_UNITS: Mapping[str, float] = {
    "mm": 1.0,
    "millimetre": 1.0,
    "m": MM_PER_METRE,
    "in": MM_PER_INCH,
    "inch": MM_PER_INCH,
}
UNIT_WORDS = {"mm": "mm", "inch": "in"}
_NUMBER = re.compile(
    r"\s*[-+]?(?:[0-9]{1,30}[.,]?[0-9]{0,30}|[.,][0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?\s*"
)
LENGTHS: Mapping[str, tuple[str, ...]] = {
    "diameter": ("DC", "DCX"),
    "smallest": ("DCN",),
    "corner_radius": ("RE",),
    "flute_length": ("APMX", "LCF", "THLGTH", "LU"),
    "neck_diameter": ("DN",),
    "neck_length": ("LN",),
    "shank_diameter": ("DCONMS", "DMM", "DCON"),
    "stickout": ("OHX",),
    "pitch": ("TP",),
    "pitch_low": ("TPN",),
    "pitch_high": ("TPX",),
    "barrel_radius": ("PRFRAD",),
}
"""Codes that a length of ours is read from, the first that is given; the first one is written."""
ANGLES: Mapping[str, str] = {"point_angle": "SIG", "helix_angle": "FHA"}
EDGE_ANGLE = "KAPR"
"""Angle between edge and feed plane: 90 less that of a taper's flank."""
TEETH = ("ZEFF", "PCEDC", "ZEFP", "NOF")
FIT, CENTRE, GROUPS, HAND = "TCHA", "CCC", "TMC1ISO", "HAND"


class ItemProperties:
    """The values of an item, which are taken out as they are read."""

    def __init__(self, item: ToolItem, source: str, scale: float) -> None:
        self.values, self.source, self.scale = dict(item.values), source, scale

    def number(self, code: str) -> float | None:
        """Return a number, None where there is none; raise `BadInput` for a text."""
        found = self.values.pop(code, None)
        if found is None:
            return None
        value = found[0]
        if isinstance(value, str):
            if not _NUMBER.fullmatch(value):
                raise BadInput(f"{self.source}: {code} must be a number; got {value[:40]!r}")
            value = float(value.replace(",", "."))
        if abs(value) > _LARGEST:
            raise BadInput(f"{self.source}: {code} is too large")
        return value

    def length(self, code: str) -> float | None:
        """Return a length in mm, None where there is none."""
        unit = self.values.get(code, ("", ""))[1].strip().lower()
        if unit and unit not in _UNITS:
            raise BadInput(
                f"{self.source}: {code} has the unit {unit[:12]!r}; known: {' '.join(_UNITS)}"
            )
        value = self.number(code)
        return None if value is None else scaled(value, _UNITS[unit] if unit else self.scale)

    def word(self, code: str) -> str:
        """Return a text, empty where there is none."""
        value = self.values.pop(code, ("", ""))[0]
        return text(value, self.source, code) if isinstance(value, str) else f"{value:g}"


_LARGEST = 1e9


def properties_of(
    cutter: Cutter, context: ExchangeContext
) -> Iterator[tuple[str, float | int | str, str]]:
    """Yield code, value and unit of what a tool has."""
    fields = fields_of(cutter)
    tool = cutter.tool
    if tool.form == "form":
        tip, angle = cone_of(tool) or (0.0, 0.0)
        fields |= {"smallest": tip, "point_angle": angle}
    for name, codes in LENGTHS.items():
        if name in fields:
            yield codes[0], unscaled(float(fields[name]), context.scale), UNIT_WORDS[context.unit]
    for name, code in ANGLES.items():
        if name in fields:
            yield code, float(fields[name]), "deg"
    if tool.form == "taper":
        yield EDGE_ANGLE, 90.0 - tool.taper_angle, "deg"
    yield TEETH[0], tool.teeth, ""
    yield CENTRE, int(tool.centre_cutting), ""
    if tool.form == REAMER:
        yield FIT, tool.fit, ""
    if cutter.suits:
        yield GROUPS, " ".join(cutter.suits), ""
