"""What a person may choose about the optimisation of cutting parameters."""

from __future__ import annotations

from trunnion.settings import setting, settings

HANDBOOK, OPTIMISED = "handbook", "optimised"
EXACT, GENETIC = "exact", "genetic"
COST, LOAD = "cost", "load"


@settings("optimize")
class OptimizeSettings:
    """Which data operations get, what time and tools cost, and the limits beside those of all cutting data."""

    data: str = setting(
        OPTIMISED,
        choices=(HANDBOOK, OPTIMISED),
        label="Cutting data",
        help="Data of the material's tables, or spindle speed and feed chosen for least time and cost within their ranges.",
    )
    method: str = setting(
        EXACT,
        choices=(EXACT, GENETIC),
        label="Method",
        help="Search along the constraints, exact and quick, or the genetic algorithm.",
    )
    time_weight: float = setting(
        0.5,
        unit="of the objective",
        low=0.0,
        high=1.0,
        label="Weight of time",
        help="Weight of time against cost: 0 for least cost, 1 for least time.",
    )
    machine_rate: float = setting(
        1.5,
        unit="money/min",
        low=0.0,
        high=1000.0,
        label="Machine rate",
        help="What a minute of the machine costs, in any currency.",
    )
    tool_cost: float = setting(
        30.0,
        unit="money",
        low=0.0,
        high=100_000.0,
        label="Cost of a cutter's life",
        help="What a cutter costs from one sharpening to the next, in the same currency.",
    )
    ra: float = setting(
        1.6,
        unit="um",
        low=0.01,
        high=100.0,
        label="Largest Ra",
        help="Mean roughness that feed marks of finishing may come to: a quarter of Rt.",
    )
    rt: float = setting(
        6.4,
        unit="um",
        low=0.01,
        high=1000.0,
        label="Largest Rt",
        help="Peak-to-valley height that feed marks of finishing may come to: fz2 / (8 r).",
    )
    rough_deflection: float = setting(
        0.25,
        unit="mm",
        low=0.001,
        high=10.0,
        label="Deflection in roughing",
        help="How far the cutting force may bend a roughing cutter: half of the usual wall allowance.",
    )
    finish_deflection: float = setting(
        0.05,
        unit="mm",
        low=0.001,
        high=10.0,
        label="Deflection in finishing",
        help="How far the cutting force may bend a finishing cutter.",
    )
    force: float = setting(
        15_000.0,
        unit="N",
        low=1.0,
        high=1_000_000.0,
        label="Largest force",
        help="Cutting force that the machine bears.",
    )


@settings("optimize.genetic")
class GeneticSettings:
    """How the genetic algorithm searches."""

    population: int = setting(
        40, low=8, high=1000, label="Population", help="Points of a generation."
    )
    generations: int = setting(
        40, low=1, high=5000, label="Generations", help="Generations that are bred."
    )
    crossover: float = setting(
        0.9,
        unit="of the pairs",
        low=0.0,
        high=1.0,
        label="Crossover",
        help="Probability that two points are crossed (simulated binary crossover).",
    )
    mutation: float = setting(
        0.5,
        unit="of the numbers",
        low=0.0,
        high=1.0,
        label="Mutation",
        help="Probability that a number of a point is changed (polynomial mutation).",
    )
    seed: int = setting(
        1,
        low=0,
        high=2**31 - 1,
        label="Seed",
        help="Start of the random numbers: same seed, same result.",
    )
    front: str = setting(
        COST,
        choices=(COST, LOAD),
        label="Pareto front",
        help="What the front holds against time: cost, or the highest share of the spindle's power.",
    )
