"""The proof of one setup: its moves checked against part and stock, timed, with their load and the material they leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.material import Machine, Material
from trunnion.model.motion.program import Program
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact import Contact, PartContact
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.judge.collision_boxes import Box, collision_boxes
from trunnion.verify.judge.load import Load, load_of
from trunnion.verify.machine.kinematics import AxisPositions, axis_positions
from trunnion.verify.machine.times import MachineTimes, times_of
from trunnion.verify.motion import Moves, moves_of
from trunnion.verify.settings import ProofSettings
from trunnion.verify.stock import Stock, StockRun, run_stock

NEAR = 2.0
"""mm: material left up to this is measured to the last digit, more to a hundredth."""
BUNDLES = {"z": ("z",), "xyz": ("x", "y", "z")}
FINEST, COARSEST = 0.15, 0.5
"""mm: distances of columns where nobody chose one. The finer is about as narrow as what a finishing pass takes off a steep face, so that
such a pass is not counted as air."""
COLUMNS = 400_000
"""Columns of a plain height field, about, at a distance that nobody chose: a small part gets finer ones at the cost of a large one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SetupProof:
    """What was measured in one setup on its machine: contact, stock, stands, times and load by move; residual (s,) mm on the samples, and
    the move nearest to each (-1: none); `collision_boxes` for each section where its tip is while it collides."""

    program: Program
    machine: Machine
    moves: Moves
    contact: Contact
    stock: StockRun
    axis_positions: AxisPositions
    times: MachineTimes
    load: Load
    residual: Floats
    nearest: Ints
    collision_boxes: tuple[tuple[Box, ...], ...]

    def collides(self, allowed: float) -> Bools:
        """Return for each move whether shank or holder enter part or stock, or anything of the tool a fixture, deeper than allowed."""
        return np.asarray(
            (self.contact.depth[:, 1] > allowed)
            | (self.stock.body_depth > allowed)
            | (self.contact.fixture_depth > allowed)
        )


def prove_setup(
    program: Program,
    contact: PartContact,
    stock: Stock,
    machine: Machine,
    material: Material | None,
    settings: ProofSettings,
    points: Floats,
    progress: Progress = NO_PROGRESS,
) -> SetupProof:
    """Return what is measured of one setup's program; `stock` is cut by it, `points` (s, 3) are the samples in its frame."""
    frame = program.setup.frame
    moves = progress.aside(lambda _: moves_of(program.sections), "Reading the moves")
    penetration, run, residual, nearest = _measured(
        stock, contact, moves, frame, points, settings, progress
    )
    positions, times = progress.aside(
        lambda _: _timed(moves, machine, foot_of(stock.blank, frame)), "Timing the moves"
    )
    load = progress.aside(
        lambda _: load_of(moves, run, times.speed, program.sections, stock.pitch, material),
        "Weighing the load",
    )
    by_section = [np.flatnonzero(moves.section == k) for k in range(len(program.sections))]
    boxes = progress.aside(
        lambda own: tuple(
            collision_boxes(moves, penetration, run, contact, rows, settings.tolerance)
            for rows in own.each(by_section)
        )
    )
    return SetupProof(
        program=program,
        machine=machine,
        moves=moves,
        contact=penetration,
        stock=run,
        axis_positions=positions,
        times=times,
        load=load,
        residual=residual,
        nearest=nearest,
        collision_boxes=boxes,
    )


def _measured(
    stock: Stock,
    contact: PartContact,
    moves: Moves,
    frame: Frame,
    points: Floats,
    settings: ProofSettings,
    progress: Progress,
) -> tuple[Contact, StockRun, Floats, Ints]:
    """Return how moves meet the part and the stock, how much (s,) they leave at samples, and the move (s,) that comes nearest to each.

    The sweep of the moves, as large as they are, is let go of with that.
    """
    sweep = progress.aside(lambda _: Sweep.of(moves, NEAR), "Making the moves ready for questions")
    # Cutting a height field keeps one core at work, the contact with the part the others.
    with progress.beside(
        lambda own: run_stock(stock, moves, frame, sweep, own, settings.threads)
    ) as cutting:
        penetration = contact.along(moves, progress.part(0.02, 0.6), settings.threads)
        progress.at(0.6, "Cutting the stock")
        run = cutting()
    deep = progress.aside(lambda _: stock.blank.depth(points, frame))
    residual, nearest = sweep.residual(points, deep, progress.part(0.7, 0.98), settings.threads)
    return penetration, run, residual, nearest


def _timed(moves: Moves, machine: Machine, foot: Floats) -> tuple[AxisPositions, MachineTimes]:
    positions = axis_positions(moves, machine, foot)
    return positions, times_of(moves, positions, machine)


def foot_of(blank: Blank, frame: Frame) -> Floats:
    """Return the middle of the blank's underside in a setup's frame (3,): it stands on the middle of the machine's table."""
    low, high = blank.box_in(frame)
    return np.array([*(0.5 * (low + high))[:2], low[2]])


def stock_of(programs: Sequence[Program], blank: Blank, settings: ProofSettings) -> Stock:
    """Return the whole blank as columns in the directions and at the distance that the settings say, or that suit programs and blank."""
    bundles = bundles_of(programs, blank, settings)
    return Stock.of(blank, settings.cell or _fitting_cell(blank, bundles), bundles)


def _fitting_cell(blank: Blank, bundles: tuple[str, ...]) -> float:
    """Return a distance of columns (mm): as fine as `COLUMNS` of them allow, `COARSEST` where rays along all three axes are needed."""
    if bundles != BUNDLES["z"]:
        return COARSEST
    low, high = blank.low, blank.high
    return float(np.clip(np.sqrt(np.prod((high - low)[:2]) / COLUMNS), FINEST, COARSEST))


def bundles_of(
    programs: Sequence[Program], blank: Blank, settings: ProofSettings
) -> tuple[str, ...]:
    """Return the directions of the rays that the stock is made of, chosen by the settings or by what the programs do."""
    if settings.bundles in BUNDLES:
        return BUNDLES[settings.bundles]
    plain = all(_from_above(p, blank) for p in programs)
    return BUNDLES["z" if plain else "xyz"]


def _from_above(program: Program, blank: Blank) -> bool:
    """Return whether every cut of a setup comes straight from above on the blank, by a cutter that is nowhere wider below than above."""
    up = program.setup.frame.local_direction(blank.frame.z)
    upright = all(
        np.linalg.norm(s.path.axis - up, axis=1).max(initial=0.0) < tolerance.PARAMETRIC
        for s in program.sections
    )
    return upright and not any(undercuts(s.cutter) for s in program.sections)


def undercuts(tool: Tool) -> bool:
    """Return whether a cutter leaves material over a part of its flutes when it comes from the side."""
    radii = [row[0] for row in tool.outline]
    return tool.form in ("t-slot", "barrel") or any(b < a for a, b in pairwise(radii))
