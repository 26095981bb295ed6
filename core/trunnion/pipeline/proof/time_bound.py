"""The bound of a proven program's time: its operations at their highest rates, one change to each tool, and the shortest rapids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.spanning_tree import least_tree
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.session import Session
from trunnion.model.verdict import Verdict
from trunnion.pipeline.context import Context
from trunnion.plan.cutting.optimization.operation import OptimizationSettings, can_be_optimised
from trunnion.plan.cutting.time_bound import RateSearch, least_seconds
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import SECONDS_PER_MINUTE


def with_bounds(
    verdict: Verdict,
    session: Session,
    context: Context,
    programs: Sequence[Program],
    progress: Progress = NO_PROGRESS,
) -> Verdict:
    """Return a verdict that knows the bound of each operation, and of the whole time at the machine."""
    process = session.process
    material = context.shop.materials.get(process.material) if process else None
    if process is None or material is None:
        return verdict
    known, search = {o.id: o for o in process.operations}, RateSearch(material)
    proofs = []
    for proof in progress.each(verdict.operations):
        operation = known.get(proof.operation)
        if operation is None:
            proofs.append(proof)
            continue
        rates = None
        if can_be_optimised(operation):
            machine = context.shop.machine(process.setup(operation.setup).machine)
            settings = OptimizationSettings.of({**session.choices, **operation.choices})
            rates = search.rates(operation, machine, settings)
        proofs.append(replace(proof, bound_s=least_seconds(operation, proof, rates)))
    beside = sum(_between(p, context.shop.machine(p.setup.machine)) for p in programs)
    whole = beside + sum(p.bound_s for p in proofs)
    return replace(verdict, operations=tuple(proofs), bound_s=min(whole, verdict.machining_time_s))


def _between(program: Program, machine: Machine) -> float:
    """Return the least time in s of one setup's tool changes and rapids: each tool is put in once, and goes by rapids to wherever it begins
    to feed, as fast as all linear axes make together."""
    by_tool = dict[int, list[Floats]]()
    for section in program.sections:
        by_tool.setdefault(section.tool.number, []).append(_begins(section.path))
    rapids = sum(least_tree(np.unique(np.vstack(b), axis=0)) for b in by_tool.values())
    fastest = np.linalg.norm([a.rapid for a in machine.axes if a.kind == "linear"])
    return len(by_tool) * machine.tool_change_s + rapids / float(fastest) * SECONDS_PER_MINUTE


def _begins(path: Toolpath) -> Floats:
    """Return where the tool begins to feed after rapids (k, 3)."""
    rapid = path.motion == Motion.RAPID
    return path.position[:-1][rapid[:-1] & ~rapid[1:]]
