"""What was measured on each operation of a setup, and on each of its blocks."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.verdict import BlockProof, OperationProof, Outcome
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE
from trunnion.verify.finish.sweep import residual_by_block
from trunnion.verify.judge.overload import power_limit, table_turns
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings


def operation_proofs(
    proof: SetupProof, tags: Ints, area: Floats, settings: ProofSettings
) -> list[OperationProof]:
    """Return the measurements of every section of a setup's program, in order.

    tags (f,) are those of the face rows; area (s,) mm2 that each sample represents.
    """
    collides = proof.collides(settings.tolerance)
    load, stock, moves = proof.load, proof.stock, proof.moves
    served = (
        np.where(proof.nearest >= 0, moves.section[proof.nearest], -1)
        if len(moves)
        else np.zeros(0, int)
    )
    found = []
    for k, section in enumerate(proof.program.sections):
        rows = moves.section == k
        feeds = rows & ~moves.rapid
        cuts = feeds & (stock.removed > 0.0)
        rapids = rows & (stock.rapid_depth > 0.0)
        gouge = float(proof.contact.depth[rows, 0].max(initial=0.0))
        failed = gouge > settings.tolerance or collides[rows].any() or rapids.any()
        new_tool = k == 0 or proof.program.sections[k - 1].tool.number != section.tool.number
        removed = float(stock.removed[rows].sum())
        seconds, residual = proof.times.seconds, proof.residual[served == k]
        found.append(
            OperationProof(
                operation=section.operation,
                setup=proof.program.setup.name,
                outcome=Outcome.FAILED if failed else Outcome.PASSED,
                gouge=gouge,
                collisions=int(collides[rows].sum()),
                rapids_in_stock=int(rapids.sum()),
                time_s=float(seconds[rows].sum())
                + section.dwell
                + proof.machine.tool_change_s * new_tool,
                removed=removed,
                air_share=1.0
                - _share(float(moves.length[cuts].sum()), float(moves.length[feeds].sum()), 1.0),
                gouges=_gouges(proof, rows, tags),
                left_min=float(residual.min(initial=np.inf)) if len(residual) else 0.0,
                left_max=float(residual.max(initial=-np.inf)) if len(residual) else 0.0,
                left_mean=float(np.average(residual, weights=area[served == k]))
                if len(residual)
                else 0.0,
                engaged=float(stock.engagement[feeds].max(initial=0.0)),
                engaged_mean=_share(
                    float((stock.engagement * moves.length)[cuts].sum()),
                    float(moves.length[cuts].sum()),
                ),
                depth=float(load.depth[rows].max(initial=0.0)),
                rate=float(load.rate[rows].max(initial=0.0)),
                rate_mean=_share(
                    removed / MM_PER_METRE * SECONDS_PER_MINUTE,
                    float(seconds[cuts].sum()),
                ),
                power=float(load.power[rows].max(initial=0.0)),
                power_limit=power_limit(
                    proof.machine,
                    section,
                    table_turns(proof, np.flatnonzero(feeds))
                    if section.tool.locked
                    else section.spindle,
                ),
                torque=float(load.torque[rows].max(initial=0.0)),
                chip=float(load.chip[rows].max(initial=0.0)),
                cutting_s=float(seconds[cuts].sum()),
                air_s=float(seconds[feeds & ~cuts].sum()),
                rapid_s=float(seconds[rows & moves.rapid].sum()),
                served=float(area[served == k].sum()),
            )
        )
    return found


def block_proof(proof: SetupProof, area: Floats) -> BlockProof:
    """Return what was measured block by block; area (s,) mm2 that each sample represents."""
    residual = residual_by_block(proof.residual, proof.nearest, len(proof.moves), area)

    def small(values: Floats) -> np.ndarray:
        return values.astype(np.float32)

    return BlockProof(
        setup=proof.program.setup.name,
        section=proof.moves.section.astype(np.int32),
        time=small(proof.times.seconds),
        gouge=small(proof.contact.depth[:, 0]),
        collision=small(np.maximum(proof.contact.depth[:, 1], proof.stock.body_depth)),
        removed=small(proof.stock.removed),
        engaged=small(proof.stock.engagement),
        depth=small(proof.load.depth),
        rate=small(proof.load.rate),
        power=small(proof.load.power),
        left_min=small(residual.least),
        left_mean=small(residual.mean),
        left_max=small(residual.most),
    )


def _gouges(proof: SetupProof, rows: np.ndarray, tags: Ints) -> tuple[tuple[int, float], ...]:
    """Return the deepest gouge by face tag, of moves that are deepest there, where it is more than can be measured."""
    depth, face = proof.contact.depth[rows, 0], proof.contact.face[rows, 0]
    real = depth > tolerance.CONTACT_BOUND
    worst = {int(tags[f]): float(depth[real & (face == f)].max()) for f in np.unique(face[real])}
    return tuple(sorted(worst.items(), key=lambda pair: (-pair[1], pair[0])))


def _share(part: float, whole: float, empty: float = 0.0) -> float:
    return part / whole if whole > 0.0 else empty
