"""The typical plan that a planner follows, its cutter rules checked by the planner that reads it."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import BadInput
from trunnion.shop import Shop, TypicalPlan


def typical_plan(shop: Shop, family: str, named: str, rules: Sequence[str]) -> TypicalPlan:
    """Return the typical plan of a family, the one that is named or (empty) the first; `rules` are the words its cutters may have.

    Raises `BadInput` where there is none, or where a stage names a rule for its cutter that the planner does not know.
    """
    plan = shop.plan_for(family, named)
    for stage in plan.stages:
        if stage.cutter not in rules:
            raise BadInput(
                f"typical plan {plan.name}, stage {stage.name}: cutter must be one of {', '.join(rules)}; got {stage.cutter!r}"
            )
    return plan
