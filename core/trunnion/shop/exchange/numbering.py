"""Numbers and names that only one tool has: of tools in libraries that need a number for each, and of what is taken over."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from trunnion.model.tool import Holder
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


class FreeNames:
    """Gives each name once: what comes again gets ` (2)`, ` (3)` ... behind it."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)
        self._tried: dict[str, int] = {}

    def take(self, name: str) -> str:
        """Return a name that is free from now on no more."""
        tried, found = self._tried.get(name, 1), name
        while found in self._taken:
            tried += 1
            found = f"{name} ({tried})"
        self._tried[name] = tried
        self._taken.add(found)
        return found


class HolderNames:
    """Gives holders names: the same one to the same shape, another one to another shape of a name that is taken."""

    def __init__(self, known: Mapping[str, Holder]) -> None:
        self._names = FreeNames(known)
        self._given = {(h.name, h.rows): h.name for h in known.values()}

    def knows(self, holder: Holder) -> bool:
        """Return whether a holder of this name and shape has been met."""
        return (holder.name, holder.rows) in self._given

    def take(self, holder: Holder) -> str:
        """Return the name that a holder goes under."""
        key = (holder.name, holder.rows)
        if key not in self._given:
            self._given[key] = self._names.take(holder.name)
        return self._given[key]
