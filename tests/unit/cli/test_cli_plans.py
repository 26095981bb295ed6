"""`trunnion plans`: a finished process is added, listed, shown, matched and removed, in words and as JSON; errors are one line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import samples
from trunnion.cli.main import BAD, DONE, main


def sibling_block() -> Any:
    """Return the block with a pocket elsewhere in space: another file of a part that is wholly alike."""
    return samples.moved(samples.block_with_pocket_shape(), (5.0, 0.0, 0.0))


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return what a command prints, once it is done well."""
    assert main(list(arguments)) == DONE
    return capsys.readouterr().out


def refusal(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the one line that a command is refused with."""
    assert main(list(arguments)) == BAD
    found = capsys.readouterr()
    assert found.out == "" and len(found.err.strip().splitlines()) == 1
    return found.err


@pytest.fixture
def shop(tmp_path: Path) -> list[str]:
    folder = tmp_path / "shop"
    folder.mkdir()
    return ["--user-folder", str(folder)]


def test_a_process_goes_in_is_found_again_followed_and_taken_out(
    shop: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    taught, part = str(samples.block_with_pocket()), str(samples.written(sibling_block()))
    added = json.loads(
        said(
            capsys,
            *("plans", "add", taught, "--name", "block", "--date", "2026-03-01", "--json", *shop),
        )
    )
    assert added["file"].endswith("plan-library.sqlite")
    assert (added["plan"]["name"], added["plan"]["date"]) == ("block", "2026-03-01")
    assert added["plan"]["stages"] and added["plan"]["operations"]

    (listed,) = json.loads(said(capsys, "plans", "list", "--json", *shop))["plans"]
    assert listed == added["plan"]
    assert json.loads(said(capsys, "plans", "show", "block", "--json", *shop)) == listed
    assert "block" in said(capsys, "plans", "list", *shop)
    shown = said(capsys, "plans", "show", "block", *shop)
    assert "2026-03-01" in shown and listed["stages"][0]["name"] in shown

    found = json.loads(said(capsys, "plans", "match", part, "--json", *shop))
    (match,) = found["matches"]
    assert (match["name"], match["similarity"], found["followed"]) == ("block", 1.0, "block")
    assert "the same sizes" in match["reasons"]
    assert found["signature"] == listed["signature"]
    # The part itself needs no plan of its own.
    own = json.loads(said(capsys, "plans", "match", taught, "--json", *shop))
    assert own["matches"][0]["similarity"] == 1.0 and own["followed"] is None
    words = said(capsys, "plans", "match", part, "--quiet", *shop)
    assert "100 %" in words and "a route follows block" in words

    route = json.loads(said(capsys, "route", part, "--json", *shop))
    assert route["plan"] == "block"
    assert "route.library" in {f["code"] for f in route["findings"]}

    assert json.loads(said(capsys, "plans", "remove", "block", "--json", *shop)) == {
        "file": added["file"],
        "removed": "block",
    }
    assert "no plans" in said(capsys, "plans", "list", *shop)
    assert json.loads(said(capsys, "plans", "match", part, "--json", *shop))["matches"] == []


def test_what_is_not_there_is_one_line_and_exit_2(
    shop: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    for command in ("show", "remove"):
        assert "there is no plan block" in refusal(capsys, "plans", command, "block", *shop)


def test_a_damaged_library_is_one_line_and_exit_2(
    shop: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    (Path(shop[1]) / "plan-library.sqlite").write_bytes(b"no library " * 99)
    line = refusal(capsys, "plans", "list", *shop)
    assert "damaged" in line and "move the file away" in line


def test_a_folder_that_is_missing_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    part = str(samples.block_with_pocket())
    line = refusal(capsys, "plans", "add", part, "--name", "x", "--user-folder", "/no/such/folder")
    assert "/no/such/folder" in line


@pytest.mark.parametrize("arguments", [["plans"], ["plans", "add"], ["plans", "sing"]])
def test_a_call_it_does_not_understand_is_one_line(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == BAD
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
