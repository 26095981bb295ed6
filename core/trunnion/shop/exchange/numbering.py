"""Numbers of tools in libraries that need one for each."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.contract import Loss, LossKind


def numbered(cutters: Sequence[Cutter]) -> tuple[list[int], tuple[Loss, ...]]:
    """Return a number for each tool, its own or, where it has none or another one has it, the lowest that is free, and which these are."""
    own = {c.tool.number for c in cutters}
    numbers: list[int] = []
    losses = []
    used: set[int] = set()
    free = 1
    for cutter in cutters:
        number = cutter.tool.number
        if number <= 0 or number in used:
            while free in own or free in used:
                free += 1
            why = (
                "the catalogue gives it no number" if number <= 0 else f"another tool has {number}"
            )
            number = free
            losses.append(
                Loss(
                    kind=LossKind.ASSUMED,
                    tool=cutter.tool.name,
                    field="number",
                    value=number,
                    why=why,
                )
            )
        used.add(number)
        numbers.append(number)
    return numbers, tuple(losses)
