"""Cutting data of tools that have tables of their own: drills, reamers, boring bars and taps, which cut along their axis, and thread
mills."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import BORING_BAR, REAMER, TAP, THREAD_MILL, Tool
from trunnion.plan.cutting.drilling import AXIAL, drilling_data
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.power import AXIAL_FORMS
from trunnion.plan.cutting.reaming import reaming_data
from trunnion.plan.cutting.tapping import tapping_data
from trunnion.plan.cutting.thread_milling import thread_milling_data
from trunnion.shop import Shop

MILL_THREAD = "thread_mill"
"""The kind of operations that mill threads."""
FORM_OF_KIND = {
    "ream": REAMER,
    "fine_bore": BORING_BAR,
    "tap": TAP,
    MILL_THREAD: THREAD_MILL,
}
"""Kinds of operation that only one form of tools can do."""
TABLE_FORMS = (*AXIAL_FORMS, THREAD_MILL)
"""Forms of cutters whose data are not the material's for milling, but a table's of their own."""
TABLE_KINDS = (*AXIAL, MILL_THREAD)
"""Kinds of operation that such cutters do."""


def table_data(
    kind: str,
    tool: Tool,
    material: Material,
    machine: Machine,
    shop: Shop,
    settings: CuttingSettings,
) -> CuttingData:
    """Return the data of an operation of a kind (`TABLE_KINDS`) by the table of its tool (`TABLE_FORMS`).

    Raises `BadInput` for a tool that can't do the kind.
    """
    needed = FORM_OF_KIND.get(kind, tool.form)
    if tool.form != needed:
        raise BadInput(f"{tool.name} is no {needed}: an operation of the kind {kind} needs one")
    if tool.form == THREAD_MILL and kind != MILL_THREAD:
        raise BadInput(f"{tool.name} is a {tool.form}: it does no operation of the kind {kind}")
    if tool.form == REAMER:
        return reaming_data(tool, material, shop.reaming_for(material), machine, settings)
    if tool.form == BORING_BAR:
        table = shop.boring_for(material)
        return reaming_data(tool, material, table, machine, settings, "boring")
    if tool.form == TAP:
        return tapping_data(tool, material, shop.tapping_for(material), machine, settings)
    if tool.form == THREAD_MILL:
        return thread_milling_data(
            tool, material, shop.thread_milling_for(material), machine, settings
        )
    return drilling_data(tool, material, shop.drilling_for(material), machine, settings, kind)
