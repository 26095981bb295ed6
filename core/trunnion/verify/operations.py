"""What was measured on each operation of a setup."""

from __future__ import annotations

from trunnion.model.material import Machine
from trunnion.model.verdict import OperationProof, Outcome
from trunnion.verify.settings import ProofSettings
from trunnion.verify.setups import SetupProof


def operation_proofs(proof: SetupProof, machine: Machine, settings: ProofSettings) -> list[OperationProof]:
    """Return the measurements of every section of a setup's program, in order."""
    collides = proof.collides(settings.tolerance)
    found = []
    for k, section in enumerate(proof.program.sections):
        rows = proof.moves.section == k
        rapids = rows & (proof.stock.rapid_depth > 0.0)
        gouge = float(proof.contact.depth[rows, 0].max(initial=0.0))
        feeds = rows & ~proof.moves.rapid
        run = float(proof.moves.length[feeds].sum())
        air = float(proof.moves.length[feeds & (proof.stock.removed <= 0.0)].sum())
        failed = gouge > settings.tolerance or collides[rows].any() or rapids.any()
        new_tool = k == 0 or proof.program.sections[k - 1].tool.number != section.tool.number
        found.append(OperationProof(
            operation=section.operation, setup=proof.program.setup.name, outcome=Outcome.FAILED if failed else Outcome.PASSED, gouge=gouge,
            collisions=int(collides[rows].sum()), rapids_in_stock=int(rapids.sum()),
            time_s=float(proof.times.seconds[rows].sum()) + machine.tool_change_s * new_tool,
            removed=float(proof.stock.removed[rows].sum()),
            air_share=air / run if run > 0.0 else 0.0))
    return found
