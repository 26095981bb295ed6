"""How many random parts are released, at once and after repairs, and how much of their feed time is air: shares of the parts programmed."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import fmean
from typing import Any

from release_rate import Outcome, outcomes

FIRST_SEED = 500
"""Seeds from here on are the bench's: no test holds them."""
COUNTS = {"panel": (20, 2), "plate": (6, 1)}
"""Parts of a kind, and how many when quick. `tests/release_rate.py` measures as many as are wanted."""
GOALS = {"panel": (0.98, 0.94, 0.10), "plate": (0.95, 0.88, 0.20)}
"""Least share released, least share released without a repair, most air."""


def released(quick: bool) -> Iterator[dict[str, Any]]:
    """Yield the shares of panels and of plates."""
    for kind, counts in COUNTS.items():
        seeds = range(FIRST_SEED, FIRST_SEED + counts[quick])
        with tempfile.TemporaryDirectory() as folder:
            yield from _shares(kind, outcomes([kind], seeds, Path(folder), (), 1))


def _shares(kind: str, found: Sequence[Outcome]) -> Iterator[dict[str, Any]]:
    """Yield the figures of the parts of a kind; seconds are the mean of a part's whole line."""
    good = [o for o in found if o.is_released]
    shares = (
        ("released", len(good) / len(found), ">="),
        ("released at once", sum(not o.repairs for o in good) / len(found), ">="),
        ("air", fmean(o.air for o in good) if good else 1.0, "<="),
    )
    for (name, share, sign), goal in zip(shares, GOALS[kind], strict=True):
        yield {
            "name": name,
            "part": f"{len(found)} {kind}s",
            "seconds": fmean(o.seconds for o in found),
            "ratio_to": "the parts" if sign == ">=" else "their feed time",
            "ratio": share,
            "goal": f"{sign} {goal:g}",
        }
