"""The problem of one operation: ranges and limits from cutter, material, machine and largest engagement, and its data at the optimum."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.spindle import surface_speed, turns_of
from trunnion.model.tool import Tool
from trunnion.plan.cutting.axial import TABLE_FORMS, TABLE_KINDS
from trunnion.plan.cutting.milling import (
    ROUGHING,
    CuttingSettings,
    chip_thinning,
    slenderness,
)
from trunnion.plan.cutting.optimization import limits
from trunnion.plan.cutting.optimization.exact import solve_exactly
from trunnion.plan.cutting.optimization.genetic import solve_genetically
from trunnion.plan.cutting.optimization.problem import (
    Constraint,
    CuttingProblem,
    Economics,
    OfSpeed,
    Optimum,
)
from trunnion.plan.cutting.optimization.settings import (
    GENETIC,
    GeneticSettings,
    OptimizeSettings,
)
from trunnion.plan.cutting.peak import LEAST_SHARE, largest_engagement
from trunnion.plan.cutting.power import NEWTON_METRES, cutting_power
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import Value, checked, choose
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, trimmed

UNIT_LENGTH = MM_PER_METRE
"""mm of way that times and costs are for: what operations cut is not known before their paths are, and does not change the choice."""
SPEED, SPINDLE, CHIP = "cutting speed", "spindle speed", "chip thickness"
PEAK_CHIP = 1.25
"""Thickest chip at the largest engagement over the largest of the material's range: half of what the proof bears over the table."""
THICKEST_CHIP = 1.4
"""Largest feed per tooth, raised for chips that are thin in a small width of cut, over the largest of the material's range: a moment in
full width, in a corner or where leftovers stand, makes chips as thick, and the proof bears one and a half times the table's."""
WEAR = "tool life"
"""What stops an optimum that no limit does: quicker ones wear more than they gain."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OptimizationSettings:
    """The settings that a choice depends on."""

    cutting: CuttingSettings
    optimize: OptimizeSettings
    genetic: GeneticSettings

    @classmethod
    def of(cls, choices: Mapping[str, Value]) -> OptimizationSettings:
        """Return them as chosen; raise `BadInput` for a value that is not allowed."""
        return cls(
            cutting=checked(choose(CuttingSettings, choices)),
            optimize=checked(choose(OptimizeSettings, choices)),
            genetic=checked(choose(GeneticSettings, choices)),
        )


def can_be_optimised(operation: Operation) -> bool:
    """Return whether there are models for an operation: a mill that cuts with its flank or end. Drills, reamers, taps and thread mills
    keep their tables."""
    return (
        operation.tool.rotates
        and not operation.tool.locked
        and operation.kind not in TABLE_KINDS
        and operation.cutter.form not in TABLE_FORMS
        and not operation.keeps_data
    )


def problem_of(
    operation: Operation,
    earlier: Iterable[Operation],
    material: Material,
    machine: Machine,
    settings: OptimizationSettings,
    choices: Mapping[str, Value],
) -> CuttingProblem | None:
    """Return the choice of an operation with its handbook data and their peak (`peak.with_peak`); None where there are no models for it.

    Constraints hold in steady cutting and at the largest engagement that its strategy can meet; a strategy that slows down there may do so
    down to the share of its feed below which a cutter rubs.
    """
    if not can_be_optimised(operation):
        return None
    peak = largest_engagement(operation, earlier, choices)
    return problem_at(operation, steady_of(operation.data), peak, material, machine, settings)


def steady_of(data: CuttingData) -> Engagement:
    """Return the engagement that an operation's data are chosen for."""
    return Engagement(width=data.width, depth=data.depth, share=1.0, at="")


def problem_at(
    operation: Operation,
    steady: Engagement,
    peak: Engagement,
    material: Material,
    machine: Machine,
    settings: OptimizationSettings,
) -> CuttingProblem:
    """Return the choice of an operation in a steady engagement and a largest one."""
    tool, optimize = operation.cutter, settings.optimize
    data = replace(operation.data, width=steady.width, depth=steady.depth)
    spindle, bounds = _spindle_range(tool, material, machine, settings.cutting, data)
    is_rough = operation.kind in ROUGHING
    deflection = optimize.rough_deflection if is_rough else optimize.finish_deflection
    share = settings.cutting.power_share
    feed = min(machine.feed_max, settings.cutting.feed_limit)
    names = _power_names(machine, spindle)
    slowest = replace(peak, share=min(peak.share, LEAST_SHARE)) if peak.slows else peak
    return CuttingProblem(
        length=UNIT_LENGTH,
        teeth=tool.teeth,
        spindle=spindle,
        feed=_feed_range(tool, material, settings.cutting, data),
        life=_life_of(tool, material, data),
        economics=Economics(
            change=machine.tool_change_s / SECONDS_PER_MINUTE,
            rate=optimize.machine_rate,
            tool=optimize.tool_cost,
        ),
        constraints=(
            limits.power_limit(names[0], machine, material, tool, steady, share),
            limits.power_limit(names[1], machine, material, tool, slowest, share),
            _peak_chip(tool, material, data, settings.cutting, peak),
            limits.force_limit(material, tool, slowest, optimize.force),
            limits.bending_limit(material, tool, steady, deflection),
            limits.feed_limit(tool.teeth, feed),
            *(() if is_rough else _feed_marks(tool, data, optimize)),
        ),
        handbook=(data.spindle, data.feed_per_tooth),
        spindle_bounds=bounds,
        feed_bounds=(CHIP, CHIP),
        load=names[1],
        identity=(
            tool,
            is_rough,
            steady,
            peak,
            data.spindle,
            data.feed_per_tooth,
            material.name,
            machine.name,
            settings,
        ),
    )


def _power_names(machine: Machine, spindle: tuple[float, float]) -> tuple[str, str]:
    """Return what the limits of power are called: of torque where the whole range is below the speed of the spindle's most power."""
    fullest = max(machine.power, key=lambda row: (row[1], -row[0]))[0]
    if spindle[1] < fullest:
        return limits.TORQUE, limits.PEAK_TORQUE
    return limits.POWER, limits.PEAK_POWER


def _spindle_range(
    tool: Tool,
    material: Material,
    machine: Machine,
    settings: CuttingSettings,
    data: CuttingData,
) -> tuple[tuple[float, float], tuple[str, str]]:
    """Return the smallest and the largest spindle speed in 1/min, and what bounds them; without range and life that of the tables alone."""
    if material.speed_range is None or material.life is None:
        return (data.spindle, data.spindle), (SPEED, SPEED)
    low, high = (turns_of(v * settings.speed_share, tool.diameter) for v in material.speed_range)
    least, most = machine.spindle_low, min(machine.spindle_high, settings.spindle_limit)
    found = tuple(min(max(n, least), most) for n in (low, high))
    return (found[0], found[1]), (
        SPEED if low >= least else SPINDLE,
        SPEED if high <= most else SPINDLE,
    )


def _feed_range(
    tool: Tool, material: Material, settings: CuttingSettings, data: CuttingData
) -> tuple[float, float]:
    """Return the smallest and the largest feed per tooth in mm of the material's range, for chip thinning and slenderness as in the data.

    Where limits made the data's feed smaller than the range's smallest, theirs is the smallest.
    """
    thinning = min(chip_thinning(tool.diameter, data.width), settings.thinning_limit)
    share = thinning * slenderness(tool, settings) * settings.feed_share
    low, high = (share * _table_chip(material, tool, r) for r in material.feed_range)
    low = min(low, data.feed_per_tooth)
    top = settings.feed_share * _table_chip(material, tool, material.feed_range[1])
    high = min(high, max(THICKEST_CHIP * top, data.feed_per_tooth))
    return low, max(high, low)


def _table_chip(material: Material, tool: Tool, share: float) -> float:
    """Return the feed per tooth in mm at a share of what lies between the table's smallest and largest."""
    rows = [(d, low + share * (high - low)) for d, low, high in material.feeds]
    return feed_at(rows, tool.diameter)


def _peak_chip(
    tool: Tool, material: Material, data: CuttingData, settings: CuttingSettings, peak: Engagement
) -> Constraint:
    """Return the constraint on the thickest chip at the largest engagement: a feed that was raised for thin chips meets thick ones there.

    It may be what the tables' own data come to there.
    """
    width = min(peak.width, tool.diameter)
    angle = math.acos(max(1.0 - 2.0 * width / tool.diameter, -1.0))
    unit = peak.share * math.sin(min(angle, 0.5 * math.pi))
    top = settings.feed_share * _table_chip(material, tool, material.feed_range[1])
    return limits.chip_limit(unit, max(PEAK_CHIP * top, unit * data.feed_per_tooth))


def _life_of(tool: Tool, material: Material, data: CuttingData) -> OfSpeed:
    """Return the tool's life in min by spindle speed: T (v / v0)^(-1/n), for the width of cut where that is known."""
    life = material.life
    if life is None:
        return lambda spindle: np.full(np.shape(spindle), math.inf)
    width = min(max(data.width / tool.diameter, life.widths[0]), life.widths[1])
    minutes = life.minutes * (life.width / width) ** life.width_exponent

    def minutes_at(spindle: Floats) -> Floats:
        speed = np.asarray(spindle, float) * surface_speed(1.0, tool.diameter)
        return np.asarray(minutes * (life.speed / speed) ** (1.0 / life.exponent))

    return minutes_at


def _feed_marks(
    tool: Tool, data: CuttingData, settings: OptimizeSettings
) -> tuple[Constraint, ...]:
    """Return the constraints on feed marks: of the corner's radius on what the end cuts, wider than deep, of the cutter's on walls.

    A sharp corner leaves no marks by that formula.
    """
    radius = tool.corner_radius if data.width > data.depth else tool.radius
    if radius <= 0.0:
        return ()
    return limits.ra_limit(radius, settings.ra), limits.rt_limit(radius, settings.rt)


def solve(
    problem: CuttingProblem, settings: OptimizationSettings, progress: Progress = NO_PROGRESS
) -> Optimum | None:
    """Return the optimum by the chosen method; None where nothing keeps the constraints."""
    weight = settings.optimize.time_weight
    if settings.optimize.method == GENETIC:
        found = solve_genetically(problem, weight, settings.genetic, progress)
        return None if found is None else found.optimum
    return solve_exactly(problem, weight)


def bound_of(problem: CuttingProblem, optimum: Optimum) -> str:
    """Return in words what stops an optimum from being quicker."""
    return ", ".join(problem.binding(optimum.spindle, optimum.feed)) or WEAR


def at_optimum(
    operation: Operation,
    problem: CuttingProblem,
    optimum: Optimum,
    material: Material,
    machine: Machine,
    settings: CuttingSettings,
) -> Operation:
    """Return the operation with spindle speed and feed of the optimum, the rest of its data as they follow, and why."""
    tool, data = operation.cutter, operation.data
    feed = optimum.feed * tool.teeth * optimum.spindle
    limit = machine.power_at(optimum.spindle) * settings.power_share
    power = cutting_power(material, tool.diameter, optimum.feed, data.depth, data.width, feed)
    speed, bound = surface_speed(optimum.spindle, tool.diameter), bound_of(problem, optimum)
    rule = (
        f"n {trimmed(optimum.spindle, 0)} 1/min and fz {trimmed(optimum.feed, 3)} mm: least time and cost, "
        f"M {optimum.objective:.3f}, bound by {bound}; the tables have {trimmed(data.spindle, 0)} 1/min "
        f"and {trimmed(data.feed_per_tooth, 3)} mm"
    )
    kept = tuple(r for r in data.rules if r.startswith("ap "))
    return replace(
        operation,
        data=replace(
            data,
            speed=speed,
            spindle=optimum.spindle,
            feed_per_tooth=optimum.feed,
            feed=feed,
            plunge_feed=feed * settings.plunge_share,
            removal_rate=data.depth * data.width * feed / MM_PER_METRE,
            power=power,
            power_limit=limit,
            torque=NEWTON_METRES * power / optimum.spindle,
            slot_share=1.0,
            rules=(rule, *kept),
            handbook_spindle=data.spindle,
            handbook_feed=data.feed,
            bound_by=bound,
            # What a link scrapes off is as thin as before: so are its chips.
            link_share=max(data.link_share * data.feed_per_tooth / optimum.feed, 1.0),
        ),
    )


__all__ = [
    "OptimizationSettings",
    "at_optimum",
    "bound_of",
    "can_be_optimised",
    "problem_of",
    "solve",
]
