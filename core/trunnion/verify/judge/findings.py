"""What is reported of a setup: gouges, collisions with part, stock and fixtures, rapids in stock, each with its block, position and
depth."""

from __future__ import annotations

import numpy as np

from trunnion.findings import Finding, Fix, error
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.program import ProgramSection
from trunnion.units import LONGEST_BLOCK, SECONDS_PER_MINUTE
from trunnion.verify.judge.collision_boxes import Box
from trunnion.verify.judge.locations import block_of, position_text
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings

MOST_FINDINGS = 5
"""Positions that one operation's finding list names of each kind; the worst come first."""


def setup_findings(proof: SetupProof, tags: Ints, settings: ProofSettings) -> list[Finding]:
    """Return an error for every face that is gouged or touched, and for the worst rapids; `tags` (f,) are those of the face rows."""
    found = []
    for k, section in enumerate(proof.program.sections):
        rows = np.flatnonzero(proof.moves.section == k)
        boxes = proof.collision_boxes[k]
        found += _gouges(proof, section, rows, tags, settings)
        found += _collisions(proof, section, rows, tags, settings, boxes)
        found += _fixtures(proof, section, rows, settings, boxes)
        found += _rapids(proof, section, rows)
        found += _endless(proof, section, rows)
    return found


def _gouges(
    proof: SetupProof, section: ProgramSection, rows: Ints, tags: Ints, settings: ProofSettings
) -> list[Finding]:
    depth, faces = proof.contact.depth[rows, 0], proof.contact.face[rows, 0]
    found = []
    for face in _worst(faces, depth, settings.tolerance):
        row = rows[np.argmax(np.where(faces == face, depth, -1.0))]
        found.append(
            error(
                "verify.gouge",
                f"{section.operation} cuts {proof.contact.depth[row, 0]:.3f} mm into face "
                f"{tags[face]} at {position_text(proof.contact.position[row, 0])}",
                section.operation,
                block_of(proof, section, row),
                f"face {tags[face]}",
                remedy="keep the cutter off this face, or choose a cutter that fits",
                fix=Fix(
                    kind="tolerance",
                    operation=section.operation,
                    reason="verify.gouge",
                    amount=float(proof.contact.depth[row, 0]),
                ),
            )
        )
    return found


def _collisions(
    proof: SetupProof,
    section: ProgramSection,
    rows: Ints,
    tags: Ints,
    settings: ProofSettings,
    boxes: tuple[Box, ...],
) -> list[Finding]:
    found = []
    depth, faces = proof.contact.depth[rows, 1], proof.contact.face[rows, 1]
    for face in _worst(faces, depth, settings.tolerance):
        row = rows[np.argmax(np.where(faces == face, depth, -1.0))]
        found.append(
            error(
                "verify.collision",
                f"shank or holder of {section.tool.name} enters face {tags[face]} by "
                f"{proof.contact.depth[row, 1]:.3f} mm at {position_text(proof.contact.position[row, 1])}",
                section.operation,
                block_of(proof, section, row),
                f"face {tags[face]}",
                remedy="choose a longer or slimmer tool",
                fix=Fix(
                    kind="tool",
                    operation=section.operation,
                    reason="verify.collision",
                    amount=float(proof.contact.depth[row, 1]),
                    boxes=boxes,
                ),
            )
        )
    body = proof.stock.body_depth[rows]
    if body.max(initial=0.0) > settings.tolerance:
        row = rows[np.argmax(body)]
        found.append(
            error(
                "verify.collision-stock",
                f"shank or holder of {section.tool.name} enters standing stock by {body.max():.3f} mm "
                f"near {position_text(proof.moves.end[row])}",
                section.operation,
                block_of(proof, section, row),
                remedy="clear the stock around first, or choose a longer tool",
                fix=Fix(
                    kind="clear_first",
                    operation=section.operation,
                    reason="verify.collision-stock",
                    amount=float(body.max()),
                    boxes=boxes,
                ),
            )
        )
    return found


def _fixtures(
    proof: SetupProof,
    section: ProgramSection,
    rows: Ints,
    settings: ProofSettings,
    boxes: tuple[Box, ...],
) -> list[Finding]:
    found = []
    depth, fixture_row = proof.contact.fixture_depth[rows], proof.contact.fixture[rows]
    for fixture in _worst(fixture_row, depth, settings.tolerance):
        row = rows[np.argmax(np.where(fixture_row == fixture, depth, -1.0))]
        name = proof.program.setup.fixtures[fixture].name
        found.append(
            error(
                "verify.fixture",
                f"{section.tool.name} enters fixture {name} by {proof.contact.fixture_depth[row]:.3f} mm at "
                f"{position_text(proof.contact.fixture_position[row])}",
                section.operation,
                block_of(proof, section, row),
                name,
                remedy="move the fixture, or keep the tool off it",
                fix=Fix(
                    kind="exclude",
                    operation=section.operation,
                    reason="verify.fixture",
                    amount=float(proof.contact.fixture_depth[row]),
                    boxes=boxes,
                ),
            )
        )
    return found


def _worst(faces: Ints, depth: Floats, limit: float) -> list[int]:
    """Return the faces entered deeper than a limit, the deepest first, at most a few."""
    bad = depth > limit
    worst = {int(f): float(depth[bad & (faces == f)].max()) for f in np.unique(faces[bad])}
    return sorted(worst, key=lambda f: (-worst[f], f))[:MOST_FINDINGS]


def _rapids(proof: SetupProof, section: ProgramSection, rows: Ints) -> list[Finding]:
    depth = proof.stock.rapid_depth
    worst = rows[np.argsort(-depth[rows], kind="stable")[:MOST_FINDINGS]]
    return [
        error(
            "verify.rapid-in-stock",
            f"a rapid of {section.operation} goes {depth[row]:.3f} mm into stock at "
            f"{position_text(proof.stock.rapid_position[row])}",
            section.operation,
            block_of(proof, section, row),
            remedy="lift the rapid, or make it a feed move",
            fix=Fix(
                kind="lift",
                operation=section.operation,
                reason="verify.rapid-in-stock",
                amount=float(depth[row]),
            ),
        )
        for row in worst
        if depth[row] > 0.0
    ]


def _endless(proof: SetupProof, section: ProgramSection, rows: Ints) -> list[Finding]:
    """Return an error for a block that takes so long that its feed must be a slip of the hand."""
    seconds = proof.times.seconds[rows]
    if seconds.max(initial=0.0) <= LONGEST_BLOCK:
        return []
    row = rows[np.argmax(seconds)]
    where = block_of(proof, section, row)
    return [
        error(
            "verify.endless",
            f"{section.operation} takes {seconds.max() / SECONDS_PER_MINUTE:.0f} min for one block, {where}, at a "
            f"feed of {proof.moves.feed[row]:g} mm/min; no block takes more than {LONGEST_BLOCK / SECONDS_PER_MINUTE:.0f} min",
            section.operation,
            where,
            remedy="check this block's feed and length",
        )
    ]
