"""Fits and threads put on the holes that were recognised: what the part's file says of their faces, and what a person demanded before.

A person's demand goes before the file's, also on a part that was revised; one that a hole does not bear any more is told.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.findings import BadCall, BadInput, Finding, face_tags, remark, warning
from trunnion.model.dimension import DIAMETER, Dimension
from trunnion.model.feature import Feature, Recognition
from trunnion.model.session import Session
from trunnion.plan.holes.demand import (
    BY_FILE,
    BY_HAND,
    demand_of,
    demanded,
    demanded_by_person,
    fit_demand,
    thread_demand,
    with_demand,
)
from trunnion.plan.holes.hole import hole_size
from trunnion.plan.holes.settings import HoleDemand
from trunnion.recognize.holes.features import HOLE
from trunnion.shop import Shop
from trunnion.units import trimmed

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

DECIMALS = 5
"""Decimals of mm that limits from a file are written with: those of inch files come from conversion."""


def with_hole_demand(
    engine: Engine, session: Session, ids: Iterable[str], demand: HoleDemand
) -> Session:
    """Return the session with a demand on some holes, or none where its words are empty; raises `BadInput` as `with_demand` does."""
    if session.recognition is None:
        raise BadCall("no features yet: recognize first")
    after = with_demand(session.recognition, ids, demand, engine.context_of(session).shop)
    return session if after is session.recognition else replace(session, recognition=after)


def with_demands(
    found: Recognition, before: Recognition | None, dimensions: Sequence[Dimension], shop: Shop
) -> Recognition:
    """Return a recognition whose holes have the demands of the part's file, and those that a person made before a step ran again."""
    kept = [f for f in before or () if f.kind == HOLE and demanded_by_person(f)]
    if not kept and not dimensions:
        return found
    findings: list[Finding] = []
    features = tuple(
        _with_demand(f, kept, dimensions, shop, findings) if f.kind == HOLE and not f.by_hand else f
        for f in found.features
    )
    if features == found.features and not findings:
        return found
    return replace(found, features=features, findings=(*found.findings, *findings))


def _with_demand(
    feature: Feature,
    kept: Sequence[Feature],
    dimensions: Sequence[Dimension],
    shop: Shop,
    findings: list[Finding],
) -> Feature:
    earlier = next((f for f in kept if _is_same(f, feature)), None)
    if earlier is not None:
        try:
            return demanded(feature, demand_of(earlier), shop, BY_HAND)
        except BadInput as reason:
            findings.append(
                warning(
                    "recognize.demand-lost",
                    f"what was demanded of {feature.id} by hand does not hold any more: {reason}",
                    feature.id,
                    *face_tags(feature.tags),
                    remedy="demand it anew, or leave the hole without",
                )
            )
    side = set(feature.with_role("side"))
    for dimension in dimensions:
        if dimension.kind != DIAMETER or not side & set(dimension.faces):
            continue
        try:
            demand = _demand_in(dimension, feature)
            if demand.fit or demand.thread:
                return demanded(feature, demand, shop, BY_FILE)
        except BadInput as reason:
            findings.append(
                remark(
                    "recognize.demand-unused",
                    f"the file's {dimension.text or 'size'} is not taken up: {reason}",
                    feature.id,
                    *face_tags(dimension.faces),
                    remedy="type the fit or the thread of the hole, or leave it without",
                )
            )
    return feature


def _is_same(before: Feature, feature: Feature) -> bool:
    """Return whether most faces of a hole are those of one before, or the other way round."""
    common = len(set(before.tags) & set(feature.tags))
    return 2 * common > min(len(before.tags), len(feature.tags))


def _demand_in(dimension: Dimension, feature: Feature) -> HoleDemand:
    """Return what a file's dimension demands of a hole; raise `BadInput` where the hole is drawn with another diameter.

    Limits are taken about the diameter that is drawn, which lies between them: files give them from a size that may be another one.
    """
    diameter = hole_size(feature, "diameter")
    if dimension.thread:
        return thread_demand(dimension.thread)
    if dimension.fit or dimension.upper is None or dimension.lower is None:
        low = high = dimension.value
    else:
        low, high = dimension.value + dimension.lower, dimension.value + dimension.upper
    if not low - tolerance.SEW <= diameter <= high + tolerance.SEW:
        raise BadInput(
            f"{feature.id} is drawn with {trimmed(diameter, 3)} mm, not with {trimmed(dimension.value, 3)}"
        )
    if dimension.fit or low == high:
        return fit_demand(dimension.fit)
    return fit_demand(f"{_signed(high - diameter)}/{_signed(low - diameter)}")


def _signed(deviation: float) -> str:
    """Return a deviation in mm as drawings have it.

    >>> _signed(0.0), _signed(0.0205)
    ('0', '+0.0205')
    """
    words = trimmed(deviation, DECIMALS)
    return words if words == "0" or words.startswith("-") else "+" + words
