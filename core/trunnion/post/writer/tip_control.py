"""Programs for controls that follow the tip of the tool by themselves: positions of the tip in the work, and the tool's direction.

Where the tool keeps one direction while it feeds, the plane of the program is tilted to it: arcs and cycles stay what they are. Where it
turns, each block says the tip and the tool axis as a vector, between which the tip goes straight and the axis turns evenly in the plane of
both: that is what a toolpath means by a block, so none is put between. The words know nothing of machine and tool length. Between two
directions that are not joined by the path itself the tool goes to the top of the machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import ClassVar

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.material import leaning_axis
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.model.tool import AnyTool
from trunnion.post.header import work_position_lines
from trunnion.post.iso_words import IsoWords, code_of
from trunnion.post.linearize import MARGIN, lines_for_arcs
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale, WrittenPath, written
from trunnion.post.writer.modal import WrittenState, changed
from trunnion.post.writer.program import ProgramWriter
from trunnion.post.writer.rotary import AxisForm, ThreeAxes, inverse_minutes
from trunnion.post.writer.tilted_plane import TiltedPlane, in_plane_of, plane_across, plane_rows
from trunnion.shop.kinematics import UPRIGHT, WorkPosition, lift_of
from trunnion.shop.rotary_angles import followed

_SAME_DIRECTION = 1e-7
"""Two directions closer than this (their difference's length) differ by what their words are rounded to."""


class TipState(WrittenState):
    """The modal state of a text in which a tool axis is written as a vector, all three numbers of it."""

    def __init__(self, words: IsoWords, settings: PostSettings, letters: str = "") -> None:
        super().__init__(words, settings, letters)
        self.vectors = self.scale_class(
            unit=1.0,
            decimals=words.direction_decimals,
            feed_decimals=words.feed_decimals,
            point=words.point,
        )

    def turned(self, angle: list[int]) -> list[str]:
        """Return the words of the tool axis."""
        return [
            word + self.vectors.text(v)
            for word, v in zip(self.words.directions, angle, strict=False)
        ]

    def axis_words(self, angle: Ints) -> list[list[str]]:
        """Return by number the words of tool axes (k, 3) after the first; "" where the axis stays."""
        turns = (angle[1:] != angle[:-1]).any(axis=1)
        return [
            changed(self.vectors.texts(v[1:], f" {word}"), turns)
            for word, v in zip(self.words.directions, angle.T, strict=False)
        ]


class TipWriter(ProgramWriter):
    """Writes one setup's program for a machine with rotary axes whose control follows the tip.

    `tilted` is the plane in force, None while the control follows the tip or before the first section; `axis` (3,) is the direction that
    the last section has left the tool in.
    """

    arcs_in_space: ClassVar[bool] = True
    """Whether arcs of an upright tool stay arcs while the control follows the tip."""
    tilted: TiltedPlane | None = None
    follows: bool = False
    axis: Floats | None = None

    def axis_form(self) -> AxisForm:
        """Return the form of tips; see `ProgramWriter`."""
        words, settings = self.words, self.settings
        return ThreeAxes(
            scale=TickScale.of(settings, words.extra_decimals_inch, words.feed_decimals)
        )

    def written_state(self) -> WrittenState:
        """Return a state that knows of vectors."""
        return TipState(self.words, self.settings)

    def work_position_lines(self, work_position: WorkPosition) -> Iterator[str]:
        """Yield where the work stands; no word depends on it, but the rotary axes of the machine can."""
        yield work_position_lines(self.program.setup, work_position, self.settings.units)[0]
        yield "WORDS ARE POSITIONS OF THE TIP IN THE WORK AND DIRECTIONS OF THE TOOL"

    def left(self) -> Iterator[str]:
        """Yield the words that end what the control does with the tool's direction."""
        if self.follows:
            yield self.words.no_tip_control
        if self.tilted is not None and not self.tilted.upright:
            yield self.words.no_plane
        self.follows, self.tilted = False, None

    def motions(self, section: ProgramSection, changed: bool) -> Iterator[str]:
        """Yield the approach and the blocks of a section; raise `Refused` for a direction that the machine can't hold or reach."""
        assert self.work_position is not None
        near = MARGIN * self.settings.straying / section.cutter.flute_length
        angles = followed(section.path.axis, self.work_position, None, near, section.operation)
        rows = plane_rows(section.path)
        if rows is None:
            yield from self.in_space(section, angles[0], changed)
        else:
            yield from self.in_plane(section, rows, angles[rows[0]], changed)

    def in_plane(
        self, section: ProgramSection, rows: tuple[int, int], angle: Floats, changed: bool
    ) -> Iterator[str]:
        """Yield a section in the plane across its tool; rapids that turn the tool there give way to one over the top."""
        words, modal, numbered = self.words, self.modal, self.numbered
        axis = section.path.axis[rows[0]]
        degrees = replace(modal.degrees, decimals=words.plane_decimals)
        plane = plane_across(axis, words.plane_order, degrees)
        known = self.tilted is not None and self.tilted.ticks == plane.ticks
        goes_on = not changed and modal.at is not None and known and rows[0] == 0
        if not changed and not goes_on:
            yield from map(numbered, [*self.left(), words.top])
            modal.at = None
        yield from map(numbered, self.lone_length(section.tool))
        a, b, c = (degrees.text(v) for v in plane.ticks)
        side = self.side(plane, angle)
        yield from (numbered(line.format(a=a, b=b, c=c, side=side)) for line in words.plane)
        self.tilted, self.follows, self.axis = plane, False, plane.matrix[:, 2]
        local = in_plane_of(section.path, rows, plane)
        path = written(local, modal.scale, section.operation)
        minutes = inverse_minutes(replace(section, path=local), path, modal.scale)
        modal.angle = []
        high = None if goes_on or plane.upright else self.high_over(local.position[0], plane, angle)
        yield from map(numbered, self.reached(section.tool, path, high, goes_on))
        yield from self.blocks(section, path, minutes)
        if rows[1] < len(section.path) - 1:
            yield from map(numbered, [*self.left(), words.top])
            modal.at = None

    def in_space(self, section: ProgramSection, angle: Floats, changed: bool) -> Iterator[str]:
        """Yield a section in which the tool turns: tips and vectors."""
        words, modal, numbered = self.words, self.modal, self.numbered
        assert isinstance(modal, TipState)
        path = self.tips(section, modal.vectors)
        goes_on = not changed and modal.at is not None and self.keeps_direction(section)
        if not goes_on and not changed:
            yield from map(numbered, [*self.left(), words.top])
            modal.at = None
        yield from map(numbered, self.lone_length(section.tool))
        if not goes_on:
            yield numbered(modal.rapid(self.turn_words(angle)))
        yield from (numbered(line.format(tool=section.tool.number)) for line in words.tip_control)
        self.tilted, self.follows, self.axis = None, True, section.path.axis[-1]
        modal.angle = None
        high = None if goes_on else self.high_over(section.path.position[0], None, angle)
        yield from map(numbered, self.reached(section.tool, path, high, goes_on))
        yield from self.blocks(section, path, np.zeros(len(path.motion)))

    def tips(self, section: ProgramSection, vectors: TickScale) -> WrittenPath:
        """Return a section's blocks as tips and vectors in ticks; arcs of a tool that leans are lines."""
        leans = np.linalg.norm(section.path.axis[:, :2], axis=1) > UPRIGHT
        leans |= not self.arcs_in_space
        arcs = np.flatnonzero((section.path.motion >= Motion.ARC_CW) & leans)
        opened, _ = lines_for_arcs(section.path, arcs, MARGIN * self.settings.straying)
        return written(opened, self.modal.scale, section.operation, vectors.ticks(opened.axis))

    def high_over(self, point: Floats, plane: TiltedPlane | None, angle: Floats) -> Floats | None:
        """Return where (3,) over its first point, in the same coordinates, a tool is beyond all that stands on the table; None where it is.

        It is up along the machine's Z: so a tool comes down on a machine whose head leans.
        """
        work_position = self.work_position
        assert work_position is not None
        setup = point if plane is None else plane.matrix @ point
        lift = lift_of(work_position, angle)
        more = work_position.radius - float((setup - work_position.centre) @ lift)
        return (
            None
            if more <= tolerance.WRITTEN
            else point + more * (lift if plane is None else plane.local(lift))
        )

    def reached(
        self, tool: AnyTool, path: WrittenPath, high: Floats | None, goes_on: bool
    ) -> Iterator[str]:
        """Yield the rapids to the first point of a section, over a point high above it where the tool comes from the top and leans."""
        modal = self.modal
        length = "" if self.follows else self.joined_length(tool)
        first, angle = path.point[0].tolist(), path.more[0].tolist()
        if self.tilted is not None and self.tilted.upright and not goes_on:
            x, y, z = (letter + modal.scale.text(v) for letter, v in zip("XYZ", first, strict=True))
            yield from (modal.rapid([x, y]), modal.rapid([length, z]))
            modal.reached(first, angle, Motion.RAPID)
        else:
            points = ([] if high is None else [modal.scale.ticks(high).tolist()]) + [first]
            for point in points:
                at = modal.plane.words(point, modal.scale.text)
                yield modal.rapid([length, *at, *modal.turned(angle)])
                length = ""
            modal.reached(first, angle, Motion.RAPID)
        modal.feed = ""

    def joined_length(self, tool: AnyTool) -> str:
        """Return the words that switch a tool's length on in the line of a move, empty where they stand alone."""
        joined = code_of(self.words, "length")
        return self.words.tool_length.format(tool=tool.number) if joined else ""

    def lone_length(self, tool: AnyTool) -> Iterator[str]:
        """Yield the line that switches a tool's length on where its words stand alone."""
        if self.words.tool_length and not self.joined_length(tool):
            yield self.words.tool_length.format(tool=tool.number)

    def side(self, plane: TiltedPlane, angle: Floats) -> str:
        """Return how the words of a plane say which of two ways to stand is meant, by angles (a,) in rad of the rotary axes."""
        return "1" if self.first_lean(angle) > 0.0 else "-1"

    def keeps_direction(self, section: ProgramSection) -> bool:
        """Whether a section begins in the direction that the tool has, and the control can follow the tip from there without a move: what a
        machine does as a tilted plane ends is its builder's choice."""
        if self.axis is None or (self.tilted is not None and not self.tilted.upright):
            return False
        return bool(np.linalg.norm(section.path.axis[0] - self.axis) <= _SAME_DIRECTION)

    def with_known_feeds(self, section: ProgramSection) -> ProgramSection:
        """Return a section with feeds by the minute where the tool turns: there the control times the tip by itself."""
        section = super().with_known_feeds(section)
        path = section.path
        turns = len(path) > 0 and not path.work_turns and plane_rows(path) is None
        return replace(section, feed_mode=FeedMode.MINUTE) if turns else section

    def turn_words(self, angle: Floats) -> list[str]:
        """Return the words of the machine's own rotary axes, to stand near a direction before the control follows the tip."""
        assert self.work_position is not None
        degrees = self.modal.degrees
        ticks = degrees.ticks(np.degrees(angle)).tolist()
        names = zip(self.work_position.names, ticks, strict=True)
        return [name + degrees.text(v) for name, v in names]

    def first_lean(self, angle: Floats) -> float:
        """Return the angle of the axis that leans the tool, the first of two or the head's: its sign says which way to stand is meant."""
        assert self.work_position is not None
        return float(angle[leaning_axis(self.work_position.machine)])
