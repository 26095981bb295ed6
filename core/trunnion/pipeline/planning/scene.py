"""What planners are given of a session: the part with its queries, and the scene that a setup's operations are made in."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from trunnion import tolerance
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.operation import OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.clearance import PartClearance
from trunnion.plan.contract import PartContext
from trunnion.plan.setups import held
from trunnion.progress import Progress
from trunnion.settings import digest
from trunnion.toolpath.motion.reorient import Pose
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.leaning_cuts import LeaningCut
from trunnion.toolpath.stock.remaining import RemainingStock
from trunnion.toolpath.stock.views import StockViews

if TYPE_CHECKING:
    from trunnion.part.part import Part

T = TypeVar("T")


class SessionContext:
    """The part of a session, with its skins and the clearance queries of its setups; queries are kept for each cutting frame."""

    def __init__(self, context: Context, session: Session) -> None:
        self.part: Part = context.part
        self._context, self._session = context, session
        self._around: dict[tuple[str, str], PartClearance] = {}

    def skin(self, chord: float, progress: Progress) -> Skin:
        """Return the part's skin in its own coordinates within a chord error (mm)."""
        return self._context.skin(chord, progress)

    def around(self, setup: Setup, cutting: Frame, skin: Skin, progress: Progress) -> PartClearance:
        """Return the clearance queries of a setup for a cutting frame, in which `skin` is the part's.

        `progress` is looked at from now on.
        """
        key = (setup.name, digest(cutting))
        if key not in self._around:
            self._around[key] = PartClearance(
                self.part,
                skin,
                cutting,
                setup.frame,
                self._context.shop.machine(setup.machine),
                self._session.fixtures_of(setup.name),
            )
        self._around[key].progress = progress
        return self._around[key]

    def make_ready(self, setup: Setup, cutting: Frame) -> None:
        """Build what the clearance queries of a cutting frame are answered by, where they were asked for."""
        around = self._around.get((setup.name, digest(cutting)))
        if around is not None:
            around.ready()


@dataclass(slots=True, kw_only=True)
class SetupScene:
    """What the operations of one setup are made in: the part, the stock that is left, and the last path with its tool.

    `handed_on` is the stock that the setups before have left; without it the blank is uncut. The setup is held by its fixtures
    (`plan.setups.held`).
    """

    context: PartContext
    recognition: Recognition
    blank: Blank
    setup: Setup
    process: ProcessTree
    fixtures: tuple[Fixture, ...]
    handed_on: StockViews | None = None
    sides: StockViews = field(init=False)
    last: OperationPath | None = None
    tool: Tool | None = None
    before_laid: Callable[[], None] | None = None
    """Called before anybody looks at `laid`: some paths may still be made."""
    before_leaning: Callable[[], None] | None = None
    """Called before anybody asks what leaning tools have cut that left an allowance."""
    before_cuts: Callable[[str], None] | None = None
    """Called with a feature before anybody asks what leaning tools have cut for it."""
    _laid: list[tuple[Tool, OperationPath]] = field(default_factory=list)
    _made: dict[Hashable, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.setup = held(self.setup, self.fixtures, self.blank)
        self.sides = StockViews(self.blank) if self.handed_on is None else self.handed_on

    @property
    def laid(self) -> Sequence[tuple[Tool, OperationPath]]:
        """The cutters and toolpaths, in the setup's frame, of all operations that cut before."""
        if self.before_laid is not None:
            self.before_laid()
        return self._laid

    def leave(self, tool: Tool, path: OperationPath) -> None:
        """Remember a tool and its path, at whose end it is left."""
        self.last, self.tool = path, tool
        self._laid.append((tool, path))

    def stock(self, setup: Setup) -> PlanningStock:
        """Return the stock that is left at this moment, in the frame of a setup (a cutting frame is one)."""
        return self.sides.seen(setup)

    def remaining_stock(
        self, frame: Frame, progress: Progress, *, leaning: bool = False
    ) -> RemainingStock:
        """Return what stands at this moment off the part by all directions together, in a frame; with `leaning` without what leaning tools
        have cut that left an allowance."""
        if leaning and self.before_leaning is not None:
            self.before_leaning()

        def skin() -> Skin:
            return self.context.skin(tolerance.SKIN_CHORD, progress)

        return self.sides.remaining_stock(frame, skin, leaning=leaning, progress=progress)

    def leaning_cuts(self, feature: str) -> tuple[LeaningCut, ...]:
        """Return what leaning tools have cut for a feature before, in their order."""
        if self.before_cuts is not None:
            self.before_cuts(feature)
        return self.sides.leaning_cuts(feature)

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return what is made once for all operations of the setup, kept under a key."""
        if key not in self._made:
            self._made[key] = make()
        made: T = self._made[key]
        return made

    def before(self, tool: Tool) -> Pose | None:
        """Return the pose that a tool was left in, or None when it comes from its change."""
        if self.last is None or self.tool is None or self.tool.number != tool.number:
            return None
        return self.last.path.position[-1], self.last.path.axis[-1]
