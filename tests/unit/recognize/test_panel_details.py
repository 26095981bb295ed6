"""Chamfers, pits and fringes of panels: what they are made of, how they are measured, and what is none of them."""

from __future__ import annotations

from typing import Any

import cadquery as cq
import pytest
from pytest import approx

import samples
from drilled_parts import box
from trunnion.model.feature import Feature, Recognition
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.panel.kinds import generalized_pocket
from trunnion.settings import choose

HEIGHT, FLOOR = 30.0, 6.0


def plate() -> cq.Workplane:
    """Return a plate of 160 x 100 x 30 with corners R10."""
    return box((160, 100, HEIGHT)).edges("|Z").fillet(10)


def with_pocket(solid: cq.Workplane) -> cq.Workplane:
    """Return a plate with a pocket x 15 to 145, y 15 to 85, its floor at 6, its corners R8."""
    return solid.cut(box((130, 70, HEIGHT)).edges("|Z").fillet(8).translate((15, 15, FLOOR)))


def pit(depth: float = 5.0, at: float = 60.0, z: float = 12.0) -> cq.Workplane:
    """Return what is cut for a pit in the wall y = 85: 20 mm long, 8 mm high, its corners R2."""
    block = box((20, 2.0 * depth, 8)).edges("|Z").fillet(2)
    return block.translate((at, 85 - depth, z))


def fringed(where: float, across: float = 4.0, skew: float = 1.5) -> cq.Workplane:
    """Return a body beyond a free-form side along y: about x = `where` at the bottom, shifted and winding the other way at the top."""

    def section(z: float, shift: float, winds: float) -> cq.Wire:
        x = where + shift
        middle = [(x, -20), (x + winds, 20), (x - winds, 80), (x, 120)]
        return (
            cq.Workplane("XY", origin=(0, 0, z))
            .moveTo(*middle[0])
            .spline(middle[1:], includeCurrent=True)
            .lineTo(where + 60, 120)
            .lineTo(where + 60, -20)
            .close()
            .val()
        )

    return cq.Workplane(
        obj=cq.Solid.makeLoft([section(-1.0, 0.0, skew), section(31.0, across, -skew)], True)
    )


def recognized(solid: Any, **chosen: Any) -> Recognition:
    part = samples.read(solid.val().wrapped if isinstance(solid, cq.Workplane) else solid)
    settings = choose(PanelFamily.settings, {f"recognize.panel.{k}": v for k, v in chosen.items()})
    return PanelFamily().recognize(part.graph(), part, settings, NO_PROGRESS)


def of_kind(found: Recognition, kind: str) -> list[Feature]:
    return list(found.of_kind(kind))


def codes(found: Recognition, feature: Feature) -> list[str]:
    return [f.code for f in found.findings if feature.id in f.where]


@pytest.mark.parametrize(("width", "height"), [(1.5, 1.5), (3.0, 1.5)])
def test_the_chamfer_round_the_outline_is_one_feature_of_all_its_faces(width, height) -> None:
    chamfered = plate().faces(">Z").edges().chamfer(height, width)
    if len(chamfered.faces(">Z").edges().vals()) and chamfered.faces(">Z").val().Area() > 16_000:
        pytest.fail("nothing was cut")
    found = recognized(with_pocket(chamfered))
    (chamfer,) = of_kind(found, "chamfer")
    angle = 45.0 if width == height else chamfer.sizes["angle"]
    assert chamfer.sizes["angle"] == approx(angle, abs=0.01)
    assert float(chamfer.sizes["width"]) in (approx(width, abs=1e-3), approx(height, abs=1e-3))
    assert len(chamfer.faces) == 8 and {f.role for f in chamfer.faces} == {"face"}
    assert not (found.unexplained or codes(found, chamfer))
    assert {f.kind for f in found} == {"pocket", "profile", "datum", "chamfer"}


def test_chamfers_of_both_sides_and_of_a_pockets_rim_are_features_of_their_own() -> None:
    solid = with_pocket(plate().faces(">Z").edges().chamfer(1.0))
    solid = solid.faces("<Z").edges().chamfer(2.0)
    found = recognized(solid)
    chamfers = of_kind(found, "chamfer")
    assert [c.sizes["width"] for c in chamfers] == [1.0, 2.0]
    assert [c.attributes.get("direction") for c in chamfers] == [None, (0.0, 0.0, -1.0)]
    assert not found.unexplained


def test_a_slope_wider_than_a_chamfer_is_none() -> None:
    solid = with_pocket(plate().faces(">Z").edges().chamfer(4.0))
    assert len(of_kind(recognized(solid), "chamfer")) == 1
    found = recognized(solid, chamfer_width=3.0)
    assert not of_kind(found, "chamfer") and len(found.unexplained) == 8


def test_a_pit_is_measured_from_the_wall_that_it_is_sunk_in() -> None:
    found = recognized(with_pocket(plate()).cut(pit()))
    (sunk,) = of_kind(found, "pit")
    assert sunk.sizes == {
        "depth": 5.0,
        "length": 20.0,
        "height": 8.0,
        "z0": 12.0,
        "z1": 20.0,
        "corner_radius": 2.0,
    }
    assert sunk.attributes == {"in": "pocket-01"} and len(sunk.with_role("floor")) == 1
    assert len(sunk.with_role("wall")) == 6 and not codes(found, sunk)
    (pocket,) = of_kind(found, "pocket")
    assert generalized_pocket(pocket, found).auxiliary == (sunk,)
    assert not found.unexplained


def test_pits_of_one_wall_stand_apart_and_keep_the_pocket_what_it_is() -> None:
    plain = recognized(with_pocket(plate()))
    found = recognized(with_pocket(plate()).cut(pit(at=30.0)).cut(pit(at=90.0, depth=3.0)))
    assert {p.sizes["depth"] for p in of_kind(found, "pit")} == {5.0, 3.0}
    own, other = of_kind(plain, "pocket")[0], of_kind(found, "pocket")[0]
    assert (own.sizes, own.attributes) == (other.sizes, other.attributes)


def test_a_recess_that_is_open_above_is_no_pit() -> None:
    found = recognized(with_pocket(plate()).cut(pit(z=24.0)))
    assert not of_kind(found, "pit")


@pytest.mark.parametrize("turn", [0.0, 37.0])
def test_a_free_form_side_of_the_outline_that_leans_is_a_fringe(turn) -> None:
    solid = with_pocket(box((160, 100, HEIGHT))).cut(fringed(150.0))
    shape = samples.turned(solid.val().wrapped, (0.3, 1.0, 0.2), turn)
    found = recognized(shape)
    (fringe,) = of_kind(found, "fringe")
    assert fringe.attributes == {"outer": True} and len(fringe.faces) == 1
    assert not (found.unexplained or codes(found, fringe))


@pytest.mark.parametrize(
    ("lean", "role"), [(6.0, "outer_convergence"), (-6.0, "inner_convergence")]
)
def test_plane_sides_of_the_outline_that_lean_are_the_profiles(lean, role) -> None:
    drafted = cq.Workplane("XY").rect(160, 100).extrude(HEIGHT, taper=lean).translate((80, 50, 0))
    found = recognized(with_pocket(drafted))
    (profile,) = of_kind(found, "profile")
    assert len(profile.with_role(role)) == len(profile.faces) >= 4
    assert not found.unexplained and "refused" not in profile.attributes


def test_a_side_that_leans_stands_beside_the_upright_ones_in_the_profile() -> None:
    wedge = cq.Workplane("XZ", origin=(0, 120, 0)).polyline([(156, 0), (170, 0), (170, 84)])
    found = recognized(with_pocket(plate()).cut(wedge.close().extrude(140)))
    (profile,) = of_kind(found, "profile")
    assert len(profile.with_role("inner_convergence")) == 1
    assert profile.with_role("wall") and not found.unexplained


def test_a_free_form_wall_near_the_outline_is_a_fringe_and_the_pockets_own() -> None:
    # The pocket's side at x = 134 to 138 winds and leans away; some 24 mm of material stand between it and the outline.
    body = plate().cut(
        box((140, 70, HEIGHT)).edges("|Z").fillet(8).translate((15, 15, FLOOR)).cut(fringed(134.0))
    )
    found = recognized(body)
    (fringe,) = of_kind(found, "fringe")
    (pocket,) = of_kind(found, "pocket")
    assert fringe.attributes == {"in": "pocket-01"}
    assert fringe.tags[0] in pocket.with_role("outer_convergence", "inner_convergence")
    # It is cut with its pocket: nothing says that it isn't planned.
    assert not any("not planned" in f.text for f in found.findings if fringe.id in f.where)
    assert not found.unexplained


def test_a_free_form_wall_far_inside_is_a_wall() -> None:
    body = plate().cut(
        box((120, 70, HEIGHT)).edges("|Z").fillet(8).translate((15, 15, FLOOR)).cut(fringed(90.0))
    )
    assert not of_kind(recognized(body), "fringe")
