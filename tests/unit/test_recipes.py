"""CONTRIBUTING's recipes for a package of one's own: a strategy and a dialect are found without touching ours."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from parts import ROOT

MODULE = '''
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, strategy


@settings("plane.engrave")
class EngraveSettings:
    """What a shop may choose when it engraves."""

    depth: float = setting(0.2, unit="mm", low=0.01, high=2.0, label="Depth", help="How deep the letters are.")


@strategy(settings=EngraveSettings)
def engrave(drive, tool, data, stock, setup, settings, progress):
    """Return no motions: a recipe's example."""
    return Planned()


class Murmur:
    """A dialect that says how many programs there are."""

    name, suffix = "murmur", "txt"

    def write(self, programs, header, settings, places):
        """Return the text."""
        return f"{len(programs)} programs"
'''
ENTRY_POINTS = '''[trunnion.strategies]
plane.engrave = shop_extra:engrave

[trunnion.dialects]
murmur = shop_extra:Murmur
'''


@pytest.fixture
def own_package(tmp_path):
    """A shop's own package as pip would lay it out; returns the environment in which Python sees it."""
    (tmp_path / "shop_extra.py").write_text(MODULE)
    info = tmp_path / "shop_extra-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: shop-extra\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    return os.environ | {"PYTHONPATH": str(tmp_path)}



def test_a_strategy_of_ones_own_brings_its_settings_to_the_command_line(own_package):
    code = "from trunnion.cli.main import run; run()"
    said = subprocess.run([sys.executable, "-c", code, "settings", "--json"], capture_output=True, text=True, env=own_package, check=True)
    listed = {entry["key"]: entry for entry in json.loads(said.stdout)}
    assert listed["plane.engrave.depth"]["unit"] == "mm"
    assert "murmur" in listed["post.dialect"]["choices"]


def test_its_values_are_checked_like_ours(own_package, sample_part):
    code = "from trunnion.cli.main import run; run()"
    said = subprocess.run([sys.executable, "-c", code, "info", str(sample_part), "--set", "plane.engrave.depth=9"], capture_output=True,
                          text=True, env=own_package, check=False)
    assert said.returncode == 2
    assert said.stderr.strip() == "trunnion: Depth (plane.engrave.depth) must be from 0.01 to 2 mm; got 9"


def test_the_recipes_name_what_the_example_does():
    recipes = (ROOT / "CONTRIBUTING.md").read_text()
    for word in ("@strategy(settings=", "trunnion.strategies", "suffix", "entry-point"):
        assert word in recipes
