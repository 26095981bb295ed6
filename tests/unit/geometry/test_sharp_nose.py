"""A wall's sharp edge with a fillet at its foot: the fillet is mitred there, and no pass may go round the edge into the mitre."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest

from samples import written
from trunnion.geometry.plane.region import Region
from trunnion.pipeline import Engine
from trunnion.toolpath.axis_region import AxisRegion


def test_the_axis_goes_straight_on_to_where_both_passes_meet():
    nosed = Region.rectangle(0, 0, 100, 100).minus(Region.rectangle(40, 60, 60, 100))
    room = AxisRegion.of(nosed, 10.0, mitred=True)
    edge = np.array([40.0, 60.0])
    assert room.holds([edge + [-10.0, -10.0]])
    assert not room.holds([edge + 10.001 * np.array([-np.sqrt(0.5), -np.sqrt(0.5)])])
    assert AxisRegion.of(nosed, 10.0).holds(
        [edge + 10.001 * np.array([-np.sqrt(0.5), -np.sqrt(0.5)])]
    )


@pytest.fixture(scope="module")
def programmed():
    """A block 160 x 120 x 30, a pocket 120 x 80 x 20 with corners R8, a sharp nose 30 wide reaching 25 into it, floor fillets R3."""
    block = cq.Workplane("XY").box(160, 120, 30, centered=(True, True, False))
    pocket = (
        cq.Workplane("XY", origin=(0, 0, 10))
        .box(120, 80, 20, centered=(True, True, False))
        .edges("|Z")
        .fillet(8)
    )
    nose = cq.Workplane("XY", origin=(0, 30, 10)).box(30, 30, 20, centered=(True, True, False))
    body = pocket.cut(nose).faces("<Z").edges().fillet(3)
    engine = Engine()
    return engine.run(engine.open(written(block.cut(body).val().wrapped)))


def test_the_mitre_is_not_cut(programmed):
    assert programmed.verdict.gouge <= 0.02
    assert programmed.verdict.releases
