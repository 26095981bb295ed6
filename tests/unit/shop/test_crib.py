"""The tool crib: the file that keeps it, what can't be in a machine, and what lists have of the tools in it."""

from __future__ import annotations

import json
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

import trunnion_resources
from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.shop import load_shop
from trunnion.shop.crib import (
    FIELDS,
    HIGHEST_NUMBER,
    LARGEST_WEAR,
    Crib,
    CribTool,
    crib_text,
    load_cribs,
)
from trunnion.store.tool_crib import put_tool, set_wear, take_tool

MILL = "Mill 1200"
SHOP = own_shop()
DRILL, MILL_16 = "DR-S D8", "AL3-stub D16 R0"
FILE = """# Tools in the machine: T number, pocket, wear in mm (below 0: worn away).

["Mill 1200"]

["Mill 1200"."AL3-stub D16 R0"]
number = 2

["Mill 1200"."DR-S D8"]
number = 5
pocket = 12
wear_length = -0.012
wear_radius = 0.004
"""


def put(folder, name=DRILL, **numbers):
    return put_tool(folder, SHOP, MILL, name, **numbers)


def test_a_crib_is_kept_in_a_file_that_a_person_reads(tmp_path):
    put(tmp_path, DRILL, number=5, pocket=12)
    put(tmp_path, MILL_16, number=2)
    set_wear(tmp_path, MILL, DRILL, -0.012, 0.004)
    assert (tmp_path / "crib" / "Mill 1200.toml").read_text() == FILE
    crib = load_shop(tmp_path).crib(MILL)
    assert crib.numbers == ((MILL_16, 2), (DRILL, 5))
    assert crib.tool(DRILL) == CribTool(
        name=DRILL, number=5, pocket=12, wear_length=-0.012, wear_radius=0.004
    )
    assert load_shop(tmp_path).crib("Cradle 800") == Crib(machine="Cradle 800")


def test_a_tool_is_put_elsewhere_with_its_wear_and_taken_out(tmp_path):
    put(tmp_path, number=5)
    set_wear(tmp_path, MILL, DRILL, -0.02, 0.0)
    assert put(tmp_path, number=7, pocket=3).tool(DRILL) == CribTool(
        name=DRILL, number=7, pocket=3, wear_length=-0.02
    )
    assert put(tmp_path).tool(DRILL).number == 7
    assert put(tmp_path, MILL_16).tool(MILL_16).number == 1
    assert take_tool(tmp_path, MILL, DRILL).names == {MILL_16}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda f: put(f, MILL_16, number=5), "have the same number, 5"),
        (lambda f: put(f, MILL_16, pocket=12), "have the same pocket, 12"),
        (lambda f: put(f, MILL_16, pocket=10_000), "the magazine has 60 pockets"),
        (lambda f: put(f, MILL_16, number=100_000), "from 1 to 99999"),
        (lambda f: put(f, "AL9 D1"), "unknown tool AL9 D1"),
        (lambda f: put_tool(f, SHOP, "Mill 9", DRILL), "unknown machine Mill 9"),
        (lambda f: take_tool(f, MILL, MILL_16), "is not in the machine"),
        (lambda f: set_wear(f, MILL, DRILL, -9.0, 0.0), "from -5 to 5"),
        (lambda f: set_wear(f, MILL, DRILL, float("nan"), 0.0), "from -5 to 5"),
    ],
)
def test_what_cannot_be_in_a_machine_is_refused_and_its_file_stays(tmp_path, change, words):
    put(tmp_path, number=5, pocket=12)
    before = (tmp_path / "crib" / "Mill 1200.toml").read_bytes()
    with pytest.raises(BadInput, match=words):
        change(tmp_path)
    assert (tmp_path / "crib" / "Mill 1200.toml").read_bytes() == before


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('["M"."A"]\nnumber = 0\n', "number must be a whole number from 1 to 99999"),
        ('["M"."A"]\npocket = 3\n', "number is missing"),
        ('["M"."A"]\nnumber = 1\nwere = 3\n', "were is not a field here"),
        ('["M"."A"]\nnumber = 1\n["M"."B"]\nnumber = 1\n', "A and B have the same number, 1"),
        ('["M"]\nA = 3\n', "A must be a table"),
        ("[M\n", "own.toml"),
    ],
)
def test_a_file_that_is_no_crib_gets_one_line(tmp_path, text, words):
    (tmp_path / "crib").mkdir()
    (tmp_path / "crib" / "own.toml").write_text(text)
    with pytest.raises(BadInput, match=words) as refused:
        load_cribs(tmp_path)
    assert "own.toml" in str(refused.value) and "\n" not in str(refused.value)


def test_machines_that_share_a_file_stay_in_it(tmp_path):
    (tmp_path / "crib").mkdir()
    own = tmp_path / "crib" / "own.toml"
    own.write_text('["Mill 1200"."Gone D9"]\nnumber = 9\n["Cradle 800"."DR-S D8"]\nnumber = 3\n')
    put(tmp_path, MILL_16)
    assert sorted(p.name for p in own.parent.iterdir()) == ["own.toml"]
    cribs = load_cribs(tmp_path)
    # A tool that the catalogue has no more keeps its number: it is in the machine all the same.
    assert cribs[MILL].numbers == ((MILL_16, 1), ("Gone D9", 9))
    assert cribs["Cradle 800"].numbers == (("DR-S D8", 3),)


def test_only_names_and_numbers_are_what_plans_depend_on(tmp_path):
    bare = load_shop(tmp_path).digest
    assert bare == SHOP.digest
    put(tmp_path, number=5)
    loaded = load_shop(tmp_path).digest
    set_wear(tmp_path, MILL, DRILL, -0.1, 0.0)
    put(tmp_path, pocket=4)
    assert load_shop(tmp_path).digest == loaded != bare
    put(tmp_path, number=6)
    assert load_shop(tmp_path).digest != loaded


def test_the_schema_has_the_fields_and_limits_of_the_reader():
    schema = json.loads((trunnion_resources.folder("schemas") / "crib.json").read_text("utf-8"))
    fields = schema["additionalProperties"]["additionalProperties"]["properties"]
    assert tuple(fields) == FIELDS
    assert {fields[n]["maximum"] for n in FIELDS[:2]} == {HIGHEST_NUMBER}
    assert {fields[n]["maximum"] for n in FIELDS[2:]} == {LARGEST_WEAR}
    assert {fields[n]["minimum"] for n in FIELDS[2:]} == {-LARGEST_WEAR}


names = st.text(st.characters(exclude_categories=("Cs",)), min_size=1, max_size=20)


@given(
    machine=names,
    tools=st.dictionaries(
        names,
        st.tuples(st.floats(-LARGEST_WEAR, LARGEST_WEAR), st.floats(-LARGEST_WEAR, LARGEST_WEAR)),
        max_size=5,
    ),
)
def test_any_names_and_wear_come_back_from_the_text(tmp_path_factory, machine, tools):
    crib = Crib(
        machine=machine,
        tools=tuple(
            CribTool(name=name, number=n, pocket=n * (n % 2), wear_length=wl, wear_radius=wr)
            for n, (name, (wl, wr)) in enumerate(tools.items(), 1)
        ),
    )
    text = crib_text([crib])
    tomllib.loads(text)
    folder = tmp_path_factory.mktemp("crib")
    (folder / "crib").mkdir()
    (folder / "crib" / "own.toml").write_text(text, encoding="utf-8", newline="")
    assert load_cribs(folder) == {machine: crib}
