"""Engagement of roughing at constant engagement, measured on the whole path by the proof's stock engine, which knows nothing of how the
passes were laid."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from milling import SETUP, box_blank, closed_pocket, cutting, mill, rounded
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.cutting.engaged import CONSTANT_ENGAGEMENT
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.constant_engagement.clearing import contact_angle
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock, positions_on
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from trunnion.verify.stock import engagement as measured_by

OVER, SHARE_OVER, LEAST_MEAN = math.radians(5.0), 0.005, 0.85
"""What the angle may be passed by, on what share of the way in material; the mean by removal over the angle."""
PIECE = 0.1
"""Radii of way between two measurements."""
CELL = 0.02
"""Radii between the stock's rays."""
DEPTH = 20.0


def random_pocket(seed: int) -> Region:
    """Return a pocket with rounded corners, and islands in some."""
    pick = random.Random(seed)
    plan = rounded(0, 0, pick.uniform(60.0, 140.0), pick.uniform(50.0, 110.0), pick.uniform(12, 18))
    low, high = plan.box()
    for _ in range(pick.randint(0, 2)):
        x, y = (pick.uniform(a + 25.0, b - 25.0) for a, b in zip(low, high, strict=True))
        plan = plan.minus(Region.circle((x, y), pick.uniform(4.0, 9.0)))
    return plan


def in_pieces(path: Toolpath, longest: float) -> Toolpath:
    """Return a path whose feed blocks are no longer than a length in mm."""
    count = np.maximum(np.ceil(path.lengths() / longest), 1).astype(int)
    count[path.motion == Motion.RAPID] = 1
    row = np.repeat(np.arange(len(path)), count)
    part = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count) + 1
    share = part / np.repeat(count, count)
    position = positions_on(path, row, share)
    position[share == 1.0] = path.position[row[share == 1.0]]
    fields = {n: getattr(path, n)[row] for n in ("axis", "motion", "centre", "feed", "mark")}
    return Toolpath(position=position, **fields)


def engagement(plan: Region, radius: float, width: float) -> tuple[Floats, Floats, Floats, Bools]:
    """Return the angle (n,) rad, the removal (n,) mm3 and the length (n,) mm of the pieces of a roughing path, and which of them are
    passes in material."""
    low, high = plan.box()
    blank = box_blank((*(low - 5.0), -DEPTH), (*(high + 5.0), 0.0))
    tool = mill(2.0 * radius)
    data = replace(cutting(DEPTH, width), layer_depth=0.5 * radius, layer_width=radius)
    path = rough(
        closed_pocket(plan, DEPTH),
        tool,
        data,
        PlanningStock.of(blank, SETUP),
        SETUP,
        RoughSettings(pattern=CONSTANT_ENGAGEMENT),
        NO_PROGRESS,
    ).path
    pieces = in_pieces(path, PIECE * radius)
    section = ProgramSection(operation="rough", tool=tool, spindle=8000.0, path=pieces)
    moves = moves_of([section])
    run = run_stock(Stock.of(blank, CELL * radius, ("z",)), moves, SETUP.frame)
    passes = (pieces.mark == Mark.CUT) & (run.removed > 0.0)
    return run.engagement, run.removed, moves.length, passes


@pytest.mark.parametrize(
    "seed", [0, 1, *(pytest.param(n, marks=pytest.mark.long) for n in range(2, 12))]
)
def test_the_angle_of_contact_is_kept_as_the_proof_sees_it(seed, monkeypatch):
    # Directions of a degree: those of the proof are four degrees apart.
    monkeypatch.setattr(measured_by, "DIRECTIONS", 180)
    radius, share = random.Random(seed).choice(((6.0, 0.5), (8.0, 0.6), (10.0, 0.2)))
    limit = contact_angle(radius, share * radius)
    angle, removed, length, passes = engagement(random_pocket(seed), radius, share * radius)
    over = passes & (angle > limit + OVER)
    assert length[over].sum() <= SHARE_OVER * length[passes].sum()
    mean = (angle * removed)[passes].sum() / removed[passes].sum()
    assert LEAST_MEAN * limit <= mean <= limit + OVER


def test_a_pocket_takes_little_more_way_than_its_volume_asks_for_and_few_blocks():
    """A pocket of FreeCAD's example panel, cutter of 16 mm, ae 4 mm, two layers of 20 mm, helices of 5 degrees: its adaptive clearing feeds
    1.12 of volume / (ae ap) without links, in 6,903 blocks."""
    plan = Region.rectangle(0, 0, 110, 120).opened(8.0)
    data = replace(
        cutting(20.0, 4.0, feed=1200.0),
        layer_depth=8.0,
        layer_width=8.0,
        entry_angle=5.0,
        fastest_link=20_000.0,
        link_share=50.0,
    )
    path = rough(
        closed_pocket(plan, 40.0),
        mill(16),
        data,
        PlanningStock.of(box_blank((-20, -20, -50), (130, 140, 0)), SETUP),
        SETUP,
        RoughSettings(pattern=CONSTANT_ENGAGEMENT),
        NO_PROGRESS,
    ).path
    feeds = (path.motion != Motion.RAPID) & (path.mark != Mark.LINK)
    assert path.lengths()[feeds].sum() <= 1.12 * plan.area * 40.0 / (4.0 * 20.0)
    assert len(path) <= 6903 / 3
