"""The cutting data that operations on holes begin with: drilled, reamed, tapped and thread milled by their tables, bores milled by
helices."""

from __future__ import annotations

from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.axial import TABLE_FORMS, TABLE_KINDS, table_data
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data, roughing_width
from trunnion.plan.holes.drive import BORE, COUNTERBORE, FLOOR
from trunnion.shop import Shop

HOLE_MILLING = (BORE, FLOOR, COUNTERBORE)
"""Kinds of operations that mill holes along helices."""
HELIX_DEPTH = 0.2
"""Depth of one turn of a helix in a hole over the cutter's diameter: the first ring cuts all of its width."""


def is_on_holes(kind: str, tool: Tool) -> bool:
    """Return whether the data of an operation of a kind are those of `hole_data`."""
    return kind in (*TABLE_KINDS, *HOLE_MILLING) or tool.form in TABLE_FORMS


def hole_data(
    kind: str,
    tool: Tool,
    material: Material,
    machine: Machine,
    shop: Shop,
    settings: CuttingSettings,
) -> CuttingData:
    """Return the data of an operation of a kind on holes: in a bore each turn of a helix takes a slice, ring by ring from the middle
    outwards."""
    if kind in TABLE_KINDS or tool.form in TABLE_FORMS:
        return table_data(kind, tool, material, machine, shop, settings)
    depth, width = HELIX_DEPTH * tool.diameter, roughing_width(tool, material, settings)
    return cutting_data(tool, material, machine, kind, settings, depth, width)
