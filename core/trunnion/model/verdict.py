"""What the proof says of a program."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from trunnion.findings import Finding
from trunnion.geometry.arrays import Floats, Ints

Smalls: TypeAlias = npt.NDArray[np.float32]
Small: TypeAlias = npt.NDArray[np.int32]


CUTTING, AIR, RAPIDS, IDLE = "cutting", "air", "rapids", "tool changes"
"""Where machining time goes."""


class Outcome(StrEnum):
    """Passed; passed with remarks (released too); failed (never released)."""

    PASSED = "passed"
    REMARKS = "passed with remarks"
    FAILED = "failed"


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceProof:
    """What was measured on one face: deepest gouge, material left (smallest, mean, largest, mm), area and finished area (mm2)."""

    face: int
    area: float
    finished: float
    gouge: float
    left_min: float
    left_mean: float
    left_max: float
    planned: bool
    reachable: bool = True
    blank_surface: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class OperationProof:
    """What was measured on one operation.

    gouge: deepest, mm; gouges: deepest by face tag, of faces that are entered by more than can be measured, deepest first; collisions of
    shank, holder or anything with fixtures; time_s at the machine; removed mm3; air_share of its feed moves' way.
    left_min, left_mean, left_max: material on the samples that it cut last or came nearest to, mm. engaged, engaged_mean: angle of the
    cutter's circumference in material, rad, largest and mean over the way that cuts; depth: largest depth of cut along the axis, a mean
    over the width that is engaged, mm.
    rate, rate_mean: removal rate, cm3/min; power kW and torque Nm at the cutter, largest, and power_limit, what the spindle gives at its
    speed; chip: thickest chip, mm.
    cutting_s, air_s, rapid_s: what of time_s is feed in stock, feed outside of it, and rapids; the rest is tool changes and dwells.
    served: area of the samples that it came nearest to, mm2. bound_s: what it takes at least (`plan.cutting.time_bound`), 0 where that was
    not asked for.
    """

    operation: str
    setup: str
    outcome: Outcome
    gouge: float
    collisions: int
    rapids_in_stock: int
    time_s: float
    removed: float
    air_share: float
    gouges: tuple[tuple[int, float], ...] = ()
    left_min: float = 0.0
    left_mean: float = 0.0
    left_max: float = 0.0
    engaged: float = 0.0
    engaged_mean: float = 0.0
    depth: float = 0.0
    rate: float = 0.0
    rate_mean: float = 0.0
    power: float = 0.0
    power_limit: float = 0.0
    torque: float = 0.0
    chip: float = 0.0
    cutting_s: float = 0.0
    air_s: float = 0.0
    rapid_s: float = 0.0
    served: float = 0.0
    bound_s: float = 0.0

    @property
    def idle_s(self) -> float:
        """Time of its tool change and dwells, s."""
        return max(self.time_s - self.cutting_s - self.air_s - self.rapid_s, 0.0)

    @property
    def over_bound(self) -> float:
        """Its time over the bound of it; 0 where the bound isn't known."""
        return self.time_s / self.bound_s if self.bound_s > 0.0 else 0.0

    def time_parts(self) -> tuple[tuple[str, float], ...]:
        """Return the seconds that the tool cuts, feeds through air, goes by rapids, and stands for a tool change or dwells."""
        return (
            (CUTTING, self.cutting_s),
            (AIR, self.air_s),
            (RAPIDS, self.rapid_s),
            (IDLE, self.idle_s),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Offer:
    """What the proof offers for a finding: `kind` feed (run blocks `first` to `last` of the operation at `feed` mm/min) or rest (cut only
    what still stands there). Blocks count from 0 in the operation; `reason` is the finding's code."""

    kind: str
    operation: str
    setup: str
    reason: str
    first: int
    last: int
    feed: float = 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BlockProof:
    """What was measured block by block in one setup, for charts and playback, n blocks in the program's order.

    section (n,) the operation's place in the setup; time (n,) s; gouge (n,) mm, collision (n,) mm of shank or holder; removed (n,) mm3;
    engaged (n,) rad; depth (n,) mm; rate (n,) cm3/min; power (n,) kW; left_min, left_mean, left_max (n,) mm of material on the samples that
    the block came nearest to, NaN where there is none. 32-bit floats.
    """

    setup: str
    section: Small
    time: Smalls
    gouge: Smalls
    collision: Smalls
    removed: Smalls
    engaged: Smalls
    depth: Smalls
    rate: Smalls
    power: Smalls
    left_min: Smalls
    left_mean: Smalls
    left_max: Smalls


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Deviation:
    """Samples of the finished part for maps: face (s,) tags, point (s, 3) part coordinates, deviation (s,) mm, + is material left, - is
    gouge."""

    face: Ints
    point: Floats
    deviation: Floats


NO_DEVIATION = Deviation(face=np.zeros(0, int), point=np.zeros((0, 3)), deviation=np.zeros(0))
"""A deviation without samples."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Verdict:
    """The proof of a whole plan. `coverage` finished area over area to be machined; `reachable` the same over what any catalogue cutter
    reaches; `bound_s` s that the operations, one change to each tool and the shortest rapids take at least (0: not asked for)."""

    outcome: Outcome
    coverage: float
    reachable: float
    gouge: float
    collisions: int
    rapids_in_stock: int
    machining_time_s: float
    operations: tuple[OperationProof, ...] = ()
    faces: tuple[FaceProof, ...] = ()
    findings: tuple[Finding, ...] = ()
    deviation: Deviation = NO_DEVIATION
    blocks: tuple[BlockProof, ...] = ()
    offers: tuple[Offer, ...] = ()
    accepted_by: str = ""
    bound_s: float = 0.0

    @property
    def over_bound(self) -> float:
        """Machining time over its bound; 0 where the bound isn't known."""
        return self.machining_time_s / self.bound_s if self.bound_s > 0.0 else 0.0

    def time_shares(self) -> tuple[tuple[str, float], ...]:
        """Return the shares of the machining time that the parts of the operations' times take together; none without operations."""
        whole = sum(o.time_s for o in self.operations)
        parts = zip(*(o.time_parts() for o in self.operations), strict=True)
        return tuple(
            (part[0][0], sum(s for _, s in part) / whole if whole > 0.0 else 0.0) for part in parts
        )

    @property
    def releases(self) -> bool:
        """Whether a program with this verdict may be released."""
        return self.outcome is not Outcome.FAILED
