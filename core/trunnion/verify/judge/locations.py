"""Positions in words: where in a program a move stands, and where in space."""

from __future__ import annotations

from trunnion.geometry.arrays import Floats
from trunnion.model.motion.program import ProgramSection
from trunnion.verify.judge.setups import SetupProof


def block_of(proof: SetupProof, section: ProgramSection, row: int) -> str:
    """Return where a move stands in its program: the line of the text when it was read back, else the block of its operation."""
    block = int(proof.moves.block[row])
    return (
        f"line {section.block_lines[block]}"
        if block < len(section.block_lines)
        else f"block {block}"
    )


def position_text(point: Floats) -> str:
    """Return a position in words."""
    return "x {:.2f} y {:.2f} z {:.2f}".format(*(float(v) + 0.0 for v in point))
