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
'''
ENTRY_POINTS = '''[trunnion.strategies]
plane.engrave = shop_extra:engrave

[trunnion.dialects]
murmur = shop_extra:MurmurDialect
'''


ROUND_TRIP = '''
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
'''


@pytest.fixture
def own_package(tmp_path):
    """A shop's own package as pip would lay it out; returns the environment in which Python sees it."""
    package = tmp_path / "shop_extra"
    package.mkdir()
    (package / "__init__.py").write_text(MODULE + recipe("A dialect"))
    words = (files("trunnion_resources") / "dialects" / "linuxcnc.toml").read_text()
    (package / "murmur.toml").write_text(words.replace('"LinuxCNC"', '"Murmur 4"').replace('"nc"', '"mur"').replace('"G21"', '"G71"'))
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


def test_a_dialect_of_ones_own_writes_and_reads_with_its_words(own_package):
    said = subprocess.run([sys.executable, "-c", ROUND_TRIP], capture_output=True, text=True, env=own_package, check=True)
    text, same = said.stdout.rsplit("\n", 2)[:2]
    assert "N10 G71\n" in text
    assert "G21" not in text
    assert same == "mur True"


def test_the_recipes_name_what_the_example_does():
    recipes = (ROOT / "CONTRIBUTING.md").read_text()
    for word in ("@strategy(settings=", "trunnion.strategies", "suffix", "entry-point"):
        assert word in recipes
