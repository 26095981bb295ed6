"""What drives operations on holes: the holes of one operation in its setup's frame, rebuilt from features whenever it is wanted."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import compress

import numpy as np

from trunnion.findings import Finding, Refused, error, face_tags, warning
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature, Recognition
from trunnion.model.guides import GuideCurve, GuideKind
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import Tool
from trunnion.plan.contract import DriveNeeds, OperationDrive, Scene
from trunnion.plan.holes.hole import (
    Countersink,
    HoleShape,
    HoleThread,
    PlannedHole,
    hole_in,
    nearer_half,
)
from trunnion.plan.plane_guides import GuideSpace, line_along
from trunnion.plan.settings import HALVES
from trunnion.plan.setups.frames import cutting_setup
from trunnion.plan.tool_choice import Candidates
from trunnion.progress import Progress
from trunnion.shop import Stage

NOT_REACHED = "hole.not-reached"
"""Code of the finding on a hole that the setup's tool axis does not reach."""
SPOT, DRILL, BORE, FLOOR, COUNTERBORE, REAM, FINE_BORE, COUNTERSINK, TAP, MILL_THREAD = (
    "spot",
    "drill",
    "hole_mill",
    "hole_floor",
    "counterbore",
    "ream",
    "fine_bore",
    "countersink",
    "tap",
    "thread_mill",
)
"""Kinds of operations on holes."""
KINDS = (SPOT, DRILL, BORE, FLOOR, COUNTERBORE, REAM, FINE_BORE, COUNTERSINK, TAP, MILL_THREAD)
THREADING = (TAP, MILL_THREAD)
"""Kinds of operations that cut the thread of a bore."""
FINISHING_KINDS = (REAM, FINE_BORE, *THREADING)
"""Kinds of operations on a bore that is made already."""
OVERLAP = 0.5
"""mm that a floor's cutter begins above what the drill's point has left."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleDrive:
    """The holes that one operation cuts, in the setup's frame.

    `holes` are whole bores, counterbores, or what a drill has left of blind ones, by the operation's `kind`; `sinks` (as many, or none) the
    cones at their mouths, `threads` (as many, or none) what is cut into them. `faces` are the tags that the operation finishes.
    """

    kind: str
    holes: tuple[PlannedHole, ...]
    sinks: tuple[Countersink, ...] = ()
    threads: tuple[HoleThread, ...] = ()
    faces: tuple[int, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is no hole to cut."""
        return not self.holes

    @property
    def threaded(self) -> tuple[tuple[PlannedHole, HoleThread | None], ...]:
        """The holes, each with the thread that is cut into it, None where none is demanded: it may be driven by an operation of another
        kind."""
        threads: Sequence[HoleThread | None] = self.threads or (None,) * len(self.holes)
        return tuple(zip(self.holes, threads, strict=True))

    def guides(self, space: GuideSpace) -> tuple[GuideCurve, ...]:
        """Return the holes' axes, as deep as their full diameters."""
        return tuple(
            line_along(
                GuideKind.AXIS,
                np.array([[h.x, h.y, h.top], [h.x, h.y, h.bottom]]),
                h.faces,
                space,
            )
            for h in self.holes
        )


def holes_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the drive of an operation on holes, seen along the operation's direction; those that can't be cut from there come out as
    findings."""
    setup = cutting_setup(scene.setup, operation.direction, scene.blank)
    drive, findings = hole_drive(operation, scene.recognition, scene.process, setup.frame)
    return OperationDrive.of(setup=setup, drive=drive, identity=drive, findings=findings)


def hole_drive(
    operation: Operation, recognition: Recognition, process: ProcessTree, setup: Frame
) -> tuple[HoleDrive, tuple[Finding, ...]]:
    """Return the drive of an operation in a setup's frame, and findings on the holes that it does not reach.

    Raises `Refused` where the operation's features are gone, or are no holes of the kind that it cuts.
    """
    features = {f.id: f for f in recognition}
    gone = [id for id in operation.all_features if id not in features]
    if gone:
        raise Refused(
            f"{operation.id}: its feature {gone[0]} is not there any more; delete the operation, or route again"
        )
    holes: list[PlannedHole] = []
    sinks: list[Countersink] = []
    threads: list[HoleThread] = []
    findings: list[Finding] = []
    for id in operation.all_features:
        try:
            shape = hole_in(features[id], recognition.frame, setup)
            if operation.choices.get(HALVES) is True:
                shape = nearer_half(shape)
            parts = _parts(operation, shape, process)
        except Refused as reason:
            findings.append(not_reached(features[id], str(reason)))
            continue
        holes += parts
        if operation.kind == COUNTERSINK and shape.countersink is not None:
            sinks.append(shape.countersink)
        if operation.kind in THREADING and shape.thread is not None:
            threads.append(shape.thread)
    if operation.own_faces:
        own = [bool(set(h.faces) & set(operation.faces)) for h in holes]
        holes, sinks = list(compress(holes, own)), list(compress(sinks, own))
        threads = list(compress(threads, own))
    drive = HoleDrive(
        kind=operation.kind,
        holes=tuple(holes),
        sinks=tuple(sinks),
        threads=tuple(threads),
        faces=operation.faces,
    )
    return drive, tuple(findings)


def not_reached(feature: Feature, reason: str) -> Finding:
    """Return the finding on a hole that can't be cut from a setup."""
    return warning(
        NOT_REACHED,
        reason,
        feature.id,
        *face_tags(feature.tags),
        remedy="machine it in another setup or by hand; the proof counts what is left",
    )


def no_thread(hole: PlannedHole) -> Finding:
    """Return the finding on a hole whose thread is to be cut, but in which none is demanded."""
    return warning(
        "hole.no-thread",
        f"{hole.feature}: no thread is demanded in it",
        hole.feature,
        remedy="name its thread, or take another strategy",
    )


def no_tool(
    stage: Stage, features: Sequence[Feature], faces: Iterable[int], missing: Candidates
) -> Finding:
    """Return the finding that no tool of the catalogue fits what a stage cuts of some holes: an error, but a warning for what is done to a
    bore that is made: its flat floor, over which the drill leaves its point, its fit, its thread."""
    names = ", ".join(f.id for f in features)
    return (warning if stage.kind in (FLOOR, *FINISHING_KINDS) else error)(
        "route.no-cutter",
        f"{names}: {missing.reason} ({stage.name})",
        *(f.id for f in features),
        *face_tags(faces),
        remedy=missing.remedy,
    )


def _parts(operation: Operation, shape: HoleShape, process: ProcessTree) -> tuple[PlannedHole, ...]:
    """Return what of a hole an operation cuts."""
    if operation.kind not in KINDS:
        raise Refused(
            f"{operation.id}: no holes are cut by operations of kind {operation.kind}; use one of {', '.join(KINDS)}"
        )
    if operation.kind == COUNTERBORE:
        if not shape.counterbores:
            raise Refused(f"{shape.bore.feature}: it has no counterbore; correct the feature")
        return shape.counterbores
    if operation.kind == COUNTERSINK and shape.countersink is None:
        raise Refused(f"{shape.bore.feature}: it has no countersink; correct the feature")
    if operation.kind in THREADING and shape.thread is None:
        raise Refused(
            f"{shape.bore.feature}: no thread is demanded in it; name its thread, or delete the operation"
        )
    if operation.kind in FINISHING_KINDS:
        return (shape.narrow,)
    if operation.kind == FLOOR:
        drills = _drills_before(operation, shape.bore.feature, process)
        point = max((d.point_length for d in drills), default=math.inf)
        return (below_point(shape.bore, point),)
    if operation.kind == BORE:
        drills = _drills_before(operation, shape.bore.feature, process)
        core = max((d.diameter for d in drills), default=0.0)
        return (replace(shape.bore, core=min(core, shape.bore.diameter)),)
    return (shape.bore,)


def below_point(bore: PlannedHole, point_length: float) -> PlannedHole:
    """Return what a drill with a point of a length (mm) has left of a blind hole with a flat floor."""
    return replace(bore, top=min(bore.bottom + point_length + OVERLAP, bore.top))


def _drills_before(operation: Operation, feature: str, process: ProcessTree) -> tuple[Tool, ...]:
    """Return the tools that drilled a feature before an operation."""
    found = []
    for other in process.of_setup(operation.setup):
        if other.id == operation.id:
            break
        if other.kind == DRILL and feature in other.all_features and not other.suppressed:
            found.append(other.cutter)
    return tuple(found)
