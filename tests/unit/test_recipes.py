"""CONTRIBUTING's recipes for a package of one's own: a strategy and a dialect are found without touching ours."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from importlib.resources import files

import pytest

from parts import ROOT

MODULE = '''
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import driven_by
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.typical import typical_plan
from trunnion.recognize.contract import Suitability
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, strategy


@settings("plane.engrave")
class EngraveSettings:
    """What a shop may choose when it engraves."""

    depth: float = setting(0.2, unit="mm", low=0.01, high=2.0, label="Depth", help="How deep the letters are.")


@strategy(settings=EngraveSettings, drive=PlaneDrive)
def engrave(drive, tool, data, stock, setup, settings, progress):
    """Return no motions: a recipe's example."""
    return Planned()


@settings("recognize.wedge")
class WedgeSettings:
    """What decides whether a part is a wedge."""


@settings("wedge")
class WedgeRouteSettings:
    """What a shop may choose about the route of a wedge."""

    slope: float = setting(3.0, unit="deg", low=0.0, high=30.0, label="Slope", help="How much a wedge leans.")


class Wedges:
    """A family whose parts are one feature."""

    name, noun, settings = "wedge", "a wedge", WedgeSettings

    def suits(self, graph):
        """Suit no part that wasn't chosen by hand."""
        return Suitability(score=0.0, explained=1.0, reason="nobody can tell")

    def recognize(self, graph, slicer, settings, progress):
        """Return one feature with all faces."""
        faces = tuple(FaceRole(role="face", face=n + 1) for n in range(len(graph.area)))
        return Recognition(family="wedge", features=(Feature(id="wedge-01", kind="wedge", faces=faces),))


class WedgePlanner:
    """Follows its typical plan, which has no operation yet."""

    name, noun, settings, cutter_rules = "wedge", "wedges", (WedgeRouteSettings,), ("chisel",)

    def can_plan(self, part):
        """Refuse no part."""

    def route(self, job):
        """Return a process without operations."""
        plan = typical_plan(job.shop, self.name, "", self.cutter_rules)
        title = f"{plan.name}, {job.chosen(WedgeRouteSettings).slope:g} degrees"
        return ProcessTree(plan=title, material=job.blank.material, setups=job.setups)

    def drive(self, operation, needs, scene, progress):
        """Return what drives an operation: there is none."""
        return driven_by({}, self, operation, needs, scene, progress)
'''
PLAN = """
["Wedges, by hand"]
title = "Wedges"
family = "wedge"
stage = [{ name = "split", kind = "split", strategy = "plane.engrave", on = ["wedge"], cutter = "CUTTER", finish = true, rule = "first" }]
"""
ENTRY_POINTS = """[trunnion.strategies]
plane.engrave = shop_extra:engrave

[trunnion.families]
wedge = shop_extra:Wedges

[trunnion.planners]
wedge = shop_extra:WedgePlanner

[trunnion.dialects]
murmur = shop_extra:MurmurDialect
"""


ROUND_TRIP = """
from programs import BULL_10, FLAT_16, S1, program_1
from trunnion import registry
from trunnion.model.listing import listing
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings

dialect = registry.get("dialects", "murmur")()
text = dialect.write([program_1()], Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34"), PostSettings())
(again,) = dialect.read(text, (FLAT_16, BULL_10), [S1])
print(text, end="")
print(dialect.suffix, listing(again, marks=False) == listing(program_1(), marks=False))
"""


@pytest.fixture
def own_package(tmp_path):
    """A shop's own package as pip would lay it out; returns the environment in which Python sees it."""
    package = tmp_path / "shop_extra"
    package.mkdir()
    (package / "__init__.py").write_text(MODULE + recipe("A dialect"))
    words = (files("trunnion_resources") / "dialects" / "linuxcnc.toml").read_text()
    (package / "murmur.toml").write_text(
        words.replace('"LinuxCNC"', '"Murmur 4"').replace('"nc"', '"mur"').replace('"G21"', '"G71"')
    )
    info = tmp_path / "shop_extra-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: shop-extra\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    path = [str(tmp_path), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
    return os.environ | {"PYTHONPATH": os.pathsep.join(path)}


def recipe(name: str) -> str:
    """Return the Python of a recipe in CONTRIBUTING."""
    after = (ROOT / "CONTRIBUTING.md").read_text().split(f"**{name}.**")[1].split("\n**")[0]
    return textwrap.dedent(after.split("```python\n")[1].split("```")[0])


def test_a_strategy_of_ones_own_brings_its_settings_to_the_command_line(own_package):
    code = "from trunnion.cli.main import run; run()"
    said = subprocess.run(
        [sys.executable, "-c", code, "settings", "--json"],
        capture_output=True,
        text=True,
        env=own_package,
        check=True,
    )
    listed = {entry["key"]: entry for entry in json.loads(said.stdout)}
    assert listed["plane.engrave.depth"]["unit"] == "mm"
    assert "murmur" in listed["post.dialect"]["choices"]


def test_its_values_are_checked_like_ours(own_package, sample_part):
    code = "from trunnion.cli.main import run; run()"
    said = subprocess.run(
        [sys.executable, "-c", code, "info", str(sample_part), "--set", "plane.engrave.depth=9"],
        capture_output=True,
        text=True,
        env=own_package,
        check=False,
    )
    assert said.returncode == 2
    assert (
        said.stderr.strip()
        == "trunnion: Depth (plane.engrave.depth) must be from 0.01 to 2 mm; got 9"
    )


def test_a_dialect_of_ones_own_writes_and_reads_with_its_words(own_package):
    said = subprocess.run(
        [sys.executable, "-c", ROUND_TRIP],
        capture_output=True,
        text=True,
        env=own_package,
        check=True,
    )
    text, same = said.stdout.rsplit("\n", 2)[:2]
    assert "N10 G71\n" in text
    assert "G21" not in text
    assert same == "mur True"


def routed(own_package, tmp_path, part, cutter):
    """Return what the command line says of a route by the planner of one's own, with a typical plan of the user's folder."""
    (tmp_path / "user" / "plans").mkdir(parents=True)
    (tmp_path / "user" / "plans" / "wedges.toml").write_text(PLAN.replace("CUTTER", cutter))
    code = "from trunnion.cli.main import run; run()"
    return subprocess.run(
        [
            sys.executable,
            "-c",
            code,
            "route",
            str(part),
            "--json",
            "--set",
            "recognize.family=wedge",
            "--set",
            "wedge.slope=7",
            "--user-folder",
            str(tmp_path / "user"),
        ],
        capture_output=True,
        text=True,
        env=own_package,
        check=False,
    )


def test_a_family_of_ones_own_is_recognised_and_planned(own_package, tmp_path, sample_panel):
    said = routed(own_package, tmp_path, sample_panel, "chisel")
    assert said.returncode == 0, said.stderr
    assert json.loads(said.stdout)["plan"] == "Wedges, by hand, 7 degrees"


def test_its_planner_checks_the_cutter_rules_of_its_typical_plan(
    own_package, tmp_path, sample_panel
):
    said = routed(own_package, tmp_path, sample_panel, "laser")
    assert said.returncode == 2
    assert (
        "typical plan Wedges, by hand, stage split: cutter must be one of chisel; got 'laser'"
        in said.stderr
    )


def test_the_recipes_name_what_the_example_does():
    recipes = (ROOT / "CONTRIBUTING.md").read_text()
    for word in (
        "@strategy(settings=",
        "trunnion.strategies",
        "trunnion.families",
        "trunnion.planners",
        "suffix",
        "entry-point",
    ):
        assert word in recipes
