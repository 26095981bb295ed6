"""Toolpaths of a whole process: each operation from its drive geometry, knowing the stock that those before it leave.

Strategies work in the cutting frame, whose z is the direction that the operation's tool comes from; their paths are turned into the setup's
frame here. An operation whose drive, tool, data, settings and stock have the same digest keeps its toolpath.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from trunnion import registry, tolerance
from trunnion.findings import BadCall, Finding
from trunnion.geometry.frame import Frame
from trunnion.model.material import Machine, Material
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.operation_path import turned
from trunnion.pipeline.path_jobs import PathJobs
from trunnion.pipeline.planning.scene import SessionContext, SetupScene
from trunnion.plan.contract import planner_for
from trunnion.plan.freeform.keys import EARLIER
from trunnion.progress import Progress
from trunnion.registry import STRATEGIES
from trunnion.toolpath.contact_passes.choices import HINDERED
from trunnion.toolpath.motion.load.path_load import LoadStock, PathLoad
from trunnion.toolpath.motion.time import reached_feeds
from trunnion.toolpath.stock.views import StockViews


def strategy_settings() -> tuple[type, ...]:
    """Return the settings of every registered strategy."""
    return tuple(registry.get(STRATEGIES, name).settings for name in registry.names(STRATEGIES))


def make_paths(session: Session, context: Context, progress: Progress) -> tuple[OperationPath, ...]:
    """Return the toolpath of every operation that is not suppressed, in the order they are cut."""
    if session.process is None or session.recognition is None or session.blank is None:
        raise BadCall("no operations yet: generate the route first")
    laid: list[OperationPath] = []
    loads: list[Callable[[], PathLoad | None]] = []
    planner, parts = planner_for(session.recognition.family), SessionContext(context, session)
    material = context.shop.material(session.process.material)
    total = sum(len(session.process.of_setup(setup.name)) for setup in session.setups)
    # What one setup leaves is the next one's stock, whatever side it looks from; what turning leaves is a blank of its own.
    blank = session.blank
    stock, done = StockViews(blank), 0
    with progress.in_turn() as beside:
        for setup in session.setups:
            scene = SetupScene(
                context=parts,
                recognition=session.recognition,
                blank=blank,
                setup=setup,
                process=session.process,
                fixtures=session.fixtures_of(setup.name),
                handed_on=stock,
            )
            loaded = LoadStock(blank, setup.frame)
            mill = context.shop.machine(setup.machine)
            operations = session.process.of_setup(setup.name)

            def taken(
                operation: Operation,
                made: OperationPath,
                frame: Frame = setup.frame,
                loaded: LoadStock = loaded,
                machine: Machine = mill,
            ) -> None:
                # No path depends on the load of another: it is measured while the next path is laid.
                load = partial(_load, made.path, frame, operation, loaded, material, machine)
                loads.append(beside(load))
                laid.append(made)

            def idle() -> None:
                for load in loads[-1:]:
                    load()

            with PathJobs(session, planner, scene, taken, idle) as jobs:
                for n, operation in enumerate(operations):
                    text = f"toolpath of {operation.id}"
                    here = progress.part((done + n) / total, (done + n + 1) / total, text)
                    here.at(0.0)
                    jobs.add(operation, here, more=n + 1 < len(operations))
                jobs.take_over()
            done += len(operations)
            if scene.blank is not blank:
                blank = scene.blank
                stock = StockViews(blank)
        progress.doing("measuring the load")
        return tuple(_with_load(made, load()) for made, load in zip(laid, loads, strict=True))


def findings_of(paths: Sequence[OperationPath], process: ProcessTree) -> tuple[Finding, ...]:
    """Return what toolpaths have reported, without what is reported of slopes and corners that another operation on the same faces is there
    for."""
    return tuple(
        f
        for path in paths
        for f in path.findings
        if not _settled(f, process.operation(path.operation), process)
    )


def _settled(finding: Finding, own: Operation, process: ProcessTree) -> bool:
    """Return whether a finding is of what its strategy leaves to others, and another operation on the same faces is there for it: by its
    strategy, or as the one on what this operation's cutter leaves."""
    beside = [
        o
        for o in process.operations
        if o.id != own.id and not o.suppressed and set(o.faces) & set(own.faces)
    ]
    if finding.code == HINDERED:
        return any(o.choices.get(EARLIER) == own.cutter.name for o in beside)
    return finding.code in registry.get(STRATEGIES, own.strategy).leaves and any(
        finding.code in registry.get(STRATEGIES, o.strategy).settles for o in beside
    )


def _load(
    path: Toolpath,
    frame: Frame,
    operation: Operation,
    stock: LoadStock,
    material: Material,
    machine: Machine,
    progress: Progress,
) -> PathLoad | None:
    """Return the load of a path in a frame at the feeds that a machine comes up to, None where it cuts nothing or its tool does not stand
    upright; it is taken off the stock."""
    cuts = path.motion != Motion.RAPID
    if not cuts.any() or (path.axis[cuts, 2] < 1.0 - tolerance.PARAMETRIC).any():
        return None
    own = turned(replace(path, feed=reached_feeds(path, machine)), frame, stock.frame)
    return stock.cut(own, operation.cutter, operation.data, material, progress)


def _with_load(laid: OperationPath, load: PathLoad | None) -> OperationPath:
    """Return a toolpath with the highest load that its motions come to."""
    if load is None:
        return laid
    power, rate, chip = (float(v.max(initial=0.0)) for v in (load.power, load.rate, load.chip))
    if (power, rate, chip) == (laid.power, laid.rate, laid.chip):
        return laid
    return replace(laid, power=power, rate=rate, chip=chip)
