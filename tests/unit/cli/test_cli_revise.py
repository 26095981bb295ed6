"""`trunnion revise`: a project goes on with a revised part file; errors are one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from revised_panels import PanelDesign
from samples import renumbered, written
from trunnion.cli.main import BAD, DONE, main


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a project of a panel, routed, whose first roughing a person made slower."""
    file = tmp_path_factory.mktemp("revise") / "panel.trunnion"
    part = written(PanelDesign().shape(), name="panel")
    words = ["--operation", "rough-pocket-01", "--feed", "3000", "--out", str(file), "--quiet"]
    assert main(["change", str(part), *words]) == DONE
    return file


def test_a_project_goes_on_with_the_revised_part(project, capsys):
    revision = written(renumbered(PanelDesign(left_floor=6.0, third=True).shape()), name="panel_b")
    out = project.with_name("panel_b.trunnion")
    capsys.readouterr()
    words = ["revise", str(project), "--by", str(revision), "--out", str(out)]
    assert main([*words, "--json"]) == DONE
    made = json.loads(capsys.readouterr().out)
    assert made["file"] == str(out) and made["operations_by_hand"] == ["rough-pocket-01"]
    assert [f["code"] for f in made["revision"]] == ["revision.faces"]
    assert main(words) == DONE
    assert capsys.readouterr().out.startswith("of 48 faces of the part before")
    assert main(["route", str(out), "--json"]) == DONE
    planned = json.loads(capsys.readouterr().out)["operations"]
    rough = next(o for o in planned if o["id"] == "rough-pocket-01")
    assert rough["by_hand"] and rough["data"]["feed"] == 3000.0
    assert any(o["feature"] == "pocket-03" for o in planned)


@pytest.mark.parametrize(
    ("by", "out", "said"),
    [
        ("nothing.step", "b.trunnion", "no such file"),
        ("SELF", "b.trunnion", "is a project"),
        ("OTHER", "b.trunnion", "it is another part"),
        ("OTHER", "b.txt", "--out wants a file that ends in .trunnion"),
    ],
)
def test_what_can_not_be_is_one_line_and_nothing_is_written(
    project, sample_part, capsys, tmp_path, by, out, said
):
    file = {"SELF": project, "OTHER": sample_part}.get(by, by)
    words = ["revise", str(project), "--by", str(file), "--out", str(tmp_path / out)]
    assert main(words) == BAD
    error = capsys.readouterr().err.strip()
    assert said in error and len(error.splitlines()) == 1 and not (tmp_path / out).exists()
