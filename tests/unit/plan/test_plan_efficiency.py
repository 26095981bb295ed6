"""Gains from areas and measured times: the paper's printed figures from its file, files of a person's own, and typed figures."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

import programs
from trunnion.cli.main import BAD, main
from trunnion.findings import BadInput
from trunnion.plan.freeform.estimate.efficiency_file import (
    example_estimates,
    example_file,
    read_estimates,
    typed_estimate,
)
from trunnion.plan.freeform.estimate.finishing_time import AreaTime, Estimate, FeatureTime
from trunnion.units import seconds_of, timed

PRINTED = {"Test piece": 28.18, "Whole impeller": 20.14, "Turbine blade": 12.33}
"""The paper's gains in per cent."""
LARGE = {
    "areas": "735.836",
    "measured_area": "1440.73",
    "measured_time": "2 h 16 min 02 s",
}
SMALL = {"areas": "737.478", "measured_area": "1440.73", "measured_time": "10462"}
OWN = """
[own.large]
areas = [100, 50]
measured_area = 10
measured_time = "1 min"
[own.small]
areas = [30]
measured_area = 10
measured_time = 120
"""


def test_the_shipped_file_gives_the_papers_three_gains():
    assert {e.name: round(100.0 * e.gain, 2) for e in example_estimates()} == PRINTED
    assert read_estimates(Path(example_file())) == example_estimates()


def test_the_shipped_file_has_the_papers_areas_and_times():
    piece, impeller, _ = example_estimates()
    assert (timed(piece.seconds), timed(piece.seconds_alone)) == (
        "2 h 16 min 02 s",
        "2 h 54 min 22 s",
    )
    assert impeller.large.areas == (3391.81, 5432.81) and impeller.small.areas == (2746.51,)


def test_the_command_prints_the_papers_numbers(capsys):
    assert main(["estimate"]) == 0
    lines = [n for n in capsys.readouterr().out.splitlines() if "more efficient" in n]
    assert len(lines) == 3
    for line, gained in zip(lines, PRINTED.values(), strict=True):
        assert f"{gained:.2f} % more efficient" in line
    assert "6 mm alone 2 h 54 min 22 s, both cutters 2 h 16 min 02 s" in lines[0]


def test_a_file_of_ones_own_by_hand(tmp_path, capsys):
    file = tmp_path / "own.toml"
    file.write_text(OWN)
    assert main(["estimate", str(file), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["estimates"]
    # 150 mm2 at 6 s a mm2 and 30 mm2 at 12 s; the small one alone 180 mm2 at 12 s
    assert (found["seconds"], found["seconds_alone"]) == (1260.0, 2160.0)
    assert found["gain"] == pytest.approx(2160.0 / 1260.0 - 1.0)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[100, 50]", "[100, -50]", "own: large: areas must be a number"),
        ("[100, 50]", '"100"', "own: large: areas must be a list of numbers"),
        ("[100, 50]", "[nan]", "own: large: areas must be a number"),
        ('"1 min"', '"soon"', "own: large: measured_time must be a time such as 2 h 16 min 02 s"),
        ('"1 min"', '"0 s"', "own: large: measured_time must be a number from"),
        ("measured_area = 10", "measured_area = 0", "own: large: measured_area must be"),
        ("measured_area = 10", "", "own: large: measured_area is missing"),
        ("measured_time = 120", "measured_time = 120\nfeed = 3", "own: small: feed is not a field"),
        (OWN, "", "there is no estimate in it"),
        (OWN, "[own", "Expected"),
        (OWN, "own = 3", "own must be a table"),
    ],
)
def test_a_wrong_file_is_one_line_and_exit_2(tmp_path, capsys, old, new, words):
    file = tmp_path / "own.toml"
    file.write_text(OWN.replace(old, new, 1))
    assert main(["estimate", str(file)]) == BAD
    said = capsys.readouterr()
    assert said.out == "" and len(said.err.strip().splitlines()) == 1
    assert words in said.err and "own.toml" in said.err


def test_a_missing_file_and_a_folder_are_one_line_and_exit_2(tmp_path, capsys):
    for path in (tmp_path / "none.toml", tmp_path):
        assert main(["estimate", str(path)]) == BAD
        said = capsys.readouterr()
        assert said.out == "" and len(said.err.strip().splitlines()) == 1 and str(path) in said.err


def test_typed_figures_give_the_blades_gain():
    assert round(100.0 * typed_estimate(LARGE, SMALL).gain, 2) == 12.33


@pytest.mark.parametrize(
    ("field", "text"),
    [("areas", "7x"), ("areas", "1e400"), ("measured_area", ""), ("measured_time", "")],
)
def test_typed_figures_that_are_none_are_refused_by_field(field, text):
    with pytest.raises(BadInput, match=f"small: {field} must be"):
        typed_estimate(LARGE, {**SMALL, field: text})


def test_no_areas_at_all_are_refused():
    with pytest.raises(BadInput, match="neither cutter has an area"):
        typed_estimate({**LARGE, "areas": ""}, {**SMALL, "areas": " "})


@pytest.mark.parametrize("words", ["2 h 16 min 02 s", "59 min 30.5 s", "7 min 00 s", "0 min 01 s"])
def test_times_in_words_are_read_as_they_are_written(words):
    assert timed(seconds_of(words)) == words


BLADE = Estimate(
    areas=(
        AreaTime(
            operation="finish-a",
            feature="rest",
            tool="ball 8",
            area=735.836,
            rate=0.1765,
            seconds=4168.7,
            seconds_alone=5343.3,
        ),
    ),
    totals=(FeatureTime(feature="rest", area=735.836, seconds=4168.7, seconds_alone=5343.3),),
    seconds=4168.7,
    alone="ball 6",
    seconds_alone=5343.3,
    gain=0.281794,
    saving=0.219843,
)


def test_the_report_shows_the_gain_where_there_is_one(tmp_path):
    from trunnion.report.html import report_html

    session = programs.session()
    page = report_html(session, "B1", (), tmp_path, estimate=BLADE)
    assert "<h2>Time by area</h2>" in page and "<td>finish-a</td>" in page
    assert "ball 6 alone" in page and "28.18 % more efficient" in page
    assert "Time by area" not in report_html(session, "B1", (), tmp_path)


def test_what_is_written_of_a_plan_has_its_estimate(tmp_path, monkeypatch):
    from trunnion.pipeline import Engine
    from trunnion.progress import Progress

    def nothing(*_arguments: object) -> None:
        return None

    class Watched:
        __enter__ = __exit__ = nothing

    part = SimpleNamespace(watched=lambda _: Watched(), mesh=nothing, picture_chord=1.0)
    monkeypatch.setattr(Engine, "context_of", lambda *_: SimpleNamespace(part=part))
    monkeypatch.setattr(Engine, "states", lambda *_: {"verify": "done"})
    monkeypatch.setattr(Engine, "save", nothing)
    monkeypatch.setattr("trunnion.report.pictures.write_pictures", lambda *_: ())
    monkeypatch.setattr("trunnion.pipeline.writing.write_programs", lambda *_, **__: ())
    monkeypatch.setattr("trunnion.pipeline.planning.finishing_estimate.estimate", lambda *_: BLADE)
    Engine().write(programs.session(), tmp_path, name="blade", progress=Progress())
    assert "28.18 % more efficient" in (tmp_path / "blade.report.html").read_text()
