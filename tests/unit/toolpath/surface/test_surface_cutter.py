"""A cutter's lower side and where it touches: by hand, against drops, and against a thicker copy of itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from own_shop import own_shop
from trunnion.findings import Refused
from trunnion.geometry.kernels.cutter_contact.drop_cutter import height_at, slope_at
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.plan.freeform.cutters.cutter import SURFACE_FORMS, lower_side, tip_at, touching

SHOP = own_shop()
ONE_OF_EACH = {form: next(t for t in SHOP.tools if t.form == form) for form in SURFACE_FORMS}
UP = np.array([[0.0, 0.0, 1.0]])


def tilted_plane(angle: float):
    """A plane through the origin that falls along x, and its normal (1, 3)."""
    fall = math.tan(angle)
    points = np.array(
        [
            [-90.0, -90.0, 90.0 * fall],
            [90.0, -90.0, -90.0 * fall],
            [90.0, 90.0, -90.0 * fall],
            [-90.0, 90.0, 90.0 * fall],
        ]
    )
    return DropSurface.of(points, np.array([[0, 1, 2], [0, 2, 3]])), np.array(
        [[math.sin(angle), 0.0, math.cos(angle)]]
    )


@pytest.mark.parametrize("form", SURFACE_FORMS)
def test_the_lower_side_rises_from_the_tip_to_the_widest_circle(form: str) -> None:
    tool = ONE_OF_EACH[form]
    rho = np.linspace(0.0, tool.radius, 400)
    side = lower_side(tool)
    assert side[0, 0] == 0.0 and height_at(side, np.zeros(1))[0] == pytest.approx(0.0)
    assert (np.diff(height_at(side, rho)) >= -1e-12).all()
    assert (np.diff(slope_at(side, rho[:-1])) >= -1e-9).all()
    assert (side[1:, 0] == side[:-1, 1]).all()


@pytest.mark.parametrize("form", SURFACE_FORMS)
@pytest.mark.parametrize("degrees", [0.0, 0.5, 12.0, 45.0, 70.0])
def test_a_cutter_put_on_a_contact_stands_as_high_as_it_drops(form: str, degrees: float) -> None:
    tool = ONE_OF_EACH[form]
    plane, normal = tilted_plane(math.radians(degrees))
    tip = tip_at(tool, np.zeros((1, 3)), normal, UP)
    assert plane.drop(tip[:, :2], lower_side(tool), -200.0) == pytest.approx(tip[:, 2], abs=1e-9)


@pytest.mark.parametrize("form", SURFACE_FORMS)
@pytest.mark.parametrize("degrees", [0.0, 12.0, 70.0])
def test_a_thicker_cutter_keeps_its_allowance_in_every_direction(form: str, degrees: float) -> None:
    tool, allowance = ONE_OF_EACH[form], 0.3
    plane, normal = tilted_plane(math.radians(degrees))
    tip = tip_at(tool, allowance * normal, normal, UP)
    dropped = plane.drop(tip[:, :2], lower_side(tool, allowance), -200.0) + allowance
    assert dropped == pytest.approx(tip[:, 2], abs=1e-9)


def test_a_ball_touches_along_its_radius() -> None:
    ball = ONE_OF_EACH["ball"]
    rho, height = touching(ball, np.radians([0.0, 30.0, 90.0]))
    assert rho == pytest.approx(ball.radius * np.array([0.0, 0.5, 1.0]))
    assert height == pytest.approx(ball.radius * np.array([0.0, 1.0 - math.sqrt(0.75), 1.0]))


def test_a_barrel_s_flank_touches_a_steep_wall() -> None:
    barrel = ONE_OF_EACH["barrel"]
    rho, height = touching(barrel, np.array([math.pi / 2]))
    assert rho == pytest.approx([barrel.radius])
    assert height == pytest.approx([barrel.widest_height], abs=1e-5)


def test_a_leaning_cutter_touches_where_it_is_put() -> None:
    ball = ONE_OF_EACH["ball"]
    axis = np.array([[math.sin(0.3), 0.0, math.cos(0.3)]])
    tip = tip_at(ball, np.array([[5.0, 6.0, 7.0]]), UP, axis)
    assert tip + ball.radius * axis == pytest.approx(np.array([[5.0, 6.0, 7.0 + ball.radius]]))


def test_a_form_that_has_no_lower_side_is_refused_by_name() -> None:
    drill = next(t for t in SHOP.tools if t.form == "drill")
    with pytest.raises(Refused, match="drill"):
        lower_side(drill)
