"""The ledger of a batch: what came of each part and what it was made from, one JSON object a line, so that a batch can be taken up again.

It is written whole after each part (`store.atomic`): whenever a batch is stopped, it holds all parts that were finished.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.model.part_result import PartResult
from trunnion.store.atomic import write_text

LEDGER_FILE, PAGE_FILE = "batch.jsonl", "batch.html"
"""Names in the batch's folder: of the ledger, and of the page that shows all parts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LedgerEntry:
    """A finished part: its file by its path from the batch's folder, the digest of all that its result was made from, and the result."""

    file: str
    digest: str
    result: PartResult


def read_ledger(folder: Path) -> tuple[LedgerEntry, ...]:
    """Return the entries of a folder's ledger, none where there is no ledger; raise `BadInput` for one that is damaged."""
    path = folder / LEDGER_FILE
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return ()
    except (OSError, UnicodeDecodeError) as reason:
        raise BadInput(f"{path}: can't be read ({getattr(reason, 'strerror', reason)})") from None
    return tuple(
        _entry(line, f"{path}, line {n}")
        for n, line in enumerate(text.split("\n"), 1)
        if line.strip()
    )


def _entry(line: str, where: str) -> LedgerEntry:
    try:
        data = json.loads(line)
        return LedgerEntry(
            file=str(data["file"]),
            digest=str(data["digest"]),
            result=PartResult.of_dict(data["result"]),
        )
    except (ValueError, KeyError, TypeError, AttributeError, BadInput) as reason:
        raise BadInput(
            f"{where}: no entry of a batch's ledger ({reason}); delete the line, its part will be programmed again"
        ) from None


def write_ledger(folder: Path, entries: Iterable[LedgerEntry]) -> None:
    """Write the ledger of a folder, whole or not at all."""
    lines = [
        json.dumps(
            {"file": e.file, "digest": e.digest, "result": e.result.as_dict()}, ensure_ascii=False
        )
        for e in entries
    ]
    write_text(folder / LEDGER_FILE, "".join(f"{line}\n" for line in lines))
