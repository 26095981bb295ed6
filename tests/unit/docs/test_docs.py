"""Documentation that is made from the code says what the code says; what is promised to exist exists."""

from __future__ import annotations

import json
import re

import pytest

from parts import ROOT
from trunnion.cli.main import main


def test_the_settings_page_is_what_the_declarations_say(capsys):
    assert main(["settings", "--markdown"]) == 0
    assert capsys.readouterr().out == (ROOT / "docs" / "settings.md").read_text(), "run `make docs`"


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "CONTRIBUTING.md",
        "docs/index.md",
        "docs/batch.md",
        "docs/installing.md",
        "docs/scripts.md",
        "docs/how-a-program-comes-about.md",
        "docs/verification.md",
    ],
)
def test_every_file_that_a_page_links_to_is_there(page):
    folder = (ROOT / page).parent
    for target in re.findall(r"\]\(([^)#:]+)\)", (ROOT / page).read_text()):
        assert (folder / target).exists(), target


def paper_rows() -> list[str]:
    """Return the rows of the table that says how each thing of the surface paper is reached."""
    page = (ROOT / "docs" / "surface.md").read_text().partition("## The paper, line by line")[2]
    return [line for line in page.splitlines() if line.startswith("| ")][1:]


def test_the_papers_table_names_commands_and_options_that_there_are():
    from trunnion.cli.main import parser

    commands = parser()._subparsers._group_actions[0].choices
    rows = paper_rows()
    assert len(rows) > 20 and all(row.count(" | ") == 2 for row in rows)
    for row in rows:
        named = re.findall(r"`(?:trunnion )?([a-z]+)(?: [^`]*)?`", row.split(" | ")[1])
        own = [commands[name] for name in named if name in commands]
        for name in re.findall(r"`trunnion ([a-z]+)", row):
            assert name in commands, row
        known = {o for c in own or [commands["recognize"]] for o in c._option_string_actions}
        assert set(re.findall(r"--[a-z-]+", row)) <= known, row


def test_the_papers_table_names_settings_that_there_are(capsys):
    assert main(["settings", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    keys, labels = {s["key"] for s in listed}, {s["label"] for s in listed}
    named = re.findall(r"--set \"?([a-z_.]+)=", "\n".join(paper_rows()))
    assert len(named) >= 7 and set(named) <= keys
    fields = {"Feature size", "Subdivide", "Similarity", "Sliver", "Wanted Ra", "Scallop height"}
    assert fields <= labels and all(f"*{f}*" in "\n".join(paper_rows()) for f in fields)


def test_every_make_target_that_is_promised_is_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    promised = set()
    for page in ("README.md", "CONTRIBUTING.md"):
        promised |= set(re.findall(r"\bmake ([a-z]+(?:-[a-z]+)*)", (ROOT / page).read_text()))
    assert promised - targets == set()
    assert {"setup", "demo", "test", "test-long", "bench", "screenshots", "run"} <= targets
