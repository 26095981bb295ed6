"""The plan library as a file: what is added is found again, what can't be read is one clear line, and nothing is lost."""

from __future__ import annotations

import json
import os
import sqlite3
import sys
import threading
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from pytest import approx

from taught_plans import RING, plan
from trunnion.findings import BadInput
from trunnion.shop.library import PlanLibrary, library_file, similarity
from trunnion.shop.library.plan_text import plan_of_text, plan_text


@pytest.fixture
def library(tmp_path):
    """A library with one plan."""
    made = PlanLibrary(tmp_path / "plans" / "plan-library.sqlite")
    made.add(plan())
    return made


def refused(call, *words: str) -> str:
    """Return the one line that a call is refused with; it has all the words."""
    with pytest.raises(BadInput) as reason:
        call()
    line = str(reason.value)
    assert "\n" not in line and all(word in line for word in words), line
    return line


def test_a_library_that_is_not_there_is_empty_and_stays_away(tmp_path):
    library = PlanLibrary(tmp_path / "none" / "plan-library.sqlite")
    assert library.plans() == () and library.names() == () and library.matches(RING) == ()
    assert not library.path.parent.exists()


def test_a_plan_comes_back_as_it_was_added(library):
    assert library.plan("ring A") == plan()
    assert library.plans() == library.plans("ring") == (plan(),)
    assert library.plans("panel") == ()


def test_a_plan_is_kept_as_readable_text_with_its_version(library):
    with closing(sqlite3.connect(library.path)) as database:
        text, date = database.execute("SELECT content, date FROM plan").fetchone()
    data = json.loads(text)
    assert data["version"] == 1 and date == data["date"] == "2026-03-01"
    assert [s["name"] for s in data["stages"]] == ["sides", "feet"]
    assert data["operations"][0]["tool"] == "EM D10"


def test_the_most_similar_plan_comes_first_with_its_reasons(library):
    other = replace(RING, features={"boss circle": 1}, sizes={"largest_diameter": 400.0})
    library.add(plan("another", other))
    found = library.matches(RING)
    assert [m.plan.name for m in found] == ["ring A", "another"]
    assert found[0].similarity.value == 1.0
    # 1 of 8 features, a third of one kind of three, half a diameter and no wall of two sizes.
    features = (1 / 8 + (1 / 3) / 3) / 2
    assert found[1].similarity.value == approx((5 * features + 3 * 0.25 + 2) / 10)
    assert "1 of 3 kinds of features and 1 of 8 features in common" in found[1].similarity.words
    assert "largest diameter 200 and 400 mm" in found[1].similarity.words
    assert "only one has a wall thickness" in found[1].similarity.words


def test_another_material_of_its_group_is_nearer_than_one_of_another_group():
    same = replace(RING, material="Inconel 718")
    other = replace(RING, material="EN AW-7075", material_group="N")
    assert 1.0 > similarity(RING, same).value > similarity(RING, other).value
    assert "the same material group S" in similarity(RING, same).words


def test_a_name_is_given_once(library):
    refused(lambda: library.add(plan(part="other")), "ring A already", "choose another name")
    assert library.plan("ring A").part == "ring"
    refused(lambda: library.add(plan(" ")), "needs a name")


def test_an_unknown_name_says_which_are_known(library):
    refused(lambda: library.plan("ring B"), "no plan ring B", "known: ring A")
    refused(lambda: library.remove("ring B"), "no plan ring B")
    library.remove("ring A")
    refused(lambda: library.plan("ring A"), "it is empty")


def test_a_damaged_file_is_one_line_and_stays_as_it_is(library):
    data = library.path.read_bytes()
    damaged = data[:100] + b"\xff" * (len(data) - 100)
    library.path.write_bytes(damaged)
    for call in (library.plans, library.names, lambda: library.add(plan("x"))):
        refused(call, str(library.path), "damaged", "move the file away")
    assert library.path.read_bytes() == damaged


def test_a_cut_off_file_is_refused(library):
    library.path.write_bytes(library.path.read_bytes()[:3000])
    refused(library.plans, str(library.path), "damaged")


def test_a_file_of_another_kind_is_refused_and_kept(library):
    library.path.write_text("no database at all, " * 20)
    refused(lambda: library.add(plan("x")), str(library.path), "damaged")
    library.path.unlink()
    with closing(sqlite3.connect(library.path)) as database:
        database.execute("CREATE TABLE other (x)")
    refused(lambda: library.add(plan()), "no plan library", "move it away")


def test_a_library_of_a_newer_version_is_refused(library):
    with closing(sqlite3.connect(library.path)) as database:
        database.execute("PRAGMA user_version = 2")
    refused(library.plans, "newer version", "schema 2", "update the program")
    refused(lambda: library.remove("ring A"), "newer version")
    with closing(sqlite3.connect(library.path)) as database:
        assert database.execute("SELECT count(*) FROM plan").fetchone()[0] == 1


def test_a_plan_of_a_newer_version_is_refused_by_its_name(library):
    text = plan_text(plan()).replace('"version": 1', '"version": 2')
    with closing(sqlite3.connect(library.path)) as database, database:
        database.execute("UPDATE plan SET content = ?", (text,))
    refused(library.plans, "plan ring A", "newer version", "update")


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('"name": "sides"', '"name": 5', "stages 1"),
        ('"feed": 900.0', '"feed": -1', "feed as a number"),
        ('"finish": true', '"finish": "yes"', "finish as true or false"),
        ('"largest_diameter": 200.0', '"largest_diameter": 0', "numbers above 0"),
        ('"operations"', '"operation"', "operations is wanted"),
        ("{", "[", "damaged"),
    ],
)
def test_a_damaged_plan_names_its_field_and_can_be_removed(library, before, after, words):
    text = plan_text(plan()).replace(before, after, 1)
    refused(lambda: plan_of_text(text, "plan ring A"), "plan ring A", words)
    with closing(sqlite3.connect(library.path)) as database, database:
        database.execute("UPDATE plan SET content = ?", (text,))
    refused(library.plans, "remove the plan")
    library.remove("ring A")
    assert library.plans() == ()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc")
def test_a_folder_that_cannot_be_written_to_is_one_line():
    library = PlanLibrary(library_file(Path("/proc/self/plans")))
    refused(lambda: library.add(plan()), "can't be written", "--user-folder")


def test_a_read_only_library_is_read_and_not_written(library):
    if os.geteuid() == 0:
        pytest.skip("root writes everywhere")
    library.path.chmod(0o444)
    library.path.parent.chmod(0o555)
    assert library.names() == ("ring A",)
    refused(lambda: library.add(plan("x")), "can't be written")
    library.path.parent.chmod(0o755)


def test_windows_that_add_at_the_same_time_lose_nothing(library):
    errors = []

    def add(n):
        try:
            for k in range(5):
                PlanLibrary(library.path).add(plan(f"plan {n}-{k}"))
        except BadInput as reason:
            errors.append(reason)

    threads = [threading.Thread(target=add, args=(n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert len(library.names()) == 21


def test_a_library_that_another_window_writes_for_long_says_so(library, monkeypatch):
    monkeypatch.setattr("trunnion.shop.library.plan_library.PATIENCE", 0.05)
    with closing(sqlite3.connect(library.path, isolation_level=None)) as database:
        database.execute("BEGIN EXCLUSIVE")
        refused(lambda: library.add(plan("x")), "another window", "try again")
        refused(library.plans, "another window")
        database.execute("ROLLBACK")
    assert library.names() == ("ring A",)


def test_the_folder_is_named_by_option_or_environment(tmp_path, monkeypatch):
    monkeypatch.setenv("TRUNNION_USER_FOLDER", str(tmp_path / "shop"))
    assert library_file(None) == tmp_path / "shop" / "plan-library.sqlite"
    assert library_file(tmp_path) == tmp_path / "plan-library.sqlite"
