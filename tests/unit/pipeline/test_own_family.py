"""A family that lives wholly in a package of its own goes from the part file to a released program on the command line."""

from __future__ import annotations

import contextlib
import io
import json
import subprocess
import sys
from types import SimpleNamespace

import pytest
from PIL import Image

from own_packages import environment, with_own_packages
from trunnion.cli.main import main
from turned_discs import turned_disc

COMMAND = "from trunnion.cli.main import run; run()"
SEVEN = ("face", "rim-rough", "slot-rough", "slot-floor", "slot-wall", "rim-finish", "bevel")


def trunnion(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Return what the command line says in a process that finds the package."""
    return subprocess.run(
        [sys.executable, "-c", COMMAND, *arguments],
        capture_output=True,
        text=True,
        env=environment(),
        check=False,
    )


def said_here(*arguments: str) -> SimpleNamespace:
    """Return what the command line says in this process, where it finds the package too."""
    out, err = io.StringIO(), io.StringIO()
    with with_own_packages(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(list(arguments))
    return SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=err.getvalue())


@pytest.fixture(scope="module")
def disc(tmp_path_factory):
    """The disc's file, the folder of its program, and what the command said."""
    folder = tmp_path_factory.mktemp("disc")
    file, out = turned_disc(folder), folder / "out"
    chosen = ("--set", "post.dialect=turner", "--set", "turned_disc.wall_allowance=0.25")
    said = trunnion("program", str(file), "-o", str(out), "--json", *chosen)
    assert said.returncode == 0, said.stderr
    return SimpleNamespace(file=file, out=out, told=json.loads(said.stdout))


def test_the_part_is_taken_for_the_family_without_being_told(disc):
    features = (disc.out / "disc.features.xml").read_text()
    assert 'family="turned_disc"' in features and 'kind="disc_slot"' in features
    assert "recognize.family" in {f["code"] for f in disc.told["findings"]}


def test_its_planner_follows_the_typical_plan_of_its_package(disc):
    assert [o["id"].partition("-disc_")[0] for o in disc.told["operations"]] == list(SEVEN)
    process = (disc.out / "disc.process.xml").read_text()
    assert "Turned disc, milled" in process and "disc.bevel" in process


def test_tools_of_its_package_are_used(disc):
    tools = json.loads((disc.out / "disc.tools.json").read_text())
    assert [t["name"] for t in tools][-1] == "Bevel cutter 45"


def test_its_program_is_proven_and_released(disc):
    assert disc.told["verdict"] == "passed"
    assert (disc.told["coverage"], disc.told["collisions"], disc.told["rapids_in_stock"]) == (
        1.0,
        0,
        0,
    )
    assert {o["verdict"] for o in disc.told["operations"]} == {"passed"}


def test_its_program_is_written_in_the_dialect_of_its_package(disc):
    (text,) = (file.read_text() for file in disc.out.glob("*.trn"))
    assert "(RELEASED)" in text and "\nN10 G71\n" in text


def test_the_program_is_read_back_and_proven_again(disc, tmp_path):
    edited = tmp_path / "edited.trn"
    edited.write_text((disc.out / "disc.S1.trn").read_text())
    project = str(disc.out / "disc.trunnion")
    said = trunnion("verify", project, "--nc", str(edited), "--json")
    assert said.returncode == 0, said.stderr
    assert json.loads(said.stdout)["verdict"] == "passed"


def test_the_report_and_its_pictures_show_the_familys_words_and_colours(disc):
    report = (disc.out / "disc.report.html").read_text()
    assert "bevel-disc_bevel-01" in report and report.count("data:image/png;base64,") == 3
    seen = Image.open(disc.out / "disc.features.png").convert("RGB").getcolors(1 << 20)
    hues = {colour: n for n, colour in seen}
    for named in ((17, 119, 51), (204, 102, 119), (51, 34, 136)):
        assert hues.get(named, 0) > 100, named


def test_settings_of_the_package_are_listed_and_checked_like_ours(disc):
    listed = {s["key"]: s for s in json.loads(trunnion("settings", "--json").stdout)}
    assert listed["disc.bevel.below"]["unit"] == "mm"
    assert {"turner", "kestrel"} <= set(listed["post.dialect"]["choices"])
    said = said_here("info", str(disc.file), "--set", "disc.bevel.below=99")
    assert said.returncode == 2
    wrong = "Below the bevel (disc.bevel.below) must be from 0 to 10 mm; got 99"
    assert said.stderr.strip() == f"trunnion: {wrong}"


def test_its_planner_checks_the_cutter_rules_of_a_shops_own_plan(disc, tmp_path):
    (tmp_path / "plans").mkdir()
    (tmp_path / "plans" / "discs.toml").write_text(
        '["Discs, by laser"]\ntitle = "Discs"\nfamily = "turned_disc"\nstage = [{ name = "burn", kind = "face", '
        'strategy = "plane.face", on = ["disc_end"], cutter = "laser", finish = true, rule = "quick" }]\n'
    )
    said = said_here("route", str(disc.file), "--user-folder", str(tmp_path))
    assert said.returncode == 2
    known = "cutter must be one of end mill, bevel; got 'laser'"
    assert f"typical plan Discs, by laser, stage burn: {known}" in said.stderr
