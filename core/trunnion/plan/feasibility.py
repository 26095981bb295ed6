"""What no route can be made for: open faces, machines without the axes that a part needs or with too little travel for its blank, and more
tools than a magazine has places for; and the setups that a route can be made in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import BadInput, Finding, error, warning
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.plan.setups import SetupSettings, turned_over
from trunnion.shop import Shop
from trunnion.units import trimmed


def refuse_open(is_closed: bool) -> None:
    """Raise `BadInput` for faces that enclose no material."""
    if not is_closed:
        raise BadInput("nothing can be planned for faces that enclose no material")


def without_axes(
    recognition: Recognition, setups: Sequence[Setup], shop: Shop, why: str, leaning: str = ""
) -> list[Finding]:
    """Return an error where the machine of the first setup has no rotary axes, which a part needs: `why`, and what they must do."""
    if shop.machine(setups[0].machine).rotary:
        return []
    wanted = f"choose a machine with rotary axes{leaning} (setup.machine)"
    return [
        error(
            "route.not-planned",
            f"{why}, and the machine has no rotary axes",
            *(f.id for f in recognition),
            remedy=wanted,
        )
    ]


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
    """Return a warning for each setup whose machine's magazine does not take the tools of all that the plan does on it."""
    machine_of = {s.name: s.machine for s in setups}
    found = []
    for setup in setups:
        machine = shop.machine(setup.machine)
        count = len({o.tool.name for o in operations if machine_of.get(o.setup) == setup.machine})
        if count > machine.tool_places:
            found.append(
                warning(
                    "route.tool-places",
                    f"{count} tools are planned on {machine.name}, which has {machine.tool_places} places",
                    setup.name,
                    remedy="load tools by hand or choose another machine",
                )
            )
    return found


def both_sides(
    setups: Sequence[Setup], blank: Blank, shop: Shop, settings: SetupSettings
) -> Sequence[Setup]:
    """Return the setups that features may be cut in: where none looks from below, the part turned over comes after them if the machine of
    the first takes that."""
    first = setups[0]
    if any(s.frame.z @ first.frame.z < -math.cos(tolerance.ANGLE) for s in setups):
        return setups
    other = turned_over(blank, replace(settings, machine=first.machine), len(setups))
    return setups if too_large(blank, (other,), shop) else (*setups, other)
