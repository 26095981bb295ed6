"""Cutting data of tools that cut along their axis, each by its table: drills, reamers, boring bars and taps."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import BORING_BAR, REAMER, TAP, Tool
from trunnion.plan.cutting.drilling import drilling_data
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.reaming import reaming_data
from trunnion.plan.cutting.tapping import tapping_data
from trunnion.shop import Shop

FORM_OF_KIND = {"ream": REAMER, "fine_bore": BORING_BAR, "tap": TAP}
"""Kinds of operation that only one form of tools can do."""


def axial_data(
    kind: str,
    tool: Tool,
    material: Material,
    machine: Machine,
    shop: Shop,
    settings: CuttingSettings,
) -> CuttingData:
    """Return the data of an operation of a kind with a tool that cuts along its axis.

    Raises `BadInput` for a tool that can't do the kind.
    """
    needed = FORM_OF_KIND.get(kind, tool.form)
    if tool.form != needed:
        raise BadInput(f"{tool.name} is no {needed}: an operation of the kind {kind} needs one")
    if tool.form == REAMER:
        return reaming_data(tool, material, shop.reaming_for(material), machine, settings)
    if tool.form == BORING_BAR:
        table = shop.boring_for(material)
        return reaming_data(tool, material, table, machine, settings, "boring")
    if tool.form == TAP:
        return tapping_data(tool, material, shop.tapping_for(material), machine, settings)
    return drilling_data(tool, material, shop.drilling_for(material), machine, settings, kind)
