"""Overload of cutter and spindle, and what to offer against it: another feed, or a rest operation.

An operation's feed is chosen for an engagement: `ProgramSection` says which. Where more is in front of the cutter, its load is held against
that of the chosen data, or of what the material's tables allow this cutter when that is more, with a margin.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, Fix, error, remark, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.material import Machine, Material
from trunnion.model.motion.program import STOPPED, ProgramSection
from trunnion.model.verdict import Offer
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE
from trunnion.verify.judge.load import NEWTON_METRES, drill_shares
from trunnion.verify.judge.locations import block_of
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings

MOST_OFFERS = 5
"""Runs of blocks that one operation is offered another feed for; the worst come first."""
AIR_WORTH = 10.0
"""s: less time in air than this is not worth another operation."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AllowedLoad:
    """Load that an operation may bring: removal rate cm3/min and thickest chip mm; infinite where nothing is known."""

    rate: float
    chip: float


def load_findings(
    proof: SetupProof, machine: Machine, material: Material | None, settings: ProofSettings
) -> tuple[list[Finding], list[Offer]]:
    """Return what is reported of the load on cutter and spindle in a setup, and what is offered for it."""
    found: list[Finding] = []
    offers: list[Offer] = []
    for k, section in enumerate(proof.program.sections):
        rows = np.flatnonzero((proof.moves.section == k) & ~proof.moves.rapid)
        if len(rows):
            for noted, offered in (
                _power(proof, section, rows, machine, material, settings),
                _excess(proof, section, rows, material, settings),
                _air(proof, section, rows, settings),
                _locked(proof, section, rows),
            ):
                found += noted
                offers += offered
    return found, offers


def allowed_load(section: ProgramSection, material: Material | None) -> AllowedLoad:
    """Return the load that a section's cutting data were chosen for, or the material's tables allow its cutter when that is more."""
    tool = section.cutter
    feed = section.feed or float(section.path.feed.max(initial=0.0))
    if tool.locked:
        # A round insert's first cut takes all that lies above its edge, as thick as the depth; later ones less.
        contact = math.acos(max(1.0 - section.depth / tool.radius, -1.0))
        segment = tool.radius**2 * (contact - math.sin(contact) * math.cos(contact))
        return AllowedLoad(
            rate=segment * feed / MM_PER_METRE or math.inf, chip=section.depth or math.inf
        )
    share = float(drill_shares((section,))[0])
    if share > 0.0:
        # A ring as wide as the depth of cut, at the feed that was chosen: of a drill, whose depth is its radius, the whole circle.
        depth = min(section.depth or tool.radius, tool.radius)
        turned = 0.0 if section.spindle_stopped else feed / (tool.teeth * section.spindle)
        rate = math.pi * (tool.diameter - depth) * depth * feed / MM_PER_METRE
        return AllowedLoad(rate=rate or math.inf, chip=share * turned or math.inf)
    area, angle = section.width * section.depth, _angle(section.width, tool.diameter)
    per_tooth = 0.0 if section.spindle_stopped else feed / (tool.teeth * section.spindle)
    chip = per_tooth * math.sin(min(angle, math.pi / 2.0))
    if material is not None:
        area = max(area, material.depth_factor * material.width_factor * tool.diameter**2)
        chip = max(chip, _thickest(material, tool.diameter))
    return AllowedLoad(rate=area * feed / MM_PER_METRE or math.inf, chip=chip or math.inf)


def _angle(width: float, diameter: float) -> float:
    """Return the angle that a cutter is engaged over at a width from its side."""
    return math.acos(max(1.0 - 2.0 * min(width, diameter) / diameter, -1.0))


def _thickest(material: Material, diameter: float) -> float:
    """Return the largest feed per tooth of the material's table at a diameter."""
    return feed_at([(d, most) for d, _, most in material.feeds], diameter)


LoadFindings = tuple[list[Finding], list[Offer]]


def _power(
    proof: SetupProof,
    section: ProgramSection,
    rows: Ints,
    machine: Machine,
    material: Material | None,
    settings: ProofSettings,
) -> LoadFindings:
    turns = table_turns(proof, rows) if section.tool.locked else section.spindle
    if material is None or turns <= STOPPED:
        return [], []
    limit = power_limit(machine, section, turns) * settings.power
    power = proof.load.power[rows]
    over = power > limit * (1.0 + tolerance.PARAMETRIC)
    if not over.any():
        return [], []
    worst = rows[int(np.argmax(power))]
    offers = _feeds(
        proof,
        section,
        rows,
        over,
        "verify.power",
        lambda at: (limit / proof.load.power[at]) ** (1.0 / (1.0 - material.force_exponent)),
    )
    torque = NEWTON_METRES * limit / turns
    wanted = NEWTON_METRES * proof.load.power[worst] / turns
    driven = "table" if section.tool.locked else "spindle"
    return [
        error(
            "verify.power",
            f"{section.operation} asks {proof.load.power[worst]:.1f} kW ({wanted:.0f} Nm) of the "
            f"{driven} at {turns:.0f} 1/min, {machine.title} gives {limit:.1f} kW ({torque:.0f} Nm)",
            section.operation,
            block_of(proof, section, worst),
            remedy=_feed_remedy(proof, section, offers),
            fix=Fix(
                kind="feed",
                operation=section.operation,
                reason="verify.power",
                amount=float(
                    (limit / proof.load.power[worst]) ** (1.0 / (1.0 - material.force_exponent))
                ),
            ),
        )
    ], offers


def power_limit(machine: Machine, section: ProgramSection, turns: float) -> float:
    """Return the power (kW) that a machine gives a section at a speed (1/min): its spindle's, or its table's where that is locked."""
    if not section.tool.locked:
        return machine.power_at(turns)
    return machine.work_spindle.power_at(turns) if machine.work_spindle is not None else 0.0


def table_turns(proof: SetupProof, rows: Ints) -> float:
    """Return how fast (1/min) the table turns along moves of a tool that leans from z: the mean of what its directions turn by."""
    seconds = float(proof.times.seconds[rows].sum())
    turns = float(np.abs(_turned(proof, rows)).sum()) / (2.0 * math.pi)
    return turns * SECONDS_PER_MINUTE / seconds if seconds > 0.0 else 0.0


def _turned(proof: SetupProof, rows: Ints) -> Floats:
    """Return the angles (k,) rad that the tool's direction turns about z by along moves."""
    first, last = proof.moves.start_axis[rows, :2], proof.moves.end_axis[rows, :2]
    across = first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0]
    return np.asarray(np.arctan2(across, (first * last).sum(axis=1)))


def _locked(proof: SetupProof, section: ProgramSection, rows: Ints) -> LoadFindings:
    """Return an error where an insert in a locked spindle cuts while the work does not turn under it, or turns back."""
    if not section.tool.locked:
        return [], []
    cuts = rows[proof.stock.removed[rows] > 0.0]
    # The rake face points to growing angles about z.
    wrong = cuts[_turned(proof, cuts) <= 0.0]
    if not len(wrong):
        return [], []
    return [
        error(
            "verify.locked-insert",
            f"{section.operation} cuts with {section.tool.name} in a locked spindle while the work does not turn towards its rake face, "
            f"{len(wrong)} blocks",
            section.operation,
            block_of(proof, section, int(wrong[0])),
            remedy="cut where the table turns the work past the insert, or take a tool that turns",
        )
    ], []


def _excess(
    proof: SetupProof,
    section: ProgramSection,
    rows: Ints,
    material: Material | None,
    settings: ProofSettings,
) -> LoadFindings:
    allowed, load = allowed_load(section, material), proof.load
    times = np.maximum(
        load.rate / (settings.removal * allowed.rate), load.chip / (settings.chip * allowed.chip)
    )
    over = times[rows] > 1.0 + tolerance.PARAMETRIC
    if not over.any():
        return [], []
    worst = rows[int(np.argmax(times[rows]))]
    offers = _feeds(proof, section, rows, over, "verify.load", lambda at: 1.0 / times[at])
    return [
        warning(
            "verify.load",
            f"{section.operation} removes {load.rate[worst]:.0f} cm3/min in chips of {load.chip[worst]:.2f} mm with "
            f"{math.degrees(proof.stock.engagement[worst]):.0f} degrees of {section.tool.name} engaged; its data are for "
            f"{allowed.rate:.0f} cm3/min and {allowed.chip:.2f} mm",
            section.operation,
            block_of(proof, section, worst),
            remedy=_feed_remedy(proof, section, offers),
            fix=Fix(
                kind="feed",
                operation=section.operation,
                reason="verify.load",
                amount=float(1.0 / times[worst]),
            ),
        )
    ], offers


def _feeds(
    proof: SetupProof,
    section: ProgramSection,
    rows: Ints,
    over: Bools,
    reason: str,
    share: Callable[[Ints], Floats],
) -> list[Offer]:
    """Return the feeds that keep a limit, for runs of blocks that pass it, the largest change first."""
    offers = []
    edges = np.flatnonzero(np.diff(np.concatenate([[False], over, [False]])))
    for first, last in edges.reshape(-1, 2):
        run = rows[first:last]
        # Cut to a whole number: a feed of 0 would stand still.
        feed = max(
            1.0, math.floor(float((proof.times.speed[run] * SECONDS_PER_MINUTE * share(run)).min()))
        )
        offers.append(
            Offer(
                kind="feed",
                operation=section.operation,
                setup=proof.program.setup.name,
                reason=reason,
                first=int(proof.moves.block[run[0]]),
                last=int(proof.moves.block[run[-1]]),
                feed=feed,
            )
        )
    return sorted(offers, key=lambda o: (o.feed, o.first))[:MOST_OFFERS]


def _feed_remedy(proof: SetupProof, section: ProgramSection, offers: list[Offer]) -> str:
    """Return which feeds are offered."""
    lines = section.block_lines
    positions = [
        (
            f"line {lines[o.first]} to {lines[o.last]}"
            if lines
            else f"block {o.first} to {o.last}",
            o.feed,
        )
        for o in offers
    ]
    return (
        "feed at most "
        + ", ".join(f"{feed:.0f} mm/min from {position}" for position, feed in positions)
        + "; or clear the material before"
    )


def _air(
    proof: SetupProof, section: ProgramSection, rows: Ints, settings: ProofSettings
) -> LoadFindings:
    if section.tool.locked:
        # The table turns on: the way over what stands between gaps is part of the work.
        return [], []
    if section.cutter.cuts_threads:
        # What it takes off is not the stock's: a thread stands in the wall of its bore.
        return [], []
    air = proof.stock.removed[rows] <= 0.0
    length, seconds = proof.moves.length[rows], proof.times.seconds[rows]
    run, wasted = float(length.sum()), float(seconds[air].sum())
    if run <= 0.0 or float(length[air].sum()) <= settings.air * run or wasted < AIR_WORTH:
        return [], []
    offer = Offer(
        kind="rest",
        operation=section.operation,
        setup=proof.program.setup.name,
        reason="verify.air",
        first=int(proof.moves.block[rows[0]]),
        last=int(proof.moves.block[rows[-1]]),
    )
    return [
        remark(
            "verify.air",
            f"{section.operation} cuts air on {100 * float(length[air].sum()) / run:.0f} % of its way, {wasted:.0f} s",
            section.operation,
            remedy="let it cut only what still stands, as a rest operation, or move it before what clears its "
            "place",
            fix=Fix(
                kind="trim",
                operation=section.operation,
                reason="verify.air",
                amount=float(length[air].sum()) / run,
            ),
        )
    ], [offer]
