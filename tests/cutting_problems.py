"""Random operations to be optimised, and the refined grid that optima are held against: brute force, knowing nothing of the search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from random import Random

import numpy as np

from flat_parts import operation
from own_shop import own_shop
from trunnion.geometry.frame import WORLD
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.cutting.optimization.problem import CuttingProblem

SHOP = own_shop()
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine="Mill 1200")
MILLS = [t for t in SHOP.tools if t.form in ("flat", "bull", "ball")]
STRATEGIES = {
    "rough": "plane.rough",
    "floor": "plane.floor",
    "wall": "plane.wall",
    "profile_finish": "plane.profile_finish",
}


def random_operation(seed: int) -> tuple[Operation, ProcessTree]:
    """Return a random operation of a random cutter in its process: any material and machine, from slots to thin walls."""
    draw = Random(f"cutting data {seed}")
    material = draw.choice(sorted(SHOP.materials))
    tool = draw.choice(MILLS)
    kind = draw.choice(sorted(STRATEGIES))
    made = operation(kind, "pocket-01", tool)
    data = replace(
        made.data,
        depth=tool.flute_length * draw.uniform(0.02, 1.0),
        width=tool.diameter * draw.choice((0.03, 0.1, 0.25, 0.5, 1.0)),
    )
    faces = () if kind == "rough" else (3,)
    made = replace(made, data=data, strategy=STRATEGIES[kind], faces=faces)
    setup = replace(SETUP, machine=draw.choice(("Mill 1200", "Gantry 4000")))
    return made, ProcessTree(plan="", material=material, setups=(setup,), operations=(made,))


Value = Callable[[np.ndarray, np.ndarray], np.ndarray]
POINTS = 161
ZOOMS = 5


def grid_best(problem: CuttingProblem, value: Value) -> tuple[float, float, float] | None:
    """Return value, spindle speed and feed per tooth of the best feasible point of a grid over both ranges, refined around it."""
    low = np.log([problem.spindle[0], problem.feed[0]])
    high = np.log([problem.spindle[1], problem.feed[1]])
    first_low, first_high, best = low, high, None
    for _ in range(ZOOMS):
        n, fz = np.meshgrid(*(np.exp(np.linspace(a, b, POINTS)) for a, b in zip(low, high)))
        n, fz = np.clip(n.ravel(), *problem.spindle), np.clip(fz.ravel(), *problem.feed)
        kept = problem.is_feasible(n, fz)
        if not kept.any():
            return best
        found = np.where(kept, value(n, fz), np.inf)
        row = int(np.argmin(found))
        if best is None or found[row] < best[0]:
            best = float(found[row]), float(n[row]), float(fz[row])
        # Along a limit a point may be far from the best one of a coarse grid: an eighth of the range is kept.
        reach = (high - low) / 16.0
        middle = np.log(best[1:])
        low, high = np.maximum(middle - reach, first_low), np.minimum(middle + reach, first_high)
    return best
