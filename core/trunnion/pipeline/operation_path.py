"""The toolpath of one operation that mills: what it depends on, the strategy's path, and what the setup gets of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from trunnion import registry
from trunnion.findings import Finding
from trunnion.geometry.frame import Frame
from trunnion.model.guides import GuideChain
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.pipeline.planning.scene import SetupScene
from trunnion.pipeline.turning import empty_path
from trunnion.plan.contract import (
    DriveNeeds,
    GuideDrive,
    LazyDrive,
    OperationDrive,
    Planner,
    ToolAxis,
)
from trunnion.plan.plane_guides import MeshSource, guide_space
from trunnion.progress import Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import checked, choose, digest
from trunnion.toolpath.contract import Planned
from trunnion.toolpath.motion.ground_links import over_ground
from trunnion.toolpath.motion.reorient import clearance_sphere, led_away, moved_over
from trunnion.toolpath.motion.rolled import laid_flat, rolled
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.stock_reads import StockBox


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CopyResult:
    """What was made of a job before its turn: the strategy's path, None where there is nothing to cut, the findings of its drive and the
    guide lines that led it, which need not be made again."""

    planned: Planned | None
    findings: tuple[Finding, ...]
    guides: tuple[GuideChain, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to cut."""
        return self.planned is None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PathJob:
    """An operation with all that its toolpath depends on but the pose that its tool is left in before."""

    operation: Operation
    settings: Any
    driven: OperationDrive
    stock: PlanningStock
    scene: SetupScene
    leans: bool

    @staticmethod
    def of(
        session: Session,
        planner: Planner,
        scene: SetupScene,
        operation: Operation,
        progress: Progress,
    ) -> PathJob:
        """Return an operation with its drive and the stock at this moment; raise `Refused` where the part does not bear its feature out."""
        strategy = registry.get(STRATEGIES, operation.strategy)
        settings = checked(choose(strategy.settings, {**session.choices, **operation.choices}))
        needs = DriveNeeds(
            drive=strategy.drive,
            leans=strategy.tool_axis(settings) is ToolAxis.LEANING,
            finds_rest=strategy.finds_rest,
            past=strategy.goes_past(settings),
            earlier_cuts=strategy.earlier_cuts,
        )
        driven = planner.drive(operation, needs, scene, progress)
        rolling, sides = driven.rolling, scene.sides
        stock = sides.over_ground(rolling) if rolling else sides.seen(driven.setup, driven.cell)
        return PathJob(
            operation=operation,
            settings=settings,
            driven=driven,
            stock=stock,
            scene=scene,
            leans=needs.leans,
        )

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to cut."""
        return self.driven.drive.is_empty

    def ahead(self, progress: Progress) -> CopyResult:
        """Return the path on the stock of the moment, with all that others need of the drive; raise `Refused` where there is none."""
        findings = self.driven.findings
        planned = None if self.is_empty else self.planned(progress)
        return CopyResult(
            planned=planned,
            findings=findings,
            guides=chains_of(self.driven, self.scene.context.part),
        )

    def takes(self, other: PathJob, made: CopyResult) -> bool:
        """Return whether this job would come to what was made of another one, of the same operation, before the stock was this one."""
        box = self._nowhere() if made.planned is None else made.planned.stock_box
        return self.stock.digest_in(box) == other.stock.digest_in(box) and digest(
            *self._identity()
        ) == digest(*other._identity())

    def known_by(self, made: CopyResult) -> PathJob:
        """Return this job with what was made of it in place of its drive."""
        return replace(self, driven=replace(self.driven, lazy=LazyDrive.of(made, made.findings)))

    def kept(self, session: Session) -> OperationPath | None:
        """Return the toolpath that a session has, where all it depends on is the same; or the empty one of what finds nothing to cut."""
        key, kept = self._key(), session.path_of(self.operation.id)
        if (
            kept is not None
            and kept.key == key
            and kept.stock_key == self.stock.digest_in(kept.stock_box)
        ):
            # It has the findings of its drive, which need not be made again.
            return kept
        return self._with_drive_findings(self._empty(key)) if self.is_empty else None

    def planned(self, progress: Progress) -> Planned:
        """Return the strategy's path in the cutting frame; raise `Refused` where it finds none."""
        operation, driven = self.operation, self.driven
        # What stands round a leaning tool is asked of all fields together.
        stock = self.stock if self.leans else self.stock.recorded()
        made: Planned = registry.get(STRATEGIES, operation.strategy)(
            driven.drive,
            operation.cutter,
            operation.data,
            stock,
            driven.setup,
            self.settings,
            progress,
        )
        return replace(made, stock_box=stock.box_read())

    def path(self, planned: Planned) -> OperationPath:
        """Return the toolpath in the setup's frame, led on from where the tool is now."""
        driven, scene = self.driven, self.scene
        sphere = clearance_sphere(scene.blank, scene.setup)
        own, rolling = scene.setup.frame, driven.rolling
        path = (
            rolled(
                over_ground(planned.path, rolling, driven.setup.clearance),
                rolling.development,
                own,
                rolling.chord,
            )
            if rolling
            else turned(planned.path, driven.setup.frame, own)
        )
        path = led_away(moved_over(path, scene.before(self.operation.cutter), sphere), sphere)
        return self._with_drive_findings(
            OperationPath(
                operation=self.operation.id,
                path=path,
                findings=tuple(planned.findings),
                key=self._key(),
                stock_box=planned.stock_box,
                stock_key=self.stock.digest_in(planned.stock_box),
                guides=chains_of(driven, scene.context.part),
            )
        )

    def _empty(self, key: str) -> OperationPath:
        """Return the empty path of a drive that is empty wherever stock stands."""
        nowhere = self._nowhere()
        return replace(
            empty_path(self.operation, key),
            stock_box=nowhere,
            stock_key=self.stock.digest_in(nowhere),
        )

    def _nowhere(self) -> StockBox:
        return self.stock.recorded().box_read()

    def cut(self, made: OperationPath, progress: Progress) -> bool:
        """Take a path off the stock, and leave the tool where it ends; return whether the stock is another one then."""
        if not len(made.path):
            return False
        scene, cutter, rolling = self.scene, self.operation.cutter, self.driven.rolling
        own, changed = scene.setup.frame, True
        if rolling is not None:
            flat = laid_flat(made.path, rolling.development, own)
            scene.sides.cut_over(rolling, flat, cutter, progress)
        else:
            setup = self.driven.setup
            changed = scene.sides.cut(
                setup,
                turned(made.path, own, setup.frame),
                cutter,
                progress,
                feature=self.operation.feature,
                allowance=self.driven.allowance,
            )
        scene.leave(cutter, made)
        return changed

    def _key(self) -> str:
        return digest(*self._identity(), self.scene.before(self.operation.cutter))

    def _identity(self) -> tuple[Any, ...]:
        """Return all that the strategy's path depends on but the stock."""
        operation, driven = self.operation, self.driven
        return (
            operation.strategy,
            driven.identity,
            # Its number is that of the order of use, which other operations change.
            replace(operation.tool, number=0),
            operation.data,
            self.settings,
            driven.setup,
        )

    def _with_drive_findings(self, made: OperationPath) -> OperationPath:
        if not self.driven.findings:
            return made
        return replace(made, findings=(*self.driven.findings, *made.findings))


def chains_of(driven: OperationDrive, part: MeshSource) -> tuple[GuideChain, ...]:
    """Return the guide lines of a drive by the faces that they are on; those that are on none say nothing."""
    drive: Any = driven.drive
    if isinstance(drive, CopyResult):
        return drive.guides
    if not isinstance(drive, GuideDrive):
        return ()
    lines = drive.guides(guide_space(part, driven.to_world))
    return tuple(g.chain for g in lines if any(g.chain.on) or g.chain.faces)


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
