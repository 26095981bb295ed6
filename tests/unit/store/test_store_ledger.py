"""The ledger of a batch: what was written is read again, and damage is named."""

from __future__ import annotations

import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from trunnion.findings import BadInput
from trunnion.model.part_result import PartResult
from trunnion.store.ledger import LEDGER_FILE, LedgerEntry, read_ledger, write_ledger

RIB = LedgerEntry(
    file="../rib.step",
    digest="5f",
    result=PartResult(
        part="rib.step",
        folder="rib",
        verdict="failed",
        coverage=0.9987,
        collisions=2,
        seconds=12.5,
        note="Rippe über Kante",
        reasons={"verify.gouge": 3},
        files=("rib.S1.REJECTED.nc", "rib.report.html"),
    ),
)
TEXTS = st.text(max_size=6)
RESULTS = st.builds(
    PartResult,
    part=TEXTS,
    folder=TEXTS,
    verdict=TEXTS,
    coverage=st.none() | st.floats(0.0, 1.0),
    collisions=st.none() | st.integers(0, 9),
    note=TEXTS,
    reasons=st.dictionaries(TEXTS, st.integers(1, 9), max_size=3),
    files=st.lists(TEXTS, max_size=3).map(tuple),
)


def test_a_folder_without_a_ledger_has_no_entries(tmp_path):
    assert read_ledger(tmp_path) == ()


def test_an_entry_is_one_line_of_json(tmp_path):
    write_ledger(tmp_path, [RIB, RIB])
    first, second = (tmp_path / LEDGER_FILE).read_text(encoding="utf-8").splitlines()
    assert first == second and "über" in first
    assert json.loads(first)["result"]["reasons"] == {"verify.gouge": 3}


@settings(max_examples=30, suppress_health_check=[HealthCheck.too_slow])
@given(results=st.lists(RESULTS, max_size=4))
def test_what_is_written_is_read_again(tmp_path_factory, results):
    folder = tmp_path_factory.mktemp("ledger")
    entries = tuple(LedgerEntry(file=f"{n}", digest="d", result=r) for n, r in enumerate(results))
    write_ledger(folder, entries)
    assert read_ledger(folder) == entries


@pytest.mark.parametrize(
    "line",
    [
        '{"file": "rib.st',
        '{"file": "a", "digest": "b"}',
        '["a"]',
        '{"file": "a", "digest": "b", "result": {"part": 3, "folder": "a", "verdict": "passed"}}',
        '{"file": "a", "digest": "b", "result": {"part": "a"}}',
        '{"file": "a", "digest": "b", "result": null}',
    ],
)
def test_a_damaged_line_is_named_with_what_to_do(tmp_path, line):
    write_ledger(tmp_path, [RIB])
    with (tmp_path / LEDGER_FILE).open("a") as ledger:
        ledger.write(line + "\n")
    with pytest.raises(BadInput, match=r"line 2: no entry of a batch's ledger .*delete the line"):
        read_ledger(tmp_path)
