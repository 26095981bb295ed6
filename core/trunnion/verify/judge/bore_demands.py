"""Threads and fits: what the motions of taps, reamers and boring bars make of the bores that have one.

A tap is taken to cut no more than its core (`Tool.core_diameter`), so neither contact nor stock see its threads. They are judged here, by
the strokes themselves: each goes down a bore that has this thread and that was bored to its core before, at the pitch a revolution; full
threads end above the tap's lead. A bore has its fit as far as the full diameter of a reamer of a class within it has come, or of a boring
bar that is set for it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error, face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.model.hole_demand import BoreDemand
from trunnion.model.motion.program import STOPPED, ProgramSection
from trunnion.model.spindle import per_minute
from trunnion.model.tool import BORING_BAR, FINISHING, Tool
from trunnion.units import trimmed
from trunnion.verify.judge.locations import block_of, position_text
from trunnion.verify.judge.milled_threads import milled_threads
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings

PARALLEL = math.cos(tolerance.ANGLE)
"""Cosine of the largest angle between a tool's axis and a bore's that it goes along."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToolStroke:
    """A feed along its axis of a tool that goes on bores: the row of its move, `tip` (3,) mm where it ends and `axis` (3,) from the tip to
    the spindle, both in the part's coordinates; `removed` mm3 by it."""

    proof: SetupProof
    section: ProgramSection
    tool: Tool
    row: int
    tip: Floats
    axis: Floats
    removed: float

    def goes_along(self, bore: BoreDemand, within: float) -> bool:
        """Return whether the stroke is on a bore's axis, no more than `within` mm beside it, and comes into it."""
        away = self.tip - bore.start
        beside = np.linalg.norm(away - (away @ bore.out) * bore.out)
        up = float(self.axis @ bore.out)
        comes_in = up > PARALLEL or (bore.through and up < -PARALLEL)
        return bool(comes_in and beside <= within and self._reached(bore) > 0.0)

    def _reached(self, bore: BoreDemand) -> float:
        """Return how far the tip has come into a bore from the end that it was sent in at, mm."""
        deep = float((bore.start - self.tip) @ bore.out)
        return deep if float(self.axis @ bore.out) > 0.0 else bore.depth - deep

    def finished(self, bore: BoreDemand) -> float:
        """Return how much of a bore has the tool's full diameter, from the end that it was sent in at, mm."""
        return min(self._reached(bore) - self.tool.lead, bore.depth)


def demand_findings(
    proofs: Sequence[SetupProof], demands: Sequence[BoreDemand], settings: ProofSettings
) -> list[Finding]:
    """Return errors on strokes of taps, and feeds of thread mills, that cut no thread that is demanded, or not as it must be, and warnings
    on bores whose thread or fit nothing makes, or not all of it."""
    found, best = milled_threads(proofs, demands, settings)
    for stroke in (s for proof in proofs for s in _strokes(proof)):
        bore = next((d for d in demands if stroke.goes_along(d, settings.tolerance)), None)
        wrong = _wrong(stroke, bore, settings) if stroke.tool.form == "tap" else []
        found += wrong
        if bore is not None and not wrong and _makes(stroke.tool, bore):
            best[bore.feature] = max(best.get(bore.feature, 0.0), stroke.finished(bore))
    return [*found, *(f for d in demands for f in _short(d, best.get(d.feature, 0.0), proofs))]


def _strokes(proof: SetupProof) -> Iterator[ToolStroke]:
    """Yield the feeds of taps, reamers and boring bars into what is below them."""
    frame, moves = proof.program.setup.frame, proof.moves
    down = np.einsum("ij,ij->i", moves.end - moves.start, moves.end_axis) < -tolerance.COINCIDENT
    for k, section in enumerate(proof.program.sections):
        tool = section.tool
        if not isinstance(tool, Tool) or tool.form not in ("tap", *FINISHING):
            continue
        for row in np.flatnonzero((moves.section == k) & ~moves.rapid & down):
            yield ToolStroke(
                proof=proof,
                section=section,
                tool=tool,
                row=int(row),
                tip=frame.to_world(moves.end[row : row + 1])[0],
                axis=frame.world_direction(moves.end_axis[row]),
                removed=float(proof.stock.removed[row]),
            )


def _makes(tool: Tool, bore: BoreDemand) -> bool:
    """Return whether a tool makes a bore's thread, or its fit."""
    if bore.is_thread:
        return tool.form == "tap" and _same_thread(tool, bore)
    same = abs(tool.diameter - bore.diameter) <= tolerance.SEW
    made = tool.form in FINISHING and same
    return made and (tool.fit in bore.fits or (tool.form == BORING_BAR and tool.fit == bore.words))


def _same_thread(tool: Tool, bore: BoreDemand) -> bool:
    return (
        abs(tool.diameter - bore.thread_diameter) <= tolerance.SEW
        and abs(tool.pitch - bore.pitch) <= tolerance.COINCIDENT
    )


def _wrong(stroke: ToolStroke, bore: BoreDemand | None, settings: ProofSettings) -> list[Finding]:
    """Return errors on a tap's stroke."""
    tool, section, proof = stroke.tool, stroke.section, stroke.proof
    if bore is None or not bore.is_thread or not _same_thread(tool, bore):
        demanded = bore.words if bore is not None and bore.is_thread else "no thread"
        return [
            _at(
                stroke,
                "verify.thread-elsewhere",
                f"{section.operation} taps with {tool.name} at {position_text(proof.moves.end[stroke.row])}, where "
                f"{demanded} is demanded",
                "tap only bores with this thread, or demand the thread of this bore",
            )
        ]
    found = []
    feed, wanted = float(proof.moves.feed[stroke.row]), per_minute(tool.pitch, section.spindle)
    if abs(feed - wanted) > tool.pitch * STOPPED:
        found.append(
            _at(
                stroke,
                "verify.thread-feed",
                f"{section.operation} taps {bore.feature} at {feed:g} mm/min; {tool.pitch:g} mm a revolution at "
                f"{section.spindle:g} 1/min are {wanted:g}",
                "feed at the pitch a revolution",
            )
        )
    film = math.pi * tool.core_diameter * settings.tolerance * bore.depth
    if stroke.removed > film:
        found.append(
            _at(
                stroke,
                "verify.thread-core",
                f"{section.operation} taps {bore.feature}, whose core of D {trimmed(tool.core_diameter, 3)} is not bored: "
                f"{trimmed(stroke.removed, 1)} mm3 stand in it",
                "drill the bore to the thread's core, as deep as the tap goes, before it is tapped",
            )
        )
    return found


def _at(stroke: ToolStroke, code: str, words: str, remedy: str) -> Finding:
    where = block_of(stroke.proof, stroke.section, stroke.row)
    return error(code, words, stroke.section.operation, where, remedy=remedy)


def _short(bore: BoreDemand, made: float, proofs: Sequence[SetupProof]) -> list[Finding]:
    """Return a warning on a bore whose thread or fit is not made, or not as far as is demanded."""
    kind = "thread" if bore.is_thread else "fit"
    if made <= 0.0:
        return [
            warning(
                f"verify.{kind}",
                f"{bore.feature}: nothing makes its {kind} {bore.words}",
                bore.feature,
                *face_tags(bore.faces),
                remedy="tap it by hand, or add an operation"
                if bore.is_thread
                else "ream or bore it by hand, or add an operation",
            )
        ]
    wanted = _wanted(bore, proofs)
    if made >= wanted - tolerance.SEW:
        return []
    return [
        warning(
            f"verify.{kind}-depth",
            f"{bore.feature}: its {kind} {bore.words} is full for {trimmed(made, 2)} of {trimmed(wanted, 2)} mm",
            bore.feature,
            *face_tags(bore.faces),
            remedy="send the tool deeper, or choose one with a shorter lead",
        )
    ]


def _wanted(bore: BoreDemand, proofs: Sequence[SetupProof]) -> float:
    """Return how far a thread or a fit is to be full, mm: a blind bore's as far as the lead of the longest-reaching tool lets it."""
    if bore.thread_depth > 0.0:
        return bore.thread_depth
    if bore.through:
        return bore.depth
    if bore.is_thread:
        return 0.0
    leads = [
        s.tool.lead
        for p in proofs
        for s in p.program.sections
        if isinstance(s.tool, Tool) and s.tool.form in FINISHING and _makes(s.tool, bore)
    ]
    return bore.depth - min(leads, default=0.0)
