"""Fusion's holders: segments from the nose up, as far as the gauge line, and the units that entries are in."""

from __future__ import annotations

import uuid
from typing import Any

from trunnion import tolerance
from trunnion.model.tool import Holder
from trunnion.shop.exchange.contract import (
    UNITS,
    ExchangeContext,
)
from trunnion.shop.exchange.description import ToolDescription, number, text
from trunnion.shop.exchange.files import listed
from trunnion.shop.exchange.scaling import scaled, unscaled, without_noise

UNIT_SCALES = {"millimeters": UNITS["mm"], "inches": UNITS["inch"]}
UNIT_NAMES = {"mm": "millimeters", "inch": "inches"}


def give_holder(tool: ToolDescription, entry: dict[str, Any], scale: float) -> None:
    """Give a tool its holder, as far as the spindle's face; one without segments has no shape."""
    if not entry:
        return
    source = f"{tool.source}: holder"
    name = text(entry.get("description") or "holder", source, "description")
    own = UNIT_SCALES[entry["unit"]] if entry.get("unit") in UNIT_SCALES else scale
    gauge = scaled(number(entry.get("gaugeLength") or 0, source, "gaugeLength"), own)
    rows = _rows(listed(entry, "segments", source) if "segments" in entry else [], source, own)
    if not rows:
        tool.ignore("holder", name, "it has no segments: its shape is not known")
        return
    top = rows[-1][2]
    if 0.0 < gauge < top - tolerance.COINCIDENT:
        tool.ignore(
            "holder segments",
            f"{top:g} mm",
            f"what is above its gauge line, {gauge:g} mm, is inside the spindle",
        )
        rows = _cut(rows, gauge)
    elif gauge > top + tolerance.COINCIDENT:
        radius = rows[-1][3]
        rows.append((top, radius, gauge, radius))
        why = "its segments end below its gauge line: the last one is taken to reach up to it"
        tool.assumed["holder_rows"] = (f"({top:g}, {radius:g}, {gauge:g}, {radius:g})", why)
    tool.values["holder"] = Holder(name=name, rows=tuple(rows))


Row = tuple[float, float, float, float]


def _rows(segments: list[dict[str, Any]], source: str, scale: float) -> list[Row]:
    """Return segments, from the nose up, as rows of a holder."""
    rows: list[Row] = []
    z = 0.0
    for n, segment in enumerate(segments, 1):
        height, low, high = (
            scaled(number(segment.get(word), f"{source}: segment {n}", word), scale)
            for word in ("height", "lower-diameter", "upper-diameter")
        )
        if height > 0.0:
            top = without_noise(z + height)
            rows.append((z, low / 2, top, high / 2))
            z = top
    return rows


def _cut(rows: list[Row], height: float) -> list[Row]:
    """Return rows up to a height."""
    found = []
    for z0, r0, z1, r1 in rows:
        if z0 >= height:
            break
        if z1 > height:
            r1 = r0 + (r1 - r0) * (height - z0) / (z1 - z0)
        found.append((z0, r0, min(z1, height), r1))
    return found


def holder_entry(holder: Holder, context: ExchangeContext) -> dict[str, Any]:
    scale = context.scale
    return {
        "description": holder.name,
        "gaugeLength": unscaled(holder.length, scale),
        "guid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"trunnion:holder:{holder.name}")),
        "product-id": "",
        "product-link": "",
        "segments": [
            {
                "height": unscaled(without_noise(z1 - z0), scale),
                "lower-diameter": unscaled(2 * r0, scale),
                "upper-diameter": unscaled(2 * r1, scale),
            }
            for z0, r0, z1, r1 in holder.rows
        ],
        "type": "holder",
        "unit": UNIT_NAMES[context.unit],
        "vendor": "",
    }
