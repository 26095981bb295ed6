"""Which reamers, boring bars and taps fit bores that a fit or a thread is demanded of, and how wide such a bore is before them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.model.feature import Feature
from trunnion.model.material import Material
from trunnion.model.tool import Tool
from trunnion.plan.holes.demand import fits_within, needs_reaming
from trunnion.plan.holes.drive import FINE_BORE, REAM, TAP
from trunnion.plan.holes.hole import HoleShape, HoleThread, PlannedHole
from trunnion.plan.holes.settings import (
    FineBoringSettings,
    HoleSettings,
    ReamSettings,
    TapSettings,
    ThreadMillSettings,
)
from trunnion.plan.holes.tools import HoleSpace, either
from trunnion.plan.tool_choice import Candidates
from trunnion.settings import Value, choose
from trunnion.shop import Shop
from trunnion.units import trimmed

THROUGH_TAPS, BLIND_TAPS = "tap_through", "tap_blind"
"""Uses of taps: chips go on ahead of a spiral point, out of a through hole, and back along spiral flutes, out of a blind one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BoreFinish:
    """What comes after a bore: reaming, boring or tapping (`kind`), with the tools for it; `before` is the bore as drills and end mills
    make it, and a drill's diameter may differ from it by `spare` mm."""

    kind: str
    found: Candidates
    before: PlannedHole
    spare: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FinishSettings:
    """What a shop may choose of what comes after a bore."""

    reaming: ReamSettings
    boring: FineBoringSettings
    tapping: TapSettings
    thread_milling: ThreadMillSettings

    @staticmethod
    def of(choices: Mapping[str, Value]) -> FinishSettings:
        """Return them by a session's settings (full keys)."""
        return FinishSettings(
            reaming=choose(ReamSettings, choices),
            boring=choose(FineBoringSettings, choices),
            tapping=choose(TapSettings, choices),
            thread_milling=choose(ThreadMillSettings, choices),
        )


def bore_finish(
    feature: Feature,
    shape: HoleShape,
    tools_of: Callable[[str], Sequence[Tool]],
    around: HoleSpace,
    settings: FinishSettings,
    material: Material,
    shop: Shop,
) -> BoreFinish | None:
    """Return what a hole's demand asks for after its bore is made, None where a drill or an end mill is enough.

    `tools_of` returns the cutters for a use. A bore that no reamer fits is made to its nominal size at once: `found` says why.
    """
    bore, thread = shape.bore, shape.thread
    if thread is not None:
        taps = tools_of(THROUGH_TAPS if bore.through else BLIND_TAPS)
        found = taps_for(shape.narrow, thread, taps, around, settings.tapping)
        return BoreFinish(kind=TAP, found=found, before=bore)
    if not needs_reaming(feature, shop):
        return None
    reamers = tools_of("ream")
    fits = fits_within(feature, sorted({t.fit for t in reamers if t.fit}), shop)
    fit = str(feature.attributes["fit"])
    kind, table = REAM, shop.reaming_for(material)
    found = reamers_for(shape.narrow, fit, fits, reamers, around, settings.reaming)
    if not found.tools:
        bars = bars_for(shape.narrow, fit, tools_of("bore"), around, settings.boring)
        if not bars.tools:
            return BoreFinish(kind=REAM, found=either(found, bars), before=bore)
        kind, found, table = FINE_BORE, bars, shop.boring_for(material)
    least, most = table.allowance(bore.diameter)
    narrower = replace(bore, diameter=bore.diameter - least)
    return BoreFinish(kind=kind, found=found, before=narrower, spare=most - least)


def drill_tolerance(finish: BoreFinish | None, settings: HoleSettings) -> float:
    """Return by how much (mm) a drill's diameter may differ from that of a bore as it is before its finish."""
    return max(settings.diameter_tolerance, 0.0 if finish is None else finish.spare)


def finish_tip(hole: PlannedHole, tool: Tool, breakthrough: float) -> float:
    """Return how deep the tip of a reamer or a boring bar goes: past the end of a through hole with its lead, else to where the bore's full
    diameter ends."""
    if hole.through:
        return hole.bottom - tool.lead - breakthrough
    return hole.bottom


def tap_tip(hole: PlannedHole, thread: HoleThread, tool: Tool, settings: TapSettings) -> float:
    """Return how deep a tap's tip goes: full threads come up to its lead only.

    To the thread's depth where one is demanded, else past the end of a through hole; in a blind one it stays over the bottom.
    """
    if hole.through:
        deepest = hole.bottom - tool.lead - settings.breakthrough
    else:
        deepest = hole.bottom + settings.bottom_distance
    if thread.depth <= 0.0:
        return deepest
    return max(hole.top - thread.depth - tool.lead, deepest)


def thread_end(hole: PlannedHole, tip: float, tool: Tool) -> float:
    """Return how deep the thread is full below where the bore begins, mm, when a tap's tip has been at a height."""
    return hole.top - max(tip + tool.lead, hole.bottom)


def is_tap_of(tool: Tool, thread: HoleThread) -> bool:
    """Return whether a tap cuts a thread."""
    return (
        abs(tool.diameter - thread.diameter) <= tolerance.COINCIDENT
        and abs(tool.pitch - thread.pitch) <= tolerance.COINCIDENT
    )


def taps_for(
    hole: PlannedHole,
    thread: HoleThread,
    tools: Sequence[Tool],
    around: HoleSpace,
    settings: TapSettings,
) -> Candidates:
    """Return the taps that cut a bore's thread, the shortest first; each test that leaves none says what would be needed."""
    size = f"D {trimmed(thread.diameter, 3)} with a pitch of {trimmed(thread.pitch, 4)} mm"
    where = "through" if hole.through else "blind"
    same = [t for t in tools if is_tap_of(t, thread)]
    if not same:
        return Candidates(
            tools=(),
            reason=f"the catalogue has no tap for {where} holes of {size}",
            remedy="add one to the tools folder",
        )
    tips = {t.name: tap_tip(hole, thread, t, settings) for t in same}
    deep = [
        t
        for t in same
        if thread_end(hole, tips[t.name], t) >= thread.depth - tolerance.SEW
        and thread_end(hole, tips[t.name], t) > 0.0
    ]
    if not deep:
        most = max(thread_end(hole, tips[t.name], t) for t in same)
        return Candidates(
            tools=(),
            reason=f"its bore is too short: {trimmed(max(most, 0.0), 2)} mm of it get full threads of {size}, "
            f"what is over the bottom goes to the tap's lead",
            remedy="drill deeper by changing the part, demand a shorter thread, or add a tap with a shorter lead to the tools folder",
        )
    free = [t for t in deep if around.has_space(hole, t, tips[t.name])]
    if not free:
        return Candidates(
            tools=(),
            reason=f"shank or holder of every tap of {size} would come too near to the hole or what stands around it",
            remedy="add a longer tap to the tools folder",
            hindered=True,
        )
    return Candidates(tools=tuple(sorted(free, key=lambda t: (t.stickout, t.name))))


def reamers_for(
    hole: PlannedHole,
    fit: str,
    fits: Collection[str],
    tools: Sequence[Tool],
    around: HoleSpace,
    settings: ReamSettings,
) -> Candidates:
    """Return the reamers that make a bore to its fit, the shortest first; each test that leaves none says what would be needed.

    `fits` are the classes whose limits lie within those of the `fit`.
    """
    size = f"D {trimmed(hole.diameter, 3)} {fit}"
    same = [
        t
        for t in tools
        if t.fit in fits and abs(t.diameter - hole.diameter) <= tolerance.COINCIDENT
    ]
    if not same:
        return Candidates(
            tools=(),
            reason=f"the catalogue has no reamer of {size}",
            remedy=f"add a reamer of {size} to the tools folder",
        )
    tips = {t.name: finish_tip(hole, t, settings.breakthrough) for t in same}
    free = [t for t in same if around.has_space(hole, t, tips[t.name])]
    if not free:
        return Candidates(
            tools=(),
            reason=f"shank or holder of every reamer of {size} would come too near to what stands around it",
            remedy=f"add a longer reamer of {size} to the tools folder",
            hindered=True,
        )
    return Candidates(tools=tuple(sorted(free, key=lambda t: (t.stickout, t.name))))


def bars_for(
    hole: PlannedHole,
    fit: str,
    tools: Sequence[Tool],
    around: HoleSpace,
    settings: FineBoringSettings,
) -> Candidates:
    """Return the boring bars set to a bore's diameter, the shortest first; each test that leaves none says what would be needed."""
    size = f"D {trimmed(hole.diameter, 3)}"
    same = [
        set_to(t, hole.diameter, fit)
        for t in tools
        if t.smallest - tolerance.COINCIDENT <= hole.diameter <= t.diameter + tolerance.COINCIDENT
    ]
    if not same:
        return Candidates(
            tools=(),
            reason=f"no boring bar of the catalogue is set to {size}",
            remedy=f"add a boring bar for {size} to the tools folder",
        )
    free = [
        t for t in same if around.has_space(hole, t, finish_tip(hole, t, settings.breakthrough))
    ]
    if not free:
        return Candidates(
            tools=(),
            reason=f"head or holder of every boring bar for {size} would come too near to what stands around it",
            remedy=f"add a longer boring bar for {size} to the tools folder",
            hindered=True,
        )
    return Candidates(tools=tuple(sorted(free, key=lambda t: (t.stickout, t.name))))


def set_to(tool: Tool, diameter: float, fit: str) -> Tool:
    """Return a boring bar that is set to a bore's diameter, for a fit."""
    return replace(tool, name=f"{tool.name} at D{trimmed(diameter, 3)}", diameter=diameter, fit=fit)
