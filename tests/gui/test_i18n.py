"""Words in other languages."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import pytest

import trunnion_gui
import trunnion_resources
from trunnion_gui import i18n

LANGUAGES = [name for name in i18n.languages() if name != "en"]
CALLS = {"tr": (0,), "command": (1, 5), "switch": (1, 4)}
"""Where a call carries words for the person: `tr(words)`, `command(id, words, …, help)`, `switch(id, words, …, help)`."""


def words_in_the_code() -> set[str]:
    """Return every text that the code asks a translation of in so many words."""
    found = set()
    for path in Path(trunnion_gui.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id in CALLS
            ):
                arguments = [node.args[n] for n in CALLS[node.func.id] if n < len(node.args)]
                found |= {
                    a.value
                    for a in arguments
                    if isinstance(a, ast.Constant) and isinstance(a.value, str) and a.value
                }
    return found


def table(language: str) -> dict[str, str]:
    return json.loads(
        (trunnion_resources.folder("translations") / f"{language}.json").read_text("utf-8")
    )


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_of_the_window_is_translated(language):
    assert sorted(words_in_the_code() - set(table(language))) == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_translation_keeps_the_places_for_values(language):
    for text, translated in table(language).items():
        assert sorted(re.findall(r"{\w+}", text)) == sorted(re.findall(r"{\w+}", translated)), text


def test_an_unknown_text_stays_as_it_is():
    i18n.use("zh_CN")
    assert i18n.tr("no such words") == "no such words"
    assert i18n.tr("Undo") == "撤销"
    i18n.use("en")
