"""Setups of a panel on its edges, for what opens there: one for each direction that features look in, as far as the machine takes it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.model.setup import Setup
from trunnion.plan.feasibility import too_large
from trunnion.plan.holes.hole import is_plain_through
from trunnion.plan.setups import SetupSettings, level_direction, on_edge
from trunnion.shop import Shop


def with_edges(
    setups: Sequence[Setup],
    features: Sequence[Feature],
    recognition: Recognition,
    blank: Blank,
    shop: Shop,
    settings: SetupSettings,
) -> Sequence[Setup]:
    """Return setups with those on edges that features need after them. What goes through asks for none where one looks along it already;
    one that the machine does not take is left out."""
    wanted: list[Floats] = []
    for goes_through in (False, True):
        for feature in features:
            out = level_direction(feature)
            if (
                out is not None
                and _goes_through(feature) is goes_through
                and not any(_looks(out, other, goes_through) for other in wanted)
            ):
                wanted.append(out)
    found = list(setups)
    own = replace(settings, machine=setups[0].machine)
    for out in wanted:
        setup = on_edge(blank, recognition.frame, out, own, len(found))
        if not too_large(blank, (setup,), shop):
            found.append(setup)
    return found


def number_on_edge(
    feature: Feature, setups: Sequence[Setup], recognition: Recognition
) -> int | None:
    """Return the number of the setup, from 0, that reaches a feature at an edge; None where there is none, or it opens at no edge."""
    out = level_direction(feature)
    if out is None:
        return None
    looks = [recognition.frame.local_direction(s.frame.z) for s in setups]
    senses = (False, True) if _goes_through(feature) else (False,)
    return next(
        (n for either in senses for n, z in enumerate(looks) if _looks(out, z, either)), None
    )


def lost_on_edges(
    features: Iterable[Feature], setups: Sequence[Setup], recognition: Recognition
) -> dict[str, str]:
    """Return for each feature at an edge that no setup reaches why, by its id."""
    return {
        f.id: "it opens at an edge, and the machine does not take the part standing on the other one"
        for f in features
        if level_direction(f) is not None and number_on_edge(f, setups, recognition) is None
    }


def _goes_through(feature: Feature) -> bool:
    return is_plain_through(feature) if feature.kind == "hole" else not feature.with_role("floor")


def _looks(out: Floats, other: Floats, either: bool) -> bool:
    cosine = float(out @ other)
    return (abs(cosine) if either else cosine) > math.cos(tolerance.ANGLE)
