"""Toolpaths of a whole process: each operation from its drive geometry, knowing the stock that those before it leave.

Strategies work in the cutting frame, whose z is the direction that the operation's tool comes from; their paths are turned into the setup's
frame here. An operation whose drive, tool, data, settings and stock have the same digest keeps its toolpath.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from trunnion import registry, tolerance
from trunnion.findings import BadCall, Finding, Refused
from trunnion.geometry.frame import Frame
from trunnion.model.material import Material
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.scene import SessionContext, SetupScene
from trunnion.pipeline.turning import empty_path, refused, turned_path
from trunnion.plan.contract import DriveNeeds, Planner, ToolAxis, planner_for
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.progress import Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import checked, choose, digest
from trunnion.toolpath.motion.ground_links import over_ground
from trunnion.toolpath.motion.load import LoadStock, PathLoad
from trunnion.toolpath.motion.reorient import clearance_sphere, led_away, moved_over
from trunnion.toolpath.motion.rolled import laid_flat, rolled
from trunnion.toolpath.stock.views import StockViews

DRIVEN = 0.2
"""Share of an operation's progress for the geometry that drives it."""


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
    stock = StockViews(blank)
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
            for operation in session.process.of_setup(setup.name):
                begin, end = (len(laid) + n for n in (0, 1))
                text = f"toolpath of {operation.id}"
                progress.at(begin / total, text)
                here = progress.part(begin / total, end / total, text)
                made = _make_one(session, planner, scene, operation, here)
                # No path depends on the load of another: it is measured while the next path is laid.
                loads.append(
                    beside(partial(_load, made.path, setup.frame, operation, loaded, material))
                )
                laid.append(made)
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
    """Return whether a finding is of what its strategy leaves to others, and another operation on the same faces is there for it."""
    return finding.code in registry.get(STRATEGIES, own.strategy).leaves and any(
        finding.code in registry.get(STRATEGIES, o.strategy).settles
        and set(o.faces) & set(own.faces)
        for o in process.operations
        if o.id != own.id and not o.suppressed
    )


def _make_one(
    session: Session, planner: Planner, scene: SetupScene, operation: Operation, progress: Progress
) -> OperationPath:
    strategy = registry.get(STRATEGIES, operation.strategy)
    if strategy.drive is RevolvedDrive:
        return turned_path(session, planner, scene, operation, progress)
    cutter = operation.cutter
    settings = checked(choose(strategy.settings, {**session.choices, **operation.choices}))
    needs = DriveNeeds(
        drive=strategy.drive,
        leans=strategy.tool_axis(settings) is ToolAxis.LEANING,
        finds_rest=strategy.finds_rest,
        past=strategy.goes_past(settings),
    )
    try:
        driven = planner.drive(operation, needs, scene, progress.part(0.0, DRIVEN))
        setup, drive, rolling = driven.setup, driven.drive, driven.rolling
        stock = (
            scene.sides.over_ground(rolling) if rolling else scene.sides.seen(setup, driven.cell)
        )
        before = scene.before(cutter)
        key = digest(
            operation.strategy,
            driven.identity,
            operation.tool,
            operation.data,
            settings,
            stock.digest,
            setup,
            before,
        )
        kept = session.path_of(operation.id)
        if drive.is_empty:
            kept = empty_path(operation, key)
        if kept is None or kept.key != key:
            planned: Any = strategy(
                drive,
                cutter,
                operation.data,
                stock,
                setup,
                settings,
                progress.part(DRIVEN, 1.0),
            )
            sphere = clearance_sphere(scene.blank, scene.setup)
            own = scene.setup.frame
            path = (
                rolled(
                    over_ground(planned.path, rolling, setup.clearance),
                    rolling.development,
                    own,
                    rolling.chord,
                )
                if rolling
                else turned(planned.path, setup.frame, own)
            )
            path = led_away(moved_over(path, before, sphere), sphere)
            kept = OperationPath(
                operation=operation.id, path=path, findings=tuple(planned.findings), key=key
            )
        if driven.findings:
            kept = replace(kept, findings=_with(driven.findings, kept.findings))
    except Refused as reason:
        return refused(operation, reason)
    if len(kept.path) and rolling is not None:
        flat = laid_flat(kept.path, rolling.development, scene.setup.frame)
        scene.sides.cut_over(rolling, flat, cutter, progress.part(1.0, 1.0))
        scene.last, scene.tool = kept, cutter
    elif len(kept.path):
        scene.sides.cut(
            setup,
            turned(kept.path, scene.setup.frame, setup.frame),
            cutter,
            progress.part(1.0, 1.0),
        )
        scene.last, scene.tool = kept, cutter
    if len(kept.path):
        scene.laid.append((cutter, kept))
    return kept


def _with(first: Sequence[Finding], others: Sequence[Finding]) -> tuple[Finding, ...]:
    """Return findings once each: those of a path that was kept hold those of its drive already."""
    codes = {f.code for f in first}
    return (*first, *(f for f in others if f.code not in codes))


def _load(
    path: Toolpath,
    frame: Frame,
    operation: Operation,
    stock: LoadStock,
    material: Material,
    progress: Progress,
) -> PathLoad | None:
    """Return the load of a path in a frame, None where it cuts nothing or its tool does not stand upright; it is taken off the stock."""
    cuts = path.motion != Motion.RAPID
    if not cuts.any() or (path.axis[cuts, 2] < 1.0 - tolerance.PARAMETRIC).any():
        return None
    own = turned(path, frame, stock.frame)
    return stock.cut(own, operation.cutter, operation.data, material, progress)


def _with_load(laid: OperationPath, load: PathLoad | None) -> OperationPath:
    """Return a toolpath with the highest load that its motions come to."""
    if load is None:
        return laid
    power, rate, chip = (float(v.max(initial=0.0)) for v in (load.power, load.rate, load.chip))
    if (power, rate, chip) == (laid.power, laid.rate, laid.chip):
        return laid
    return replace(laid, power=power, rate=rate, chip=chip)


def turned(path: Toolpath, frame: Frame, other: Frame) -> Toolpath:
    """Return a path given in one frame in another one."""
    if frame is other or not len(path):
        return path
    arcs = np.isfinite(path.centre).all(axis=1)
    centre = path.centre.copy()
    centre[arcs] = other.to_local(frame.to_world(path.centre[arcs]))
    return replace(
        path,
        position=other.to_local(frame.to_world(path.position)),
        centre=centre,
        axis=other.local_direction(frame.world_direction(path.axis)),
    )
