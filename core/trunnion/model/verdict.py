"""What the proof says of a program."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from trunnion.findings import Finding
from trunnion.geometry.arrays import Floats, Ints


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
    """What was measured on one operation: deepest gouge, collisions (shank, holder), rapids in stock, time at the machine, removed volume
    (mm3)."""

    operation: str
    setup: str
    outcome: Outcome
    gouge: float
    collisions: int
    rapids_in_stock: int
    time_s: float
    removed: float
    air_share: float


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
    reaches."""

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
    accepted_by: str = ""

    @property
    def releases(self) -> bool:
        """Whether a program with this verdict may be released."""
        return self.outcome is not Outcome.FAILED
