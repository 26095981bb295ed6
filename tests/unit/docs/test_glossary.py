"""Names are words of the glossary or plain words, and one name means one thing."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from parts import ROOT

SOURCES = (ROOT / "core" / "trunnion", ROOT / "gui" / "trunnion_gui")
MODULES = [path for source in SOURCES for path in sorted(source.rglob("*.py"))]

PROGRAMS = """
access actions app appearance arrays atomic attributes bars base batch build builder cache call chart
check child choice class cli click code column command common compiled compiling context contract
count declared dialog display document drawing drawn edits engine example export fallback file finder foldout form
gc gui handlers history html i18n icons identity info input interpreter job judge keys kind label
language layout legend locator look main manual mapping members memory menus message metadata metric model
module notice number numbers offer owner painted palette pane parameters parser picker picture pipeline
player page plot preferences printed problem project properties query read readers reading record recovery reply
report request requirement result role rules scene screen screenshots search selection severity
shared sharing snapshot source state statements status storage store sync table text theme threads
tracer transfer trunnion units version view viewport welcome widgets window write writer writing written
xml
"""
"""Plain words of programs and windows."""

SHAPES = """
above angles arc boundary bounded bounds collapses column constant corner cost curve direction distance
exact extreme figure fit fitting general geometry grid grow intersection lattice least limits
locations measure measuring meshing one order ordered parallel path piece planned points radii
radius range raw samples segment shape side slopes smallest space spacing sphere symmetry three
time timing tracing
"""
"""Plain words of geometry and arithmetic."""

EVERY_DAY = """
accuracy allowed alternatives arrangement attempts bad bar cancelled candidates change colour
colouring confirm confirmed contouring dense details estimated evaluate execution external finish
finished for free generate linking milled milling moment mover moves needs offsetting opened
optimize passed patched pick planning posted rated recognize refine refined refused ridged
rough round row run scale score shortest slicer slicing slider start suppression taken tally
trial unexplained unsaved verify worst
"""
"""Plain words of a workshop and of every day."""

PLAIN = set((PROGRAMS + SHAPES + EVERY_DAY).split())
"""Words in names that need no line in the glossary: anybody who reads English or code knows them."""

BEFORE = """
answer answers ask asked asker asking asks beside chosen clear closer course courses crowded draft
going hand hands having keeping leaving left making manner manners meeting parcel place placed
places placing quiet reckoning room rooms said say says shell shells shown stand standing stands
stood straying swing tell tells tidy tidying told touch touched touches verb verbs way ways whose
wish wished wishes
"""
PRIVATE = frozenset(BEFORE.split())
"""Words that names had before the glossary, or that say a thing of everyday talk instead of the field's."""

ALLOWED = {
    "clear": "any_clear clear clear_area first_clear is_clear is_clear_of_walls clear_of clear_of_corners",
    "hand": "by_hand hand",
    "hands": "hands",
    "left": "is_left left left_max left_mean left_min left_normal left_of left_width",
    "beside": "beside",
    "places": "places tool_places",
    "shell": "shell",
    "shells": "shells shells_of",
    "shown": "is_shown most_shown settings_shown shown shown_motions",
    "straying": "rapid_straying straying",
    "way": "way",
}
"""Names that keep such a word, in small letters and without leading underscores.

`clear`: of contact, or emptied; `hand`: a tool's, and made by one, a key of project files; `left`: a side, and keys of the verdict;
`beside`, `places`, `straying`, `way`: parts of digests, keys of project files, of the catalogue and of settings; `shell`: of faces;
`shown`: in a window, or as text.
"""

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


@dataclass(frozen=True)
class Given:
    """Names that a module gives: its public classes, and all of functions, methods, parameters, fields, attributes and variables."""

    classes: list[str]
    names: set[str]


@cache
def given_by(path: Path) -> Given:
    """Return the names that a module gives; not worked out while tests are collected."""
    tree, names = ast.parse(path.read_text()), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.arg):
            names.add(node.arg)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            names.add(node.attr)
    classes = [n.name for n in tree.body if isinstance(n, ast.ClassDef)]
    return Given([name for name in classes if not name.startswith("_")], names)


def by_module(found: Callable[[Path], Mapping[str, set[str]]]) -> dict[str, Mapping[str, set[str]]]:
    """Return what is found in the names of each module that has any, by its path."""
    return {str(p.relative_to(ROOT)): names for p in MODULES if (names := found(p))}


def private_words(name: str) -> set[str]:
    """Return the private words of a name that may not have them."""
    bare = name.strip("_").lower()
    return {w for w in words_of(name) if w in PRIVATE and bare not in ALLOWED.get(w, "").split()}


@cache
def known_words() -> set[str]:
    return {w for row in GLOSSARY for w in words_of(row[0])} | PLAIN


def singulars(word: str) -> set[str]:
    ends = (("", ""), ("s", ""), ("es", ""), ("es", "is"), ("ies", "y"))
    return {word[: len(word) - len(end)] + new for end, new in ends if word.endswith(end)}


def strange_words(name: str) -> set[str]:
    """Return the words of a name that are neither in the glossary nor plain."""
    known = known_words()
    return {w for w in words_of(name) if not singulars(w) & known}


def test_modules_and_classes_have_words_of_the_glossary_or_plain_ones():
    def strange(path):
        own = path.parent.name if path.stem == "__init__" else path.stem
        names = [own, *given_by(path).classes]
        return {name: words for name in names if (words := strange_words(name))}

    assert by_module(strange) == {}, "use the field's word, and give it a line in docs/words.md"


def test_a_private_word_is_found():
    assert strange_words("RoomManner") == {"room", "manner"}
    assert strange_words("tool_axis") == set()
    assert strange_words("AxesAndBodies") == {"and"}


def test_no_class_has_a_private_word():
    named = {name for path in MODULES for name in given_by(path).classes}
    assert {n for n in named if set(words_of(n)) & PRIVATE} == set()


def test_no_function_parameter_or_variable_has_a_private_word():
    def private(path):
        return {name: words for name in given_by(path).names if (words := private_words(name))}

    assert by_module(private) == {}, (
        "use the field's word of docs/words.md; one word for one meaning"
    )


def test_a_private_word_in_any_name_is_found():
    assert private_words("_ask_states") == {"ask"}
    assert private_words("places_told") == {"places", "told"}
    assert private_words("_left_of") == private_words("axis_position") == set()


def test_every_allowed_name_is_in_use():
    given = {name.strip("_").lower() for path in MODULES for name in given_by(path).names}
    assert {name for names in ALLOWED.values() for name in names.split()} - given == set()


def test_a_class_name_means_one_thing():
    where = defaultdict(list)
    for path in MODULES:
        for name in given_by(path).classes:
            where[name].append(path.name)
    assert {n: w for n, w in where.items() if len(w) > 1 and n not in TWICE} == {}


def test_every_plain_word_is_in_use():
    used = {
        form
        for path in MODULES
        for name in (path.stem, path.parent.name, *given_by(path).classes)
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
