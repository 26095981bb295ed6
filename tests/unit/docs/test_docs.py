"""Documentation that is made from the code says what the code says; what is promised to exist exists."""

from __future__ import annotations

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
        "docs/how-a-program-comes-about.md",
        "docs/verification.md",
    ],
)
def test_every_file_that_a_page_links_to_is_there(page):
    folder = (ROOT / page).parent
    for target in re.findall(r"\]\(([^)#:]+)\)", (ROOT / page).read_text()):
        assert (folder / target).exists(), target


def test_every_make_target_that_is_promised_is_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    promised = set()
    for page in ("README.md", "CONTRIBUTING.md"):
        promised |= set(re.findall(r"\bmake ([a-z]+(?:-[a-z]+)*)", (ROOT / page).read_text()))
    assert promised - targets == set()
    assert {"setup", "demo", "test", "test-long", "bench", "screenshots", "run"} <= targets
