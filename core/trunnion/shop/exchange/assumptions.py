"""What is assumed of a tool where a library says nothing: values on the safe side, each told.

A tool that stands out too little, cuts with too few teeth or has a point too long costs time; the other way it costs a collision. Where no
assumption is safe (the pitch of a tap, the angle of a taper) the tool is left out.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
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
from trunnion.shop.exchange.fields import plain
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
    done: list[ToolResult] = []
    names: set[str] = set()
    known = dict(context.holders)
    for description in descriptions:
        one = _completed(description, context, known, names)
        if one.cutter is not None:
            names.add(one.cutter.tool.name)
            known[one.cutter.tool.holder.name] = one.cutter.tool.holder
        done.append(one)
    return done


def _completed(
    description: ToolDescription,
    context: ExchangeContext,
    known: Mapping[str, Holder],
    taken: Collection[str],
) -> ToolResult:
    """Return a described tool made whole. `known` are the holders whose names are given away, `taken` the names of tools that are."""
    filling = Filling(dict(description.values), dict(description.assumed))
    cutter, why = None, description.refusal
    try:
        why = why or _fill(filling, context, known)
    except BadInput as reason:
        why = str(reason)
    if not why:
        _name(filling, taken)
        try:
            cutter = _made(filling.values, description.source)
        except BadInput as reason:
            why = (
                str(reason)
                .removeprefix(f"{description.source}: ")
                .removeprefix(f"{filling.values['name']}: ")
            )
    name = cutter.tool.name if cutter else description.name
    if cutter is None:
        left = Loss(kind=LossKind.OMITTED, tool=name, field=WHOLE_TOOL, value="", why=why)
        return ToolResult(None, (left,), why)
    assumed = tuple(
        Loss(kind=LossKind.ASSUMED, tool=name, field=field, value=value, why=reason)
        for field, (value, reason) in filling.assumed.items()
    )
    return ToolResult(cutter, (*assumed, *description.ignored(name)))


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


def _fill(filling: Filling, context: ExchangeContext, known: Mapping[str, Holder]) -> str:
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
    _fill_holder(filling, context, known)
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


def _fill_holder(filling: Filling, context: ExchangeContext, known: Mapping[str, Holder]) -> None:
    """Fill in the holder: the one that is requested for, else that of the catalogue's cutter with the nearest shank."""
    own = filling.values.get("holder")
    if own is not None:
        if own.name not in known:
            check_holder(own)
        name = own.name
        tried = 1
        while name in known and known[name].rows != own.rows:
            tried += 1
            name = f"{own.name} ({tried})"
        if name != own.name:
            filling.values["holder"] = replace(own, name=name)
            filling.assumed["holder"] = (name, "another holder has the file's name for it")
        return
    if context.holder:
        selected, why = context.holders[context.holder], "as chosen; the file doesn't say it"
    else:
        selected = _nearest(filling.length("shank_diameter"), context)
        why = "the file doesn't say it; what the catalogue holds the nearest shank with"
    filling.values["holder"] = selected
    filling.assumed["holder"] = (selected.name, why)
    filling.assumed["holder_rows"] = (plain(selected.rows), why)


def check_holder(holder: Holder) -> None:
    """Raise `BadInput` for a holder that no catalogue file may hold."""
    fields = {"title": holder.name, "rows": [list(row) for row in holder.rows]}
    holder_of(CatalogueEntry(file="holder", name=holder.name, fields=fields))


def _nearest(shank: float, context: ExchangeContext) -> Holder:
    """Return the holder of the catalogue's milling or drilling cutter whose shank is nearest to one, mm."""
    cutters = [c.tool for c in context.cutters if not c.tool.locked]
    if not cutters:
        raise BadInput("the catalogue has no cutter whose holder could be assumed: name one")
    best = min(cutters, key=lambda t: (abs(t.shank_diameter - shank), t.holder.name))
    return best.holder


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


def _name(filling: Filling, taken: Collection[str]) -> None:
    """Give the tool a name that no other has, and a title."""
    values = filling.values
    if not values.get("name"):
        words = f"T{values['number']}" if values.get("number") else str(values["form"])
        filling.correct("name", f"{words} D{trimmed(filling.length('diameter'), 3)}", UNSAID)
    name, tried = str(values["name"]), 1
    while values["name"] in taken:
        tried += 1
        filling.correct("name", f"{name} ({tried})", "another tool of the file has its name")
    if not values.get("title"):
        filling.correct("title", values["name"], f"{UNSAID}; its name stands there")
