"""Pockets that broke through the wall between them: one stepped pocket, or two that share their space over a lip."""

from __future__ import annotations

import cadquery as cq
import pytest

from trunnion import tolerance
from trunnion.pipeline import Engine

LENGTH, WIDTH, HEIGHT = 120.0, 70.0, 24.0


def _pocket(x0: float, x1: float, floor: float, fillet: float) -> cq.Workplane:
    body = (
        cq.Workplane("XY")
        .box(x1 - x0, WIDTH - 12.0, HEIGHT, centered=False)
        .edges("|Z")
        .fillet(8.0)
    )
    body = body.faces("<Z").edges().fillet(fillet) if fillet else body
    return body.translate((x0, 6.0, floor))


def _session(pockets, tmp_path, until):
    plate = cq.Workplane("XY").box(LENGTH, WIDTH, HEIGHT, centered=False)
    for pocket in pockets:
        plate = plate.cut(pocket)
    path = tmp_path / "merged.step"
    cq.exporters.export(plate, str(path))
    engine = Engine()
    return engine.run(engine.open(str(path)), until)


def test_pockets_that_share_their_space_are_one_with_two_floors(tmp_path):
    session = _session(
        [_pocket(6.0, 66.0, 5.0, 4.0), _pocket(64.0, 114.0, 8.5, 4.0)], tmp_path, "recognize"
    )
    (pocket,) = session.recognition.of_kind("pocket")
    assert len(pocket.with_role("floor")) == 2
    assert pocket.sizes["floors_z"] == pytest.approx((8.5, 5.0))


@pytest.mark.parametrize(
    "pockets",
    [
        ((6.0, 66.0, 5.0, 4.0), (64.0, 114.0, 8.5, 4.0)),
        pytest.param(((6.0, 64.5, 6.0, 2.0), (64.0, 114.0, 5.5, 0.0)), marks=pytest.mark.long),
    ],
    ids=["a fillet cut off by a higher floor", "a lip between fillet and wall"],
)
def test_the_lip_between_pockets_that_share_their_space_is_not_gouged(pockets, tmp_path):
    verdict = _session([_pocket(*p) for p in pockets], tmp_path, "verify").verdict
    assert verdict.gouge < tolerance.GOUGE
    assert verdict.collisions == 0 and verdict.rapids_in_stock == 0
    # Against the lip a cutter that is rounder than the lip is high leaves some of the fillets.
    assert verdict.reachable > 0.98


def test_the_cutters_of_merged_pockets_fit_through_the_narrowest_of_them(tmp_path):
    # 18 mm between the walls of the second, less the fillets of 3 mm at their feet on both sides.
    session = _session(
        [_pocket(6.0, 60.0, 5.0, 0.0), _pocket(59.0, 77.0, 5.5, 3.0)], tmp_path, "route"
    )
    (pocket,) = session.recognition.of_kind("pocket")
    for kind in ("rough", "wall"):
        assert session.process.operation(f"{kind}-{pocket.id}").cutter.diameter <= 12.0
