"""What `trunnion info` lists of the sizes that a file gives as data."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import samples
from dimensioned import Sized, write_dimensioned
from trunnion.cli.info import MOST_DIMENSIONS, dimension_text
from trunnion.cli.main import DONE, main
from trunnion.model.dimension import DIAMETER, Dimension

SIZES = [
    Sized(holes=(0, 1), value=12.0, lower=0.0, upper=0.021),
    Sized(holes=(2,), value=8.0, fit="H7"),
]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_dimensioned(tmp_path_factory.mktemp("info") / "plate.step", (12, 12, 8), SIZES)


def test_dimensions_are_counted_and_listed(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(file)]) == DONE
    lines = [line.split() for line in capsys.readouterr().out.splitlines()[-4:]]
    assert lines == [
        ["2", "dimensions"],
        ["size", "mm", "upper", "lower", "fit", "thread", "faces", "called"],
        ["diameter", "12", "+0.021", "0", "7", "8", "diameter"],
        ["diameter", "8", "H7", "9", "diameter"],
    ]


def test_json_has_all_of_each_dimension(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(file), "--json"]) == DONE
    first, second = json.loads(capsys.readouterr().out)["dimensions"]
    assert first == {
        "kind": "diameter",
        "value": 12.0,
        "upper": 0.021,
        "lower": 0.0,
        "fit": "",
        "thread": "",
        "text": "diameter",
        "faces": [7, 8],
    }
    assert (second["fit"], second["upper"], second["faces"]) == ("H7", None, [9])


def test_a_file_without_dimensions_lists_none(capsys: pytest.CaptureFixture[str]) -> None:
    box = samples.written(samples.box_shape())
    assert main(["info", str(box)]) == DONE
    assert "dimension" not in capsys.readouterr().out
    assert main(["info", str(box), "--json"]) == DONE
    assert json.loads(capsys.readouterr().out)["dimensions"] == []


def test_of_many_dimensions_the_rest_is_counted() -> None:
    text = dimension_text([Dimension(DIAMETER, 6.0, thread="M6x1")] * (MOST_DIMENSIONS + 3))
    assert text.startswith(f"{MOST_DIMENSIONS + 3} dimensions\n")
    assert text.endswith("and 3 more: --json has all") and text.count("M6x1") == MOST_DIMENSIONS
