"""How long the finishing of areas takes, by area over area rate, and what cutters of their own gain: the paper's arithmetic on this plan.

Before toolpaths are made a cutter's area rate is its feed times the distance of its passes on a plane; the moves between passes, leads and
the machine's acceleration are not in it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.estimate.efficiency import AreaRate, gain, saving
from trunnion.units import SECONDS_PER_MINUTE

FINISH = "finish"
"""Kind of the operations that finish whole areas of curved faces."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AreaTime:
    """An operation that finishes an area: mm2, the area rate of its cutter in mm2/s, and the time in s that follows."""

    operation: str
    tool: str
    area: float
    rate: float
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """The times of all areas, and how long the slowest of their cutters would take alone (s), with the gain as the paper has it."""

    areas: tuple[AreaTime, ...]
    seconds: float
    alone: str
    seconds_alone: float
    gain: float
    saving: float


def estimate_of(process: ProcessTree, area: Floats) -> Estimate | None:
    """Return the estimate for a plan, by the area (n,) mm2 of face row = tag - 1; None where no area of curved faces is finished.

    A face that several operations finish, one its steep positions and one the others, counts in equal parts, so that none counts twice.
    """
    finishing = [o for o in process.operations if o.kind == FINISH and not o.suppressed and o.faces]
    if not finishing:
        return None
    rows = [np.array(o.faces) - 1 for o in finishing]
    shared = area / np.maximum(np.bincount(np.concatenate(rows), minlength=len(area)), 1)
    times = tuple(
        _time(o, float(shared[of_it].sum())) for o, of_it in zip(finishing, rows, strict=True)
    )
    return _summed(times)


def measured(estimate: Estimate, seconds: Mapping[str, float]) -> Estimate:
    """Return the estimate with the seconds that the operations' own toolpaths take, by operation, where they are known."""
    times = tuple(
        AreaTime(operation=t.operation, tool=t.tool, area=t.area, seconds=s, rate=t.area / s)
        if s > 0.0
        else t
        for t in estimate.areas
        for s in (seconds.get(t.operation, 0.0),)
    )
    return _summed(times)


def _summed(times: tuple[AreaTime, ...]) -> Estimate:
    slowest = min(times, key=lambda t: t.rate)
    alone = AreaRate(area=slowest.rate, time=1.0).seconds(sum(t.area for t in times))
    total = sum(t.seconds for t in times)
    return Estimate(
        areas=times,
        seconds=total,
        alone=slowest.tool,
        seconds_alone=alone,
        gain=gain(alone, total),
        saving=saving(alone, total),
    )


def _time(operation: Operation, area: float) -> AreaTime:
    rate = operation.data.feed * operation.data.width / SECONDS_PER_MINUTE
    return AreaTime(
        operation=operation.id, tool=operation.tool.name, area=area, rate=rate, seconds=area / rate
    )
