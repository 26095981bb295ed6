"""A program that the proof releases is clean in a simulation that shares nothing with it, and faults planted in its text are seen."""

from __future__ import annotations

import ast
import math
from pathlib import Path

import numpy as np
import pytest

from samples import written
from seeded.plates import small_plate
from seeded.pockets import random_panel
from simulated import simulated
from simulation import mutations, reader, sweep
from simulation.judge import judged

SEED, CELL = 0, 0.5
PROGRAM = """N10 G21
N20 G90 G91.1 G17 G40 G49 G80 G94
(OPERATION one)
N30 T1 M6
N40 G0 X10 Y0
N50 G43 H1 Z5
N60 G1 Z-1 F100
N70 G3 X-10 I-10 Z-3
N80 G0 Z5
N90 G53 G0 Z0
N100 M30
"""


@pytest.fixture(scope="module")
def panel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("panel")
    return simulated(written(random_panel(SEED)), folder, cell=CELL)[0]


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plate")
    return simulated(written(small_plate(SEED)), folder, surface_scallop="0.015", cell=CELL)[0]


def report_of(program, text):
    return judged(program.on, text)


def test_the_simulation_knows_nothing_of_the_program_that_wrote_the_text():
    folder = Path(sweep.__file__).parent
    for path in folder.glob("*.py"):
        if path.name.startswith("test_"):
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert {name.split(".")[0] for name in names}.isdisjoint(
                {"trunnion", "trunnion_gui", "trunnion_resources"}
            ), path.name


def test_a_small_panel_that_is_released_is_clean(panel):
    assert panel.told["verdict"].startswith("passed")
    report = report_of(panel, panel.text)
    assert report.faults == () and report.is_clean(panel.told["coverage"])
    assert report.columns > 10_000


def test_a_small_plate_that_is_released_is_clean(plate):
    assert plate.told["verdict"].startswith("passed")
    report = report_of(plate, plate.text)
    assert report.faults == () and report.is_clean(plate.told["coverage"])


@pytest.mark.parametrize("kind", ["floor", "wall"])
def test_a_finishing_block_that_lies_lower_is_a_gouge_of_that_operation(panel, kind):
    operation = panel.operation(kind)
    report = report_of(panel, mutations.deepened(panel.text, operation, 0.3))
    assert report.kinds() == {"gouge"}
    assert {fault.operation for fault in report.faults} >= {operation}
    assert report.faults[0].depth == pytest.approx(0.3, abs=0.05)


def test_a_point_of_a_finished_plate_that_lies_lower_is_a_gouge(plate):
    operation = plate.operation("finish")
    report = report_of(plate, mutations.deepened(plate.text, operation, 0.3))
    assert {(fault.what, fault.operation) for fault in report.faults} == {("gouge", operation)}


@pytest.mark.parametrize(("program", "kind"), [("panel", "rough"), ("plate", "finish")])
def test_a_rapid_that_comes_down_too_far_is_in_stock(program, kind, request):
    program = request.getfixturevalue(program)
    report = report_of(program, mutations.dived(program.text, program.operation(kind), 3.0))
    assert "rapid" in report.kinds()


def test_an_operation_with_any_other_tool_is_not_clean(panel):
    for operation in (panel.operation("floor"), panel.operation("wall")):
        for tool in set(panel.on.scene.cutters) - {panel.tool(operation)}:
            report = report_of(panel, mutations.swapped(panel.text, operation, tool))
            assert not report.is_clean(panel.told["coverage"]), (operation, tool)


def test_a_finishing_arc_that_runs_the_other_way_is_a_gouge(panel):
    text = mutations.turned_back(panel.text, panel.operation("profile_finish"))
    assert "gouge" in report_of(panel, text).kinds()


def test_an_operation_that_is_missing_leaves_stock(panel):
    lines = panel.text.split("\n")
    for kind in ("wall", "profile_finish", "floor"):
        rows = set(mutations.rows_of(lines, panel.operation(kind)))
        text = "\n".join(line for row, line in enumerate(lines) if row not in rows)
        assert not report_of(panel, text + "\nM30").is_clean(panel.told["coverage"]), kind


def test_a_helix_is_read_as_chords_on_its_arc():
    moves = reader.travel(PROGRAM, {1: 50.0})
    arc = moves.line == 8
    assert np.allclose(np.hypot(*moves.end[arc, :2].T), 10.0)
    middle = 0.5 * (moves.start[arc, :2] + moves.end[arc, :2])
    assert 10.0 - np.hypot(*middle.T).min() <= reader.SAGITTA
    assert moves.end[arc][-1] == pytest.approx((-10.0, 0.0, -3.0))
    assert moves.end[arc][len(moves.end[arc]) // 2][1] > 0.0
    assert moves.rapid.sum() == 4 and set(moves.operation) == {"one"}


def test_a_length_that_is_another_tools_moves_the_tip():
    moves = reader.travel(PROGRAM.replace("H1", "H2"), {1: 50.0, 2: 47.0})
    assert moves.end[moves.line == 7][0, 2] == pytest.approx(-4.0)


@pytest.mark.parametrize("word", ["G41", "A10", "R5", "G2 X1 Y1 I3", "X1e3", "M98"])
def test_what_the_reader_does_not_know_it_refuses(word):
    with pytest.raises(ValueError, match="line 5"):
        reader.travel(PROGRAM.replace("N40 G0 X10 Y0", f"N40 {word}"), {1: 50.0})


@pytest.mark.parametrize("corner", [0.0, 1.0, 2.5, 5.0])
@pytest.mark.parametrize("slope", [0.0, 0.3, -0.8, 4.0])
def test_the_lowest_place_over_a_way_is_that_of_its_finest_steps(corner, slope):
    radius, length = 5.0, 7.0
    s = np.linspace(0.0, length, 200_001)
    for along, beside in ((-3.0, 1.0), (2.0, 0.0), (3.5, -4.5), (9.0, 2.0)):
        distance = np.hypot(s - along, beside)
        flat = radius - corner
        form = np.where(
            distance <= flat,
            0.0,
            corner - np.sqrt(np.maximum(corner**2 - (distance - flat) ** 2, 0.0)),
        )
        stepped = np.where(distance <= radius, 1.0 + slope * s + form, math.inf).min()
        found = sweep.lowest(along, beside, length, 1.0, slope, radius, corner)
        assert found == pytest.approx(stepped, abs=1e-3)
