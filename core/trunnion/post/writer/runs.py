"""Which blocks of a section are alike: long runs of straight ones are written many at a time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Motion
from trunnion.post.ticks import WrittenPath

LEAST_RUN = 16
"""Blocks from which on a run is written sooner at once than one by one."""


def runs(path: WrittenPath, minutes: Floats) -> Iterator[tuple[int, int, bool]]:
    """Yield the rows of a path after its first in runs: the first of them, the one after the last, and whether all are alike.

    Those are straight, as the row before each is, in no cycle, without a dwell or `minutes` (m,) of their own. All rows of a cycle or a
    helix are in one run.
    """
    straight = (path.motion < Motion.ARC_CW) & (path.dwell <= 0.0) & (minutes <= 0.0)
    straight[0] = False
    for cycle in path.cycles:
        straight[cycle.first : cycle.last + 1] = False
    alike = straight[1:] & straight[:-1]
    edge = np.flatnonzero(alike[1:] != alike[:-1]) + 1
    starts, ends = np.append(0, edge), np.append(edge, len(alike))
    first = 1
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        if end - start >= LEAST_RUN and alike[start]:
            if first <= start:
                yield first, start + 1, False
            yield start + 1, end + 1, True
            first = end + 1
    if first <= len(alike):
        yield first, len(alike) + 1, False
