"""Ribs that are lower than the fillets at their foot are high: the pocket's walls on the other sides are still found over these."""

from __future__ import annotations

import math

import cadquery as cq
import pytest

from flat_parts import MILL
from trunnion import tolerance
from trunnion.pipeline import Engine
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.settings import choose

LENGTH, WIDTH, HEIGHT, FLOOR = 120.0, 70.0, 24.0, 6.0
SIDE, CORNER, FILLET = 6.0, 9.0, 6.0
POCKET = (51.0, WIDTH - 2.0 * SIDE)


def _panel(rib: float, path):
    """A panel with two pockets of `POCKET` mm and between them a rib of 6 mm whose top stands `rib` mm over the floors."""
    body = cq.Workplane("XY").box(*POCKET, HEIGHT, centered=False).edges("|Z").fillet(CORNER)
    body = body.faces("<Z").edges().fillet(FILLET)
    plate = cq.Workplane("XY").box(LENGTH, WIDTH, HEIGHT, centered=False)
    for x in (SIDE, LENGTH - SIDE - POCKET[0]):
        plate = plate.cut(body.translate((x, SIDE, FLOOR)))
    gap = cq.Workplane("XY").box(20.0, 30.0, HEIGHT, centered=(True, True, False))
    plate = plate.cut(gap.translate((0.5 * LENGTH, 0.5 * WIDTH, FLOOR + rib)))
    cq.exporters.export(plate, str(path))
    return path


@pytest.mark.parametrize("share", [0.5, 0.8, 0.999, 1.2])
def test_a_pocket_beside_a_low_rib_reaches_to_its_walls(share, tmp_path):
    engine = Engine()
    session = engine.run(engine.open(_panel(share * FILLET, tmp_path / "rib.step")), "blank")
    part = engine.context_of(session).part
    (setup,) = make_setups(session.recognition, session.blank, choose(SetupSettings, MILL))
    space = SetupSpace.of(part, session.recognition, session.blank, setup)
    area = POCKET[0] * POCKET[1] - (4.0 - math.pi) * CORNER**2
    pockets = session.recognition.of_kind("pocket")
    assert len(pockets) == 2
    for pocket in pockets:
        assert pocket.sizes["lowest_rim_z"] == pytest.approx(FLOOR + share * FILLET)
        *_, lowest = space.bands_of(pocket)
        width = math.sqrt(lowest.wanted.area / area)
        assert width == pytest.approx(1.0, abs=tolerance.GOUGE / POCKET[0])


@pytest.mark.parametrize("share", [0.9, 1.5])
def test_a_floor_above_a_low_rib_ends_at_the_rib(share, tmp_path):
    """The rib between two pockets is lower than the upper floor of one of them: no section over that floor is closed by itself."""
    step = 2.0 * FILLET
    plain, stepped = _panel(share * FILLET, tmp_path / "rib.step"), tmp_path / "stepped.step"
    block = cq.Workplane("XY").box(0.6 * POCKET[0], POCKET[1] + 2.0, step, centered=False)
    body = cq.importers.importStep(str(plain)).union(
        block.translate((SIDE - 1.0, SIDE - 1.0, FLOOR))
    )
    cq.exporters.export(body, str(stepped))
    engine = Engine()
    session = engine.run(engine.open(stepped), "blank")
    part = engine.context_of(session).part
    (setup,) = make_setups(session.recognition, session.blank, choose(SetupSettings, MILL))
    space = SetupSpace.of(part, session.recognition, session.blank, setup)
    pocket = next(
        f for f in session.recognition.of_kind("pocket") if len(f.with_role("floor")) == 2
    )
    upper, lower = space.bands_of(pocket)
    assert upper.bottom - lower.bottom == pytest.approx(step)
    area = POCKET[0] * POCKET[1] - (4.0 - math.pi) * CORNER**2
    assert upper.wanted.area == pytest.approx(area, rel=0.01)
    assert upper.wanted.minus(lower.wanted).area == pytest.approx(
        (0.6 * POCKET[0] - 1.0) * POCKET[1], rel=0.05
    )


@pytest.mark.long
@pytest.mark.parametrize("share", [0.5, 0.9])
def test_a_panel_with_a_low_rib_passes_its_proof(share, tmp_path):
    engine = Engine()
    session = engine.run(engine.open(_panel(share * FILLET, tmp_path / "rib.step")))
    assert session.verdict.releases
    assert session.verdict.gouge < tolerance.GOUGE
