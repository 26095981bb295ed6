"""What the simulation says of a program: gouges, rapids and bodies in stock, and what is left standing.

**Bound of a gouge.** A column is a line: how high part and stock are at it is not smeared over a cell. The part's height is off by the
chord of its triangles, the tool's by the chord of arcs and the last decimal that is written. `SLACK` is these together with the 0.02 mm
that a program may enter the part by; a column counts as gouged when it is lower, by more than the slack, than the part is anywhere within
the slack beside it: so a wall may stand off sideways by as much as a floor in height, and a slope by both. What is deeper is a gouge
whatever the cell is. The cell bounds what may be missed instead: a gouge whose area in plan is below a few cells. Along a wall of length l
the turned lattice meets one that is w wide sideways when w l is more than two cells' area.

**What is left** is stock higher, by more than the slack, than the part anywhere within the slack beside it: over the part's own outline and
in a rim of a millimetre around it, where it counts from the part's lowest place.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from simulation import part_mesh, reader
from simulation.columns import (
    NOTHING,
    Lattice,
    blank_heights,
    lattice_over,
    part_heights,
    turned,
)
from simulation.sweep import simulate
from simulation.written import Written

PROMISED = 0.02
"""mm: how deep a released program may enter the part, and what it may leave on a finished face."""
DECIMAL = 1e-4
"""mm: positions are written to this, and feeds of inches no coarser than 25.4 of the fifth decimal."""
SLACK = PROMISED + part_mesh.CHORD + reader.SAGITTA + 3.0 * DECIMAL
"""mm: see above."""
CELL = 0.35
"""mm between columns."""
RIM = 1.0
"""mm: how far beside the part's outline stock that stands counts as left."""
LEFT = 0.002
"""Share of the columns on which more may be left than the verdict says: the proof goes by samples 2 mm apart."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One move that does wrong: what (gouge, rapid, body), line of the text, operation, how deep in mm, how many columns."""

    what: str
    line: int
    operation: str
    depth: float
    columns: int = 1


@dataclass(frozen=True, slots=True, eq=False)
class Report:
    """What was seen: faults, the deepest of each line; share of the columns on which stock is left, and its mean height (mm); how many
    columns that are; the part's surface over their area in plan."""

    faults: tuple[Fault, ...]
    left: float
    left_height: float
    columns: int
    surface: float

    def kinds(self) -> set[str]:
        """Return the kinds of faults."""
        return {fault.what for fault in self.faults}

    def is_clean(self, coverage: float) -> bool:
        """Return whether a program does no wrong and leaves no more than a verdict's coverage says."""
        return not self.faults and self.left <= LEFT + (1.0 - coverage) * self.surface


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """All that a text is judged against: columns, the blank in them, how high the part is at least and at most about each, and which of
    them are wanted free of stock (ny, nx); the part's lowest place (mm) and its surface (mm2)."""

    scene: Written
    lattice: Lattice
    blank: np.ndarray
    low: np.ndarray
    high: np.ndarray
    wanted: np.ndarray
    bottom: float
    surface: float


def stage(scene: Written, file: Path, cell: float = CELL) -> Stage:
    """Return what a setup's text is judged against; `file` is the part's STEP file, `cell` mm between columns."""
    lattice = lattice_over(scene, cell)
    mesh = turned(scene.frame.into(part_mesh.triangles(file).reshape(-1, 3))).reshape(-1, 3, 3)
    low, high = part_heights(mesh, lattice, SLACK)
    return Stage(
        scene,
        lattice,
        blank_heights(scene, lattice),
        low,
        high,
        part_heights(mesh, lattice, RIM)[1] > NOTHING,
        float(mesh[..., 2].min()),
        part_mesh.area(mesh),
    )


def judged(on: Stage, text: str) -> Report:
    """Return what becomes of a part when a text is run."""
    cutters = on.scene.cutters
    moves = reader.travel(text, {number: c.length for number, c in cutters.items()})
    stock = on.blank.copy()
    by, rapid, body = _run(cutters, moves, stock, on.lattice)
    gouged = np.where(on.low > NOTHING, on.low - SLACK - stock, 0.0)
    left = np.where(on.wanted, stock - np.maximum(on.high, on.bottom) - SLACK, 0.0)
    standing, columns = left > 0.0, max(int(on.wanted.sum()), 1)
    return Report(
        (
            *_gouges(moves, gouged, by),
            *_struck("rapid", moves, rapid),
            *_struck("body", moves, body),
        ),
        float(standing.sum() / columns),
        float(left[standing].mean()) if standing.any() else 0.0,
        columns,
        on.surface / (columns * on.lattice.cell**2),
    )


def _run(cutters, moves, stock, lattice):
    """Cut the stock and return what `sweep.simulate` does."""
    numbers = sorted(cutters)
    ordered = [cutters[number] for number in numbers]
    # Before the first tool change the spindle is empty: such moves are of no tool, high above everything.
    used = np.searchsorted(numbers, np.maximum(moves.tool, numbers[0]))
    counts = np.cumsum([0, *(len(c.bodies) for c in ordered)])
    return simulate(
        stock,
        lattice.corner,
        lattice.cell,
        turned(moves.start),
        turned(moves.end),
        moves.rapid,
        np.array([(c.radius, c.corner) for c in ordered])[used],
        np.array([b for c in ordered for b in c.bodies]).reshape(-1, 2),
        np.column_stack([counts[used], counts[used + 1]]),
        SLACK,
    )


def _gouges(moves, gouged, by):
    """Give the gouges of each line, the deepest first."""
    # What no move has cut stands as the blank does: the part sticks out of it.
    lines = np.append(moves.line, 0)[by[gouged > 0.0]]
    depth = gouged[gouged > 0.0]
    found = []
    for line in np.unique(lines):
        mine = depth[lines == line]
        found.append(Fault("gouge", int(line), _name(moves, line), float(mine.max()), len(mine)))
    return sorted(found, key=lambda fault: -fault.depth)


def _struck(what, moves, depth):
    return [
        Fault(what, int(moves.line[n]), moves.operation[n], float(depth[n]))
        for n in np.flatnonzero(depth > 0.0)
    ]


def _name(moves, line):
    return moves.operation[int(np.flatnonzero(moves.line == line)[0])] if line else "blank"
