"""The machine of a session's setups, where a person named one and where the program chooses it."""

from __future__ import annotations

from collections.abc import Mapping

from trunnion.findings import BadInput
from trunnion.model.blank import Blank
from trunnion.plan.contract import Leaning, Planner
from trunnion.plan.machine_choice import machine_for
from trunnion.plan.setups import SetupSettings
from trunnion.settings import Value, checked, choose
from trunnion.shop import Shop

MACHINE = "setup.machine"
"""Key of the setting that names the machine of the first setup."""


def with_machine(
    planner: Planner, blank: Blank, choices: Mapping[str, Value], shop: Shop
) -> Mapping[str, Value]:
    """Return a session's choices with the machine of its setups among them: the named one, else one that the planner's parts need.

    Raises `BadInput` for a name that the catalogue doesn't know, and where it has no machine to choose from.
    """
    settings = checked(choose(SetupSettings, choices))
    for name in filter(None, (settings.machine, settings.next_machine)):
        if name not in shop.machines:
            raise BadInput(
                f"there is no machine {name} in the catalogue; known: {', '.join(sorted(shop.machines))}"
            )
    lean = planner.lean if isinstance(planner, Leaning) else 0.0
    name = machine_for(blank, lean, settings, shop)
    if not name:
        raise BadInput("the catalogue has no machine that mills; describe one in the user folder")
    return {**choices, MACHINE: name}
