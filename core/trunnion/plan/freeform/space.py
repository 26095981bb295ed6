"""The space of a part of curved surfaces as a tool from one direction sees it: its skin, its exact faces, and the blank around it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from trunnion.findings import Finding, face_tags
from trunnion.geometry.arrays import Floats
from trunnion.geometry.cache import Cache
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.geometry.plane.region import Region
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Blank
from trunnion.model.keep_out import KeepOutBox
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.part.part import Part
from trunnion.part.shape.exact import ExactFace
from trunnion.plan.clearance import ClearanceQuery, LeaningCutQuery, RemainingStockQuery
from trunnion.plan.contract import DriveNeeds
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.finishing.partition import parted_within
from trunnion.plan.freeform.finishing.rest import remaining_of, remaining_upright, without_met
from trunnion.plan.freeform.fixtures import (
    KeepOutArea,
    OffsetFixture,
    off_boxes,
    off_fixtures,
    with_fixtures,
)
from trunnion.plan.freeform.keys import EXTENSION, OVERHANG, SCALLOP, number, total_allowance
from trunnion.plan.prismatic.fixtures import Notice, kept_off
from trunnion.plan.prismatic.keep_out import excluded
from trunnion.plan.setups.frames import UPRIGHT, Direction, cutting_setup
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest

AROUND = 45.0
"""mm: how far free space is looked at around the blank: two diameters of the largest cutter, but no way for it to wander."""

PAST = 10.0
"""mm more than tools come near to while they finish faces: as far as they are taken longer or wider where they are tested."""

LEFTOVER = 2.0
"""Times the depth of cut: what operations before leave on faces at most."""


KEPT = 32
"""Heights whose plan areas are kept: more than the walls of most parts end at."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfaceSpace:
    """A part in its blank, seen from the tool's direction; everything is in the cutting frame.

    `setup` is the machine's setup turned into that frame, `skin` the whole part's, `low` and `high` (3,) the box around the blank.
    """

    part: Part
    blank: Blank
    setup: Setup
    direction: Direction
    skin: Skin
    low: Floats
    high: Floats
    _thick: list[OffsetFixture] = field(init=False, repr=False, default_factory=list)
    _above: Cache[Region] = field(init=False, repr=False, default_factory=partial(Cache, KEPT))

    @staticmethod
    def of(
        part: Part, skin: Skin, blank: Blank, setup: Setup, direction: Direction = UPRIGHT
    ) -> SurfaceSpace:
        """Return the space of a direction given in the setup's frame; `skin` is in the part's coordinates."""
        turned = cutting_setup(setup, direction, blank)
        low, high = blank.box_in(turned.frame)
        return SurfaceSpace(
            part=part,
            blank=blank,
            setup=turned,
            direction=direction,
            skin=skin.moved(WORLD, turned.frame),
            low=low,
            high=high,
        )

    @property
    def frame(self) -> Frame:
        """The cutting frame."""
        return self.setup.frame

    def fixtures(self) -> Sequence[OffsetFixture]:
        """Return the fixtures of the setup as they stand in the cutting frame."""
        if len(self._thick) < len(self.setup.fixtures):
            self._thick[:] = [
                OffsetFixture.of(f, self.setup, self.blank) for f in self.setup.fixtures
            ]
        return self._thick

    def blank_area(self) -> Region:
        """Return the blank seen along the tool."""
        return self.blank.plan_area(self.frame)

    def around(self) -> Region:
        """Return the plan area of the blank and of the free space around it."""
        return Region.rectangle(*(self.low[:2] - AROUND), *(self.high[:2] + AROUND))

    def plan_above(self, z: float) -> Region:
        """Return the plan area of the part's triangles above a height, no smaller than the part's own; kept by height."""
        skin = self.skin
        return self._above.get(
            z, lambda: plan_area_above(skin.points[skin.triangles], z, skin.bound)
        )

    def seen_from(self, setup: Setup, direction: Direction) -> SurfaceSpace:
        """Return the same part seen from another direction given in the frame of the machine's setup."""
        turned = cutting_setup(setup, direction, self.blank)
        low, high = self.blank.box_in(turned.frame)
        return replace(
            self,
            setup=turned,
            direction=direction,
            skin=self.skin.moved(self.frame, turned.frame),
            low=low,
            high=high,
        )

    def drive_of(
        self,
        operation: Operation,
        needs: DriveNeeds,
        earlier: Tool | None = None,
        query_for: Callable[[Tool], ClearanceQuery] | None = None,
        remaining_stock: RemainingStockQuery | None = None,
        upright: Tool | None = None,
        progress: Progress = NO_PROGRESS,
        within: Region | None = None,
        leaning_cuts: tuple[LeaningCutQuery, ...] = (),
    ) -> SurfaceDrive:
        """Return what an operation on curved faces is driven by.

        `earlier` is the cutter that finished them before, `query_for` returns the clearance query of a tool, `remaining_stock` is the
        material that stands, `leaning_cuts` what leaning tools have cut for the feature, `upright` the cutter that finished what an upright
        one comes to.

        With a plan area only what is `within` it is finished of faces that run out of it.

        Unless the tool leans, what it can't come to without its shank or holder meeting the part, or any of it a fixture of the setup,
        is none of its area; neither is what it can't come to with its tip outside the boxes that the operation avoids.
        """
        height, extension = (number(operation, key) for key in (SCALLOP, EXTENSION))
        thickness = _thickness(operation)
        skin, faces, lowest = self.skin, operation.faces, float(self.low[2]) - self.setup.clearance
        if within is not None:
            skin, faces = parted_within(skin, faces, within)
        if not needs.leans and needs.past < math.inf:
            tools = [t for t in (operation.cutter, earlier, upright) if t is not None]
            skin = skin_around(skin, faces, tools, thickness + extension + needs.past)
        if earlier is not None and not needs.finds_rest:
            own = None if needs.leans else operation.cutter
            skin, faces = remaining_of(skin, faces, earlier, lowest, height, progress, own)
        if upright is not None:
            skin, faces = remaining_upright(
                skin, faces, upright, lowest, height, thickness, progress
            )
        if not needs.leans:
            skin, faces = without_met(
                skin, faces, operation.cutter, lowest, height, thickness, progress
            )
        fixtures, refused = self.fixtures(), None
        if fixtures and not needs.leans:
            skin, faces, refused = off_fixtures(
                skin, faces, operation.cutter, fixtures, lowest, height, progress
            )
        if fixtures:
            skin = with_fixtures(skin, fixtures)
        boxes, avoided = _avoided(operation, needs), None
        if boxes:
            skin, faces, avoided = off_boxes(skin, faces, operation.cutter, boxes, height, progress)
        notices = ((kept_off, refused), (excluded, avoided))
        return SurfaceDrive(
            feature=operation.feature,
            kind=operation.kind,
            faces=faces,
            skin=skin,
            frame=self.frame,
            exact=tuple(ExactFace(self.part, tag, self.frame) for tag in operation.faces),
            low=self.low,
            high=self.high,
            clearance=self.setup.clearance,
            allowance=total_allowance(operation),
            height=height,
            digest=self.drive_digest(operation, needs, earlier, upright, within),
            earlier=earlier,
            query_for=query_for,
            remaining_stock=remaining_stock,
            leaning_cuts=leaning_cuts,
            findings=tuple(
                self._finding(operation, area, notice)
                for notice, area in notices
                if area is not None
            ),
            extension=extension,
        )

    def drive_digest(
        self,
        operation: Operation,
        needs: DriveNeeds,
        earlier: Tool | None = None,
        upright: Tool | None = None,
        within: Region | None = None,
    ) -> str:
        """Return a digest of all that `drive_of` makes a drive from, but for the fixtures and the operation's own tool and settings."""
        boxes, extension = _avoided(operation, needs), number(operation, EXTENSION)
        return digest(
            self.part.digest,
            self.part.solid,
            operation.feature,
            operation.kind,
            operation.faces,
            self.frame,
            self.blank,
            self.setup.clearance,
            self.skin.bound,
            len(self.skin.triangles),
            number(operation, SCALLOP),
            total_allowance(operation),
            earlier,
            upright,
            _thickness(operation),
            needs.leans,
            *((boxes,) if boxes else ()),
            *((extension,) if extension else ()),
            *((within,) if within is not None else ()),
        )

    def _finding(self, operation: Operation, refused: KeepOutArea, notice: Notice) -> Finding:
        at = self.frame.to_world(refused.at)
        where = (operation.feature, *face_tags(operation.faces))
        return notice(
            operation.feature, f"{refused.area:.0f} mm2", refused.by, operation.cutter, at, where
        )


def _thickness(operation: Operation) -> float:
    """Return what (mm) operations before leave on faces that hang over."""
    known = OVERHANG in operation.choices
    return number(operation, OVERHANG) if known else LEFTOVER * operation.data.depth


def _avoided(operation: Operation, needs: DriveNeeds) -> tuple[KeepOutBox, ...]:
    """Return the boxes that an operation avoids: a leaning tool knows none."""
    return () if needs.leans else operation.avoid


def skin_around(skin: Skin, tags: tuple[int, ...], tools: Sequence[Tool], more: float) -> Skin:
    """Return what of a skin upright tools may come near to, by `more` mm than they touch it, while they finish faces: a part has many
    pockets, and each operation is in one."""
    mine = skin.points[skin.triangles[skin.of(tags)]].reshape(-1, 3)
    if not len(mine):
        return skin
    low, high = mine.min(axis=0), mine.max(axis=0)
    # What of a tool is higher over the lowest place of the faces than the part is high meets nothing.
    above = float(skin.points[:, 2].max() - low[2]) + PAST
    wide = max(r for t in tools for z, r in t.rings() if z < above)
    around = max(t.radius for t in tools) + wide + more + PAST
    return skin.near(low[:2] - around, high[:2] + around)
