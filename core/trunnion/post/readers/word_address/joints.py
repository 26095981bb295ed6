"""Positions of a machine's axes opened into what the tool does: straight ways of the tip and even turns of its axis, as the proof wants.

Between two blocks the control moves all axes evenly. Where a rotary axis turns, the tip goes along a curve; it is opened into as many
pieces as it takes to stay within a tolerance of it, at the tip and at the upper end of the flutes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import AnyTool, Tool, rotating
from trunnion.post.linearize import even_turn
from trunnion.post.readers.sections import Point, SectionBlocks, marks_of, path_of
from trunnion.shop.kinematics import UP, UPRIGHT, WorkPosition, lift_of, poses_of, spindle_of

OPENED, OPENED_RAPID = 0.001, 0.01
"""mm: how far a piece may be from what the tool does, in feed moves and in rapids."""
FIRST_PIECE = math.radians(10.0)
"""Turn of an axis in one piece before it is looked at how far it strays."""
SHARES = (0.25, 0.5, 0.75)


@dataclass(frozen=True, slots=True, eq=False)
class Joints:
    """Points are X, Y, Z words in mm and the angles of the rotary axes in degrees."""

    work_position: WorkPosition
    clearance: float

    def above(self, point: Point, tool: AnyTool) -> Point | None:
        """See `PoseInterpreter`: an upright tool is lifted to the clearance height, a leaning one with the machine's Z beyond all that
        stands on the table."""
        words, angle = np.array([point[:3]]), np.radians([point[3:]])
        (tip,), (axis,) = poses_of(self.work_position, words, angle, tool.gauge_length)
        if float(np.linalg.norm(axis - UP)) < UPRIGHT:
            more = self.clearance - float(tip[2])
        else:
            more = self.work_position.radius - float(
                (tip - self.work_position.centre) @ lift_of(self.work_position, angle[0])
            )
        return None if more <= tolerance.WRITTEN else (*point[:2], point[2] + more, *point[3:])

    def opened(self, rows: SectionBlocks) -> tuple[Toolpath, tuple[int, ...]]:
        """See `PoseInterpreter`."""
        points = np.array(rows.point)
        words, angle, gauge = points[:, :3], np.radians(points[:, 3:]), rows.tool.gauge_length
        motion = np.array(rows.motion)
        turning = np.zeros(len(points), bool)
        turning[1:] = (points[1:, 3:] != points[:-1, 3:]).any(axis=1)
        tip, axis = poses_of(self.work_position, words, angle, gauge)
        centre = self._centres(rows, motion, turning, angle)
        whole = path_of(rows, tip, axis, centre)
        if not turning.any():
            return whole, tuple(rows.line)
        row, share = self._pieces(
            rotating(rows.tool, f"in line {rows.line[0]}"),
            words,
            angle,
            motion,
            np.flatnonzero(turning),
        )
        row, share = (
            np.concatenate([np.flatnonzero(~turning), row]),
            np.concatenate([np.ones(int((~turning).sum())), share]),
        )
        order = np.lexsort((share, row))
        row, share = row[order], share[order]
        inner = share < 1.0
        position, direction = tip[row], axis[row]
        position[inner], direction[inner] = _between(
            self.work_position, words, angle, gauge, row[inner], share[inner]
        )
        path = Toolpath(
            position=position,
            axis=direction,
            motion=motion[row],
            centre=centre[row],
            feed=whole.feed[row],
            mark=marks_of(motion[row]),
            dwell=whole.dwell_of(row),
        )
        return path, tuple(np.array(rows.line)[row].tolist())

    def _centres(
        self, rows: SectionBlocks, motion: Ints, turning: np.ndarray, angle: Floats
    ) -> Floats:
        """Return the centres of arcs in the setup frame; refuse arcs in which the tool turns or that it leans to."""
        centre = np.array(rows.centre)
        arcs = np.flatnonzero(motion >= Motion.ARC_CW)
        for k in arcs[turning[arcs]]:
            raise BadInput(
                f"line {rows.line[k]}: an arc in which a rotary axis turns is not understood; write lines"
            )
        leans = np.linalg.norm(spindle_of(self.work_position, angle[arcs])[:, :2], axis=1) > UPRIGHT
        for k in arcs[leans]:
            raise BadInput(
                f"line {rows.line[k]}: an arc in the plane XY while the head leans is not understood; write lines"
            )
        if len(arcs):
            centre[arcs], _ = poses_of(
                self.work_position, centre[arcs], angle[arcs], rows.tool.gauge_length
            )
        return centre

    def _pieces(
        self, tool: Tool, words: Floats, angle: Floats, motion: Ints, block: Ints
    ) -> tuple[Ints, Floats]:
        """Return the pieces of blocks (b,) that turn: the block of each (k,) and the share of it where it ends."""
        turn = np.abs(angle[block] - angle[block - 1]).max(axis=1)
        first = np.maximum(1, np.ceil(turn / FIRST_PIECE)).astype(np.int64)
        owner, index_in_owner = items_of(first)
        start, end = index_in_owner / first[owner], (index_in_owner + 1) / first[owner]
        row = block[owner]
        rapid = motion[row] == Motion.RAPID
        allowed = np.where(rapid, OPENED_RAPID, OPENED)
        reach = np.where(rapid, tool.stickout, tool.flute_length)[:, None]
        strays = self._strays(words, angle, tool.gauge_length, row, start, end, reach)
        more = np.maximum(1, np.ceil(np.sqrt(strays / allowed))).astype(np.int64)
        again, number = items_of(more)
        number = number + 1
        share = np.where(
            number == more[again],
            end[again],
            start[again] + number / more[again] * (end - start)[again],
        )
        return row[again], np.where(
            (number == more[again]) & (index_in_owner[again] + 1 == first[owner][again]), 1.0, share
        )

    def _strays(
        self,
        words: Floats,
        angle: Floats,
        gauge: float,
        row: Ints,
        start: Floats,
        end: Floats,
        reach: Floats,
    ) -> Floats:
        """Return by how much (k,) mm tip or flutes leave a straight path with an even turn between shares of blocks."""
        tip0, axis0 = _between(self.work_position, words, angle, gauge, row, start)
        tip1, axis1 = _between(self.work_position, words, angle, gauge, row, end)
        most = np.zeros(len(row))
        for share in SHARES:
            tip, axis = _between(
                self.work_position, words, angle, gauge, row, start + share * (end - start)
            )
            straight = tip0 + share * (tip1 - tip0)
            even = even_turn(axis0, axis1, np.full(len(row), share))
            most = np.maximum(most, np.linalg.norm(tip - straight, axis=1))
            most = np.maximum(
                most, np.linalg.norm(tip + reach * axis - straight - reach * even, axis=1)
            )
        return most


def _between(
    work_position: WorkPosition,
    words: Floats,
    angle: Floats,
    gauge: float,
    row: Ints,
    share: Floats,
) -> tuple[Floats, Floats]:
    """Return tips and axes (k, 3) at shares (k,) of blocks whose axes go evenly."""
    s = share[:, None]
    return poses_of(
        work_position,
        words[row - 1] + s * (words[row] - words[row - 1]),
        angle[row - 1] + s * (angle[row] - angle[row - 1]),
        gauge,
    )
