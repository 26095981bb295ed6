"""The proof of one setup: its moves held against part and stock, timed, and asked what they leave."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.model.program import Program
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact import Contact, PartContact
from trunnion.verify.coverage import depth_in_blank
from trunnion.verify.limits import times_of
from trunnion.verify.motion import Moves, moves_of
from trunnion.verify.settings import ProofSettings
from trunnion.verify.stock import Field, StockRun, blank_box, run_stock
from trunnion.verify.sweep import Sweep

NEAR = 2.0
"""mm: material left beyond this is only known to be more, unless the blank's surface is nearer."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SetupProof:
    """What was measured in one setup: contact and stock by move, times (n,) s, and what is left (s,) mm on the samples."""

    program: Program
    moves: Moves
    contact: Contact
    stock: StockRun
    times: Floats
    left: Floats

    def collides(self, allowed: float) -> Bools:
        """Say for each move whether shank or holder enter part or stock deeper than allowed."""
        return np.asarray((self.contact.depth[:, 1] > allowed) | (self.stock.body_depth > allowed))


def prove_setup(program: Program, contact: PartContact, blank: Blank, machine: Machine, settings: ProofSettings, points: Floats,
                progress: Progress = QUIET) -> SetupProof:
    """Return what is measured of one setup's program; `points` (s, 3) are the samples in its frame."""
    moves = moves_of(program.sections)
    sweep = Sweep.of(moves, NEAR)
    touched = contact.along(moves, progress.part(0.0, 0.4))
    field = Field.of(blank, program.setup.frame, settings.cell)
    stock = run_stock(field, moves, sweep, progress.part(0.4, 0.7))
    low, high = blank_box(blank, program.setup.frame)
    left, _ = sweep.left(points, np.minimum(depth_in_blank(points, low, high), NEAR), progress.part(0.7, 1.0))
    return SetupProof(program=program, moves=moves, contact=touched, stock=stock, times=times_of(moves, machine), left=left)
