"""How long the finishing of areas takes, by area over area rate, and what cutters of their own gain: the paper's arithmetic on this plan.

Like is compared with like. Alone, the smallest of the cutters finishes every area, steep and shallow places at its own rate for each: a
waterline is never held against parallel passes. What only larger cutters leave, it need not finish a second time.

Before toolpaths are made a cutter's area rate is its feed times the distance of its passes on a plane; the moves between passes, leads and
the machine's acceleration are not in it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.estimate.efficiency import AreaRate, gain, saving
from trunnion.units import SECONDS_PER_MINUTE

FINISH, REST_FINISH = "finish", "rest_finish"
"""Kinds of the operations that finish whole areas of curved faces, and what their cutters left of these."""

REMAINING_AREA, LOCAL_FEATURES = "remaining area", "local features"
"""What the totals of the two classes of groups are called."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PathFigures:
    """What an operation's toolpath takes: s by the machine's model of time, and how far its cutting passes go in mm."""

    seconds: float
    length: float


@dataclass(frozen=True, slots=True, kw_only=True)
class AreaTime:
    """An operation that finishes an area: mm2, the area rate of its cutter in mm2/s, the time in s that follows, and the time in s that the
    smallest cutter would take for it. A rest has no area of its own: it counts in those that leave it.
    """

    operation: str
    feature: str
    tool: str
    area: float
    rate: float
    seconds: float
    seconds_alone: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FeatureTime:
    """All that finishes a feature, a group or a class of groups: mm2, and s with cutters of their own and by the smallest cutter alone."""

    feature: str
    area: float
    seconds: float
    seconds_alone: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """The times of all areas and by feature, and how long the smallest of their cutters would take alone (s), with the gain as the paper
    has it."""

    areas: tuple[AreaTime, ...]
    totals: tuple[FeatureTime, ...]
    seconds: float
    alone: str
    seconds_alone: float
    gain: float
    saving: float


def estimate_of(
    process: ProcessTree,
    area: Floats,
    paths: Mapping[str, PathFigures] | None = None,
    groups: Mapping[str, Sequence[int]] | None = None,
    local: Collection[str] = (),
) -> Estimate | None:
    """Return the estimate for a plan, by the area (n,) mm2 of face row = tag - 1; None where no area of curved faces is finished.

    `paths` are the figures of the operations' own toolpaths, where they are there. A face that several operations finish, one its steep
    positions and one the others, counts so that none counts twice: by how far their passes go, in equal parts where that is not known.
    With the tags of all groups of patches, and which of them are local, totals are those of either class and of every group (the paper's
    figure 17); an operation's time goes to its faces by their area. Without them totals are those of the operations' features.
    """
    done = [o for o in process.operations if not o.suppressed and o.faces and o.tool.rotates]
    finishing = [o for o in done if o.kind == FINISH]
    if not finishing:
        return None
    known = paths or {}
    shares = _shared_areas(finishing, area, known)
    rates = [_rate(o, shares[o.id], known.get(o.id)) for o in finishing]
    smallest = min((o.cutter for o in finishing), key=lambda t: (t.diameter, t.corner_radius))
    alone = _SingleCutter(smallest.name, finishing, rates)
    times = [
        _time(o, shares[o.id], rate, alone.rate(o, rate))
        for o, rate in zip(finishing, rates, strict=True)
    ]
    times += [
        _rest_time(o, known[o.id], alone=o.cutter.diameter < smallest.diameter)
        for o in done
        if o.kind == REST_FINISH and o.id in known
    ]
    totals = (
        _group_totals(times, {o.id: o.faces for o in done}, area, groups, local)
        if groups
        else _feature_totals(times)
    )
    return _summed(tuple(times), totals, smallest.name)


def _shared_areas(
    finishing: Sequence[Operation], area: Floats, paths: Mapping[str, PathFigures]
) -> dict[str, float]:
    """Return the area (mm2) that each operation finishes, by its id: its share of each of its faces."""
    known = all(o.id in paths for o in finishing)
    weight = {o.id: paths[o.id].length if known else 1.0 for o in finishing}
    total = np.zeros(len(area))
    for o in finishing:
        total[np.array(o.faces) - 1] += weight[o.id]
    return {
        o.id: float((area[rows] * weight[o.id] / total[rows]).sum())
        for o in finishing
        for rows in (np.array(o.faces) - 1,)
    }


def _planned_rate(operation: Operation) -> float:
    return operation.data.feed * operation.data.width / SECONDS_PER_MINUTE


def _rate(operation: Operation, area: float, path: PathFigures | None) -> float:
    if path is None or path.seconds <= 0.0 or area <= 0.0:
        return _planned_rate(operation)
    return area / path.seconds


@dataclass(frozen=True, slots=True)
class _SingleCutter:
    """The smallest cutter at work on all areas: its name, all finishing operations and their area rates in mm2/s."""

    tool: str
    finishing: Sequence[Operation]
    rates: Sequence[float]

    def rate(self, operation: Operation, rate: float) -> float:
        """Return the cutter's rate where another one finishes: its own by the same strategy where it has one in the plan, else the other
        one's rate by how the planned ones differ."""
        if operation.cutter.name == self.tool:
            return rate
        same = [r for o, r in self._own() if o.strategy == operation.strategy]
        if same:
            return float(np.mean(same))
        planned = np.mean([_planned_rate(o) for o, _ in self._own()])
        return float(rate * planned / _planned_rate(operation))

    def _own(self) -> Iterator[tuple[Operation, float]]:
        pairs = zip(self.finishing, self.rates, strict=True)
        return ((o, r) for o, r in pairs if o.cutter.name == self.tool)


def _time(operation: Operation, area: float, rate: float, alone: float) -> AreaTime:
    return AreaTime(
        operation=operation.id,
        feature=operation.feature,
        tool=operation.tool.name,
        area=area,
        rate=rate,
        seconds=AreaRate(area=rate, time=1.0).seconds(area),
        seconds_alone=AreaRate(area=alone, time=1.0).seconds(area),
    )


def _rest_time(operation: Operation, path: PathFigures, *, alone: bool) -> AreaTime:
    """Return the time of what finishes a rest; a smaller cutter than the smallest of the areas' has it to do in either way."""
    return AreaTime(
        operation=operation.id,
        feature=operation.feature,
        tool=operation.tool.name,
        area=0.0,
        rate=0.0,
        seconds=path.seconds,
        seconds_alone=path.seconds if alone else 0.0,
    )


def _summed(times: tuple[AreaTime, ...], totals: tuple[FeatureTime, ...], alone: str) -> Estimate:
    own, by_one = sum(t.seconds for t in times), sum(t.seconds_alone for t in times)
    return Estimate(
        areas=times,
        totals=totals,
        seconds=own,
        alone=alone,
        seconds_alone=by_one,
        gain=gain(by_one, own),
        saving=saving(by_one, own),
    )


def _feature_totals(times: Sequence[AreaTime]) -> tuple[FeatureTime, ...]:
    features = dict.fromkeys(t.feature for t in times)
    return tuple(_total(f, [(t, 1.0) for t in times if t.feature == f]) for f in features)


def _group_totals(
    times: Sequence[AreaTime],
    faces: Mapping[str, Sequence[int]],
    area: Floats,
    groups: Mapping[str, Sequence[int]],
    local: Collection[str],
) -> tuple[FeatureTime, ...]:
    """Return the totals of the remaining area, of local features and of every group, without those that nothing finishes."""

    def total(name: str, ids: Collection[str]) -> FeatureTime:
        tags = {tag for id in ids for tag in groups[id]}
        return _total(name, [(t, _share(faces[t.operation], tags, area)) for t in times])

    found = [
        total(REMAINING_AREA, [id for id in groups if id not in local]),
        total(LOCAL_FEATURES, [id for id in groups if id in local]),
        *(total(id, [id]) for id in groups),
    ]
    return tuple(t for t in found if t.seconds > 0.0)


def _share(faces: Sequence[int], tags: Collection[int], area: Floats) -> float:
    """Return the share of the area of some faces that lies on those with the given tags."""
    rows = np.array(faces) - 1
    inside = np.array([tag in tags for tag in faces])
    return float(area[rows[inside]].sum() / area[rows].sum())


def _total(feature: str, shares: Sequence[tuple[AreaTime, float]]) -> FeatureTime:
    return FeatureTime(
        feature=feature,
        area=sum(t.area * share for t, share in shares),
        seconds=sum(t.seconds * share for t, share in shares),
        seconds_alone=sum(t.seconds_alone * share for t, share in shares),
    )
