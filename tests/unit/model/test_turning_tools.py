"""Turning tools and inserts: designations, sizes, outlines, the catalogue, and that nothing that mills takes them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.model.tool import CORNERS, Insert, TurningTool
from trunnion.post.header import tool_line
from trunnion.shop import load_shop

SHOP = own_shop()
CNMG = Insert(
    designation="CNMG120408", inscribed_circle=12.7, thickness=4.76, nose_radius=0.8, grade="P25"
)
LENGTHS = {
    "shank_height": 25.0,
    "shank_width": 25.0,
    "functional_length": 150.0,
    "functional_width": 32.0,
}
USES = ("face", "rough", "finish", "surface", "undercut", "drill")


def tool(insert=CNMG, angle=95.0, hand="right"):
    return TurningTool(
        number=3,
        name="DCLNR",
        insert=insert,
        edge_angle=angle,
        hand=hand,
        holder_name="DCLNR2525M12",
        **LENGTHS,
    )


def points_of(rows):
    """Return points on an outline, eight to an arc: on the circle that the bulge makes to the left of a clockwise way."""
    found = []
    for (z, x, bulge), (z1, x1, _) in zip(rows, [*rows[1:], rows[0]], strict=True):
        start, end = complex(z, x), complex(z1, x1)
        for share in np.linspace(0.0, 1.0, 8, endpoint=False):
            if bulge == 0.0:
                found.append(start + share * (end - start))
            else:
                turn = 4.0 * math.atan(bulge)
                centre = (start + end) / 2 - 1j * (end - start) / (2.0 * math.tan(turn / 2))
                found.append(centre + (start - centre) * np.exp(-1j * turn * share))
    return np.array([[p.real, p.imag] for p in found])


def test_an_insert_knows_what_its_designation_says():
    assert (CNMG.shape, CNMG.point_angle, CNMG.clearance_angle) == ("C", 80.0, 0.0)
    assert CNMG.edge_length == approx(12.7 / math.sin(math.radians(80.0)))
    dnmg = Insert(designation="DNMG150608", inscribed_circle=12.7, thickness=6.35, nose_radius=0.8)
    assert dnmg.edge_length == approx(12.7 / math.sin(math.radians(55.0)))
    tcmt = Insert(designation="TCMT110204", inscribed_circle=6.35, thickness=2.38, nose_radius=0.4)
    assert (tcmt.edge_length, tcmt.clearance_angle) == (approx(6.35 * math.sqrt(3.0)), 7.0)


def test_the_corners_of_every_shape_close_it():
    for shape, angles in CORNERS.items():
        if angles:
            assert sum(180.0 - a for a in angles) == approx(360.0), shape


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"designation": "CNMG160408"}, "edge is 12.90 mm long, its designation says 16"),
        ({"designation": "CNMG120608"}, "thickness is 4.76 mm, its designation says 06"),
        ({"nose_radius": 1.2}, "nose radius is 1.2 mm, its designation says 08"),
        ({"nose_radius": 7.0}, "a nose radius that fits it"),
        ({"designation": "XNMG120408"}, "not a designation after ISO 1832"),
        ({"designation": "CNMG"}, "not a designation after ISO 1832"),
    ],
)
def test_an_insert_whose_numbers_contradict_its_name_is_refused(changes, says):
    with pytest.raises(ValueError, match=says):
        replace(CNMG, **changes)


@pytest.mark.parametrize("hand", ["right", "left"])
def test_the_outline_touches_the_tools_point_and_has_the_inscribed_circle(hand):
    points = points_of(tool(hand=hand).outline())
    side = points[:, 0] if hand == "right" else -points[:, 0]
    assert points[:, 1].min() == approx(0.0, abs=0.02) and points[:, 1].min() > -1e-9
    assert side.min() == approx(0.0, abs=0.02) and side.min() > -1e-9
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    # Edges are tangent to the inscribed circle: nothing of the outline is nearer to its middle.
    assert np.linalg.norm(points - middle, axis=1).min() == approx(12.7 / 2, abs=0.02)


def test_the_major_edge_stands_at_the_edge_angle():
    rows = tool().outline()
    (z0, x0, _), (z1, x1, _) = rows[1], rows[2]
    assert math.degrees(math.atan2(x1 - x0, -(z1 - z0))) == approx(95.0)


def test_a_round_insert_is_its_circle():
    rcmt = Insert(designation="RCMT1204M0", inscribed_circle=12.0, thickness=4.76, nose_radius=6.0)
    points = points_of(tool(rcmt, 90.0).outline())
    assert np.linalg.norm(points - 6.0, axis=1) == approx(6.0)


def test_a_corner_that_rubs_behind_the_edge_is_refused():
    with pytest.raises(ValueError, match="rubs behind the cutting edge"):
        tool(angle=100.0)
    with pytest.raises(ValueError, match="hand is one of right, left"):
        tool(hand="both")


def test_the_catalogue_has_each_holder_with_each_of_its_inserts():
    names = [t.name for t in SHOP.turning]
    assert "DCLNR2525M12 CNMG120408" in names and "DCLNR2525M12 CNMG120412" in names
    assert {t.insert.shape for t in SHOP.turning} == {"C", "D", "V"}


def test_nothing_that_mills_or_drills_is_offered_a_turning_tool_nor_a_drill_for_milling():
    for group in ("P", "M", "K", "N", "S", "H"):
        for use in USES:
            forms = {t.form for t in SHOP.tools_for(group, use)}
            assert "turning" not in forms
            assert forms <= {"drill"} if use == "drill" else "drill" not in forms


def test_tool_list_and_header_treat_all_tools_alike():
    shared = {"number", "name", "form", "gauge_length", "holder_name", "description"}
    for own in (SHOP.tools[0], SHOP.turning[0]):
        assert shared <= own.as_dict().keys()
        assert tool_line(own, "mm").startswith(f"TOOL 0 {own.name} ")
    assert tool_line(tool(), "mm") == "TOOL 3 DCLNR R0.8 LENGTH 150 WIDTH 32 HOLDER DCLNR2525M12"
    told = tool().as_dict()
    assert (told["KAPR"], told["LF"], told["insert"]["RE"]) == (95.0, 150.0, 0.8)


WRONG_EDGE = "[insert.CNMG120408]\ninscribed_circle = 9.525\nthickness = 4.76\nnose_radius = 0.8\n"
WRONG_INSERT = """
[tool.A]
title = "a"
inserts = ["CNMG999999"]
edge_angle = 95
hand = "right"
shank_height = 1
shank_width = 1
functional_length = 1
functional_width = 1
"""


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[mill.A]\n", "tables are named .insert.NAME. or .tool.NAME."),
        (WRONG_EDGE, "edge is 9.67"),
        (WRONG_INSERT, "inserts knows CNMG120408"),
    ],
)
def test_a_broken_file_is_told_in_one_line(tmp_path, text, says):
    (tmp_path / "turning").mkdir()
    (tmp_path / "turning" / "own.toml").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=says) as told:
        load_shop(tmp_path)
    assert "\n" not in str(told.value)
