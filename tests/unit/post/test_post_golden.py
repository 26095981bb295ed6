"""Golden cases of posts: a folder `golden/post/CASE` holds README, input and expected.

Input is motions as the neutral listing writes them (`*.motions`, one file a setup) or a text (`*.nc`, `*.cl`); expected is the text of a
dialect or the listing of what was read. `TRUNNION_REGOLD=1` writes what comes out now; a person reads the difference. `golden/refused`
holds texts whose first line is the message that they must be refused with.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from leaning_paths import TABLE, standing
from programs import BULL_10, FLAT_16, S1, S2, program_from
from trunnion import registry
from trunnion.findings import BadInput
from trunnion.model.motion.listing import listing
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import NO_WORK_POSITIONS

GOLDEN = Path(__file__).resolve().parents[2] / "golden"
CASES = sorted((GOLDEN / "post").iterdir())
REFUSED = sorted(f for f in (GOLDEN / "refused").iterdir())
HEADER = Header(
    name="B1",
    part="B1",
    part_digest="ab12",
    plan_digest="cd34",
    material="al-7075",
    date="2026-01-02",
)
DIALECTS = {".nc": "linuxcnc", ".cl": "apt", ".MPF": "sinumerik", ".h": "heidenhain"}
"""By the ending of a text; cases whose name has another dialect's in it are of that."""
TABLES = {"S1": standing(TABLE)}
"""Where work stands in cases of five axes."""


def dialect_of(name: str, suffix: str):
    """Return the dialect of a text of a case."""
    return registry.get("dialects", "fanuc" if "fanuc" in name else DIALECTS[suffix])()


def made(case: Path, expected: Path) -> str:
    sources = sorted(case.glob("input*"))
    if sources[0].suffix != ".motions":
        suffix = sources[0].suffix
        dialect = (
            registry.get("dialects", "apt")() if suffix == ".cl" else dialect_of(case.name, suffix)
        )
        setups = [S1, S2] if sources[0].suffix == ".cl" else [S1]
        places = TABLES if "five-axis" in case.name else NO_WORK_POSITIONS
        if expected.suffix != ".listing":
            programs = dialect.read(sources[0].read_text(), (FLAT_16,), [S1])
            target = dialect_of(case.name, expected.suffix)
            return target.write(programs, HEADER, PostSettings(), TABLES)
        return "".join(
            listing(p, marks=False)
            for p in dialect.read(sources[0].read_text(), (FLAT_16, BULL_10), setups, places)
        )
    settings = PostSettings(units="inch" if "inch" in case.name else "mm")
    programs = [program_from(source.read_text()) for source in sources]
    return dialect_of(case.name, expected.suffix).write(programs, HEADER, settings)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_case_comes_out_as_expected(case):
    assert (case / "README.md").is_file()
    (expected,) = case.glob("expected*")
    text = made(case, expected)
    if os.environ.get("TRUNNION_REGOLD"):
        expected.write_text(text)
    assert text == expected.read_text()


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text.name)
def test_a_text_is_refused_with_the_message_of_its_first_line(text):
    dialect = dialect_of(text.name, text.suffix)
    message = text.read_text().split("\n", 1)[0].lstrip(";$ ")
    with pytest.raises(BadInput) as refused:
        places = TABLES if "five-axis" in text.name else NO_WORK_POSITIONS
        dialect.read(text.read_text(), (FLAT_16, BULL_10), [S1], places)
    assert str(refused.value) == message
