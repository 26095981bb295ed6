"""What is assumed of a tool where a library says nothing: values on the safe side, each told.

A tool that stands out too little, cuts with too few teeth or has a point too long costs time; the other way it costs a collision. Where no
assumption is safe (the pitch of a tap, the angle of a taper) the tool is left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.tool import BORING_BAR, BUTTON, Holder
from trunnion.shop.cutters import (
    END_MILL,
    ISO_GROUPS,
    LARGEST,
    Cutter,
    cutter_of,
    holder_of,
    usual_use,
)
from trunnion.shop.exchange.contract import (
    WHOLE_TOOL,
    ExchangeContext,
    Loss,
    LossKind,
    ReadTools,
)
from trunnion.shop.exchange.description import ToolDescription
from trunnion.shop.exchange.fields import ONLY, plain
from trunnion.shop.exchange.numbering import FreeNames, HolderNames
from trunnion.shop.exchange.shape_assumptions import UNSAID, Filling, fill_lengths, fill_shape
from trunnion.shop.reading import CatalogueEntry
from trunnion.units import trimmed

TEETH = 2
"""The fewest usual ones: feeds are given a tooth."""


@dataclass(frozen=True, slots=True)
class ToolResult:
    """A described tool made whole: the cutter, or None where it was left out, and what was assumed and ignored."""

    cutter: Cutter | None
    losses: tuple[Loss, ...]
    why: str = ""


def read_tools(descriptions: Iterable[ToolDescription], context: ExchangeContext) -> ReadTools:
    """Return the tools of a file and what was lost; raise `BadInput` when none can be taken."""
    found = list(descriptions)
    done = all_completed(found, context)
    cutters = tuple(one.cutter for one in done if one.cutter is not None)
    if not cutters:
        if not found:
            raise BadInput("the file holds no tools")
        more = "; no other tool of the file can be taken either" if len(found) > 1 else ""
        raise BadInput(f"{found[0].source}: {done[0].why}{more}")
    return ReadTools(cutters=cutters, losses=tuple(loss for one in done for loss in one.losses))


def all_completed(
    descriptions: Iterable[ToolDescription], context: ExchangeContext
) -> list[ToolResult]:
    """Return the described tools of a file made whole, in their order, with names that differ."""
    library = _LibraryContext(context)
    return [_completed(description, library) for description in descriptions]


class _LibraryContext:
    """What is known while the tools of one library are made whole: names that are given away, and the catalogue's holders by shank."""

    def __init__(self, context: ExchangeContext) -> None:
        self.names, self.holders = FreeNames(), HolderNames(context.holders)
        self._selected = context.holders.get(context.holder)
        tools = (c.tool for c in context.cutters if not c.tool.locked)
        self._by_shank: dict[float, Holder] = {}
        for tool in sorted(tools, key=lambda t: t.holder.name):
            self._by_shank.setdefault(tool.shank_diameter, tool.holder)

    def holder_for(self, shank: float) -> tuple[Holder, str]:
        """Return the holder of a tool that comes without one, by the diameter of its shank in mm, and why it is this one."""
        if self._selected is not None:
            return self._selected, "as chosen; the file doesn't say it"
        if not self._by_shank:
            raise BadInput("the catalogue has no cutter whose holder could be assumed: name one")
        nearest = min(self._by_shank, key=lambda s: (abs(s - shank), s))
        why = "the file doesn't say it; what the catalogue holds the nearest shank with"
        return self._by_shank[nearest], why


def _completed(description: ToolDescription, library: _LibraryContext) -> ToolResult:
    """Return a described tool made whole, under a name that no other tool of the library has."""
    _ignore_of_other_kinds(description)
    filling = Filling(dict(description.values), dict(description.assumed))
    cutter, why = None, description.refusal
    try:
        why = why or _fill(filling, library)
    except BadInput as reason:
        why = str(reason)
    if not why:
        _name(filling)
        try:
            cutter = _made(filling.values, description.source)
        except BadInput as reason:
            why = (
                str(reason)
                .removeprefix(f"{description.source}: ")
                .removeprefix(f"{filling.values['name']}: ")
            )
    if cutter is None:
        left = Loss(
            kind=LossKind.OMITTED, tool=description.name, field=WHOLE_TOOL, value="", why=why
        )
        return ToolResult(None, (left,), why)
    name = library.names.take(cutter.tool.name)
    if name != cutter.tool.name:
        filling.correct("name", name, "another tool of the file has its name")
        cutter = replace(cutter, tool=replace(cutter.tool, name=name))
    assumed = tuple(
        Loss(kind=LossKind.ASSUMED, tool=name, field=field, value=value, why=reason)
        for field, (value, reason) in filling.assumed.items()
    )
    return ToolResult(cutter, (*assumed, *description.ignored(name)))


def _ignore_of_other_kinds(description: ToolDescription) -> None:
    """Take out what a file says of a tool and its kind doesn't have here, such as the pitch of an end mill."""
    kind = description.values.get("form", END_MILL)
    for name, kinds in ONLY.items():
        if name in description.values and kind not in kinds:
            description.assumed.pop(name, None)
            why = f"the catalogue has none of kind {kind}"
            description.ignore(name, description.values.pop(name), why)


def _made(values: dict[str, Any], source: str) -> Cutter:
    """Return the cutter by the rules of catalogue files."""
    holder: Holder = values["holder"]
    fields = {
        name: list(map(list, value))
        if name == "outline"
        else list(value)
        if isinstance(value, tuple)
        else value
        for name, value in values.items()
        if name not in ("name", "number", "gauge_length", "holder")
    }
    entry = CatalogueEntry(
        file=source, name=str(values["name"]), fields={**fields, "holder": holder.name}
    )
    cutter = cutter_of(entry, str(values["name"]), {holder.name: holder})
    return replace(cutter, tool=replace(cutter.tool, number=int(values.get("number", 0))))


def _fill(filling: Filling, library: _LibraryContext) -> str:
    """Fill in what is missing; return why the tool can't be taken, or nothing."""
    filling.fill("form", END_MILL, UNSAID)
    if not filling.has("diameter") or not filling.length("diameter") > 0.0:
        return "it gives no diameter above 0"
    if filling.length("diameter") > LARGEST:
        return f"its diameter is larger than {LARGEST:g} mm"
    wrong = fill_shape(filling)
    if wrong:
        return wrong
    fill_lengths(filling)
    _fill_holder(filling, library)
    _fill_stickout(filling)
    filling.fill(
        "teeth",
        1 if filling.values["form"] in (BUTTON, BORING_BAR) else TEETH,
        f"{UNSAID}; few teeth give low feeds",
    )
    filling.fill("helix_angle", 0.0, UNSAID)
    filling.fill(
        "centre_cutting",
        filling.values["form"] == "drill",
        f"{UNSAID}; such a tool enters from outside or by a ramp",
    )
    filling.fill("suits", ISO_GROUPS, "the file doesn't say which materials it is for")
    filling.fill(
        "use",
        usual_use(filling.values["form"]) or ("tap_through",),
        "what such a tool is usually for",
    )
    return ""


def _fill_holder(filling: Filling, library: _LibraryContext) -> None:
    """Fill in the holder of a tool without one; give a holder that comes with a tool a name that no other shape has."""
    own = filling.values.get("holder")
    if own is not None:
        if not library.holders.knows(own):
            check_holder(own)
        name = library.holders.take(own)
        if name != own.name:
            filling.values["holder"] = replace(own, name=name)
            filling.assumed["holder"] = (name, "another holder has the file's name for it")
        return
    holder, why = library.holder_for(filling.length("shank_diameter"))
    filling.values["holder"] = holder
    filling.assumed["holder"] = (holder.name, why)
    filling.assumed["holder_rows"] = (plain(holder.rows), why)


def check_holder(holder: Holder) -> None:
    """Raise `BadInput` for a holder that no catalogue file may hold."""
    fields = {"title": holder.name, "rows": [list(row) for row in holder.rows]}
    holder_of(CatalogueEntry(file="holder", name=holder.name, fields=fields))


def _fill_stickout(filling: Filling) -> None:
    """Fill in how far the tool stands out: by its gauge length where that is known, else as little as it can."""
    neck, holder = filling.length("neck_length"), filling.values["holder"]
    if not filling.has("stickout") and filling.has("gauge_length"):
        rest = filling.length("gauge_length") - holder.length
        if rest >= neck:
            filling.correct("stickout", rest, "the gauge length less the height of the holder")
            return
    filling.fill("stickout", neck, f"{UNSAID}; the least that such a tool stands out")
    if filling.length("stickout") < neck:
        filling.correct("stickout", neck, "the file's holder begins below the end of the neck")
    if filling.has("gauge_length"):
        whole = filling.length("stickout") + holder.length
        if abs(filling.length("gauge_length") - whole) > tolerance.COINCIDENT:
            filling.assumed["gauge_length"] = (
                whole,
                "the file's length doesn't go with the holder",
            )


def _name(filling: Filling) -> None:
    """Give a tool a name and a title where it has none."""
    values = filling.values
    if not values.get("name"):
        words = f"T{values['number']}" if values.get("number") else str(values["form"])
        filling.correct("name", f"{words} D{trimmed(filling.length('diameter'), 3)}", UNSAID)
    if not values.get("title"):
        filling.correct("title", values["name"], f"{UNSAID}; its name stands there")
