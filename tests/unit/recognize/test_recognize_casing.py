"""Recognition of casings on seeded random parts with truth by construction, wherever they lie, and on parts made for one rule each."""

from __future__ import annotations

from collections import Counter
from functools import cache

import cadquery as cq
import numpy as np
import pytest

import samples
from seeded.casings import SIDES, MadeBoss, MadeCasing, Shell, _with_boss, casing, small_casing
from trunnion.findings import BadInput
from trunnion.model.feature import Recognition
from trunnion.part.part import Part
from trunnion.part.read.part_file import read_part
from trunnion.recognize.casing import CasingFamily, CasingSettings
from trunnion.settings import choose

FAMILY = CasingFamily()


def recognized(part: Part, **words) -> Recognition:
    return FAMILY.recognize(part.graph(), part, choose(CasingSettings, words))


@cache
def seeded(seed: int, most: int) -> tuple[MadeCasing, Recognition]:
    import tempfile
    from pathlib import Path

    made = casing(seed, most)
    with tempfile.TemporaryDirectory() as folder:
        return made, recognized(read_part(made.written(Path(folder))))


def check(made: MadeCasing, found: Recognition) -> None:
    """Check everything that is known of a made casing: what there is, its sizes, and the roles of all faces."""
    assert found.counts() == made.counts and found.unexplained == () and found.findings == ()
    bosses = [b for b in made.bosses for _ in range(2 if b.cut else 1)]
    words = Counter("cut rectangle" if b.cut else b.outline for b in bosses)
    assert Counter(str(f.attributes["outline"]) for f in found.of_kind("boss")) == words
    fillets = sorted(float(f.sizes["root_fillet"]) for f in found.of_kind("boss"))
    assert fillets == pytest.approx(sorted(b.fillet for b in bosses), abs=0.01)
    for outline in ("circle", "slot"):
        own = [f for f in found.of_kind("boss") if f.attributes["outline"] == outline]
        heights = sorted(b.height for b in bosses if b.outline == outline)
        assert sorted(f.sizes["height"] for f in own) == pytest.approx(heights, abs=1e-3)
    for f in found.of_kind("boss"):
        assert len(f.with_role("top")) == 1
        if not f.attributes.get("cut"):
            assert len(f.with_role("side")) == SIDES[str(f.attributes["outline"])]
        assert bool(f.with_role("root_fillet")) == (f.sizes["root_fillet"] > 0.0)
    for pocket in found.of_kind("pocket"):
        on = [f for f in found.of_kind("boss") if f.attributes["on"] == pocket.id]
        sides = {t for f in on for t in f.with_role("side")}
        assert set(pocket.with_role("restrict")) == sides
        assert len(pocket.with_role("side")) == 2 and pocket.attributes["full_circle"] is True


@pytest.mark.parametrize("seed", [2, 6, 9])
def test_all_of_a_random_casing_is_found(seed: int) -> None:
    check(*seeded(seed, 4))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(200, 220))
def test_all_of_many_random_casings_with_bosses_close_together_is_found(seed: int) -> None:
    check(*seeded(seed, 9))


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_casing_written_as_surfaces_and_mirrored_is_the_same(mirrored: bool) -> None:
    shape = cq.Shape.cast(small_casing())
    part = samples.read((shape.mirror("XZ") if mirrored else shape).wrapped, "igs")
    found = recognized(part)
    assert found.counts() == {"boss": 3, "pocket": 1, "profile": 1, "hole": 1}
    assert [f.attributes["outline"] for f in found.of_kind("boss")] == (
        ["circle", "rectangle", "lobe"] if not mirrored else ["lobe", "rectangle", "circle"]
    )


@cache
def small() -> tuple[Part, Recognition]:
    part = samples.read(small_casing())
    return part, recognized(part)


def test_bosses_stand_where_they_were_made_and_have_the_sizes_that_they_were_made_with() -> None:
    circle, rectangle, lobe = small()[1].of_kind("boss")
    assert (circle.sizes["diameter"], circle.sizes["height"]) == (14.0, 5.0)
    assert (rectangle.sizes["length_u"], rectangle.sizes["length_v"]) == (12.0, 14.0)
    assert rectangle.sizes["corner_radius"] == 2.0
    assert [lobe.sizes[k] for k in ("lobes", "lobe_distance", "lobe_radius", "concave_radius")] == [
        3,
        5.0,
        3.0,
        3.5,
    ]
    assert [b.sizes["theta"] for b in (circle, rectangle)] == [20.0, 60.0]
    assert [b.sizes["z"] for b in (circle, rectangle)] == [25.0, 25.0]


def test_the_foot_of_a_round_boss_on_a_cylinder_reaches_as_far_as_the_arcsine_of_the_radii() -> (
    None
):
    circle = small()[1].of_kind("boss")[0]
    reach = np.degrees(np.arcsin(7.0 / 40.0))
    assert circle.sizes["theta_low"] == pytest.approx(20.0 - reach, abs=1e-5)
    assert circle.sizes["theta_high"] == pytest.approx(20.0 + reach, abs=1e-5)
    assert (circle.sizes["z_low"], circle.sizes["z_high"]) == (18.0, 32.0)


def test_the_wall_under_a_pocket_is_as_thick_as_it_was_made() -> None:
    (pocket,) = small()[1].of_kind("pocket")
    assert (pocket.sizes["wall_thickness"], pocket.sizes["wall_thickness_max"]) == (3.0, 3.0)
    assert (pocket.sizes["z_low"], pocket.sizes["z_high"]) == (5.0, 45.0)
    (profile,) = small()[1].of_kind("profile")
    assert profile.sizes["inner_diameters"] == (74.0,)
    assert profile.sizes["outer_diameters"] == (98.0,)


def test_z_goes_up_from_the_lower_end_face_and_x_is_as_in_the_file() -> None:
    frame = small()[1].frame
    assert np.allclose(frame.axes, np.eye(3)) and np.allclose(frame.origin, 0.0)


def test_angles_may_count_from_the_boss_that_stands_out_most() -> None:
    found = recognized(small()[0], x="boss")
    turned = [f.sizes["theta"] for f in found.of_kind("boss")]
    assert min((float(t) + 180.0) % 360.0 - 180.0 for t in turned if t < 1.0 or t > 359.0) == (
        pytest.approx(0.0, abs=1e-3)
    )


def test_a_small_pad_on_a_large_casing_is_a_boss_though_its_top_hardly_leaves_the_round() -> None:
    shell = Shell(radius=300.0, slope=0.0, length=40.0, wall=4.0, flange=5.0, rim=12.0, rib=0.0)
    pad = MadeBoss(
        outline="rectangle",
        theta=30.0,
        z=20.0,
        height=3.0,
        tilt=0.0,
        fillet=0.0,
        sizes=(12.0, 12.0, 2.0),
        hole=0.0,
    )
    body = _with_boss(shell.solid(), shell, pad).cut(shell.bore())
    found = recognized(samples.read(body.val().wrapped))
    assert found.counts() == {"boss": 1, "pocket": 1, "profile": 1}
    assert found.of_kind("boss")[0].sizes["height"] == pytest.approx(3.0)


def test_a_pad_inside_the_bore_is_a_boss_on_the_inner_side() -> None:
    shell = Shell(radius=60.0, slope=0.0, length=50.0, wall=6.0, flange=6.0, rim=10.0, rib=0.0)
    ring = shell.solid().cut(shell.bore())
    inward = cq.Plane(origin=(44.0, 0.0, 25.0), xDir=(0, 1, 0), normal=(-1, 0, 0))
    found = recognized(
        samples.read(ring.union(cq.Workplane(inward).circle(8.0).extrude(-12.0)).val().wrapped)
    )
    (boss,) = found.of_kind("boss")
    assert boss.attributes["where"] == "inside" and boss.attributes["outline"] == "circle"
    assert boss.sizes["height"] == pytest.approx(10.0, abs=1e-3)
    reach = np.degrees(np.arcsin(8.0 / 54.0))
    low, high = (float(boss.sizes[k]) for k in ("theta_low", "theta_high"))
    assert high - low == pytest.approx(2.0 * reach, abs=1e-4)
    assert found.unexplained == ()


def test_a_boss_with_a_chamfered_rim_has_the_outline_of_its_sides() -> None:
    shell = Shell(radius=60.0, slope=0.0, length=60.0, wall=5.0, flange=6.0, rim=12.0, rib=0.0)
    plane = cq.Plane(origin=(70.0, 0.0, 30.0), xDir=(0, 1, 0), normal=(1, 0, 0))
    prism = cq.Workplane(plane).circle(10.0).extrude(-14.0).faces(">X").chamfer(1.5)
    body = shell.solid().union(prism).cut(shell.bore())
    found = recognized(samples.read(body.val().wrapped))
    (boss,) = found.of_kind("boss")
    assert boss.sizes["diameter"] == pytest.approx(20.0) and found.unexplained == ()
    assert len(boss.with_role("side")) == 2


def test_a_part_without_an_axis_is_refused_in_one_line() -> None:
    with pytest.raises(BadInput, match="no face is of revolution about an axis"):
        recognized(samples.read(samples.box_shape()))


def test_an_opening_that_is_no_round_hole_is_named() -> None:
    shell = Shell(radius=60.0, slope=0.0, length=60.0, wall=5.0, flange=6.0, rim=12.0, rib=0.0)
    window = cq.Workplane("YZ").center(0.0, 30.0).rect(12.0, 20.0).extrude(100.0)
    found = recognized(samples.read(shell.solid().cut(shell.bore()).cut(window).val().wrapped))
    assert [f.code for f in found.findings] == ["casing.opening"]
    assert len(found.unexplained) == 4
