"""Planning of turned discs: the stages of the typical plan, with strategies for planes and one for bevels."""

from __future__ import annotations

import math
from dataclasses import replace

from trunnion.findings import warning
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import OperationDrive, driven_by
from trunnion.plan.cutting.milling import (
    CuttingSettings,
    cutting_data,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.feasibility import too_large, too_many_tools
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE, PlaneDrive, drive_of
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.typical import typical_plan
from trunnion.settings import choose, setting, settings
from turned_disc.bevel import SAME_ANGLE, BevelDrive
from turned_disc.kinds import SHARP

FLOOR_WIDTH = 0.6
"""Width of a floor's passes over the cutter's diameter."""
SLIMMER = 0.75
"""Diameter of a slot's cutter over the slot's width: it has to turn round inside."""


@settings("turned_disc")
class TurnedDiscRouteSettings:
    """What a shop may choose about the route of a disc."""

    wall_allowance: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Wall allowance",
        help="What roughing leaves on walls.",
    )
    floor_allowance: float = setting(
        0.2,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Floor allowance",
        help="What roughing leaves on floors.",
    )


def end_mill(job, feature):
    """Return the largest flat end mill that gets into the slots of the part and below its top."""
    material = job.shop.material(job.blank.material)
    widths = [s.value for s in job.sizes if s.name == "width" and s.feature != "part"]
    height = next(s.value for s in job.sizes if s.name == "height" and s.feature == "part")
    fits = [
        t
        for t in job.shop.tools_for(material.iso_group, "finish")
        if t.form == "flat"
        and t.diameter <= SLIMMER * min(widths, default=math.inf)
        and t.neck_length > height
    ]
    return max(fits, key=lambda t: (t.diameter, -t.stickout, t.name), default=None)


def bevel_cutter(job, feature):
    """Return a conical cutter with the angle of a bevel."""
    fits = [
        t
        for t in job.shop.tools
        if t.form == "taper" and abs(t.taper_angle - feature.sizes["angle"]) <= SAME_ANGLE
    ]
    return min(fits, key=lambda t: (t.diameter, t.name), default=None)


CUTTERS = {"end mill": end_mill, "bevel": bevel_cutter}


class TurnedDiscPlanner:
    """Follows its typical plan feature by feature."""

    name, noun, settings, cutter_rules = (
        "turned_disc",
        "turned discs",
        (TurnedDiscRouteSettings,),
        tuple(CUTTERS),
    )

    def can_plan(self, part):
        """Refuse no part."""

    def route(self, job):
        """Return the process: every stage on every feature of its kinds, and a finding for each feature that nothing is planned for."""
        plan = typical_plan(job.shop, self.name, "", self.cutter_rules)
        chosen, setup = job.settings_of(TurnedDiscRouteSettings), job.setups[0]
        findings = too_large(job.blank, job.setups, job.shop)
        operations: list[Operation] = []
        for stage in job.progress.each(plan.stages):
            for feature in job.recognition.of_kind(*stage.on):
                tool = CUTTERS[stage.cutter](job, feature)
                if tool is None or feature.attributes.get(SHARP):
                    findings.append(_left(feature, tool))
                    continue
                before = [o for o in operations if o.group in (*stage.after, *stage.after_all)]
                operations.append(_operation(job, chosen, setup, stage, feature, tool, before))
        served = {o.feature for o in operations} | {w for f in findings for w in f.where}
        findings += [_left(f, None) for f in job.recognition if f.id not in served]
        operations = [] if not operations else _numbered(operations)
        return ProcessTree(
            plan=plan.name,
            material=job.blank.material,
            setups=job.setups,
            operations=tuple(operations),
            findings=(*findings, *too_many_tools(operations, job.setups, job.shop)),
        )

    def drive(self, operation, needs, scene, progress):
        """Return a plane drive from the part's sections, or the cone of a bevel."""
        makers = {PlaneDrive: _plane, BevelDrive: _bevel}
        return driven_by(makers, self, operation, needs, scene, progress)


def _left(feature, tool):
    why = (
        "it is left sharp by hand" if feature.attributes.get(SHARP) else "there is no cutter for it"
    )
    return warning(
        "disc.not-planned", f"{feature.id}: {why}", feature.id, remedy="machine it by hand"
    )


def _operation(job, chosen, setup, stage, feature, tool, before):
    material, machine = job.shop.material(job.blank.material), job.shop.machine(setup.machine)
    cutting = choose(CuttingSettings, {})
    depth, width = roughing_depth(tool, material, cutting), roughing_width(tool, material, cutting)
    if stage.kind == "floor":
        depth, width = chosen.floor_allowance, FLOOR_WIDTH * tool.diameter
    elif stage.kind in ("wall", "profile_finish"):
        depth, width = tool.flute_length, chosen.wall_allowance
    elif stage.kind == "bevel":
        depth = width = feature.sizes["height"]
    leaves = (
        {}
        if stage.finish
        else {WALL_ALLOWANCE: chosen.wall_allowance, FLOOR_ALLOWANCE: chosen.floor_allowance}
    )
    faces = (
        feature.with_role("top")
        if stage.kind == "face"
        else feature.with_role("floor")
        if stage.kind == "floor"
        else feature.tags
    )
    return Operation(
        id=f"{stage.name.replace(' ', '-')}-{feature.id}",
        kind=stage.kind,
        strategy=stage.strategy,
        feature=feature.id,
        setup=setup.name,
        tool=tool,
        data=cutting_data(tool, material, machine, stage.kind, cutting, depth, width),
        faces=faces if stage.finish else (),
        choices=leaves,
        rules=(stage.rule,),
        after=tuple(o.id for o in before),
        group=stage.name,
    )


def _numbered(operations):
    numbers: dict[str, int] = {}
    return [
        replace(o, tool=replace(o.tool, number=numbers.setdefault(o.tool.name, len(numbers) + 1)))
        for o in operations
    ]


def _plane(operation, needs, scene, progress):
    part = scene.context.part
    space = scene.once(
        "sections", lambda: SetupSpace.of(part, scene.recognition, scene.blank, scene.setup)
    )
    drive = drive_of(operation, scene.process, space)
    return OperationDrive.of(setup=scene.setup, drive=drive, identity=drive)


def _bevel(operation, needs, scene, progress):
    sizes, frame = scene.recognition.feature(operation.feature).sizes, scene.recognition.frame
    foot = scene.setup.frame.to_local(frame.to_world([0.0, 0.0, sizes["foot_z"]]))
    drive = BevelDrive(
        centre=(float(foot[0]), float(foot[1])),
        radius=sizes["outer_radius"],
        foot=float(foot[2]),
        top=float(foot[2]) + sizes["height"],
        angle=sizes["angle"],
    )
    return OperationDrive.of(setup=scene.setup, drive=drive, identity=drive)
