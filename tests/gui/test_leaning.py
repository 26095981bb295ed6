"""Toolpaths whose tool leans: strokes show how it stands, and the playback stands it so."""

from __future__ import annotations

import numpy as np
import pytest
from fake_engine import HEIGHT, POCKETS
from test_viewport import hue, pixel

from trunnion_gui.look.colours import axis_colour, rgb, tool_colours


@pytest.fixture
def made(make_window, part_file, idle):
    """A window with toolpaths, one of which sways."""
    window = make_window("fake_engine:SwayingEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.run("toolpath", "Generate")
    idle(window)
    return window


def test_strokes_show_how_a_leaning_tool_stands(made):
    made.document.selection.select_operation("op-02")
    strokes = (
        made.viewport.scene.view.actors["tool axes"].mapper.GetInput().points.reshape(-1, 2, 3)
    )
    _, y0, _, y1 = POCKETS[0]
    assert len(strokes) > 10
    assert strokes[:, 0, 2] == pytest.approx(HEIGHT - 10.0, abs=1e-3)
    assert strokes[:, 0, 1] == pytest.approx((y0 + y1) / 2, abs=1e-3)
    along = strokes[:, 1] - strokes[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    assert along[:, 1] == pytest.approx(0.0, abs=1e-5)
    assert np.degrees(np.arcsin(along[:, 0])).max() == pytest.approx(30.0, abs=1.0)
    assert np.degrees(np.arcsin(along[:, 0])).min() == pytest.approx(-30.0, abs=1.0)


def test_the_legend_explains_the_strokes(made):
    assert (axis_colour(), "Tool axis", "") in made.viewport.legend.rows


def test_an_upright_operation_has_no_strokes(made):
    made.document.selection.select_operation("op-03")
    assert "tool axes" not in made.viewport.scene.view.actors


def test_strokes_go_with_the_cutting_moves(made):
    made.viewport.show_motions(("rapid", "link"))
    assert "tool axes" not in made.viewport.scene.view.actors
    assert "Tool axis" not in [words for _, words, _ in made.viewport.legend.rows]


def test_the_played_tool_leans_as_its_path_says(made, qtbot):
    made.registry.run("view.front")
    made.registry.run("play.show")
    qtbot.waitUntil(lambda: made.player.timeline is not None, timeout=60000)
    line = made.player.timeline
    row = next(n for n, p in enumerate(line.passages) if p.operation == "op-02")
    for share in (5.5, 16.5):
        made.player.go(float(line.first[row]) + share)
        qtbot.waitUntil(lambda: made.player.is_settled, timeout=60000)
        tip, axis = line.pose(made.player.position)
        stands = np.array(made.viewport.scene.view.actors["cutter"].user_matrix)
        assert stands[:3, 2] == pytest.approx(axis) and stands[:3, 3] == pytest.approx(tip)
        assert abs(np.degrees(np.arcsin(axis[0]))) > 25.0
        length = line.passages[row].tool.flute_length
        seen = pixel(made, tip + axis * (length - 2.0))
        assert hue(seen) @ hue(rgb(tool_colours()["cutter"])) > 0.9
