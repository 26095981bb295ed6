"""The turning of a casing from its blank: first with the lower end up, a little past its flange, then standing on it, all the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion.findings import Finding, Refused, error
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Revolved
from trunnion.model.material import Machine, WorkSpindle
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.part.part import Part
from trunnion.plan.blank import ring_turned_outline
from trunnion.plan.casing.milling_settings import CasingRouteSettings
from trunnion.plan.contract import DriveNeeds, OperationDrive, RouteJob, Scene
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.turning import TURNING_FINISH
from trunnion.plan.setups import SetupSettings, work_offset
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.meridian import meridian_in, on_one_axis, seen_from, turned_to
from trunnion.plan.turning.operations import RULES, SetupTurning
from trunnion.plan.turning.reach import TurningLimits
from trunnion.plan.turning.settings import TurningSettings
from trunnion.progress import Progress
from trunnion.recognize.casing.kinds import PROFILE
from trunnion.recognize.revolution import RevolutionAxis, of_revolution
from trunnion.settings import digest
from trunnion.shop import Shop, Stage, TypicalPlan
from trunnion.units import trimmed

WORTH = 1.0
"""mm2 of the meridian beyond the largest turned state: a blank with less comes turned."""
FLANGE_DROP = 1.0
"""mm by which the outside falls behind a flange."""
THICKEST_FLANGE = 60.0
"""mm: what is thicker is no flange to be held by."""
HELD, HELD_SHARE = 20.0, 0.25
"""mm, and share of the length, that the first setup turns where there is no flange."""
BEYOND, OVERLAP = 3.0, 0.5
"""mm that the first setup turns past what the second one holds, and that the second one turns once more of what the first has turned."""
STEP = 0.1
"""mm between heights at which a flange's end is looked for."""
ON_FACE = 0.02
"""mm: points of a face this close to chips were under them."""
SHARE_OF_FACE = 0.3
"""Share of a face's points from which on an operation finishes it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurnedRoute:
    """The turning of a casing: setups, operations and findings, and the blank that milling then starts from."""

    setups: tuple[Setup, ...]
    operations: tuple[Operation, ...]
    findings: tuple[Finding, ...]
    blank: Revolved


def plan_turned(job: RouteJob, plan: TypicalPlan) -> TurnedRoute | None:
    """Return the turning from the job's blank to the largest turned state, None where there is nothing to turn or the plan has no stage
    for it; where no machine turns it, the route has no setups and a finding says why."""
    blank, found = job.blank, job.recognition
    stages = [s for s in plan.stages if s.cutter in RULES]
    if not stages or not isinstance(blank, Revolved) or not on_one_axis(blank.frame, found.frame):
        return None
    target = turned_target(job.context.part, found.frame, blank)
    if shapely.Polygon(blank.outline).difference(target).area <= WORTH:
        return None
    machine, why = lathe_for(job.shop, job.settings_of(CasingRouteSettings).lathe, blank)
    if machine is None or machine.work_spindle is None:
        return TurnedRoute(setups=(), operations=(), findings=why, blank=blank)
    return _planned(job, stages, machine, machine.work_spindle, target, blank)


def turned_target(part: Part, frame: Frame, blank: Revolved) -> BaseGeometry:
    """Return the meridian of the largest turned state about a frame's z, in the blank's frame."""
    outline = ring_turned_outline(frame, part.mesh(), part.graph())
    return shapely.Polygon(seen_from(outline, frame, blank.frame))


def turned_here(target: BaseGeometry, work: Frame, setup: Setup) -> BaseGeometry:
    """Return what of a target, a meridian in the work's frame, a setup turns, in the setup's frame: turned over what the upright one holds,
    and straight on from there; the ground behind its flange is the upright one's."""
    if float(setup.frame.z @ work.z) < 0.0:
        target = held_straight(target, float(target.bounds[1]) + held_height(target))
    return shapely.transform(target, lambda points: seen_from(points, work, setup.frame))


def revolved_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return what an operation turns: the meridian that must stand, and how much of the stock lies beyond it."""
    blank, frame = scene.blank, scene.recognition.frame
    stock = meridian_in(blank, scene.setup.frame)
    if not isinstance(blank, Revolved):
        raise Refused(f"{operation.id}: only a blank of revolution is turned")
    part = scene.once(
        ("turned", digest(frame)),
        lambda: turned_here(
            turned_target(scene.context.part, frame, blank), blank.frame, scene.setup
        ),
    )
    drive = RevolvedDrive(
        part=shapely.get_coordinates(shapely.get_exterior_ring(part))[:-1],
        to_cut=float(stock.difference(part).area),
    )
    return OperationDrive.of(setup=scene.setup, drive=drive, identity=(drive, blank))


def after_turning(
    setups: Sequence[Setup], turned: TurnedRoute | None, settings: SetupSettings
) -> list[Setup]:
    """Return the setups of milling as they come after those of turning: named and numbered on, and begun with what turning leaves."""
    if turned is None or not turned.setups:
        return list(setups)
    before = len(turned.setups)
    return [
        replace(
            setup,
            name=f"S{before + k + 1}",
            work_offset=work_offset(settings, before + k),
            blank=turned.blank,
        )
        for k, setup in enumerate(setups)
    ]


def lathe_for(
    shop: Shop, wanted: str, blank: Revolved
) -> tuple[Machine | None, tuple[Finding, ...]]:
    """Return the machine that is wanted for turning, or the smallest one that turns the blank; or why there is none.

    One with rotary axes is not taken: no control here has words for work that turns on it.
    """
    width, height = 2.0 * blank.radius, float(np.ptp(blank.outline[:, 1]))
    known = (
        [shop.machine(wanted)] if wanted else sorted(shop.machines.values(), key=_largest_diameter)
    )
    for machine in known:
        z = machine.axis("Z")
        if _largest_diameter(machine) >= width and z.high - z.low >= height:
            return machine, ()
    why = error(
        "route.not-turned",
        f"{wanted or 'no machine of the catalogue'} turns no blank of {trimmed(width, 1)} mm across and {trimmed(height, 1)} mm high",
        remedy="choose a machine with a work spindle (casing.lathe), or a blank that comes turned (blank.kind = ring-turned)",
    )
    return None, (why,)


def _largest_diameter(machine: Machine) -> float:
    turns = machine.work_spindle if not machine.rotary else None
    return turns.largest_diameter if turns is not None else 0.0


def _planned(
    job: RouteJob,
    stages: Sequence[Stage],
    machine: Machine,
    spindle: WorkSpindle,
    target: BaseGeometry,
    blank: Revolved,
) -> TurnedRoute:
    """Return the turning of both setups on a machine."""
    material = job.shop.material(blank.material)
    low, high = float(target.bounds[1]), float(target.bounds[3])
    held = held_height(target)
    turned = _RoundFaces.of(job, blank.frame)
    setups: list[Setup] = []
    operations: list[Operation] = []
    findings: list[Finding] = []
    now = blank
    for upright in (False, True):
        setup = _setup(len(setups), upright, (low, high), now, machine, job)
        lowest = held - OVERLAP - (high - low) if upright else -held - BEYOND
        stock = meridian_in(now, setup.frame)
        planned = SetupTurning(
            setup=setup,
            part=turned_here(target, blank.frame, setup),
            stock=stock,
            limits=TurningLimits(
                floor=lowest if upright else float(stock.bounds[1]), lowest=lowest
            ),
            tools=job.shop.turning,
            material=material,
            table=job.shop.turning_for(material),
            spindle=spindle,
            cutting=job.settings_of(CuttingSettings),
            settings=job.settings_of(TurningSettings),
        )
        for stage in job.progress.each(stages):
            planned.plan(stage, turned.profile)
        findings += planned.findings
        if planned.operations:
            setups.append(setup)
            operations += turned.named(planned, blank.frame)
            now = turned_to(now, setup.frame, planned.stock)
    return TurnedRoute(
        setups=tuple(setups), operations=tuple(operations), findings=tuple(findings), blank=now
    )


def held_height(target: BaseGeometry) -> float:
    """Return how far up from its lower end a casing is turned first, and held by then: up to where its lower flange ends."""
    low, high = float(target.bounds[1]), float(target.bounds[3])
    length = high - low
    heights = np.arange(low + STEP, low + min(THICKEST_FLANGE, 0.5 * length), STEP)
    outside = np.array([_outside(target, z) for z in heights])
    drops = np.flatnonzero(outside < outside[0] - FLANGE_DROP) if len(outside) else np.zeros(0, int)
    if not len(drops):
        return min(HELD, HELD_SHARE * length)
    corners = shapely.get_coordinates(target)[:, 1]
    at = float(heights[drops[0]])
    nearest = float(corners[np.argmin(np.abs(corners - at))])
    return (nearest if abs(nearest - at) <= STEP else at) - low


def held_straight(target: BaseGeometry, height: float) -> BaseGeometry:
    """Return a meridian up to a height, and from there on straight: what a setup leaves to the next one stands in its way."""
    low, top = float(target.bounds[1]), float(target.bounds[3])
    below = target.intersection(shapely.box(0.0, low - STEP, 1e4, height))
    inner, _, outer, _ = target.intersection(shapely.box(0.0, height - STEP, 1e4, height)).bounds
    return below.union(shapely.box(inner, height - STEP, outer, top)).buffer(0.0)


def _outside(target: BaseGeometry, z: float) -> float:
    return float(target.intersection(shapely.LineString([(0.0, z), (1e4, z)])).bounds[2])


def _seen(meridian: BaseGeometry, frame: Frame, other: Frame) -> BaseGeometry:
    return shapely.transform(meridian, lambda points: seen_from(points, frame, other))


def _setup(
    number: int,
    upright: bool,
    ends: tuple[float, float],
    blank: Revolved,
    machine: Machine,
    job: RouteJob,
) -> Setup:
    """Return a setup of turning: its zero on the axis, in the plane of the end that is up."""
    work, settings = blank.frame, job.settings_of(SetupSettings)
    z = work.z if upright else -work.z
    zero = work.to_world(np.array([0.0, 0.0, ends[1] if upright else ends[0]]))
    frame = Frame(zero, work.x, z)
    return Setup(
        name=f"S{number + 1}",
        frame=frame,
        work_offset=work_offset(settings, number),
        clearance=float(blank.box_in(frame)[1][2]) + settings.clearance,
        machine=machine.name,
        blank=blank if number else None,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _RoundFaces:
    """Faces of revolution with points (n, 2) of their meridians in the blank's frame, and the features that they are of."""

    points: dict[int, Floats]
    feature: dict[int, str]
    profile: str

    @staticmethod
    def of(job: RouteJob, work: Frame) -> _RoundFaces:
        """Return the faces of a casing that turning may finish."""
        part, found = job.context.part, job.recognition
        mesh, graph = part.mesh(), part.graph()
        round_ = of_revolution(
            graph, RevolutionAxis(point=found.frame.origin, direction=found.frame.z)
        )
        own = work.to_local(mesh.points)
        meridian = np.column_stack([np.hypot(own[:, 0], own[:, 1]), own[:, 2]])
        points = {
            int(tag): meridian[np.unique(mesh.triangles[mesh.face == tag])]
            for tag in np.flatnonzero(round_) + 1
        }
        feature = {t: f.id for f in found for t in f.tags if t in points}
        profiles = found.of_kind(PROFILE) or tuple(found)
        return _RoundFaces(points=points, feature=feature, profile=profiles[0].id)

    def named(self, planned: SetupTurning, work: Frame) -> list[Operation]:
        """Return the operations of a setup, finishing ones with the faces that their chips come off."""
        made = []
        for operation, chips in zip(planned.operations, planned.cut, strict=True):
            if operation.kind != TURNING_FINISH:
                made.append(operation)
                continue
            near = _seen(chips, planned.setup.frame, work).buffer(ON_FACE)
            shapely.prepare(near)
            tags = tuple(
                tag
                for tag, points in self.points.items()
                if float(np.mean(shapely.contains_xy(near, points))) >= SHARE_OF_FACE
            )
            features = list(dict.fromkeys(self.feature[t] for t in tags if t in self.feature))
            first = features[0] if features else self.profile
            made.append(replace(operation, faces=tags, feature=first, others=tuple(features[1:])))
        return made
