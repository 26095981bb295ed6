"""Toolpaths of a whole process: each operation from its drive geometry, knowing the stock that those before it leave.

Strategies work in the cutting frame, whose z is the direction that the operation's tool comes from; their paths are turned into the setup's
frame here. An operation whose drive, tool, data, settings and stock have the same digest keeps its toolpath.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from trunnion import registry, tolerance
from trunnion.findings import BadCall, Finding, Refused, error, info
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Toolpath
from trunnion.pipeline.asking import PartSurroundings
from trunnion.pipeline.bench import Bench
from trunnion.plan.drive import PlaneDrive, drive_of
from trunnion.plan.regions import Space
from trunnion.plan.surface.frames import Direction
from trunnion.plan.surface.layers import plane_drive_of
from trunnion.plan.surface.settings import EARLIER
from trunnion.plan.surface.space import SurfaceSpace
from trunnion.progress import Progress
from trunnion.settings import checked, choose, digest
from trunnion.toolpath.contract import ToolAxis
from trunnion.toolpath.sides import Sides
from trunnion.toolpath.stock import PlanningStock
from trunnion.toolpath.turning import Pose, moved_over, swing_of

SURFACE_FAMILY = "surface"
"""The family whose plane operations are driven by how high the part stands, not by its features."""


def strategy_settings() -> tuple[type, ...]:
    """Return the settings of every registered strategy."""
    return tuple(registry.get("strategies", name).settings for name in registry.names("strategies"))


def make_paths(session: Session, bench: Bench, progress: Progress) -> tuple[OperationPath, ...]:
    """Return the toolpath of every operation that is not suppressed, in the order they are cut."""
    if session.process is None or session.recognition is None or session.blank is None:
        raise BadCall("no operations yet: generate the route first")
    made: list[OperationPath] = []
    total = sum(len(session.process.of_setup(setup.name)) for setup in session.setups)
    for setup in session.setups:
        room = Room(bench, session.recognition, session.blank, setup)
        for operation in session.process.of_setup(setup.name):
            progress.at(len(made) / max(total, 1), f"toolpath of {operation.id}")
            here = progress.part(len(made) / max(total, 1), (len(made) + 1) / max(total, 1), f"toolpath of {operation.id}")
            made.append(_make_one(session, room, operation, here))
    return tuple(made)


DRIVEN = 0.2
"""Share of an operation's progress for the geometry that drives it."""


def findings_of(paths: Sequence[OperationPath], process: ProcessTree) -> tuple[Finding, ...]:
    """Return what toolpaths have told, without what is said of slopes and corners that another operation on the same faces is there for."""
    return tuple(f for path in paths for f in path.findings if not _settled(f, process.operation(path.operation), process))


def _settled(finding: Finding, own: Operation, process: ProcessTree) -> bool:
    """Say whether a finding is of what its strategy leaves to others, and another operation on the same faces is there for it."""
    return finding.code in registry.get("strategies", own.strategy).leaves and any(
        finding.code in registry.get("strategies", o.strategy).settles and set(o.faces) & set(own.faces)
        for o in process.operations if o.id != own.id and not o.suppressed)


@dataclass(slots=True)
class Room:
    """What the operations of one setup are made in: the part as each direction sees it, the stock that is left there, and the last path
    with its tool."""

    bench: Bench
    recognition: Recognition
    blank: Blank
    setup: Setup
    sides: Sides = field(init=False)
    last: OperationPath | None = None
    tool: Tool | None = None
    _plane: Space | None = None
    _curved: dict[tuple[Direction, float], SurfaceSpace] = field(default_factory=dict)
    _around: dict[Direction, PartSurroundings] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.sides = Sides(self.blank)

    def before(self, tool: Tool) -> Pose | None:
        """Return the pose that a tool was left in, or None when it comes from its change."""
        if self.last is None or self.tool is None or self.tool.number != tool.number:
            return None
        return self.last.path.position[-1], self.last.path.axis[-1]

    def plane(self) -> Space:
        """Return the part's sections as the setup sees them."""
        if self._plane is None:
            self._plane = Space.of(self.bench.part, self.recognition, self.blank, self.setup)
        return self._plane

    def curved(self, direction: Direction, chord: float, progress: Progress) -> SurfaceSpace:
        """Return the part's skin, within a chord error (mm), as a tool from a direction sees it."""
        if (direction, chord) not in self._curved:
            skin = self.bench.skin(chord, progress)
            self._curved[direction, chord] = SurfaceSpace.of(self.bench.part, skin, self.blank, self.setup, direction)
        return self._curved[direction, chord]

    def around(self, direction: Direction, fixtures: tuple[Fixture, ...], progress: Progress) -> PartSurroundings:
        """Return who says for a leaning tool, from a direction, whether it is clear of part and fixtures."""
        if direction not in self._around:
            space = self.curved(direction, tolerance.SKIN_CHORD, progress)
            self._around[direction] = PartSurroundings(self.bench.part, space.skin, space.frame, self.setup.frame,
                                                       self.bench.shop.machine(self.setup.machine), fixtures)
        self._around[direction].progress = progress
        return self._around[direction]


def _make_one(session: Session, room: Room, operation: Operation, progress: Progress) -> OperationPath:
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    strategy = registry.get("strategies", operation.strategy)
    chosen = checked(choose(strategy.settings, {**session.choices, **operation.choices}))
    try:
        leans = strategy.tool_axis(chosen) is ToolAxis.LEANING
        setup, stock, drive, told = _driven(session, room, operation, leans, progress.part(0.0, DRIVEN))
        before = room.before(operation.tool)
        key = digest(operation.strategy, told, operation.tool, operation.data, chosen, stock.digest, setup, before)
        kept = session.path_of(operation.id)
        if isinstance(drive, PlaneDrive) and not any(level.wanted for level in drive.levels):
            nothing = info("toolpath.nothing-left", f"{operation.id}: nothing stands there any more that it could cut", operation.id,
                           remedy="suppress it")
            kept = OperationPath(operation=operation.id, findings=(nothing,), key=key)
        if kept is None or kept.key != key:
            planned: Any = strategy(drive, operation.tool, operation.data, stock, setup, chosen, progress.part(DRIVEN, 1.0))
            swing = swing_of(room.blank, replace(room.setup, fixtures=session.fixtures_of(room.setup.name)))
            path = moved_over(turned(planned.path, setup.frame, room.setup.frame), before, swing)
            kept = OperationPath(operation=operation.id, path=path, findings=tuple(planned.findings), key=key)
    except Refused as reason:
        left = error("toolpath.refused", str(reason), operation.id, operation.feature)
        return OperationPath(operation=operation.id, findings=(left,))
    if len(kept.path):
        room.sides.cut(setup, turned(kept.path, room.setup.frame, setup.frame), operation.tool, progress.part(1.0, 1.0))
        room.last, room.tool = kept, operation.tool
    return kept


def _driven(session: Session, room: Room, operation: Operation, leans: bool, progress: Progress) -> tuple[Setup, PlanningStock, Any, Any]:
    """Return the setup, the stock and the drive of an operation in its cutting frame, and what tells the drive from others."""
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    plane = registry.get("strategies", operation.strategy).drive is PlaneDrive
    if plane and room.recognition.family != SURFACE_FAMILY:
        flat = drive_of(operation, session.process, room.plane())
        return room.setup, room.sides.seen(room.setup), flat, flat
    space = room.curved(operation.direction, tolerance.CHORD if plane else tolerance.SKIN_CHORD, progress)
    stock = room.sides.seen(space.setup)
    if plane:
        layers = plane_drive_of(operation, space, stock, progress, session.process)
        return space.setup, stock, layers, layers
    fixtures = session.fixtures_of(room.setup.name)
    name = operation.choices.get(EARLIER, "")
    earlier = next((t for t in session.process.tools() if t.name == name), None)
    drive = space.drive_of(operation, earlier, room.around(operation.direction, fixtures, progress), leans, progress)
    return space.setup, stock, drive, (drive.digest, fixtures)


def turned(path: Toolpath, frame: Frame, other: Frame) -> Toolpath:
    """Return a path given in one frame in another one."""
    if frame is other or not len(path):
        return path
    arcs = np.isfinite(path.centre).all(axis=1)
    centre = path.centre.copy()
    centre[arcs] = other.to_local(frame.to_world(path.centre[arcs]))
    return replace(path, position=other.to_local(frame.to_world(path.position)), centre=centre,
                   axis=other.local_direction(frame.world_direction(path.axis)))
