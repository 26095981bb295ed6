"""What is assumed of a tool where a library says nothing: values on the safe side, each told.

A tool that stands out too little, cuts with too few teeth or has a point too long costs time; the other way it costs a collision. Where no
assumption is safe (the pitch of a tap, the angle of a taper) the tool is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.tool import BORING_BAR, BUTTON, REAMER, TAP, THREAD_MILL, Holder
from trunnion.model.tool.drill import point_height
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.shop.cutters import (
    END_MILL,
    ISO_GROUPS,
    LARGEST,
    WITHOUT_CORNER,
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
    Plain,
    ReadTools,
)
from trunnion.shop.exchange.description import ToolDescription
from trunnion.shop.exchange.fields import plain
from trunnion.shop.exchange.scaling import without_noise
from trunnion.shop.reading import CatalogueEntry
from trunnion.units import trimmed

FLUTES = 2.0
"""Flute length over diameter: no longer than short end mills and drills have it (DIN 6527, DIN 6537 short)."""
POINT_ANGLE = 118.0
"""Degrees: the longest of the usual points of drills (type N, DIN 1414)."""
TEETH = 2
"""The fewest usual ones: feeds are given a tooth."""
REAMER_LEAD = 0.1
"""Lead of a reamer over its diameter; leads after DIN 212 are shorter."""
TAP_LEAD = 5.0
"""Lead of a tap in pitches: that of form B (DIN 2197), the longest of machine taps."""
TAP_LEAD_SHARE = 0.5
"""The most that a lead takes of a tap's thread."""
NOSE = 0.2
"""mm: the nose of a boring bar's insert, ISO 1832 corner 02."""
BAR = 0.9
"""Thickness of a boring bar, and of a tap's neck, over the bore that it goes into."""
FIT = "H7"
"""The class of holes that reamers are usually made for (DIN 1420)."""


@dataclass(frozen=True, slots=True)
class ToolResult:
    """A described tool made whole: the cutter, or None where it was left out, and what was assumed and ignored."""

    cutter: Cutter | None
    losses: tuple[Loss, ...]
    why: str = ""


@dataclass(slots=True)
class _Filling:
    """The values of one tool while what is missing is filled in."""

    values: dict[str, Any]
    assumed: dict[str, tuple[Plain, str]]

    def has(self, name: str) -> bool:
        return name in self.values

    def fill(self, name: str, value: Any, why: str) -> None:
        """Assume a value for a field that is missing."""
        if name not in self.values:
            self.correct(name, value, why)

    def correct(self, name: str, value: Any, why: str) -> None:
        """Assume a value for a field, whatever stands there."""
        self.values[name] = value
        self.assumed[name] = (plain(value), why)

    def length(self, name: str) -> float:
        return float(self.values[name])


_UNSAID = "the file doesn't say it"


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
    filling = _Filling(dict(description.values), dict(description.assumed))
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


def _fill(filling: _Filling, context: ExchangeContext, known: Mapping[str, Holder]) -> str:
    """Fill in what is missing; return why the tool can't be taken, or nothing."""
    filling.fill("form", END_MILL, _UNSAID)
    if not filling.has("diameter") or not filling.length("diameter") > 0.0:
        return "it gives no diameter above 0"
    if filling.length("diameter") > LARGEST:
        return f"its diameter is larger than {LARGEST:g} mm"
    wrong = _fill_shape(filling)
    if wrong:
        return wrong
    _fill_lengths(filling)
    _fill_holder(filling, context, known)
    _fill_stickout(filling)
    filling.fill(
        "teeth",
        1 if filling.values["form"] in (BUTTON, BORING_BAR) else TEETH,
        f"{_UNSAID}; few teeth give low feeds",
    )
    filling.fill("helix_angle", 0.0, _UNSAID)
    filling.fill(
        "centre_cutting",
        filling.values["form"] == "drill",
        f"{_UNSAID}; such a tool enters from outside or by a ramp",
    )
    filling.fill("suits", ISO_GROUPS, "the file doesn't say which materials it is for")
    filling.fill(
        "use",
        usual_use(filling.values["form"]) or ("tap_through",),
        "what such a tool is usually for",
    )
    return ""


def _fill_shape(filling: _Filling) -> str:
    """Fill in what only one kind has; return what no assumption is safe for, or nothing."""
    kind = str(filling.values["form"])
    if kind not in WITHOUT_CORNER:
        filling.fill("corner_radius", 0.0, f"{_UNSAID}; taken for a sharp corner")
    own: dict[str, Callable[[_Filling], str]] = {
        "taper": lambda f: "" if f.has("taper_angle") else "it gives no taper angle",
        "barrel": lambda f: "" if f.has("barrel_radius") else "it gives no radius of its flank",
        "form": lambda f: "" if f.has("outline") else "it gives no outline",
        "drill": _fill_drill,
        REAMER: _fill_reamer,
        BORING_BAR: _fill_boring_bar,
        TAP: _fill_tap,
        THREAD_MILL: _fill_thread_mill,
    }
    return own[kind](filling) if kind in own else ""


def _fill_drill(filling: _Filling) -> str:
    filling.fill("point_angle", POINT_ANGLE, _UNSAID)
    return ""


def _fill_reamer(filling: _Filling) -> str:
    filling.fill("lead", REAMER_LEAD * filling.length("diameter"), _UNSAID)
    filling.fill("fit", FIT, f"{_UNSAID}; usual for reamers")
    return ""


def _fill_boring_bar(filling: _Filling) -> str:
    filling.fill(
        "smallest", filling.length("diameter"), f"{_UNSAID}; taken for set to its diameter alone"
    )
    filling.fill("lead", NOSE, _UNSAID)
    return ""


def _fill_tap(filling: _Filling) -> str:
    if not filling.has("pitch") or not filling.length("pitch") > 0.0:
        return "it gives no pitch"
    lead = TAP_LEAD * filling.length("pitch")
    if filling.has("flute_length"):
        lead = min(lead, TAP_LEAD_SHARE * filling.length("flute_length"))
    filling.fill("lead", lead, f"{_UNSAID}; a long one, that of form B after DIN 2197")
    return ""


def _fill_thread_mill(filling: _Filling) -> str:
    ranged = filling.has("pitch_low") and filling.has("pitch_high")
    return "" if filling.has("pitch") or ranged else "it gives no pitch"


def _fill_lengths(filling: _Filling) -> None:
    """Fill in flutes, neck and shank; lengths that contradict each other are set right on the short side."""
    values, diameter = filling.values, filling.length("diameter")
    least = _least_flutes(values)
    filling.fill(
        "flute_length",
        max(FLUTES * diameter, least),
        f"{_UNSAID}; short for a tool of its diameter",
    )
    flutes = filling.length("flute_length")
    filling.fill("neck_length", flutes, f"{_UNSAID}; taken for no neck")
    if filling.length("neck_length") < flutes:
        filling.correct("neck_length", flutes, "the file's neck ends below its flutes")
    if not filling.has("neck_diameter"):
        if values["form"] == THREAD_MILL and filling.length("neck_length") > flutes:
            filling.correct("neck_length", flutes, "the file doesn't say how thick its neck is")
        filling.fill("neck_diameter", _neck(values), _UNSAID)
    filling.fill("shank_diameter", diameter, f"{_UNSAID}; taken for as thick as its diameter")


def _least_flutes(values: dict[str, Any]) -> float:
    """Return how long flutes must be at least for what is known of a tool's end."""
    diameter = float(values["diameter"])
    if values["form"] == "drill" and 0.0 < float(values["point_angle"]) <= 180.0:
        return point_height(diameter, float(values["point_angle"])) + diameter
    if values["form"] == "form":
        return float(values["outline"][-1][1])
    return 0.0


def _neck(values: dict[str, Any]) -> float:
    diameter = float(values["diameter"])
    if values["form"] == TAP:
        core = basic_minor_diameter(diameter, float(values["pitch"]))
        return without_noise(BAR * max(core, 0.0))
    if values["form"] == BORING_BAR:
        return without_noise(BAR * float(values["smallest"]))
    return diameter


def _fill_holder(filling: _Filling, context: ExchangeContext, known: Mapping[str, Holder]) -> None:
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


def _fill_stickout(filling: _Filling) -> None:
    """Fill in how far the tool stands out: by its gauge length where that is known, else as little as it can."""
    neck, holder = filling.length("neck_length"), filling.values["holder"]
    if not filling.has("stickout") and filling.has("gauge_length"):
        rest = filling.length("gauge_length") - holder.length
        if rest >= neck:
            filling.correct("stickout", rest, "the gauge length less the height of the holder")
            return
    filling.fill("stickout", neck, f"{_UNSAID}; the least that such a tool stands out")
    if filling.length("stickout") < neck:
        filling.correct("stickout", neck, "the file's holder begins below the end of the neck")
    if filling.has("gauge_length"):
        whole = filling.length("stickout") + holder.length
        if abs(filling.length("gauge_length") - whole) > tolerance.COINCIDENT:
            filling.assumed["gauge_length"] = (
                whole,
                "the file's length doesn't go with the holder",
            )


def _name(filling: _Filling, taken: Collection[str]) -> None:
    """Give the tool a name that no other has, and a title."""
    values = filling.values
    if not values.get("name"):
        words = f"T{values['number']}" if values.get("number") else str(values["form"])
        filling.correct("name", f"{words} D{trimmed(filling.length('diameter'), 3)}", _UNSAID)
    name, tried = str(values["name"]), 1
    while values["name"] in taken:
        tried += 1
        filling.correct("name", f"{name} ({tried})", "another tool of the file has its name")
    if not values.get("title"):
        filling.correct("title", values["name"], f"{_UNSAID}; its name stands there")
