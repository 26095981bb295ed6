"""Interrupted turning of a casing's bottoms: where a machine turns and mills, a round insert turns the gaps between bosses and gets out of
the way of each boss as it comes.

A gap is turned where it is long enough at the speed that the machine's table and feed allow, by the rule of `gaps.py`; what the tool is not
down on, at the ends of gaps and between closer bosses, is milled after it.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace

from trunnion.findings import Finding, info
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.material import Machine
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.tool import Tool
from trunnion.plan.casing.bottom_route import LEAST, cutter_clearance
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.cutting.interrupted import INTERRUPTED, interrupted_data
from trunnion.plan.development.drives import OFF_STOCK, ROUGH, GroundCutter
from trunnion.plan.development.gap_passes import gap_passes, turned_region
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.freeform.keys import number
from trunnion.plan.freeform.lands import ABOVE_TOOL, AROUND_TOOL
from trunnion.plan.prismatic.drive import WALL_ALLOWANCE
from trunnion.plan.turning.gap_drive import GapDrive, GapPass
from trunnion.plan.turning.gap_motion import PER_MINUTE, GapMotion
from trunnion.recognize.casing.kinds import BOTTOM
from trunnion.settings import Value
from trunnion.shop import Stage
from trunnion.units import MM_PER_METRE, trimmed

MOTION = "turning.interrupted."
"""How the keys of the strategy's settings begin."""
GAPS = "gaps"
"""Word that a typical plan may give for the tool of a stage of interrupted turning."""
WORTH = 0.02
"""Share of a bottom that interrupted turning must finish to be worth its tool."""
AS_GOOD = 0.95
"""Share of the most that any insert turns from which on a larger one is taken."""


def plan_gaps(state: CasingPlanState, stage: Stage, pocket: Feature) -> None:
    """Add the interrupted turning of a bottom that runs round where the machine can, and enough of it lies in gaps that are long enough."""
    if pocket.id in state.hosts:
        return
    machine, ground = state.machine, state.grounds[pocket.id]
    roughed = [o for o in state.operations if o.feature == pocket.id and o.kind == ROUGH]
    if not state.settings.interrupted or not turns_and_mills(machine) or not roughed:
        return
    tried = [_tried(state, pocket, ground, roughed, tool) for tool in _inserts(state)]
    least = min(state.regions.lowest_speed, state.regions.surface_speed)
    if tried and max(t.data.speed for t in tried) < least:
        state.findings.append(_too_slow(stage, pocket, tried[0].data.speed, least))
        return
    most = max((t.area for t in tried), default=0.0)
    if most < WORTH * ground.band(*ground.ends).area:
        return
    best = next(t for t in tried if t.area >= AS_GOOD * most)
    data, state.gaps[pocket.id] = best.data, best.finished
    state.add(
        stage,
        pocket.id,
        pocket.id,
        best.tool,
        depth=data.depth,
        width=data.width,
        faces=pocket.with_role(BOTTOM),
        choices=best.choices,
        why=f"{best.tool.name}: at {trimmed(data.speed, 1)} m/min gaps of {trimmed(best.shortest_gap, 0)} mm and more are turned, "
        f"{trimmed(100.0 * best.area / ground.band(*ground.ends).area, 0)} % of the bottom; the rest is milled.",
        data=data,
    )
    state.findings.append(
        info(
            "route.locked-spindle",
            f"{stage.name} of {pocket.id}: {best.tool.name} stands in the locked spindle, its rake face towards growing angles about the "
            "part's axis, for the tool goes round that way in the part",
            pocket.id,
            remedy="set the insert so at the angle that the spindle is locked at, and measure it there",
        )
    )


def _too_slow(stage: Stage, pocket: Feature, speed: float, least: float) -> Finding:
    return info(
        "route.gaps-milled",
        f"{stage.name} of {pocket.id}: the machine brings the ground past the tool at {trimmed(speed, 1)} m/min, inserts need "
        f"{trimmed(least, 1)}: its gaps are milled",
        pocket.id,
        remedy="choose a machine whose table turns faster, or an insert's grade for lower speeds (casing.regions.lowest_speed)",
    )


def turns_and_mills(machine: Machine) -> bool:
    """Return whether the table of a machine turns work as a spindle, and as a rotary axis under a tool that leans."""
    return machine.work_spindle is not None and any(a.carries == "work" for a in machine.rotary)


def gap_drive(
    operation: Operation, ground: DevelopedGround, roughed: list[Operation], clearance: float
) -> GapDrive:
    """Return the passes of an operation over ground that earlier operations have roughed; it is clear of all at a height (mm)."""
    return GapDrive(
        development=ground.development,
        passes=_passes(
            ground,
            GroundCutter.of(operation),
            roughed,
            operation.data,
            _motion_of(operation),
        ),
        clearance=clearance,
    )


def _motion_of(operation: Operation) -> GapMotion:
    """Return how an operation's tool moves in gaps."""
    return GapMotion(**{f.name: number(operation, MOTION + f.name) for f in fields(GapMotion)})


def turned_of(operation: Operation, ground: DevelopedGround, drive: GapDrive) -> Region:
    """Return the area of ground that an operation of interrupted turning finishes by its drive."""
    return _finished(ground, drive.passes, operation.data, _motion_of(operation))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Tried:
    """An insert with its data, choices, the shortest gap (mm) that it turns and what it finishes."""

    tool: Tool
    data: CuttingData
    choices: dict[str, Value]
    shortest_gap: float
    finished: Region

    @property
    def area(self) -> float:
        """The area (mm2) that it finishes."""
        return self.finished.area


def _inserts(state: CasingPlanState) -> list[Tool]:
    """Return the inserts of the catalogue for interrupted cuts in the blank's material, the largest first."""
    found = [t for t in state.cutters(INTERRUPTED) if t.locked]
    return sorted(found, key=lambda t: (-t.diameter, t.stickout, t.name))


def _tried(
    state: CasingPlanState,
    pocket: Feature,
    ground: DevelopedGround,
    roughed: list[Operation],
    tool: Tool,
) -> _Tried:
    machine, regions = state.machine, state.regions
    assert machine.work_spindle is not None
    depth = max(state.route.floor_allowance, LEAST)
    lift = ground.top + state.route.reach_clearance
    linear = [a for a in machine.axes if a.kind == "linear"]
    retract = min(regions.retract_speed, *(a.rapid / MM_PER_METRE for a in linear))
    data = interrupted_data(
        tool,
        state.material,
        state.shop.turning_for(state.material),
        machine,
        machine.work_spindle,
        state.cutting,
        speed=regions.surface_speed,
        retract_speed=retract,
        radius=ground.least_radius,
        lift=lift,
        depth=depth,
        ridge=state.settings.scallop,
    )
    motion = _motion(
        regions,
        data.speed,
        lift,
        retract,
        min(regions.acceleration, *(a.acceleration for a in linear)),
    )
    cutter = GroundCutter(
        tool=tool,
        allowance=state.route.wall_allowance + OFF_STOCK,
        around=cutter_clearance(state, ground, tool, pocket, state.route.wall_allowance),
        above=state.route.reach_clearance,
    )
    passes = _passes(ground, cutter, roughed, data, motion)
    choices: dict[str, Value] = {
        WALL_ALLOWANCE: cutter.allowance,
        AROUND_TOOL: cutter.around,
        ABOVE_TOOL: cutter.above,
        **{f"{MOTION}{name}": value for name, value in asdict(motion).items()},
    }
    return _Tried(
        tool=tool,
        data=data,
        choices=choices,
        shortest_gap=min((motion.needed(data.speed, p.lift) for p in passes), default=0.0),
        finished=_finished(ground, passes, data, motion),
    )


def _motion(
    regions: RegionSettings, speed: float, lift: float, retract: float, acceleration: float
) -> GapMotion:
    """Return what regions ask of gaps as the strategy takes it, at a speed (m/min), for an axis that retracts at a speed (m/min) and
    an acceleration (mm/s2): the shop's factor is in the shortest cut."""
    plain = GapMotion(
        retract_speed=retract,
        acceleration=acceleration,
        margin=regions.margin,
        shortest=0.0,
        threshold=regions.threshold,
    )
    cut = regions.shop_factor * speed * PER_MINUTE * regions.shortest_cut
    more = (regions.shop_factor - 1.0) * 2.0 * plain.end(speed, lift)
    return replace(plain, shortest=cut + more)


def _passes(
    ground: DevelopedGround,
    cutter: GroundCutter,
    roughed: list[Operation],
    data: CuttingData,
    motion: GapMotion,
) -> tuple[GapPass, ...]:
    return gap_passes(
        ground,
        cutter,
        [GroundCutter.of(o) for o in roughed],
        data.feed_per_tooth,
        lambda lift: motion.needed(data.speed, lift),
    )


def _finished(
    ground: DevelopedGround,
    passes: tuple[GapPass, ...],
    data: CuttingData,
    motion: GapMotion,
) -> Region:
    return turned_region(
        ground, passes, data.feed_per_tooth, lambda lift: motion.end(data.speed, lift)
    )
