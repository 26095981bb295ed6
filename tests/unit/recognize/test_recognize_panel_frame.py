"""Where the frame of a panel lies: z out of the pockets, x along the longer side, the origin in the lowest corner."""

from __future__ import annotations

import numpy as np

from blockparts import BlockPart, terrace
from trunnion.geometry.frame import Frame
from trunnion.recognize.extent import box
from trunnion.recognize.panel.frame import choose_frame, flipped

POCKETS = [[40.0] * 5, [40.0, 5.0, 30.0, 8.0, 40.0], [40.0] * 5]


def panel(placed: Frame | None = None) -> BlockPart:
    part = terrace((0, 10, 50, 54, 80, 100), (0, 10, 50, 60), POCKETS)
    return part if placed is None else BlockPart(part.breaks, part.full, placed)


def test_z_points_out_of_the_pockets_not_out_of_the_flat_back() -> None:
    assert choose_frame(panel().graph()).z.tolist() == [0.0, 0.0, 1.0]


def test_a_panel_on_its_face_has_z_down() -> None:
    placed = Frame(
        np.array([0.0, 0.0, 40.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    )
    assert choose_frame(panel(placed).graph()).z.tolist() == [0.0, 0.0, -1.0]


def test_x_runs_along_the_longer_side() -> None:
    placed = Frame(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    assert abs(choose_frame(panel(placed).graph()).x[1]) == 1.0


def test_the_box_begins_at_the_origin() -> None:
    placed = Frame(
        np.array([7.0, -3.0, 11.0]), np.array([3.0, 4.0, 0.0]), np.array([4.0, -3.0, 5.0])
    )
    graph = panel(placed).graph()
    low, high = box(graph.in_frame(choose_frame(graph)))
    np.testing.assert_allclose(low, 0.0, atol=1e-6)
    np.testing.assert_allclose(high, [100.0, 60.0, 40.0], atol=1e-6)


def test_the_frame_moves_with_the_part() -> None:
    placed = Frame(
        np.array([7.0, -3.0, 11.0]), np.array([3.0, 4.0, 0.0]), np.array([4.0, -3.0, 5.0])
    )
    still, moved = choose_frame(panel().graph()), choose_frame(panel(placed).graph())
    np.testing.assert_allclose(placed.to_local(moved.origin), still.origin, atol=1e-6)
    np.testing.assert_allclose(placed.local_direction(moved.axes), still.axes, atol=1e-6)


def test_the_sides_of_a_boss_on_a_thin_plate_are_no_floors() -> None:
    boss = terrace((0, 10, 90, 100), (0, 10, 50, 60), [[10.0] * 3, [10.0, 40.0, 10.0], [10.0] * 3])
    assert choose_frame(boss.graph()).z.tolist() == [0.0, 0.0, 1.0]


def test_a_deep_block_is_looked_at_from_its_pocket() -> None:
    block = terrace(
        (0, 10, 90, 100), (0, 10, 50, 60), [[150.0] * 3, [150.0, 20.0, 150.0], [150.0] * 3]
    )
    assert choose_frame(block.graph()).z.tolist() == [0.0, 0.0, 1.0]


def test_the_frame_from_below_has_its_origin_in_the_opposite_corner() -> None:
    below = flipped(
        Frame(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])), 60.0, 40.0
    )
    np.testing.assert_allclose(below.to_world(np.array([5.0, 10.0, 0.0])), [5.0, 50.0, 40.0])
