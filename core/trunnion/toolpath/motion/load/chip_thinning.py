"""Feeds raised where a cut is narrower than its feed was chosen for: where crescents begin and end, over strips, beside what was cut.

At an angle of contact below a right one chips are thinner than the feed per tooth: in a width w a chip is as thick as in the width ae of
the cutting data at the feed times t(w) / t(ae), t the chip thinning D / (2 sqrt(w (D - w))). The power then goes with sqrt(w / (D - w)) and
is less: neither chip nor power passes what the data were chosen for.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import chip_thinning
from trunnion.toolpath.motion.load.pieces import cut_width

STEPS = 2
"""Feeds are raised in so many steps, always down from what would be right: blocks stay few."""
MOST = 1.4
"""Times that a feed is raised at most: a film that stands far round the cutter, too thin for the field of heights, makes chips as thick as
the whole feed per tooth, and that may be one and a half times the table's (`verify.chip`)."""
NEAR = 0.5
"""Radii before and behind a piece within which the widest cut counts."""
NARROWEST = 1e-3
"""Of the diameter: widths below it are none."""


def raised(
    pieces: Toolpath,
    feed: Floats,
    tool: Tool,
    data: CuttingData,
    volume: Floats,
    squares: Floats,
    cell: float,
) -> Floats:
    """Return the feeds (n,) mm/min of pieces that take off volumes (n,) mm3, raised from `feed` (n,) where they cut little or nothing.

    `squares` (n,) mm4 are the heights that they take off, squared and summed over the area in plan, in cells of a side (mm): a cut may be
    wider by half of one. Entries, links and leads keep theirs.
    """
    length = np.maximum(pieces.lengths(), tolerance.COINCIDENT)
    cuts = (pieces.motion != Motion.RAPID) & (pieces.mark == Mark.CUT)
    width = np.where(cuts, cut_width(volume / length, squares / length, tool), 0.0)
    near = _widest(width, pieces, NEAR * tool.radius)
    half = 0.5 * tool.diameter
    bounded = np.clip(near + 0.5 * cell, NARROWEST * tool.diameter, half)
    thinning = half / np.sqrt(bounded * (tool.diameter - bounded))
    most = min(data.thin_share, MOST)
    share = np.clip(thinning / chip_thinning(tool.diameter, data.width), 1.0, most)
    step = max((most - 1.0) / STEPS, tolerance.PARAMETRIC)
    share = 1.0 + step * np.floor((share - 1.0) / step + tolerance.PARAMETRIC)
    fastest = max(data.fastest_link, data.feed)
    return np.where(cuts, np.maximum(np.minimum(share * feed, fastest), feed), feed)


def _widest(width: Floats, pieces: Toolpath, reach: float) -> Floats:
    """Return the largest of the widths (n,) of pieces that are no farther along the path than `reach` mm from each; a rapid is farther."""
    at = np.concatenate(
        [
            [0.0],
            np.cumsum(np.where(pieces.motion == Motion.RAPID, 2.0 * reach, pieces.lengths())),
        ]
    )
    first = np.searchsorted(at[1:], at[:-1] - reach + tolerance.COINCIDENT)
    last = np.searchsorted(at[:-1], at[1:] + reach - tolerance.COINCIDENT)
    spans = np.column_stack([first, last]).ravel()
    return np.asarray(np.maximum.reduceat(np.append(width, 0.0), spans)[::2])
