"""Names are words of the glossary or plain words, and one name means one thing."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from pathlib import Path

import pytest

from parts import ROOT

SOURCES = (ROOT / "core" / "trunnion", ROOT / "gui" / "trunnion_gui")
MODULES = [path for source in SOURCES for path in sorted(source.rglob("*.py"))]

PROGRAMS = """
access actions app appearance arrays atomic attributes bars base batch build builder cache call chart
check child choice class cli click code column command common compiled compiling context contract
count declared dialog display document drawing drawn edits engine export fallback file finder foldout form
gc gui handlers history html i18n icons identity info input interpreter job judge keys kind label
language layout legend look main manual mapping members memory menus message metadata metric model
notice number numbers offer owner painted palette pane parameters parser picker picture pipeline
player preferences project properties query read readers reading record recovery reply
report request requirement result role rules scene screen screenshots search selection severity
shared sharing snapshot source state statements status storage store sync table text theme threads
tracer transfer trunnion units view viewport welcome widgets window write writer writing written
xml
"""
"""Plain words of programs and windows."""

SHAPES = """
above angles arc boundary bounded bounds column constant corner cost curve direction distance
exact extreme figure fit fitting general geometry grid grow intersection lattice least limits
locations measure measuring meshing one order ordered parallel path piece planned points radii
radius range raw samples segments shape side slopes smallest space spacing sphere symmetry three
time timing tracing
"""
"""Plain words of geometry and arithmetic."""

EVERY_DAY = """
accuracy allowed alternatives arrangement attempts bad bar cancelled candidates change colour colouring confirm confirmed
contouring dense estimated evaluate execution external finish finished for free generate going linking
milled milling moment mover moves needs offsetting opened optimize passed patched pick planning
posted rated recognize refine refined refused ridged round row rough run scale score shortest slicer slicing slider
suppression taken tally trial unexplained unsaved verify worst
"""
"""Plain words of a workshop and of every day."""

PLAIN = set((PROGRAMS + SHAPES + EVERY_DAY).split())
"""Words in names that need no line in the glossary: anybody who reads English or code knows them."""

BEFORE = """
ask asker asking beside chosen clear closer course crowded draft going hand having keeping leaving
making manner meeting parcel placing quiet reckoning room say shell shown stands stood straying
swing tell tidying told touch verbs way whose wishes
"""
PRIVATE = frozenset(BEFORE.split())
"""Words that names had before the glossary, or that say a thing of everyday talk instead of the field's."""

STILL = {"Going", "SwingSphere"}
"""Classes whose names keep one: a swing is the field's word for a tool that turns; the other is inside the stock engine."""

TWICE = {
    "ExactFace": "a protocol of planning, and the class of `part` that meets it",
    "ExactPoints": "a protocol of planning, and the class of `part` that meets it",
    "Engagement": "the largest that is foreseen, and what the proof measured",
}
"""Class names that stand twice, and why."""


def rows_of(page: str) -> list[list[str]]:
    """Return the rows of the glossary's tables: term, meaning, unit, source."""
    found = [
        [cell.strip() for cell in line.strip().strip("|").split(" | ")]
        for line in page.splitlines()
        if line.startswith("| ")
    ]
    return [row for row in found if len(row) == 4 and row[0] != "term"]


GLOSSARY = rows_of((ROOT / "docs" / "words.md").read_text())


def words_of(name: str) -> list[str]:
    """Return the words of a name, camel case and underscores parted: `HTTPServer_two` is http, server, two."""
    return [w.lower() for w in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+|[0-9]+", name)]


def classes_of(path: Path) -> list[str]:
    """Return the public classes of a module."""
    body = ast.parse(path.read_text()).body
    return [n.name for n in body if isinstance(n, ast.ClassDef) and not n.name.startswith("_")]


def known_words() -> set[str]:
    return {w for row in GLOSSARY for w in words_of(row[0])} | PLAIN


def singulars(word: str) -> set[str]:
    ends = (("", ""), ("s", ""), ("es", ""), ("es", "is"), ("ies", "y"))
    return {word[: len(word) - len(end)] + new for end, new in ends if word.endswith(end)}


def strange_words(name: str) -> set[str]:
    """Return the words of a name that are neither in the glossary nor plain."""
    known = known_words()
    return {w for w in words_of(name) if not singulars(w) & known}


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(ROOT)))
def test_modules_and_classes_have_words_of_the_glossary_or_plain_ones(path):
    own = [path.parent.name if path.stem == "__init__" else path.stem, *classes_of(path)]
    strange = {name: words for name in own if (words := strange_words(name))}
    assert strange == {}, "use the field's word, and give it a line in docs/words.md"


def test_a_private_word_is_found():
    assert strange_words("RoomManner") == {"room", "manner"}
    assert strange_words("tool_axis") == set()
    assert strange_words("AxesAndBodies") == {"and"}


def test_no_class_has_a_private_word():
    named = {name for path in MODULES for name in classes_of(path)}
    assert {n for n in named if set(words_of(n)) & PRIVATE} - STILL == set()


def test_a_class_name_means_one_thing():
    where = defaultdict(list)
    for path in MODULES:
        for name in classes_of(path):
            where[name].append(path.name)
    assert {n: w for n, w in where.items() if len(w) > 1 and n not in TWICE} == {}


def test_every_plain_word_is_in_use():
    used = {
        form
        for path in MODULES
        for name in (path.stem, path.parent.name, *classes_of(path))
        for w in words_of(name)
        for form in singulars(w)
    }
    assert PLAIN - used == set()


@pytest.mark.parametrize("row", GLOSSARY, ids=lambda row: row[0])
def test_a_term_has_one_sentence_a_unit_and_a_source(row):
    term, meaning, unit, source = row
    assert meaning.endswith(".") and meaning.count(". ") == 0, meaning
    assert meaning[0].isupper() and term and unit and source


def test_no_term_stands_twice():
    terms = Counter(t.strip() for row in GLOSSARY for t in row[0].split(","))
    assert len(GLOSSARY) > 150
    assert {t for t, n in terms.items() if n > 1} == set()
