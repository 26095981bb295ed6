"""The area of faces that is touched on moves of passes which are left out.

Passes may lie far closer to each other than the widest stepover between them, as those over leaning walls do beside upright ones: a length
times that is no area. Samples on the faces are asked instead: each is cut or not as is the position that is nearest to the tip touching it
(Voronoi's diagram of the positions).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.reach import reached, samples_on
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.upright.pass_samples import PassSamples
from trunnion.toolpath.contact_passes.upright.stock_trimming import sample_count


def uncut_area(
    passes: Sequence[Pass],
    places: PassSamples,
    is_cut: Sequence[Bools],
    drive: SurfaceDrive,
    tool: Tool,
    stepover: float,
    progress: Progress,
) -> float:
    """Return the area (mm2) of the faces that an upright tool touches nearer to moves that are not cut than to others, and no farther from
    them than a stepover (mm): no more than this times the length of these moves.

    places: positions along the passes; is_cut: of each pass, which moves are cut.
    """
    cut: Bools = np.concatenate(is_cut)
    if cut.all():
        return 0.0
    moved = np.concatenate([np.diff(p.tip, axis=0) for p in passes])
    length = float(np.linalg.norm(moved[~cut], axis=1).sum())
    first = np.cumsum([0, *(len(some) for some in is_cut)])
    is_uncut = ~cut[first[places.owner] + places.move]
    area = float(drive.skin.areas(drive.skin.of(drive.faces)).sum())
    samples = samples_on(drive.skin, drive.faces, sample_count(area))
    axis = np.broadcast_to(UPRIGHT, samples.normal.shape)
    tips = tip_at(tool, samples.point + drive.allowance * samples.normal, samples.normal, axis)
    progress.check()
    uncut, others = cKDTree(places.tips[is_uncut]), places.tips[~is_uncut]
    away = np.asarray(uncut.query(tips, distance_upper_bound=stepover)[0])
    own = np.isfinite(away)
    progress.check()
    if own.any() and len(others):
        own[own] = away[own] < np.asarray(cKDTree(others).query(tips[own])[0])
    # What no tool touches, or only another one, is not left because of stock.
    below = tool.flute_length
    own[own] = reached(drive, samples.of(own), tool, 0.0, drive.allowance, progress, below)
    return min(length * stepover, float(own.sum()) * samples.area)
