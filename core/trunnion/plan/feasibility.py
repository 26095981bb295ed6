"""What no route can be made for: blanks that a machine's travel does not take, more tools than its magazine has places for."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import Finding, error, warning
from trunnion.model.blank import Blank
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.shop import Shop
from trunnion.units import trimmed


def too_large(blank: Blank, setups: Sequence[Setup], shop: Shop) -> list[Finding]:
    """Return an error for each setup whose machine has less travel than the blank needs."""
    found = []
    for setup in setups:
        machine = shop.machine(setup.machine)
        low, high = blank.box_in(setup.frame)
        need = dict(
            zip("XYZ", (high[0] - low[0], high[1] - low[1], setup.clearance - low[2]), strict=True)
        )
        short = [
            f"{name} needs {trimmed(float(span), 1)} of {trimmed(axis.high - axis.low, 1)} mm"
            for name, span in need.items()
            if span > (axis := machine.axis(name)).high - axis.low
        ]
        if short:
            found.append(
                error(
                    "route.travel",
                    f"the blank exceeds the machine's travel ({machine.name}): {', '.join(short)}",
                    setup.name,
                    remedy="choose a larger machine",
                )
            )
    return found


def too_many_tools(
    operations: Sequence[Operation], setups: Sequence[Setup], shop: Shop
) -> list[Finding]:
    """Return a warning for each machine whose magazine does not take the tools of the plan."""
    count, found = len({o.tool.name for o in operations}), []
    for setup in setups:
        machine = shop.machine(setup.machine)
        if count > machine.tool_places:
            found.append(
                warning(
                    "route.tool-places",
                    f"{count} tools are planned, {machine.name} has {machine.tool_places} places",
                    setup.name,
                    remedy="load tools by hand or choose another machine",
                )
            )
    return found
