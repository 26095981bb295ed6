"""How the commands show operations: as a table and as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from trunnion.cli.common import table
from trunnion.model.operation import Operation


def operation_dict(operation: Operation) -> dict[str, Any]:
    """Return an operation as JSON data."""
    return {
        "id": operation.id,
        "kind": operation.kind,
        "strategy": operation.strategy,
        "feature": operation.feature,
        **({"others": list(operation.others)} if operation.others else {}),
        "setup": operation.setup,
        "direction": list(operation.direction),
        "tool": operation.tool.number,
        "faces": list(operation.faces),
        "data": operation.data.as_dict(),
        "choices": dict(operation.choices),
        "rules": list(operation.rules),
        "after": list(operation.after),
        "by_hand": operation.by_hand,
        **({"copy_of": operation.copy_of} if operation.copy_of else {}),
        **({"moved": True} if operation.moved else {}),
        **({"own_faces": True} if operation.own_faces else {}),
        "suppressed": operation.suppressed,
        **({"avoid": [asdict(b) for b in operation.avoid]} if operation.avoid else {}),
    }


def operation_table(operations: Iterable[Operation]) -> str:
    """Return operations as aligned text."""
    rows = [
        ("operation", "kind", "feature", "tool", "n 1/min", "vf mm/min", "ap mm", "ae mm", "kW")
    ]
    for o in operations:
        d = o.data
        rows.append(
            (
                o.id,
                o.kind,
                o.feature,
                f"T{o.tool.number} {o.tool.name}",
                f"{d.spindle:.0f}",
                f"{d.feed:.0f}",
                f"{d.depth:.2f}",
                f"{d.width:.2f}",
                f"{d.power:.2f}",
            )
        )
    return table(rows, right=(4, 5, 6, 7, 8))
