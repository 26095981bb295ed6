"""How the commands show a verdict: as text, as the JSON other programs rely on, and as an exit code."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from trunnion.findings import has_errors
from trunnion.model.verdict import Offer, OperationProof

if TYPE_CHECKING:
    from trunnion.model.operation import Operation
    from trunnion.model.session import Session


def proof_dict(
    session: Session, files: tuple[str, ...], seconds: Mapping[str, float]
) -> dict[str, Any]:
    """Return the verdict as JSON data; every figure is the proof's own."""
    verdict, process, blank = session.verdict, session.process, session.blank
    assert verdict is not None and process is not None and blank is not None
    proofs = {p.operation: p for p in verdict.operations}
    box = {
        "min": [float(v) for v in blank.low],
        "max": [float(v) for v in blank.high],
        "frame": blank.frame.as_dict(),
    }
    operations = []
    for o in process.operations:
        p = proofs.get(o.id)
        measured = (
            operation_dict(p)
            if p
            else {
                "verdict": "not cut",
                "gouge_mm": 0.0,
                "time_s": 0.0,
                "bound_s": 0.0,
                "removed_mm3": 0.0,
                "air_share": 0.0,
            }
        )
        operations.append(
            {
                "id": o.id,
                "kind": o.kind,
                "feature": o.feature,
                "tool": o.tool.number,
                "setup": o.setup,
                **_foreseen(session, o),
                **measured,
            }
        )
    return {
        "verdict": str(verdict.outcome),
        "coverage": verdict.coverage,
        "reachable": verdict.reachable,
        "gouge_mm": verdict.gouge,
        "collisions": verdict.collisions,
        "rapids_in_stock": verdict.rapids_in_stock,
        "machining_time_s": verdict.machining_time_s,
        "bound_s": verdict.bound_s,
        "over_bound": verdict.over_bound,
        "seconds": dict(seconds),
        "setups": [
            {
                "name": s.name,
                "nc": next((f for f in files if f".{s.name}." in f), ""),
                "frame": s.frame.as_dict(),
                "work_offset": s.work_offset,
                "blank": box,
            }
            for s in process.setups
        ],
        "operations": operations,
        "offers": [offer_dict(o) for o in verdict.offers],
        "repairs": [entry for r in session.repairs for entry in r.as_dicts()],
        "files": list(files),
        "findings": [f.as_dict() for f in session.findings()],
    }


def _foreseen(session: Session, operation: Operation) -> dict[str, Any]:
    """Return what was foreseen of an operation's load: at the largest engagement of its strategy, and of its path as it was laid."""
    made = session.path_of(operation.id)
    return {
        "foreseen_kw": operation.data.highest_power,
        **({"laid_kw": made.power, "laid_chip_mm": made.chip} if made and made.power else {}),
    }


def operation_dict(p: OperationProof) -> dict[str, Any]:
    """Return what was measured on one operation as JSON data."""
    gouges = [{"face": f"face {tag}", "depth_mm": depth} for tag, depth in p.gouges]
    return {
        "verdict": str(p.outcome),
        "gouge_mm": p.gouge,
        "gouges": gouges,
        "collisions": p.collisions,
        "rapids_in_stock": p.rapids_in_stock,
        "time_s": p.time_s,
        "bound_s": p.bound_s,
        "cutting_s": p.cutting_s,
        "air_s": p.air_s,
        "rapid_s": p.rapid_s,
        "idle_s": p.idle_s,
        "removed_mm3": p.removed,
        "air_share": p.air_share,
        "left_mm": {"min": p.left_min, "mean": p.left_mean, "max": p.left_max},
        "engaged_deg": {"mean": math.degrees(p.engaged_mean), "max": math.degrees(p.engaged)},
        "depth_of_cut_mm": p.depth,
        "removal_cm3_min": {"mean": p.rate_mean, "max": p.rate},
        "chip_mm": p.chip,
        "power_kw": p.power,
        "power_limit_kw": p.power_limit,
        "torque_nm": p.torque,
    }


def offer_dict(offer: Offer) -> dict[str, Any]:
    """Return what the proof offers for a finding as JSON data."""
    return {
        "kind": offer.kind,
        "operation": offer.operation,
        "setup": offer.setup,
        "reason": offer.reason,
        "first_block": offer.first,
        "last_block": offer.last,
        "feed_mm_min": offer.feed,
    }


def proof_text(session: Session) -> str:
    """Return the verdict in a few lines."""
    v = session.verdict
    assert v is not None
    minutes, seconds = divmod(round(v.machining_time_s), 60)
    bound = f", {v.over_bound:.2f} times its bound" if v.bound_s > 0.0 else ""
    parts = ", ".join(f"{100 * share:.0f} % {name}" for name, share in v.time_shares())
    return "\n".join(
        [
            f"verdict            {v.outcome}",
            f"coverage           {100 * v.coverage:.2f} % ({100 * v.reachable:.2f} % of what can be reached)",
            f"greatest gouge     {v.gouge:.4f} mm",
            f"collisions         {v.collisions}",
            f"rapids in stock    {v.rapids_in_stock}",
            f"time at the machine {minutes} min {seconds:02d} s in {len(v.operations)} operations{bound}",
            *([f"of that             {parts}"] if parts else []),
        ]
    )


def verdict_code(session: Session) -> int:
    """Return 0 when the program may be released and nothing is an error, 1 otherwise."""
    released = session.verdict is not None and session.verdict.releases
    return 0 if released and not has_errors(session.findings()) else 1
