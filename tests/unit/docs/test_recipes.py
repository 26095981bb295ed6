"""CONTRIBUTING's recipe of a dialect does what it says; whole packages of one's own are in `test_own_family.py`."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from importlib.resources import files

import pytest

from parts import ROOT

ENTRY_POINTS = """[trunnion.dialects]
murmur = shop_extra:MurmurDialect
"""


ROUND_TRIP = """
from programs import BULL_10, FLAT_16, S1, program_1
from trunnion import registry
from trunnion.model.motion.listing import listing
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
    (package / "__init__.py").write_text(recipe("A dialect"))
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
