"""Panels of blocks, without CAD: what is a pocket, a rib, an island, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from blockparts import BlockPart, terrace
from trunnion.findings import BadInput, Cancelled
from trunnion.model.feature import Feature, Recognition
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.panel import PanelFamily
from trunnion.settings import choose

H = 40.0
X5, Y5 = (0, 10, 40, 60, 90, 100), (0, 10, 25, 40, 60, 70)


def recognized(part: BlockPart, **words: float) -> Recognition:
    return PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, words), NO_PROGRESS
    )


def ringed(inner: list[list[float]]) -> list[list[float]]:
    """Return heights with a rim of the part's top around them."""
    width = len(inner[0]) + 2
    return [[H] * width, *([H, *row, H] for row in inner), [H] * width]


def roles(feature: Feature) -> dict[str, int]:
    return {
        role: len(feature.with_role(role)) for role in dict.fromkeys(f.role for f in feature.faces)
    }


def codes(found: Recognition) -> set[str]:
    return {f.code for f in found.findings}


def test_a_pocket_has_its_floor_and_the_walls_around_it() -> None:
    found = recognized(terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]])))
    pocket = found.feature("pocket-01")
    assert roles(pocket) == {"floor": 1, "wall": 4}
    assert (pocket.sizes["depth"], pocket.sizes["floor_z"], pocket.sizes["top_z"]) == (
        32.0,
        8.0,
        40.0,
    )


def test_every_face_of_a_plain_panel_is_explained() -> None:
    found = recognized(terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]])))
    assert found.counts() == {"pocket": 1, "profile": 1, "datum": 1}
    assert found.unexplained == () and found.unexplained_share == 0.0 and found.findings == ()


def test_a_low_wall_between_two_pockets_is_a_rib_and_its_outer_walls_belong_to_both() -> None:
    found = recognized(terrace((0, 10, 50, 54, 90, 100), (0, 10, 50, 60), ringed([[5, 30, 8]])))
    left, right = found.of_kind("pocket")
    assert found.counts()["rib"] == 1
    assert len(set(left.tags) & set(right.tags)) == 2
    assert left.sizes["lowest_rim_z"] == 30.0


def test_the_sizes_of_a_rib_are_measured_at_its_top() -> None:
    found = recognized(terrace((0, 10, 50, 54, 90, 100), (0, 10, 50, 60), ringed([[5, 30, 8]])))
    sizes = found.feature("rib-01").sizes
    assert sizes == {
        "top_z": 30.0,
        "below_top": 10.0,
        "thickness": 4.0,
        "height": 25.0,
        "lower_height": 22.0,
        "length": 40.0,
    }


def test_a_wall_as_high_as_the_part_is_no_rib() -> None:
    found = recognized(terrace((0, 10, 50, 54, 90, 100), (0, 10, 50, 60), ringed([[5, H, 8]])))
    assert found.counts() == {"pocket": 2, "profile": 1, "datum": 1}


def test_crossing_ribs_of_one_height_are_one_compound_rib() -> None:
    found = recognized(
        terrace(
            (0, 10, 40, 43, 80, 90),
            (0, 10, 40, 43, 90, 100),
            ringed([[5, 30, 8], [30, 30, 30], [9, 30, 7]]),
        )
    )
    assert found.counts()["pocket"] == 4 and found.counts()["rib"] == 1
    assert found.feature("rib-01").sizes["compound"] is True


def test_a_rib_crossed_by_a_higher_one_is_two() -> None:
    found = recognized(
        terrace(
            (0, 10, 40, 43, 80, 90),
            (0, 10, 40, 43, 90, 100),
            ringed([[5, 30, 8], [35, 35, 35], [9, 30, 7]]),
        )
    )
    assert [r.sizes["top_z"] for r in found.of_kind("rib")].count(30.0) == 2 and found.counts()[
        "rib"
    ] == 3


def test_a_wide_low_top_in_no_pocket_is_a_boss() -> None:
    found = recognized(terrace((0, 40, 60, 100), (0, 50), [[H, 8.0, 30.0]]))
    boss = found.feature("boss-01")
    assert roles(boss) == {"top": 1}
    assert boss.sizes == {"top_z": 30.0, "below_top": 10.0, "area": 2000.0}
    assert found.unexplained == () and "panel.lower-top" not in codes(found)


def test_a_narrow_low_top_in_no_pocket_is_a_rib_still() -> None:
    found = recognized(terrace((0, 40, 60, 70), (0, 50), [[H, 8.0, 30.0]]))
    assert found.counts()["rib"] == 1 and "boss" not in found.counts()


def test_a_wide_low_top_between_two_floors_is_a_floor() -> None:
    found = recognized(terrace((0, 10, 40, 70, 100, 110), (0, 10, 50, 60), ringed([[5, 20, 8]])))
    assert found.feature("pocket-01").sizes["floors_z"] == (20.0, 8.0, 5.0)


def test_the_widest_rib_is_a_setting() -> None:
    part = terrace((0, 10, 40, 55, 100, 110), (0, 10, 90, 100), ringed([[5, 20, 8]]))
    assert recognized(part).counts().get("rib") is None
    assert recognized(part, rib_width=20.0).counts()["rib"] == 1


def test_a_stepped_pocket_is_one_pocket_with_two_floors() -> None:
    found = recognized(terrace((0, 10, 40, 90, 100), (0, 10, 50, 60), ringed([[20, 8]])))
    pocket = found.feature("pocket-01")
    assert found.counts()["pocket"] == 1 and roles(pocket) == {"floor": 2, "wall": 5}
    assert (pocket.sizes["floors_z"], pocket.sizes["depth"]) == ((20.0, 8.0), 32.0)


def test_a_pocket_inside_a_floor_is_nested_and_its_top_is_that_floor() -> None:
    found = recognized(terrace(X5, Y5, ringed([[20, 20, 20], [20, 8, 20], [20, 20, 20]])))
    inner = next(p for p in found.of_kind("pocket") if "nested_in" in p.attributes)
    assert (inner.sizes["top_z"], inner.sizes["depth"]) == (20.0, 12.0)
    assert found.feature(str(inner.attributes["nested_in"])).sizes["floor_z"] == 20.0


@pytest.mark.parametrize("top", [25.0, H])
def test_what_stands_in_a_pocket_is_an_island_also_as_high_as_the_part(top: float) -> None:
    found = recognized(terrace(X5, Y5, ringed([[5, 5, 5], [5, top, 5], [5, 5, 5]])))
    island = found.feature("island-01")
    assert roles(island) == {"top": 1, "wall": 4} and island.attributes["in"] == "pocket-01"
    assert not set(island.tags) & set(found.feature("pocket-01").tags)
    assert (island.sizes["top_z"], island.sizes["height"]) == (top, top - 5.0)


def test_a_pocket_at_the_outline_is_open_and_has_only_its_real_walls() -> None:
    found = recognized(terrace((0, 10, 90, 100), (0, 50, 60), [[H, 10, H], [H] * 3]))
    assert roles(found.feature("open_pocket-01")) == {"floor": 1, "wall": 3}
    assert found.counts() == {"open_pocket": 1, "profile": 1, "datum": 1}


def test_a_slot_across_the_part_is_open_at_both_ends() -> None:
    found = recognized(terrace((0, 40, 60, 100), (0, 60), [[H, 10, H]]))
    assert roles(found.feature("open_pocket-01")) == {"floor": 1, "wall": 2}


def test_an_opening_without_a_floor_is_a_through_pocket_found_once() -> None:
    found = recognized(terrace((0, 10, 40, 70, 100), (0, 10, 50, 60), ringed([[0, H]])))
    assert found.counts() == {"pocket": 1, "profile": 1, "datum": 1}
    assert found.feature("pocket-01").attributes["through"] is True


def test_a_pocket_on_the_other_side_has_a_direction() -> None:
    full = np.ones((3, 3, 3), dtype=bool)
    full[1, 1, 2] = full[1, 1, 0] = False
    found = recognized(BlockPart(((0, 10, 50, 60), (0, 10, 40, 50), (0, 10, 14, 30)), full))
    below = found.feature("pocket-02")
    assert below.attributes["direction"] == (0.0, 0.0, -1.0)
    assert "refused" not in below.attributes and codes(found) == set()
    assert (below.sizes["floor_z"], below.sizes["top_z"]) == (10.0, 0.0)


def test_a_pocket_under_a_lip_is_refused() -> None:
    full = np.ones((4, 3, 4), dtype=bool)
    full[1:3, 1, 1] = full[1, 1, 2:] = False
    found = recognized(BlockPart(((0, 10, 50, 70, 80), (0, 10, 50, 60), (0, 5, 15, 25, 30)), full))
    assert found.feature("pocket-01").attributes["refused"] == "material stands over 33% of it"
    assert "panel.overhang" in codes(found)


def test_a_recess_in_a_wall_is_named_and_not_taken_for_a_pocket() -> None:
    full = np.ones((4, 3, 4), dtype=bool)
    full[1, 1, 1:] = full[2, 1, 2] = False
    found = recognized(BlockPart(((0, 10, 50, 55, 80), (0, 20, 40, 60), (0, 5, 15, 20, 30)), full))
    assert found.counts()["pocket"] == 1 and "refused" not in found.feature("pocket-01").attributes
    assert "panel.undercut" in codes(found) and found.unexplained_share > 0.0


def test_a_step_around_a_boss_is_an_open_pocket_and_the_boss_keeps_its_top() -> None:
    found = recognized(
        terrace((0, 10, 90, 100), (0, 10, 50, 60), [[10] * 3, [10, H, 10], [10] * 3])
    )
    assert found.counts() == {"open_pocket": 1, "profile": 1, "datum": 1} and found.findings == ()


def test_pockets_are_numbered_by_rows_from_the_front() -> None:
    part = terrace(
        (0, 10, 30, 40, 80, 90),
        (0, 10, 30, 40, 70, 80),
        [[H] * 5, [H, 5, H, 6, H], [H] * 5, [H, 7, H, 8, H], [H] * 5],
    )
    centres = [p.attributes["centre"] for p in recognized(part).of_kind("pocket")]
    rows = [c[1] for c in centres]  # type: ignore[index]
    assert rows == sorted(rows) and centres[0][0] < centres[1][0] and centres[2][0] < centres[3][0]  # type: ignore[index]


def test_cancelling_stops_the_recognition() -> None:
    part = terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]]))
    with pytest.raises(Cancelled):
        PanelFamily().recognize(
            part.graph(), part, choose(PanelFamily.settings, {}), Progress(cancelled=lambda: True)
        )


class Torn:
    """A part that can't be cut."""

    def section(self, frame: object, z: float) -> object:
        raise BadInput("the shell is open")


def test_a_part_that_no_plane_can_cut_is_named() -> None:
    part = terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]]))
    with pytest.raises(BadInput, match="can't be cut"):
        PanelFamily().recognize(part.graph(), Torn(), choose(PanelFamily.settings, {}), NO_PROGRESS)  # type: ignore[arg-type]


class TornInTheMiddle(BlockPart):
    """A part that a plane in the middle between two floors can't cut."""

    def section(self, frame, z):  # type: ignore[no-untyped-def]
        if abs(z - 16.0) < 0.1:
            raise ValueError("a seam lies in the plane")
        return BlockPart.section(self, frame, z)


def test_a_slice_that_fails_gives_way_to_one_beside_it() -> None:
    whole = terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]]))
    assert recognized(TornInTheMiddle(whole.breaks, whole.full)).findings == ()


class TornOnce(BlockPart):
    """A part that a plane at the height of the walls can't cut."""

    def section(self, frame, z):  # type: ignore[no-untyped-def]
        if 8.0 < z < 24.0:
            raise BadInput("the shell is open")
        return BlockPart.section(self, frame, z)


def test_a_slice_that_fails_is_left_out_with_a_finding() -> None:
    whole = terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]]))
    found = recognized(TornOnce(whole.breaks, whole.full))
    assert codes(found) == {"panel.no-slice"} and found.counts()["pocket"] == 1


def test_a_panel_suits_the_family() -> None:
    suits = PanelFamily().suits(terrace((0, 10, 90, 100), (0, 10, 50, 60), ringed([[8]])).graph())
    assert (suits.score, suits.explained) == pytest.approx((1.0, 1.0))
    assert suits.reason == "100 % of the area level or upright"
