"""Which cutters an impeller gets, and what is said where nothing can be planned."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.findings import Refused
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.feature import Recognition
from trunnion.plan.impeller.cutters import (
    WheelSizes,
    in_fillet,
    in_wide_parts,
    on_hub,
    on_walls,
    through_channel,
)
from trunnion.plan.impeller.wheel import wheel_of
from trunnion.shop import load_shop

TOOLS = load_shop(None).tools_for("N", "surface")


def sizes(channel=4.5, fillet=1.5, height=11.6) -> WheelSizes:
    return WheelSizes(channel=channel, fillet=fillet, height=height)


def test_the_largest_ball_goes_through_the_channel_with_its_allowance():
    assert through_channel(TOOLS, sizes(), 0.3).diameter == 3.0
    assert through_channel(TOOLS, sizes(channel=6.7), 0.3).diameter == 6.0


def test_flutes_are_longer_than_blades_are_high():
    for height in (11.6, 20.0, 30.0):
        tool = through_channel(TOOLS, sizes(channel=12.0, height=height), 0.3)
        assert tool.flute_length > height


def test_the_hubs_ball_is_as_round_as_the_fillets_and_the_fillets_ball_smaller():
    assert on_hub(TOOLS, sizes()).corner_radius == 1.5
    assert in_fillet(TOOLS, sizes()).corner_radius == 1.0


def test_where_no_flutes_are_long_enough_a_slim_shank_goes_down_into_the_fillets():
    tool = in_fillet(TOOLS, sizes(channel=10.7, fillet=3.0, height=31.2))
    assert tool.corner_radius == 2.5
    assert tool.flute_length < 31.2 < tool.stickout
    thick = in_fillet(TOOLS, sizes(channel=6.0, fillet=3.0, height=31.2))
    assert thick is None
    assert in_fillet(TOOLS, sizes(channel=10.7, fillet=3.0, height=60.0)) is None


def test_the_ball_on_walls_comes_down_to_the_rims_of_the_fillets():
    assert through_channel(TOOLS, sizes(channel=6.7), 0.3).diameter == 6.0
    assert on_walls(TOOLS, sizes(channel=6.7), 0.3).diameter == 3.0
    assert on_walls(TOOLS, sizes(channel=6.7, fillet=0.0), 0.3).diameter == 6.0


def test_without_fillets_the_channel_alone_bounds_the_cutter():
    assert in_fillet(TOOLS, sizes(fillet=0.0, channel=8.1)).diameter == 8.0


def test_a_wide_cutter_goes_first_where_it_saves_a_quarter_of_the_time():
    def removal(tool):
        return tool.diameter**2

    narrow = through_channel(TOOLS, sizes(), 0.3)
    widths = np.array([[4.5, 0.1], [6.0, 0.2], [9.0, 0.4], [12.0, 0.3]])
    some = WheelSizes(channel=4.5, fillet=1.5, height=11.6, widths=widths)
    assert some.share_of(9.0) == pytest.approx(0.7)
    tool = in_wide_parts(TOOLS, some, 0.3, narrow, removal)
    # D5 fits into 0.9 of it and leaves 0.9 * 9 / 25 + 0.1 of the time, D8 into 0.7: 0.7 * 9 / 64 + 0.3, D10 into 0.3.
    assert tool.diameter == 8.0
    even = WheelSizes(channel=4.5, fillet=1.5, height=11.6, widths=np.array([[4.5, 1.0]]))
    assert in_wide_parts(TOOLS, even, 0.3, narrow, removal) is None
    assert in_wide_parts(TOOLS, some, 0.3, narrow, lambda tool: 1.0) is None


def test_where_no_cutter_fits_there_is_none():
    assert through_channel(TOOLS, sizes(channel=1.0), 0.3) is None
    assert in_fillet(TOOLS, sizes(height=500.0)) is None


def test_features_without_blades_make_no_wheel():
    none = np.zeros((0, 3))
    skin = Skin(
        points=none,
        normals=none,
        triangles=none.astype(int),
        face=np.zeros(0, int),
        bound=0.0,
    )
    with pytest.raises(Refused, match="a wheel needs two blades"):
        wheel_of(Recognition(family="impeller"), skin)
