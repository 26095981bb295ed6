"""Allowances that a person demands on features: material that stays on purpose, for a later process or for fitting.

A demand stands on the feature, as the attributes `wall_allowance` and `floor_allowance` in mm. The route gives it to every operation on the
feature: roughing leaves it beside its own allowance, finishing leaves it alone. The proof is told of the faces (`face_allowances`), not of
the operations. Nothing is demanded until somebody says so.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from trunnion import registry, tolerance
from trunnion.findings import BadInput, Finding, face_tags, warning
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.region import Region, union_all
from trunnion.model.allowance import FaceAllowance
from trunnion.model.feature import Feature, Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import AllowancePlanner
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import ALLOWANCE, KEPT
from trunnion.plan.prismatic.drive import KEPT_ON_FLOORS, KEPT_ON_WALLS, PlaneDrive
from trunnion.plan.prismatic.regions import SectionSource, floor_fillet
from trunnion.plan.settings import KEPT_KEYS
from trunnion.registry import STRATEGIES
from trunnion.settings import Value, setting, settings
from trunnion.units import trimmed

WALL, FLOOR = "wall_allowance", "floor_allowance"
"""Attributes of a feature: what its walls and its floors keep, mm."""
FLOORS, FEET = ("floor", "top", "bottom"), ("floor_fillet",)
"""Roles of faces that keep the floors' allowance, and of those where the walls' runs into it."""
AT_RIM = tolerance.SEW
"""mm that the plan area of a feature's floors is wider, so that it has the walls at its rim."""


@settings("feature")
class FeatureAllowance:
    """What a person may demand that a feature keeps."""

    wall_allowance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Kept on walls",
        help="Material that stays on the feature's walls when the program has run; the proof counts it as wanted.",
    )
    floor_allowance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Kept on floors and tops",
        help="Material that stays on the feature's floors or top when the program has run; the proof counts it as wanted.",
    )


def allowance_of(feature: Feature) -> FeatureAllowance:
    """Return what a feature keeps on purpose."""
    wall, floor = (feature.attributes.get(name, 0.0) for name in (WALL, FLOOR))
    return FeatureAllowance(
        wall_allowance=float(wall) if isinstance(wall, (int, float)) else 0.0,
        floor_allowance=float(floor) if isinstance(floor, (int, float)) else 0.0,
    )


def has_allowance(feature: Feature) -> bool:
    """Return whether anything is demanded to stay on a feature."""
    return WALL in feature.attributes or FLOOR in feature.attributes


def with_allowance(
    recognition: Recognition,
    ids: Iterable[str],
    allowance: FeatureAllowance,
    planner: AllowancePlanner,
) -> Recognition:
    """Return a recognition in which some features, of kinds that their planner can leave material on, keep it; nothing where both are 0.

    Features whose walls are cut with those of another one keep on them what that one keeps. Raises `BadInput` for what is no such feature,
    and for an allowance on walls or floors that it has not.
    """
    wanted = tuple(dict.fromkeys(ids))
    known = {f.id: f for f in recognition}
    for id in wanted:
        if id not in known:
            raise BadInput(f"there is no feature {id}; known: {', '.join(known)}")
        _refuse(known[id], allowance, planner, recognition)
    amounts = {f.id: allowance_of(f) for f in recognition} | dict.fromkeys(wanted, allowance)
    for f in recognition:
        leader = planner.walls_with(f, recognition)
        if leader != f.id and _walls(f):
            amounts[f.id] = replace(amounts[f.id], wall_allowance=amounts[leader].wall_allowance)
    features = tuple(_given(f, amounts[f.id]) for f in recognition.features)
    return (
        recognition if features == recognition.features else replace(recognition, features=features)
    )


def _refuse(
    feature: Feature,
    allowance: FeatureAllowance,
    planner: AllowancePlanner,
    recognition: Recognition,
) -> None:
    id = feature.id
    if feature.kind not in planner.allowance_kinds:
        can = ", ".join(k.replace("_", " ") for k in planner.allowance_kinds)
        raise BadInput(
            f"{id} is a {feature.kind.replace('_', ' ')}: material is left on purpose on these kinds of features alone: {can}"
        )
    leader = planner.walls_with(feature, recognition)
    if leader != id and allowance.wall_allowance != allowance_of(feature).wall_allowance:
        raise BadInput(f"the walls of {id} are cut with those of {leader}: let that one keep it")
    if allowance.wall_allowance > 0.0 and not _walls(feature):
        raise BadInput(f"{id} has no walls of its own to keep material on")
    if allowance.floor_allowance > 0.0 and not feature.with_role(*FLOORS):
        raise BadInput(f"{id} has no floor and no top to keep material on")


def _walls(feature: Feature) -> tuple[int, ...]:
    return tuple(f.face for f in feature.faces if f.role not in (*FLOORS, *FEET))


def _given(feature: Feature, allowance: FeatureAllowance) -> Feature:
    """Return a feature with an allowance in the place of its own."""
    attributes = {k: v for k, v in feature.attributes.items() if k not in (WALL, FLOOR)}
    if allowance.wall_allowance > 0.0:
        attributes[WALL] = allowance.wall_allowance
    if allowance.floor_allowance > 0.0:
        attributes[FLOOR] = allowance.floor_allowance
    return replace(feature, attributes=attributes)


def with_allowances_kept(found: Recognition, before: Recognition | None) -> Recognition:
    """Return a recognition whose features keep what a person demanded of those before a step ran again that have most of their faces."""
    kept = [f for f in before or () if has_allowance(f)]
    if not kept:
        return found

    def taken_over(feature: Feature) -> Feature:
        tags = set(feature.tags)
        same = (f for f in kept if f.kind == feature.kind)
        earlier = next((f for f in same if 2 * len(tags & set(f.tags)) > len(tags)), None)
        return feature if earlier is None else _given(feature, allowance_of(earlier))

    features = tuple(taken_over(f) for f in found.features)
    return found if features == found.features else replace(found, features=features)


def face_allowances(
    recognition: Recognition | None, part: SectionSource
) -> tuple[FaceAllowance, ...]:
    """Return what faces keep, by tag and feature. Of a wall that features with level floors share, as that behind ribs, each has what lies
    at the rim of its own floors in plan."""
    demanded = [f for f in recognition or () if has_allowance(f)]
    if recognition is None or not demanded:
        return ()
    found = []
    for feature in demanded:
        kept = allowance_of(feature)
        for face in feature.faces:
            least, most = _limits(face.role, kept)
            if most <= 0.0:
                continue
            rest = [f for f in recognition if f.id != feature.id and face.face in f.tags]
            own, others = _areas(feature, rest, recognition.frame, part)
            found.append(
                FaceAllowance(
                    feature=feature.id,
                    face=face.face,
                    least=least,
                    most=most,
                    frame=recognition.frame,
                    own=own,
                    others=others,
                )
            )
    return tuple(sorted(found, key=lambda a: (a.face, a.feature)))


def _areas(
    feature: Feature, others: Sequence[Feature], frame: Frame, part: SectionSource
) -> tuple[Region | None, Region | None]:
    """Return the plan areas of a feature's floors up to its walls and of those of others; None, None where one of them has no level floor
    or there are no others."""
    areas = [_floor_area(f, frame, part) for f in (feature, *others)]
    known = [a for a in areas if a is not None]
    if len(known) < len(areas) or not others:
        return None, None
    return known[0], union_all(known[1:])


def _floor_area(feature: Feature, frame: Frame, part: SectionSource) -> Region | None:
    graph, floors = part.graph(), feature.with_role("floor")
    level = [
        graph.surface[t - 1] == "plane"
        and abs(float(graph.normal[t - 1] @ frame.z)) > math.cos(tolerance.ANGLE)
        for t in floors
    ]
    if not level or not all(level):
        return None
    outlines = [part.face_outline(frame, tag) for tag in floors]
    return union_all(outlines).offset(floor_fillet(feature) + AT_RIM)


def _limits(role: str, kept: FeatureAllowance) -> tuple[float, float]:
    """Return how little and how much a face of a role keeps, mm.

    A cutter's corner that is offset by both amounts leaves, where a fillet's normal leans by t, wall cos t + floor sin t: at least the
    smaller and at most the root of the sum of the squares.
    """
    wall, floor = kept.wall_allowance, kept.floor_allowance
    if role in FEET:
        return min(wall, floor), math.hypot(wall, floor)
    return (floor, floor) if role in FLOORS else (wall, wall)


def on_operations(process: ProcessTree, recognition: Recognition) -> ProcessTree:
    """Return a process whose operations leave what their features keep; with findings on those that can't.

    Operations of plane drives keep walls and floors by amounts of their own. Those on curved faces keep one amount, of the faces that they
    finish; roughing keeps the larger one.
    """
    findings: list[Finding] = []
    operations = tuple(_on_operation(o, recognition, findings) for o in process.operations)
    fresh = tuple(f for f in findings if f not in process.findings)
    if operations == process.operations and not fresh:
        return process
    return replace(process, operations=operations, findings=(*process.findings, *fresh))


def _on_operation(
    operation: Operation, recognition: Recognition, findings: list[Finding]
) -> Operation:
    """Return an operation that leaves what its features keep, as `on_operations`; what is to be told is appended to the findings."""
    own = {k: v for k, v in operation.choices.items() if not k.startswith(KEPT_KEYS)}
    features = [f for f in recognition if f.id in operation.all_features]
    kept = [allowance_of(f) for f in features]
    wall = max((k.wall_allowance for k in kept), default=0.0)
    floor = max((k.floor_allowance for k in kept), default=0.0)
    more: dict[str, Value] = {}
    if wall > 0.0 or floor > 0.0:
        drive = registry.get(STRATEGIES, operation.strategy).drive
        if issubclass(drive, SurfaceDrive) or ALLOWANCE in own:
            amounts = _amounts(operation.faces, features) or {max(wall, floor)}
            more = {KEPT: max(amounts)} if max(amounts) > 0.0 else {}
            if len(amounts) > 1:
                findings.append(_uneven(operation, amounts))
        elif issubclass(drive, PlaneDrive):
            more = {k: v for k, v in ((KEPT_ON_WALLS, wall), (KEPT_ON_FLOORS, floor)) if v > 0.0}
        else:
            findings.append(_cannot(operation, max(wall, floor)))
    if {**own, **more} == dict(operation.choices):
        return operation
    return replace(operation, choices={**own, **more})


def _amounts(faces: Sequence[int], features: Sequence[Feature]) -> set[float]:
    """Return the amounts that some faces keep, those of fillets between them left out."""
    tags, found = set(faces), set()
    for feature in features:
        kept = allowance_of(feature)
        for face in feature.faces:
            if face.face in tags and face.role not in FEET:
                found.add(_limits(face.role, kept)[1])
    return found


def _uneven(operation: Operation, amounts: Collection[float]) -> Finding:
    words = " and ".join(trimmed(a, 3) for a in sorted(amounts))
    return warning(
        "route.allowance-uneven",
        f"{operation.id} finishes faces that keep {words} mm; it leaves {trimmed(max(amounts), 3)} mm on all of them",
        operation.id,
        *face_tags(operation.faces),
        remedy="let walls and floors of features with curved or leaning faces keep the same",
    )


def _cannot(operation: Operation, amount: float) -> Finding:
    return warning(
        "route.allowance",
        f"{operation.id} leaves nothing on purpose where {trimmed(amount, 3)} mm are to stay on {operation.feature}",
        operation.id,
        remedy="take the allowance of this feature away, or suppress the operation",
    )


def allowance_words(recognition: Recognition | None) -> tuple[tuple[str, float, float], ...]:
    """Return what features keep as a step's key reads it."""
    kept = [(f.id, allowance_of(f)) for f in recognition or () if has_allowance(f)]
    return tuple((id, own.wall_allowance, own.floor_allowance) for id, own in kept)
