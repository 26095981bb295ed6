"""The proof of one turning setup: what each move cuts of the stock, what it enters that it must not, and what it asks of the spindle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.material import Machine, Material
from trunnion.model.motion.program import Program
from trunnion.model.tool import TurningTool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT
from trunnion.verify.kernels.timing import block_times
from trunnion.verify.turning.moves import (
    CHORD,
    MeridianFrame,
    TurningMoves,
    depth_between,
    swept,
    turning_moves,
)

FINE = 1e-3
"""mm: what two outlines share along their rims only, by the chords that they are made of, is no contact."""
STRETCH = 3.0
"""mm of way over which a depth of cut is taken at least."""
LEAST_CHIP = 1e-3
"""mm: below this an edge rubs; Kienzle's formula is not held there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurningProof:
    """What was measured in a turning setup on its machine, by move: gouge (n,) mm of the insert and collision (n,) mm of the holder in the
    part or in standing stock, with the places (n, 2); rapid_depth (n,) mm in stock; removed (n,) mm3, depth (n,) mm of cut on the mean of
    a stretch, chip (n,) mm, rate (n,) cm3/min, power (n,) kW, seconds (n,). `left` is the meridian of the stock after it, `cut` what all
    feed moves have swept."""

    program: Program
    machine: Machine
    plane: MeridianFrame
    moves: TurningMoves
    gouge: Floats
    gouge_at: Floats
    collision: Floats
    collision_at: Floats
    in_stock: Bools
    rapid_depth: Floats
    removed: Floats
    depth: Floats
    chip: Floats
    rate: Floats
    power: Floats
    seconds: Floats
    left: BaseGeometry
    cut: BaseGeometry

    def rows_of(self, section: int) -> Ints:
        """Return the moves of a section."""
        return np.flatnonzero(self.moves.section == section)


def prove_turning(
    program: Program,
    plane: MeridianFrame,
    part: BaseGeometry,
    stock: BaseGeometry,
    machine: Machine,
    material: Material | None,
    progress: Progress = NO_PROGRESS,
) -> TurningProof:
    """Return what is measured of a turning program.

    `part` is the meridian that the part sweeps and `stock` that of the stock before, both in the work's plane. Raises `BadInput` for a
    program of which only some sections turn.
    """
    moves = turning_moves(program, plane)
    n = len(moves)
    tools = [_Tool.of(s.tool, plane) for s in program.sections if isinstance(s.tool, TurningTool)]
    made = {name: np.zeros(n) for name in ("gouge", "collision", "rapid_depth", "removed")}
    gouge_at, collision_at, in_stock = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n, bool)
    cuts: list[BaseGeometry] = []
    areas = np.zeros(n)
    # What comes no deeper than chords are off touches the part at most: nearly all moves are told so at once.
    inner = shapely.buffer(part, -FINE)
    shapely.prepare(inner)
    for row in progress.each(range(n)):
        tool, poses = tools[int(moves.section[row])], moves.poses(row)
        hull = swept(tool.insert, poses)
        if shapely.intersects(inner, hull):
            made["gouge"][row], gouge_at[row] = depth_between(hull, part, FINE)
        if moves.rapid[row]:
            made["rapid_depth"][row], _ = depth_between(hull, stock, tolerance.RAPID_DEPTH)
        else:
            shared = shapely.intersection(hull, stock)
            area = float(shared.area)
            if area > 0.0:
                # Guldin: what an area sweeps about the axis is the area times the way of its centroid.
                made["removed"][row] = 2.0 * math.pi * float(shared.centroid.x) * area
                areas[row] = area
                stock = shapely.difference(stock, hull)
            cuts.append(hull)
        for shape in tool.holder:
            body = swept(shape, poses)
            for other, is_stock in ((part, False), (stock, True)):
                if not is_stock and not shapely.intersects(inner, body):
                    continue
                deep, where = depth_between(body, other, FINE)
                if deep > made["collision"][row]:
                    made["collision"][row], collision_at[row] = deep, where
                    in_stock[row] = is_stock
    made["depth"] = _depths(moves, areas)
    angle = np.array([math.sin(math.radians(t.edge_angle)) for t in tools] or [1.0])
    per_turn = np.divide(
        moves.feed, moves.turns, out=np.zeros(n), where=~moves.rapid & (moves.turns > 0.0)
    )
    made["chip"] = np.where(made["removed"] > 0.0, per_turn * angle[moves.section], 0.0)
    speed = (
        2.0 * math.pi * np.maximum(moves.start[:, 0], moves.end[:, 0]) * moves.turns / MM_PER_METRE
    )
    rate = speed * per_turn * made["depth"]
    power = np.zeros(n)
    if material is not None:
        specific = material.force * np.maximum(made["chip"], LEAST_CHIP) ** -material.force_exponent
        power = rate * specific / (SECONDS_PER_MINUTE * WATTS_PER_KILOWATT)
    return TurningProof(
        program=program,
        machine=machine,
        plane=plane,
        moves=moves,
        gouge_at=gouge_at,
        collision_at=collision_at,
        in_stock=in_stock,
        rate=rate,
        power=power,
        seconds=_seconds(moves, machine),
        left=stock,
        cut=shapely.union_all(cuts) if cuts else shapely.Polygon(),
        **made,
    )


def _depths(moves: TurningMoves, areas: Floats) -> Floats:
    """Return the depth of cut of each move (n,) mm from the areas (n,) mm2 that moves take: area over length, on a stretch of `STRETCH`
    around it at least, all in one section. An edge bears more for less, as where it comes along a shoulder."""
    depth, cuts = np.zeros(len(moves)), ~moves.rapid
    for section in np.unique(moves.section):
        rows = np.flatnonzero(cuts & (moves.section == section))
        end, total = np.cumsum(moves.length[rows]), np.cumsum(areas[rows])
        if not len(rows) or end[-1] <= 0.0:
            continue
        along, taken = np.concatenate([[0.0], end]), np.concatenate([[0.0], total])
        middle, half = end - 0.5 * moves.length[rows], 0.5 * np.maximum(moves.length[rows], STRETCH)
        low, high = (np.interp(middle + side * half, along, taken) for side in (-1.0, 1.0))
        depth[rows] = np.where(areas[rows] > 0.0, (high - low) / (2.0 * half), 0.0)
    return depth


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Tool:
    """A turning tool in the work's plane: insert (m, 2) and the parts of its holder, all convex."""

    insert: Floats
    holder: tuple[Floats, ...]
    edge_angle: float

    @staticmethod
    def of(tool: TurningTool, plane: MeridianFrame) -> _Tool:
        return _Tool(
            insert=plane.of_tool(tool.insert_profile(CHORD)),
            holder=tuple(plane.of_tool(h) for h in tool.holder_profiles()),
            edge_angle=tool.edge_angle,
        )


def _seconds(moves: TurningMoves, machine: Machine) -> Floats:
    """Return the time of each move (n,) with accelerations of the slower axis; rapids go at the slower axis's rapid."""
    n = len(moves)
    seconds, top = np.zeros(n), np.zeros(n)
    axes = [machine.axis(name) for name in ("X", "Z")]
    fastest = min(a.rapid for a in axes)
    speed = np.where(moves.rapid, fastest, np.minimum(moves.feed, fastest)) / SECONDS_PER_MINUTE
    step = moves.end - moves.start
    heading = step / np.maximum(np.linalg.norm(step, axis=1), tolerance.COINCIDENT)[:, None]
    turn = np.concatenate([[0.0], (heading[1:] * heading[:-1]).sum(axis=1)]) if n else np.zeros(0)
    block_times(moves.length, speed, turn, min(a.acceleration for a in axes), seconds, top)
    return seconds
