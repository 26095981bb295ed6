"""What a drawing demands of a hole beyond its shape: a fit of its bore or a thread in it, typed by a person or said by the part's file.

A demand stands on the hole's feature: the words `fit` or `thread` as attributes, and among the sizes what they mean in mm (`fit_lower`,
`fit_upper`; `thread_diameter`, `thread_pitch`, `thread_depth`, 0 for as deep as the bore allows). Nothing is guessed: a bore of 5 mm is no
M6 until somebody says so.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.feature import Feature, Recognition, Size
from trunnion.model.hole_demand import BoreDemand
from trunnion.plan.holes.hole import (
    THREAD_SIZES,
    bore_start,
    hole_direction,
    hole_size,
    thread_of,
)
from trunnion.plan.holes.settings import HoleDemand
from trunnion.recognize.holes.features import HOLE
from trunnion.shop import Shop
from trunnion.units import trimmed

FIT, THREAD = "fit", "thread"
"""Attributes of a hole: the fit of its bore, the thread in it, as a drawing writes them."""
SOURCE = "demanded"
"""Attribute of a hole: who made its demand, or said by hand that there is none."""
BY_HAND, BY_FILE = "by hand", "by the file"
FIT_SIZES = ("fit_lower", "fit_upper")
CORE_SLACK = 0.05
"""mm: a bore drawn by so much outside the limits of a thread's core is still taken for it; models round the sizes of tap drills."""
DRILLED_FIT = "H10"
"""A bore whose tolerance is at least as wide as this class's comes out of a drill or along a helix; a finer one is reamed."""


def fit_demand(words: str) -> HoleDemand:
    """Return the demand of a fit; without words of none."""
    return HoleDemand(fit=words, thread="", thread_depth=0.0)


def thread_demand(words: str, depth: float = 0.0) -> HoleDemand:
    """Return the demand of a thread, full down to a depth in mm, 0: as deep as may be; without words of none."""
    return HoleDemand(fit="", thread=words, thread_depth=depth)


def demand_of(feature: Feature) -> HoleDemand:
    """Return what is demanded of a hole."""
    fit, thread = (str(feature.attributes.get(name, "")) for name in (FIT, THREAD))
    return HoleDemand(fit=fit, thread=thread, thread_depth=hole_size(feature, "thread_depth"))


def demanded_by_person(feature: Feature) -> bool:
    """Return whether a person made a hole's demand, or said that there is none."""
    return feature.attributes.get(SOURCE) == BY_HAND


def demand_words(recognition: Recognition | None) -> tuple[tuple[str, HoleDemand], ...]:
    """Return what is demanded of holes, by the names of their features."""
    return tuple(
        (f.id, demand_of(f))
        for f in recognition or ()
        if f.kind == HOLE and (FIT in f.attributes or THREAD in f.attributes)
    )


def needs_reaming(feature: Feature, shop: Shop) -> bool:
    """Return whether the fit of a hole's bore is finer than what a drill or an end mill holds (`DRILLED_FIT`)."""
    if FIT not in feature.attributes:
        return False
    lower, upper = (hole_size(feature, name) for name in FIT_SIZES)
    limits = shop.fit_limits(DRILLED_FIT, hole_size(feature, "diameter"))
    return upper - lower < limits.width


def with_demand(
    recognition: Recognition, ids: Iterable[str], demand: HoleDemand, shop: Shop
) -> Recognition:
    """Return a recognition in which some holes have a demand that a person made, or none where its words are empty.

    Raises `BadInput` for what is no hole, a fit or a thread that nobody knows, and one that the bore's diameter does not suit.
    """
    wanted = tuple(dict.fromkeys(ids))
    known = {f.id: f for f in recognition}
    holes = [f.id for f in recognition if f.kind == HOLE]
    for id in wanted:
        if id not in known:
            raise BadInput(
                f"there is no feature {id}"
                + (f"; holes: {', '.join(holes)}" if holes else "; the part has no holes")
            )
        if known[id].kind != HOLE:
            raise BadInput(
                f"{id} is a {known[id].kind}: fits and threads are demanded of holes alone"
            )
    changed = {id: demanded(known[id], demand, shop, BY_HAND) for id in wanted}
    if all(changed[id] == known[id] for id in wanted):
        return recognition
    features = tuple(changed.get(f.id, f) for f in recognition.features)
    return replace(recognition, features=features)


def demanded(feature: Feature, demand: HoleDemand, shop: Shop, source: str) -> Feature:
    """Return a hole with a demand from a source (`BY_HAND`, `BY_FILE`) in the place of the one that it had.

    Raises `BadInput` as `with_demand` does.
    """
    if demand.fit and demand.thread:
        raise BadInput(
            f"{feature.id}: a bore has a fit or a thread, not both: take {demand.fit} or {demand.thread} away"
        )
    if demand.thread_depth > 0.0 and not demand.thread:
        raise BadInput(f"{feature.id}: a thread depth is of a thread: name the thread too")
    sizes = {k: v for k, v in feature.sizes.items() if k not in (*FIT_SIZES, *THREAD_SIZES)}
    attributes = {k: v for k, v in feature.attributes.items() if k not in (FIT, THREAD, SOURCE)}
    more = _fitted(feature, demand, shop) if demand.fit else {}
    more |= _threaded(feature, demand, shop) if demand.thread else {}
    words: dict[str, Size] = {k: v for k, v in more.items() if k in (FIT, THREAD)}
    words[SOURCE] = source
    numbers: dict[str, Size] = {k: v for k, v in more.items() if k not in (FIT, THREAD)}
    return replace(feature, sizes={**sizes, **numbers}, attributes={**attributes, **words})


def _fitted(feature: Feature, demand: HoleDemand, shop: Shop) -> dict[str, Size]:
    diameter = hole_size(feature, "diameter")
    try:
        limits = shop.fit_limits(demand.fit, diameter)
    except BadInput as reason:
        raise BadInput(f"{feature.id}: {reason}") from None
    return {FIT: demand.fit.strip(), "fit_lower": limits.lower, "fit_upper": limits.upper}


def _threaded(feature: Feature, demand: HoleDemand, shop: Shop) -> dict[str, Size]:
    diameter, deep = hole_size(feature, "diameter"), bore_depth(feature)
    try:
        thread = shop.thread(demand.thread)
    except BadInput as reason:
        raise BadInput(f"{feature.id}: {reason}") from None
    if not thread.core_low - CORE_SLACK <= diameter <= thread.core_high + CORE_SLACK:
        raise BadInput(
            f"{feature.id}: {thread.name} needs a bore of {trimmed(thread.core_low, 3)} to {trimmed(thread.core_high, 3)} mm, "
            f"its core, and this one has {trimmed(diameter, 3)} mm; choose the thread of this bore, or draw the bore at the core"
        )
    if demand.thread_depth > deep:
        raise BadInput(
            f"{feature.id}: a thread {trimmed(demand.thread_depth, 3)} mm deep does not fit into its bore of {trimmed(deep, 3)} mm"
        )
    return {
        THREAD: thread.name,
        "thread_diameter": thread.diameter,
        "thread_pitch": thread.pitch,
        "thread_depth": demand.thread_depth,
    }


def bore_depth(feature: Feature) -> float:
    """Return how long a hole's narrowest bore is, from the counterbore's floor where it has one, mm."""
    return hole_size(feature, "depth") - bore_start(feature)


def bore_demands(recognition: Recognition, shop: Shop) -> tuple[BoreDemand, ...]:
    """Return what the proof holds programs against: bores with threads, and those with a fit that is finer than a drill's."""
    fits = sorted({t.fit for t in shop.tools if t.fit})
    return tuple(
        _bore_demand(f, recognition, shop, fits)
        for f in recognition
        if f.kind == HOLE and (thread_of(f) is not None or needs_reaming(f, shop))
    )


def fits_within(feature: Feature, fits: Collection[str], shop: Shop) -> tuple[str, ...]:
    """Return the classes whose limits at a hole's diameter lie within those of its fit: a reamer of one of them makes it."""
    lower, upper = (hole_size(feature, name) for name in FIT_SIZES)
    diameter = hole_size(feature, "diameter")
    found = []
    for fit in fits:
        limits = shop.fit_limits(fit, diameter)
        if lower <= limits.lower and limits.upper <= upper:
            found.append(fit)
    return tuple(found)


def _bore_demand(
    feature: Feature, recognition: Recognition, shop: Shop, fits: Collection[str]
) -> BoreDemand:
    x, y, top, depth = (hole_size(feature, name) for name in ("x", "y", "top_z", "depth"))
    out, thread = hole_direction(feature), thread_of(feature)
    start = np.array([x, y, top]) - bore_start(feature) * out
    return BoreDemand(
        feature=feature.id,
        start=recognition.frame.to_world(start[None])[0],
        out=recognition.frame.world_direction(out),
        diameter=hole_size(feature, "diameter"),
        depth=depth - bore_start(feature),
        through=bool(feature.sizes.get("through", feature.attributes.get("through", False))),
        words=str(feature.attributes.get(THREAD if thread is not None else FIT, "")),
        thread_diameter=0.0 if thread is None else thread.diameter,
        pitch=0.0 if thread is None else thread.pitch,
        thread_depth=0.0 if thread is None else thread.depth,
        fits=() if thread is not None else fits_within(feature, fits, shop),
        faces=feature.with_role("side"),
    )
