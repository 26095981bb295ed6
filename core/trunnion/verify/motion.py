"""The blocks of a setup's program as the engines of the proof read them: tips and axes in space, and plan curves for an upright tool."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.motion.program import NO_STANCES, ProgramSection, Stance
from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import THREAD_MILL, Tool
from trunnion.verify.cutter import Bodies, bodies_of, bodies_of_one
from trunnion.verify.kernels.contact.strips import (
    COS_HALF,
    CX,
    CY,
    KIND,
    MOVE_COLUMNS,
    MX,
    MY,
    RADIUS,
    START_ANGLE,
    SWEEP,
    X0,
    X1,
    Y0,
    Y1,
    Z_END,
    Z_START,
)

AXIS_LEAN = 1e-9
"""A tool axis this close to +z (its sine) stands on it: it comes from a fixed axis written with twelve digits."""


EVERY = slice(None)
"""All moves."""
PER_MOVE = (
    "start",
    "end",
    "start_axis",
    "end_axis",
    "centre",
    "sweep",
    "upright",
    "row",
    "section",
    "block",
    "rapid",
    "feed",
    "length",
    "tool",
)
"""The fields of `Moves` with a row a move."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Moves:
    """The moves of one setup, n in order.

    start, end (n, 3) tips and start_axis, end_axis (n, 3) unit tool axes, in the setup frame; between them the tip runs straight (or along
    an arc about the axis) and the axis turns at an even rate in the plane of both. centre (n, 3) of arcs, NaN otherwise; sweep (n,) the
    signed angle an arc turns, rad. upright (n,): the axis is +z all along; row (n, 15): those as the strip kernel reads them.
    section (n,), block (n,) where each comes from; rapid (n,); feed (n,) mm/min; length (n,) mm of the tip's path.
    tools: the tools in use, tool (n,) their rows, bodies theirs. stances: what the text says of the rotary axes at
    the end of a move, by its row; `some` moves have none.
    """

    start: Floats
    end: Floats
    start_axis: Floats
    end_axis: Floats
    centre: Floats
    sweep: Floats
    upright: Bools
    row: Floats
    section: Ints
    block: Ints
    rapid: Bools
    feed: Floats
    length: Floats
    tools: tuple[Tool, ...]
    tool: Ints
    bodies: Bodies
    stances: Mapping[int, Stance] = field(default_factory=lambda: NO_STANCES)

    def __len__(self) -> int:
        return len(self.row)

    def some(self, rows: Ints | Bools | slice) -> Moves:
        """Return some of the moves, in the order of `rows`."""
        return replace(
            self, stances=NO_STANCES, **{name: getattr(self, name)[rows] for name in PER_MOVE}
        )

    def turning(self, rows: Ints | Bools | slice = EVERY) -> Bools:
        """Return along which of some moves (k,) the tool axis turns."""
        turned = np.abs(self.end_axis[rows] - self.start_axis[rows]).max(axis=1, initial=0.0)
        return np.asarray(turned > AXIS_LEAN)

    @property
    def cutters(self) -> Floats:
        """Radius, corner radius and flute length of the cutter of each move (n, 3)."""
        table = np.array(
            [[t.core_radius, t.corner_radius, t.flute_length] for t in self.tools]
        ).reshape(-1, 3)
        return table[self.tool]

    @property
    def reach(self) -> Floats:
        """The largest radius of the whole tool of each move (n,)."""
        return self.bodies.widest()[self.tool]


def refuse_turning(sections: Iterable[ProgramSection]) -> None:
    """Raise `BadInput` for a section that turns the work: `verify.turning` proves setups that turn all along."""
    for section in sections:
        if section.path.work_turns or not section.tool.rotates:
            raise BadInput(
                f"operation {section.operation} turns the work: a setup turns all along or mills all along; give it a setup of its own"
            )


def moves_of(sections: Sequence[ProgramSection]) -> Moves:
    """Return the moves of a setup's sections in order.

    A section's first block starts where it ends, when the tool comes from its change; where the same tool goes on, it starts where the
    section before has left it. Raises `BadInput` for turning.
    """
    refuse_turning(sections)
    starts: list[Floats] = []
    ends: list[Floats] = []
    start_axes: list[Floats] = []
    end_axes: list[Floats] = []
    centres: list[Floats] = []
    sweeps: list[Floats] = []
    rows, sections_of, blocks, rapid, feeds, lengths, tool_row = [], [], [], [], [], [], []
    tools: dict[Tool, int] = {}
    stances: dict[int, Stance] = {}
    begin = 0
    for index, section in enumerate(sections):
        path = section.path
        n = len(path)
        stances.update((begin + block, stance) for block, stance in section.stances)
        begin += n
        start, sweep = path.starts(), path.sweeps()
        start_axis, length = np.vstack([path.axis[:1], path.axis[:-1]]), path.lengths()
        before = sections[index - 1] if index else section
        if n and index and before.tool == section.tool and len(before.path):
            start[0], start_axis[0] = before.path.position[-1], before.path.axis[-1]
            length[0] = np.linalg.norm(path.position[0] - start[0])
        starts.append(start)
        ends.append(path.position)
        start_axes.append(start_axis)
        end_axes.append(path.axis)
        centres.append(path.centre)
        sweeps.append(sweep)
        rows.append(_rows(start, path.position, path.centre, sweep, path.motion))
        sections_of.append(np.full(n, index))
        blocks.append(np.arange(n))
        rapid.append(path.motion == Motion.RAPID)
        feeds.append(path.feed)
        lengths.append(length)
        fed = tools.setdefault(section.cutter, len(tools))
        in_rapids = tools.setdefault(_in_rapids(section.cutter), len(tools))
        tool_row.append(np.where(rapid[-1], in_rapids, fed))
    first, last = _points(start_axes), _points(end_axes)
    return Moves(
        start=_points(starts),
        end=_points(ends),
        start_axis=first,
        end_axis=last,
        centre=_points(centres),
        sweep=np.concatenate([np.zeros(0), *sweeps]),
        upright=_upright(first, last),
        bodies=bodies_of(tuple(tools)),
        row=np.vstack([np.zeros((0, MOVE_COLUMNS)), *rows]),
        section=_ints(sections_of),
        block=_ints(blocks),
        rapid=np.concatenate([np.zeros(0, bool), *rapid]),
        feed=np.concatenate([np.zeros(0), *feeds]),
        length=np.concatenate([np.zeros(0), *lengths]),
        tools=tuple(tools),
        tool=_ints(tool_row),
        stances=stances,
    )


def _in_rapids(tool: Tool) -> Tool:
    """Return what a tool is taken for in rapids: a thread mill for a plain cylinder as thick as its teeth; others are as they are."""
    if tool.form != THREAD_MILL:
        return tool
    return replace(tool, form="flat", pitch=0.0, pitch_low=0.0, pitch_high=0.0)


def seen_from(moves: Moves, frame: Frame, other: Frame) -> Moves:
    """Return moves given in a frame as they are in another."""
    if other is frame:
        return moves
    start, end, centre = (
        other.to_local(frame.to_world(p)) for p in (moves.start, moves.end, moves.centre)
    )
    first, last = (
        other.local_direction(frame.world_direction(a)) for a in (moves.start_axis, moves.end_axis)
    )
    motion = np.where(moves.sweep == 0.0, Motion.LINE, Motion.ARC_CCW)
    return replace(
        moves,
        start=start,
        end=end,
        start_axis=first,
        end_axis=last,
        centre=centre,
        upright=_upright(first, last),
        row=_rows(start, end, centre, moves.sweep, motion),
    )


def _upright(first: Floats, last: Floats) -> Bools:
    return upright_axes(first) & upright_axes(last)


def upright_axes(axes: Floats) -> Bools:
    """Return which tool axes (..., 3) stand on +z."""
    return np.asarray((np.abs(axes[..., :2]) <= AXIS_LEAN).all(axis=-1) & (axes[..., 2] > 0.0))


def _points(parts: list[Floats]) -> Floats:
    return np.vstack([np.zeros((0, 3)), *parts])


def poses_of(tool: Tool, tips: Floats, axes: Floats | None = None) -> Moves:
    """Return moves of one tool that stand still at tips (n, 3), upright or with unit axes (n, 3)."""
    tips = np.asarray(tips, dtype=np.float64).reshape(-1, 3)
    n, nowhere = len(tips), np.full_like(tips, np.nan)
    axes = (
        np.tile([0.0, 0.0, 1.0], (n, 1))
        if axes is None
        else np.asarray(axes, dtype=np.float64).reshape(-1, 3)
    )
    return Moves(
        start=tips,
        end=tips,
        start_axis=axes,
        end_axis=axes,
        centre=nowhere,
        sweep=np.zeros(n),
        upright=_upright(axes, axes),
        row=_rows(tips, tips, nowhere, np.zeros(n), np.zeros(n, int)),
        section=np.zeros(n, np.int64),
        block=np.arange(n),
        rapid=np.zeros(n, bool),
        feed=np.zeros(n),
        length=np.zeros(n),
        tools=(tool,),
        tool=np.zeros(n, np.int64),
        bodies=bodies_of_one(tool),
    )


def _ints(parts: list[Ints]) -> Ints:
    return np.concatenate([np.zeros(0, int), *parts]).astype(np.int64)


def _rows(start: Floats, end: Floats, centre: Floats, sweep: Floats, motion: Ints) -> Floats:
    row = np.zeros((len(end), MOVE_COLUMNS))
    row[:, [X0, Y0, Z_START]], row[:, [X1, Y1, Z_END]] = start, end
    arc = motion >= Motion.ARC_CW
    if arc.any():
        c = centre[arc, :2]
        away, back = start[arc, :2] - c, end[arc, :2] - c
        # Posted ends are rounded: the mean of both radii halves what an end may lie off the arc.
        radius = 0.5 * (np.hypot(away[:, 0], away[:, 1]) + np.hypot(back[:, 0], back[:, 1]))
        angle, turn = np.arctan2(away[:, 1], away[:, 0]), sweep[arc]
        middle, half = angle + 0.5 * turn, np.minimum(0.5 * np.abs(turn), np.pi)
        row[arc, KIND] = 1.0
        row[arc, CX], row[arc, CY] = c[:, 0], c[:, 1]
        row[arc, RADIUS], row[arc, MX], row[arc, MY], row[arc, COS_HALF] = (
            radius,
            np.cos(middle),
            np.sin(middle),
            np.cos(half),
        )
        row[arc, START_ANGLE], row[arc, SWEEP] = angle, turn
    return row
