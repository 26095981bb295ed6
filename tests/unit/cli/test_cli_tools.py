"""`trunnion tools`: the catalogue listed, libraries taken over into a shop's folder, tools of catalogue and plan written."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import programs
from programs import BULL_10, FLAT_16, TURNING
from trunnion.cli.main import BAD, DONE, main
from trunnion.model.session import Session
from trunnion.shop.cutters import load_cutters, load_holders
from trunnion.store.project import save_project

LIBRARIES = Path(__file__).parents[2] / "tool_libraries"
FUSION = LIBRARIES / "fusion" / "by-hand.json"
TABLE = LIBRARIES / "linuxcnc" / "sample_tool.tbl"


def said(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """Return what a command prints, once it is done well."""
    assert main(["tools", *map(str, arguments)]) == DONE
    return capsys.readouterr().out


def refusal(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """Return the one line that a command is refused with."""
    assert main(["tools", *map(str, arguments)]) == BAD
    found = capsys.readouterr()
    assert found.out == "" and len(found.err.strip().splitlines()) == 1
    return found.err


def test_the_catalogue_is_listed_by_kind_diameter_and_words(capsys):
    found = json.loads(said(capsys, "list", "--json", "--kind", "drill", "--diameter", "6-6.5"))
    assert found["tools"] and all(
        t["form"] == "drill" and 6.0 <= t["diameter"] <= 6.5 for t in found["tools"]
    )
    taps = json.loads(said(capsys, "list", "--json", "--text", "tap_blind M6x1"))["tools"]
    assert [t["name"] for t in taps] == ["TAP-C M6x1"]
    balls = json.loads(said(capsys, "list", "--json", "--kind", "ball"))["tools"]
    assert balls and {t["form"] for t in balls} == {"end mill"}
    assert "TAP-C M6x1" in said(capsys, "list", "--text", "tap_blind M6x1")
    assert said(capsys, "list", "--diameter", "999").strip() == "no such tools"
    assert "unknown kind lathe" in refusal(capsys, "list", "--kind", "lathe")
    assert "--diameter wants mm" in refusal(capsys, "list", "--diameter", "thick")


def test_a_library_goes_into_a_shops_folder_and_is_in_its_catalogue_then(tmp_path, capsys):
    shop = tmp_path / "shop"
    done = json.loads(said(capsys, "import", FUSION, "-o", shop, "--json"))
    assert done["format"] == "fusion"
    assert [Path(f).relative_to(shop).as_posix() for f in done["files"]] == [
        "tools/by-hand.toml",
        "holders/by-hand.toml",
    ]
    assert {l["kind"] for l in done["losses"]} == {"lost", "ignored", "assumed", "left out"}
    assert {f["code"] for f in done["findings"]} >= {"tools.assumed", "tools.left-out"}
    listed = json.loads(said(capsys, "list", "--json", "--user-folder", shop))["tools"]
    names = {t["name"]: t for t in listed}
    for tool in done["tools"]:
        own = names[tool["name"]]
        assert {k: v for k, v in own.items() if k != "number"} == {
            k: v for k, v in tool.items() if k != "number"
        }
    assert names["EM-10"]["holder"] == "CAT40 ER32"
    # Numbers are a plan's: that they are not kept is said.
    assert {"EM-10"} <= {l["tool"] for l in done["losses"] if l["field"] == "number"}


def test_nothing_is_written_over_and_names_stay_apart(tmp_path, capsys):
    shop = tmp_path / "shop"
    said(capsys, "import", FUSION, "-o", shop, "--quiet")
    assert "is there already" in refusal(capsys, "import", FUSION, "-o", shop)
    again = tmp_path / "again.json"
    again.write_bytes(FUSION.read_bytes())
    said(capsys, "import", again, "-o", shop, "--quiet")
    cutters = load_cutters(load_holders(shop), shop)
    assert {"EM-10", "EM-10 (2)"} <= {c.tool.name for c in cutters}


def test_a_library_becomes_one_file_or_is_printed(tmp_path, capsys):
    file = tmp_path / "own.toml"
    said(capsys, "import", TABLE, "-o", file, "--holder", "HSK-A63 ER32", "--quiet")
    written = tomllib.loads(file.read_text())["tool"]
    printed = tomllib.loads(said(capsys, "import", TABLE, "--holder", "HSK-A63 ER32", "--quiet"))
    assert printed["tool"] == written
    assert {t["holder"] for t in written.values()} == {"HSK-A63 ER32"}
    assert written["8mm Ballend"]["diameter"] == 8.0
    assert "give a folder" in refusal(capsys, "import", FUSION, "-o", tmp_path / "f.toml")
    assert not (tmp_path / "f.toml").exists()


def test_what_is_assumed_stands_over_each_tool(capsys):
    text = said(capsys, "import", TABLE, "--quiet")
    assert "# Assumed, to be checked: form, corner_radius, flute_length," in text


def test_chosen_tools_are_written_for_each_program(tmp_path, capsys):
    chosen = ("--tool", "DR-K D8", "--tool", "TAP-C M6x1")
    for ending in (".tbl", ".fctl", ".json", ".tools", ".p21"):
        file = tmp_path / f"out{ending}"
        done = json.loads(said(capsys, "export", *chosen, "-o", file, "--json"))
        assert done["count"] == 2 and str(file) in done["files"]
        assert {l["tool"] for l in done["losses"]} == {"DR-K D8", "TAP-C M6x1"}
        again = json.loads(said(capsys, "import", file, "--json"))
        # The catalogue has tools of these names already.
        assert [t["name"] for t in again["tools"]] == ["DR-K D8 (2)", "TAP-C M6x1 (2)"]
    file = tmp_path / "one.txt"
    said(capsys, "export", "--tool", "DR-K D8", "-o", file, "--format", "linuxcnc", "--quiet")
    assert file.read_text().startswith("T1 P1 D8.0 Z")
    inch = tmp_path / "inch.tbl"
    said(capsys, "export", "--tool", "DR-K D6.35", "-o", inch, "--unit", "inch", "--quiet")
    assert inch.read_text().startswith("T1 P1 D0.25 Z")


def test_the_tools_of_a_project_are_written_with_their_numbers(tmp_path, capsys):
    project, file = tmp_path / "p.trunnion", tmp_path / "p.tbl"
    tree = programs.process_tree()
    rough = tree.operations[0]
    more = (replace(rough, id="bull", tool=BULL_10), replace(rough, id="turned", tool=TURNING))
    session = Session(process=replace(tree, operations=(*tree.operations, *more)))
    save_project(session, project, b"", ".step")
    done = json.loads(said(capsys, "export", "--project", project, "-o", file, "--json"))
    numbers = sorted(t.number for t in (FLAT_16, BULL_10))
    lines = file.read_text().splitlines()
    assert [line.split()[0] for line in lines] == [f"T{n}" for n in numbers]
    assert done["count"] == 2
    assert not [l for l in done["losses"] if l["field"] == "number"]
    left = [l["tool"] for l in done["losses"] if l["kind"] == "left out"]
    assert left == [TURNING.name]


def test_a_project_without_a_plan_has_no_tools(tmp_path, capsys):
    project = tmp_path / "p.trunnion"
    save_project(Session(), project, b"", ".step")
    line = refusal(capsys, "export", "--project", project, "-o", tmp_path / "t.tbl")
    assert "no plan yet" in line


def test_bad_calls_get_one_line(tmp_path, capsys):
    assert "unknown tool nought" in refusal(
        capsys, "export", "--tool", "nought", "-o", tmp_path / "t.tbl"
    )
    assert "there is no tool to write" in refusal(
        capsys, "export", "--diameter", "999", "-o", tmp_path / "t.tbl"
    )
    assert "no format has files with this ending" in refusal(
        capsys, "export", "-o", tmp_path / "t.xyz"
    )
    assert "there is no folder" in refusal(capsys, "export", "-o", tmp_path / "no" / "t.tbl")
    assert "none of the tools can be written" in refusal(
        capsys, "export", "--kind", "button", "-o", tmp_path / "t.json"
    )
    assert "no such folder" in refusal(capsys, "list", "--user-folder", tmp_path / "none")
    assert not list(tmp_path.iterdir())
