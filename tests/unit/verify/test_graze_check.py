"""Rapids that graze material between rays: all of their places are asked about at once, each of the cuts before its own rapid."""

from __future__ import annotations

import numpy as np
import pytest

from leaning_tools import EVERY_FORM, leaning_section
from trunnion.findings import Cancelled
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box
from trunnion.progress import Progress
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock
from trunnion.verify.stock.engagement import probes_of
from trunnion.verify.stock.graze_check import confirm_grazed
from trunnion.verify.stock.rays import Passed

BLOCK = Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=(60.0, 40.0, 20.0), material="test", density=2.8)
TURNED = Frame(np.array([60.0, 0.0, 20.0]), np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
"""A setup that looks at the block from below."""


def passes(form, height, lean):
    """Return the moves of passes along y over the block, the tool leaning in the plane of the way."""
    tips = [
        (x, y, height)
        for k, x in enumerate(np.linspace(5.0, 55.0, 30))
        for y in ((2.0, 38.0) if k % 2 else (38.0, 2.0))
    ]
    axis = np.array([0.0, np.sin(lean), np.cos(lean)])
    return moves_of([leaning_section(EVERY_FORM[form], tips, [axis] * len(tips))])


def one_by_one(stock, found, frame, sweep):
    """Return depths and positions as `confirm_grazed` notes them, by asking for each place by itself."""
    depth, position = found.depth.copy(), found.position.copy()
    for rows, places in found.grazed:
        for row, place in zip(rows, places, strict=True):
            world = stock.frame.to_world(place[None, :3])
            is_cut = [sweep.cut_before(frame.to_local(world), int(row))[0]]
            is_cut += [s.cut_before(f.to_local(world), len(s.moves))[0] for s, f in stock.cut_by]
            if stock.was_solid(place[None, :3])[0] and not any(is_cut) and place[3] > depth[row]:
                depth[row], position[row] = place[3], place[:3]
    return depth, position


@pytest.fixture(scope="module")
def grazed():
    """A stock that a setup from below has cut, the sweep of a setup from above, and random places that its moves graze."""
    below, above = passes("flat", 16.0, 0.0), passes("ball", 14.0, 0.3)
    stock = Stock.of(BLOCK, 2.0, ("x", "y", "z"))
    stock.cut_by.append((Sweep.of(below, 2.0), TURNED))
    rng = np.random.default_rng(5)
    found = Passed.empty(len(above), probes_of(above))
    for _ in range(3):
        places = rng.uniform([-2.0, -2.0, 0.0, 0.01], [62.0, 42.0, 22.0, 3.0], (200, 4))
        found.grazed.append((np.sort(rng.integers(0, len(above), 200)), places))
    return stock, found, Sweep.of(above, 2.0)


def fresh(found):
    """Return what was found before grazed places are looked at."""
    depth = np.linspace(0.0, 3.0, len(found.depth))
    return Passed(
        found.removed,
        depth,
        np.full((len(depth), 3), np.nan),
        found.body,
        found.tally,
        found.grazed,
    )


def test_each_rapid_is_as_deep_as_its_deepest_place_that_no_cut_before_it_has_removed(grazed):
    stock, found, sweep = grazed
    found = fresh(found)
    depth, position = one_by_one(stock, found, WORLD, sweep)
    noted = np.isfinite(position[:, 0])
    assert 3 < noted.sum() < len(noted)
    confirm_grazed(stock, found, WORLD, sweep)
    assert found.depth.tobytes() == depth.tobytes()
    assert found.position.tobytes() == position.tobytes()


def test_no_sweep_is_asked_more_than_once_however_many_rapids_graze(grazed, monkeypatch):
    stock, found, sweep = grazed
    asked, plain = [], Sweep.cut_before

    def counted(self, *rest):
        asked.append(self)
        return plain(self, *rest)

    monkeypatch.setattr(Sweep, "cut_before", counted)
    confirm_grazed(stock, fresh(found), WORLD, sweep)
    assert asked == [sweep, stock.cut_by[0][0]]


def test_looking_closer_at_rapids_can_be_cancelled(grazed):
    stock, found, sweep = grazed
    with pytest.raises(Cancelled):
        confirm_grazed(stock, fresh(found), WORLD, sweep, Progress(cancelled=lambda: True))
