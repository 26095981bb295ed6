"""How similar two parts are by their signatures, with the reason in words.

    s = 0                                                        for parts of different families
    s = (5 h + 3 z + m + k) / 10                                 for parts of the same

    h = (sum of min(a_i, b_i) / sum of max(a_i, b_i)             features a_i and b_i of each kind in either part
         + mean of min(a_i, b_i) / max(a_i, b_i)) / 2
    z = mean of min(a_j, b_j) / max(a_j, b_j)                    sizes a_j and b_j of each name, 0 where only one part has it
    m = 1 for the same material, 3/4 for the same ISO 513 group, else 0
    k = 1 for the same kind of machine, else 0

The first half of h is the Ruzicka similarity, the Jaccard index of weighted sets (Cha 2007, "Comprehensive survey on distance/similarity
measures between probability density functions", equation 12); the second takes each kind alone, so that a hundred holes do not hide that
the bosses are others. Both fall with every feature that one part has more than the other. A size enters by
exp(-|ln(a/b)|), the smaller over the larger, which counts alike in either direction, so s is symmetric; it is 1 for equal signatures and
lies between 0 and 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from trunnion.shop.library.signature import PartSignature
from trunnion.units import percent, trimmed

FEATURES, SIZES, MATERIAL, MACHINE = 5.0, 3.0, 1.0, 1.0
"""Weights of features, sizes, material and machine: a plan follows from the features first. Whole numbers add up exactly."""
SAME_GROUP = 0.75
"""What another material of the same ISO 513 group counts: stages and cutters stay, cutting data are computed anew."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Similarity:
    """How similar two parts are, from 0 to 1, and why in words."""

    value: float
    reasons: tuple[str, ...]

    @property
    def words(self) -> str:
        """The reasons as one sentence part."""
        return ", ".join(self.reasons)


def similarity(one: PartSignature, other: PartSignature) -> Similarity:
    """Return how similar two parts are; see the module for the formula."""
    if one.family != other.family:
        return Similarity(
            value=0.0, reasons=(f"parts of different families ({one.family}, {other.family})",)
        )
    total = (
        FEATURES * common_share(one.features, other.features)
        + SIZES * size_ratio(one.sizes, other.sizes)
        + MATERIAL * _material(one, other)
        + MACHINE * float(one.machine == other.machine)
    )
    reasons = (
        _feature_words(one.features, other.features),
        _size_words(one.sizes, other.sizes),
        _material_words(one, other),
        _machine_words(one, other),
    )
    return Similarity(
        value=total / (FEATURES + SIZES + MATERIAL + MACHINE),
        reasons=tuple(r for r in reasons if r),
    )


def common_share(one: Mapping[str, int], other: Mapping[str, int]) -> float:
    """Return how similar two histograms are, taken as a whole and kind by kind; 1 where both are empty.

    >>> common_share({"pocket": 4, "hole": 4}, {"pocket": 2})
    0.25
    """
    most = _total(one, other, max)
    return 0.5 * (_total(one, other, min) / most + _mean_ratio(one, other)) if most else 1.0


def size_ratio(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Return the mean of the smaller over the larger of each size, 0 for one that only one part has; 1 where neither has any.

    >>> size_ratio({"length": 100.0, "width": 50.0}, {"length": 50.0, "width": 50.0})
    0.75
    """
    return _mean_ratio(one, other) if one or other else 1.0


def _mean_ratio(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Return the mean of the smaller over the larger of values above 0 by name, 0 for one that is in one of the mappings only."""
    ratios = [
        min(one[name], other[name]) / max(one[name], other[name])
        if name in one and name in other
        else 0.0
        for name in sorted({*one, *other})
    ]
    return math.fsum(ratios) / len(ratios)


def _total(
    one: Mapping[str, int], other: Mapping[str, int], pick: Callable[[int, int], int]
) -> int:
    return sum(pick(one.get(kind, 0), other.get(kind, 0)) for kind in {*one, *other})


def _material(one: PartSignature, other: PartSignature) -> float:
    if one.material == other.material:
        return 1.0
    return SAME_GROUP if one.material_group == other.material_group else 0.0


def _feature_words(one: Mapping[str, int], other: Mapping[str, int]) -> str:
    kinds = {*one, *other}
    common = {kind for kind in kinds if one.get(kind, 0) and other.get(kind, 0)}
    same, most = _total(one, other, min), _total(one, other, max)
    return (
        f"{len(common)} of {len(kinds)} kinds of features and {same} of {most} features in common"
    )


def _size_words(one: Mapping[str, float], other: Mapping[str, float]) -> str:
    """Return how far apart the sizes are that both parts have, naming the one that differs most."""
    common = sorted(set(one) & set(other))
    if not common:
        return "no size in common" if one or other else ""
    apart = {
        name: max(one[name], other[name]) / min(one[name], other[name]) - 1.0 for name in common
    }
    most = max(common, key=lambda name: (apart[name], name))
    alone = sorted(set(one) ^ set(other))
    only = f", only one has a {', '.join(map(_spoken, alone))}" if alone else ""
    if apart[most] < SAME_SIZE:
        return f"the same sizes{only}"
    return (
        f"sizes within {percent(apart[most])} ({_spoken(most)} {trimmed(one[most], 2)} and "
        f"{trimmed(other[most], 2)} mm){only}"
    )


SAME_SIZE = 0.0005
"""Sizes that differ by a smaller share are called the same: a whole per mille is more than the noise of measuring."""


def _spoken(name: str) -> str:
    return name.replace("_", " ")


def _material_words(one: PartSignature, other: PartSignature) -> str:
    if one.material == other.material:
        return f"the same material ({one.material})"
    if one.material_group == other.material_group:
        return f"the same material group {one.material_group} ({one.material}, {other.material})"
    return f"another material group ({one.material_group}, {other.material_group})"


def _machine_words(one: PartSignature, other: PartSignature) -> str:
    if one.machine == other.machine:
        return f"the same kind of machine ({one.machine})"
    return f"another kind of machine ({one.machine}, {other.machine})"
