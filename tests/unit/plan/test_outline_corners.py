"""Inner corners of outlines: a stiff cutter goes all round and leaves them to slimmer ones; where none reaches they are told."""

from __future__ import annotations

from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from long_mark import mostly_long
from trunnion.pipeline import Engine


def notched(folder: Path, seed: int, height: float, radius: float, narrowest: float = 15.0) -> Path:
    """Return a plate with a pocket, and notches in its outline whose inner corners have a radius (mm), one as narrow as said (mm)."""
    draw = np.random.default_rng(seed)
    plate = cq.Workplane("XY").box(140.0, 90.0, height, centered=(True, True, False))
    for x in (-40.0, 0.0, 40.0):
        size = draw.uniform((15.0, 16.0), (26.0, 30.0))
        if x == 0.0:
            size[0] = narrowest
        notch = cq.Workplane("XY").box(*map(float, size), 3.0 * height).edges("|Z").fillet(radius)
        plate = plate.cut(notch.translate((x + float(draw.uniform(-5.0, 5.0)), 45.0, 0.0)))
    corner = cq.Workplane("XY").box(50.0, 40.0, 3.0 * height).edges("|Z").fillet(radius)
    plate = plate.cut(corner.translate((70.0, -45.0, 0.0)))
    pocket = cq.Workplane("XY").box(40.0, 25.0, 8.0).edges("|Z").fillet(6.0)
    path = folder / "notched.step"
    cq.exporters.export(plate.cut(pocket.translate((-20.0, -10.0, height - 4.0))), str(path))
    return path


def outline_of(session):
    """Return the operations on the outline."""
    return [o for o in session.process.operations if o.feature.startswith("profile")]


@pytest.mark.parametrize("seed", mostly_long(range(4), 3))
def test_sharp_corners_of_a_thick_outline_are_left_to_slimmer_cutters(seed, tmp_path):
    """A cutter of D 5 went all round 30 mm deep: 24 minutes for what takes three."""
    radius = float(np.random.default_rng(seed).uniform(2.5, 2.95))
    engine = Engine()
    session = engine.run(engine.open(notched(tmp_path, seed, 30.0, radius)), "route")
    kinds = [o.kind for o in outline_of(session)]
    assert {"profile_rough", "corner", "profile_finish", "corner_finish"} == set(kinds)
    by_kind = {o.kind: o.cutter for o in outline_of(session)}
    assert by_kind["profile_finish"].diameter >= 2.0 * by_kind["corner_finish"].diameter
    assert by_kind["corner_finish"].radius <= radius
    assert kinds.index("corner") < kinds.index("profile_finish") < kinds.index("corner_finish")
    assert not [f for f in session.findings() if f.code in ("route.no-cutter", "route.corner-left")]


def test_such_an_outline_is_finished_whole_and_released(tmp_path):
    engine = Engine()
    verdict = engine.run(engine.open(notched(tmp_path, 7, 30.0, 2.6))).verdict
    assert verdict.releases and verdict.coverage > 0.999 and verdict.gouge == 0.0


def test_an_outline_with_wide_corners_is_cut_by_one_cutter(tmp_path):
    engine = Engine()
    session = engine.run(engine.open(notched(tmp_path, 1, 20.0, 7.0)), "route")
    assert [o.kind for o in outline_of(session)] == ["profile_rough", "profile_finish"]


def test_corners_that_no_cutter_reaches_into_are_told_and_the_outline_is_cut(tmp_path):
    """No cutter as slim as these corners is 20 mm long: nothing was planned for the whole outline."""
    engine = Engine()
    session = engine.run(engine.open(notched(tmp_path, 2, 20.0, 1.4)), "route")
    (told,) = [f for f in session.findings() if f.code == "route.corner-left"]
    slimmest = min(o.cutter.radius for o in outline_of(session))
    assert f"a radius of {slimmest:g} mm" in told.text and slimmest > 1.4
    assert {"profile_rough", "profile_finish"} < {o.kind for o in outline_of(session)}
    assert not [f for f in session.findings() if f.code == "route.no-cutter"]


def test_a_notch_too_narrow_for_the_largest_cutter_is_no_corner(tmp_path):
    """What is left to slimmer cutters are corners alone: the one all round goes into every notch."""
    engine = Engine()
    session = engine.run(engine.open(notched(tmp_path, 3, 30.0, 2.6, narrowest=11.0)), "route")
    finish = next(o for o in outline_of(session) if o.kind == "profile_finish")
    assert 6.0 < finish.cutter.diameter <= 11.0


@pytest.mark.parametrize(("angle", "is_cut"), ((172.0, False), (90.0, True)))
def test_a_sharp_inner_edge_gets_a_slimmer_cutter_where_more_than_a_trace_stays(
    angle, is_cut, tmp_path
):
    """An outline that turns in by 8 degrees keeps some hundredths of a millimetre of a large cutter; a right angle four of them."""
    far = 60.0 * float(np.tan(np.radians(90.0 - 0.5 * angle)))
    points = [(-60.0, -40.0), (60.0, -40.0), (60.0, far), (0.0, 0.0), (-60.0, far)]
    plate = cq.Workplane("XY").polyline(points).close().extrude(12.0)
    pocket = cq.Workplane("XY").box(60.0, 20.0, 12.0).edges("|Z").fillet(6.0)
    plate = plate.cut(pocket.translate((0.0, -22.0, 12.0)))
    cq.exporters.export(plate, str(tmp_path / "edge.step"))
    engine = Engine()
    session = engine.run(engine.open(tmp_path / "edge.step"), "route")
    cut = [o.cutter.diameter for o in outline_of(session) if o.kind.startswith("corner")]
    assert bool(cut) == is_cut
    assert is_cut == any(f.code == "route.corner-left" for f in session.findings())
