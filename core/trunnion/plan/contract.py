"""What the planner of a family promises: from features to a process, and from an operation to the geometry that drives it.

A package adds a planner through the entry points `trunnion.planners`, under the name of the family whose parts it plans. Any planner may
use any strategy: it makes the drive geometry that the strategy declares.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, runtime_checkable

from trunnion import registry
from trunnion.findings import BadInput, Finding, Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.development import Development
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.guides import GuideCurve
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import SizeEntry
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceScene, LeaningCutQuery, RemainingStockQuery
from trunnion.plan.plane_guides import GuideSpace, guide_space
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.prismatic.fixtures import PlanFixture, off_fixtures
from trunnion.plan.prismatic.guide_faces import on_guide_faces
from trunnion.plan.prismatic.keep_out import off_boxes
from trunnion.plan.prismatic.kept import kept_by, with_kept
from trunnion.progress import Progress
from trunnion.registry import PLANNERS
from trunnion.settings import Value, checked, choose, digest
from trunnion.shop import Shop

if TYPE_CHECKING:
    from trunnion.part.part import Part

T = TypeVar("T")


class StockHeights(Protocol):
    """What is known to be gone already, as a field of heights (`toolpath.stock.PlanningStock`)."""

    @property
    def heights(self) -> Floats:
        """Heights (nx, ny) mm of square cells."""

    @property
    def corner(self) -> Floats:
        """Where cell (0, 0) begins (2,)."""

    @property
    def cell(self) -> float:
        """Side of a cell in mm."""


class PartContext(Protocol):
    """A part in its shop, and what may be asked of it beside its sections."""

    part: Part

    def skin(self, chord: float, progress: Progress) -> Skin:
        """Return the part's skin in its own coordinates within a chord error (mm)."""

    def around(
        self, setup: Setup, cutting: Frame, skin: Skin, progress: Progress
    ) -> ClearanceScene:
        """Return the clearance queries of a setup for a cutting frame, in which `skin` is the part's."""

    def make_ready(self, setup: Setup, cutting: Frame) -> None:
        """Build what the clearance queries of a cutting frame are answered by, where they were asked for."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RouteJob:
    """All that a route is made of; `choices` are a session's settings by full key."""

    recognition: Recognition
    sizes: tuple[SizeEntry, ...]
    blank: Blank
    setups: tuple[Setup, ...]
    shop: Shop
    context: PartContext
    choices: Mapping[str, Value]
    progress: Progress

    def settings_of(self, group: type[T]) -> T:
        """Return a group of settings as chosen; raise `BadInput` for a value that is not allowed."""
        return checked(choose(group, self.choices))


class ToolAxis(Enum):
    """Whether a strategy's tool keeps the z axis of the cutting frame."""

    FIXED = "fixed"
    LEANING = "leaning"


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveNeeds:
    """What an operation's strategy needs: the class of its drive, whether its tool leans, whether it finds for itself what an earlier
    cutter left, how far in mm its tips go past where they touch the faces, and whether it asks where leaning tools have cut before."""

    drive: type
    leans: bool = False
    finds_rest: bool = False
    past: float = math.inf
    earlier_cuts: bool = False


class Scene(Protocol):
    """What the operations of one setup are made in."""

    context: PartContext
    recognition: Recognition
    blank: Blank
    setup: Setup
    process: ProcessTree
    fixtures: tuple[Fixture, ...]

    @property
    def laid(self) -> Sequence[tuple[Tool, OperationPath]]:
        """The cutters and toolpaths, in the setup's frame, of the operations that cut before."""

    def stock(self, setup: Setup) -> StockHeights:
        """Return the stock that is left at this moment, in the frame of a setup (a cutting frame is one)."""

    def remaining_stock(
        self, frame: Frame, progress: Progress, *, leaning: bool = False
    ) -> RemainingStockQuery:
        """Return what stands at this moment off the part by all directions together, in a frame; with `leaning` without what leaning tools
        have cut that left an allowance."""

    def leaning_cuts(self, feature: str) -> tuple[LeaningCutQuery, ...]:
        """Return what leaning tools have cut for a feature before, in their order."""

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return what is made once for all operations of the setup, kept under a key."""


class Drive(Protocol):
    """Drive geometry of any class."""

    @property
    def is_empty(self) -> bool:
        """Whether an operation that it drives has nothing to cut."""


@runtime_checkable
class GuideDrive(Protocol):
    """Drive geometry of a class in which lines lead the passes, not faces alone."""

    def guides(self, space: GuideSpace) -> tuple[GuideCurve, ...]:
        """Return the lines in the part's coordinates."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RollingGround:
    """Ground that a path is rolled onto: its development, the chord error (mm) of feeds, and the corners (2,) of the plane's box that the
    stock over it is known in. `profile` (k, 2): places along the straight lines and how high the blank is there. `widths`: the share of its
    width that a straight cutter still has over the plane at the top of what is cut there. `known`: the places along the straight lines
    between which all is known that stands there. `upper`: the ground that what stands higher is cut with, where this one is sunk into it.
    """

    development: Development
    chord: float
    low: Floats
    high: Floats
    profile: Floats
    widths: float
    known: tuple[float, float] = (-math.inf, math.inf)
    upper: RollingGround | None = None


class LazyDrive:
    """A drive that is made when it is first looked at, and findings on what was cut off it then.

    When one operation is changed most paths of a plan stay, and what tells their drives from others is known without making them.
    """

    def __init__(self, make: Callable[[], tuple[Drive, tuple[Finding, ...]]]) -> None:
        self._make, self._made = make, list[tuple[Drive, tuple[Finding, ...]]]()

    @staticmethod
    def of(drive: Drive, findings: tuple[Finding, ...] = ()) -> LazyDrive:
        """Return a drive that is there already."""
        return LazyDrive(lambda: (drive, findings))

    def made(self) -> tuple[Drive, tuple[Finding, ...]]:
        """Return the drive and the findings; raise `Refused` where the part does not bear the feature out."""
        if not self._made:
            self._made.append(self._make())
        return self._made[0]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperationDrive:
    """The drive of an operation, the setup whose frame it lies in (the cutting frame), and `identity`, what a digest is made of that tells
    the drive from others: the drive itself, or its digest, with all else that its queries depend on.

    A drive over a `rolling` ground lies in the plane of its development instead, and so does the path until it is rolled onto it. `cell`:
    side (mm) of the cells that the stock is known in, where it need not be as fine as usual (0). `allowance`: mm that a leaning tool leaves
    for later ones, which are told what it has cut; 0 where it leaves nothing.
    """

    setup: Setup
    lazy: LazyDrive
    identity: Any
    rolling: RollingGround | None = None
    cell: float = 0.0
    allowance: float = 0.0

    @staticmethod
    def of(
        *,
        setup: Setup,
        drive: Drive,
        identity: Any,
        findings: tuple[Finding, ...] = (),
        rolling: RollingGround | None = None,
        cell: float = 0.0,
    ) -> OperationDrive:
        """Return an operation's drive that is there already."""
        return OperationDrive(
            setup=setup,
            lazy=LazyDrive.of(drive, findings),
            identity=identity,
            rolling=rolling,
            cell=cell,
        )

    def to_world(self, points: Floats) -> Floats:
        """Return points (n, 3) of the drive's frame in the part's coordinates."""
        if self.rolling is not None:
            return self.rolling.development.to_world(points)
        return self.setup.frame.to_world(points)

    @property
    def drive(self) -> Drive:
        """The drive itself, made when it is first looked at; raises `Refused` where the part does not bear the feature out."""
        return self.lazy.made()[0]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What was cut off the drive."""
        return self.lazy.made()[1]


class Planner(Protocol):
    """The planner of a family's parts.

    `name` is the family's, `noun` what several of its parts are called ("panels"); `settings` are the groups that its route reads,
    `cutter_rules` the words that its typical plans may give for a stage's cutter.
    """

    name: str
    noun: str
    settings: tuple[type, ...]
    cutter_rules: tuple[str, ...]

    def can_plan(self, part: Part) -> None:
        """Raise `BadInput` with what to do where nothing can be planned for a part."""

    def route(self, job: RouteJob) -> ProcessTree:
        """Return the process: operations in cutting order, and findings on what is not planned.

        Raises `BadInput` for settings or a typical plan that can't be followed, `Cancelled` when a person asked to stop.
        """

    def drive(
        self, operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
    ) -> OperationDrive:
        """Return the drive of an operation; raise `Refused` where the part does not bear the feature out."""


@runtime_checkable
class Leaning(Protocol):
    """A planner whose parts can't be made by an upright tool alone."""

    lean: float
    """rad: how far the tool leans from the setup's z axis, all round the part."""


@runtime_checkable
class AllowancePlanner(Protocol):
    """A planner whose operations leave what a person demands to stay on features (`plan.allowances`)."""

    allowance_kinds: tuple[str, ...]
    """The kinds of features that it can leave material on."""

    def walls_with(self, feature: Feature, recognition: Recognition) -> str:
        """Return the id of the feature whose operations cut a feature's walls; the feature's own where those on it do."""


@runtime_checkable
class SkinPlanner(Protocol):
    """A planner that looks at skins of every part of its family: they can be made before it is asked."""

    skins: tuple[float, ...]
    """mm: their chord errors, in the order they are wanted."""


DriveMaker = Callable[[Operation, DriveNeeds, Scene, Progress], OperationDrive]
"""How a planner makes drives of one class."""


def planner_for(family: str) -> Planner:
    """Return the planner of a family; raise `BadInput` where it has none."""
    known = registry.names(PLANNERS)
    if family not in known:
        raise BadInput(
            f"parts of the family {family} are segmented and measured, but not planned yet; for flat pockets and "
            f"outlines choose recognize.family = {' or '.join(known)}"
        )
    planner: Planner = registry.get(PLANNERS, family)()
    return planner


def allowance_planner(family: str) -> AllowancePlanner:
    """Return the planner of a family that can leave material on features; raise `BadInput` where it has none, or it can't."""
    planner = planner_for(family)
    if not isinstance(planner, AllowancePlanner):
        raise BadInput(f"material is not left on purpose on features of {planner.noun} yet")
    return planner


def driven_by(
    makers: Mapping[type, DriveMaker],
    planner: Planner,
    operation: Operation,
    needs: DriveNeeds,
    scene: Scene,
    progress: Progress,
) -> OperationDrive:
    """Return the drive of an operation by the maker for the class that its strategy needs; raise `Refused` where there is none.

    The faces that a person gave it lead a plane drive, which leaves what its feature keeps on purpose; makers of other drives take the
    operation's. What fixtures, or the areas that it avoids, keep its cutter from is cut off a plane drive; makers of other drives see to
    that themselves. Links know those areas by the drive's setup.
    """
    if needs.drive not in makers:
        raise Refused(
            f"{operation.id}: {operation.strategy} is driven by a {needs.drive.__name__}, which is not made for {planner.noun}; "
            "choose another strategy"
        )
    driven = makers[needs.drive](operation, needs, scene, progress)
    if needs.drive is PlaneDrive and operation.own_faces:
        driven = _on_guide_faces(driven, operation, scene)
    if needs.drive is PlaneDrive and kept_by(operation) != (0.0, 0.0):
        driven = _with_kept(driven, operation)
    if needs.drive is PlaneDrive and scene.fixtures:
        driven = _off_fixtures(driven, operation, scene)
    return driven if needs.leans or not operation.avoid else _off_boxes(driven, operation, needs)


def _on_guide_faces(driven: OperationDrive, operation: Operation, scene: Scene) -> OperationDrive:
    plane = driven.drive
    assert isinstance(plane, PlaneDrive)
    space = guide_space(scene.context.part, driven.to_world)
    drive = on_guide_faces(plane, operation.id, operation.faces, space)
    return replace(
        driven,
        lazy=LazyDrive.of(drive, driven.findings),
        identity=(driven.identity, drive),
    )


def _with_kept(driven: OperationDrive, operation: Operation) -> OperationDrive:
    plane = driven.drive
    assert isinstance(plane, PlaneDrive)
    drive = with_kept(plane, *kept_by(operation))
    return replace(
        driven,
        lazy=LazyDrive.of(drive, driven.findings),
        identity=(driven.identity, drive),
    )


def _off_fixtures(driven: OperationDrive, operation: Operation, scene: Scene) -> OperationDrive:
    setup, plane = driven.setup, driven.drive
    assert isinstance(plane, PlaneDrive)
    fixtures = scene.once(
        ("fixtures", digest(setup.frame)),
        lambda: tuple(PlanFixture.of(f, setup, scene.blank) for f in scene.fixtures),
    )
    drive, findings = off_fixtures(plane, operation.cutter, setup, fixtures)
    return replace(
        driven,
        lazy=LazyDrive.of(drive, (*driven.findings, *findings)),
        identity=(driven.identity, drive),
    )


def _off_boxes(driven: OperationDrive, operation: Operation, needs: DriveNeeds) -> OperationDrive:
    setup = replace(driven.setup, avoid=operation.avoid)
    if needs.drive is not PlaneDrive:
        return replace(driven, setup=setup)
    plane = driven.drive
    assert isinstance(plane, PlaneDrive)
    drive, findings = off_boxes(plane, operation.cutter, setup, operation.avoid)
    return replace(
        driven,
        setup=setup,
        lazy=LazyDrive.of(drive, (*driven.findings, *findings)),
        identity=(driven.identity, drive),
    )
