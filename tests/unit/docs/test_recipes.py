"""CONTRIBUTING's recipes of a dialect and of a format of tools do what they say; whole packages are in `test_own_family.py`."""

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


TOOL_ENTRY_POINTS = """[trunnion.tool_formats]
lines = tool_extra:LinesFormat
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


TOOLS_ROUND_TRIP = """
from pathlib import Path

from trunnion.shop.cutters import load_cutters, load_holders
from trunnion.shop.exchange import ExchangeContext, format_of

holders = load_holders(None)
context = ExchangeContext(holders=holders, cutters=load_cutters(holders, None))
drill = next(c for c in context.cutters if c.tool.name == "DR-K D8")
path = Path("two.lines")
done = format_of(path).write([drill], path, context)
path.write_bytes(done.files[path])
(again,) = format_of(path).read(path, context).cutters
print(done.files[path].decode(), end="")
print(again.tool.name, again.tool.diameter, sorted({l.field for l in done.losses})[:3])
"""


def test_a_format_of_tools_of_ones_own_reads_and_writes(tmp_path):
    package = tmp_path / "tool_extra"
    package.mkdir()
    (package / "__init__.py").write_text(recipe("A format of tool libraries"))
    info = tmp_path / "tool_extra-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: tool-extra\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(TOOL_ENTRY_POINTS)
    path = [str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])]
    said = subprocess.run(
        [sys.executable, "-c", TOOLS_ROUND_TRIP],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(path)},
        cwd=tmp_path,
        check=True,
    )
    assert said.stdout.splitlines() == [
        "8.0 DR-K D8",
        "DR-K D8 8.0 ['centre_cutting', 'flute_length', 'form']",
    ]


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
