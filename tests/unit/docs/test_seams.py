"""Family is a seam: outside its own packages no module names a family, a kind of feature or a strategy."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import trunnion
import trunnion_gui
from trunnion import registry
from trunnion.recognize.contract import feature_kinds

HOUSES = (Path(trunnion.__file__).parent, Path(trunnion_gui.__file__).parent)
NAMES = {*registry.names("families"), *registry.names("part_kinds"), *registry.names("planners")}
PREFIXES = {name.partition(".")[0] for name in registry.names("strategies")}
DOTTED = {f"{word}." for word in NAMES | PREFIXES}
"""How groups of settings, strategies and findings of a family or a folder of strategies begin."""
OWN = tuple(
    f"{floor}/{name}" for floor in ("recognize", "plan", "families", "cli") for name in NAMES
) + tuple(f"toolpath/{prefix}" for prefix in PREFIXES)
"""Packages (or modules) of families and of strategies, which may name what is theirs."""
OF_KINDS = "plan/prismatic"
"""The package with rules for kinds of features, which any planner calls."""
ALSO_SURFACES_AND_CYCLES = {"plane", "bore"}
"""Kinds of features whose word is a surface's or a drilling cycle's as well, which any module may name."""
OTHER_WORDS = {
    # the column of a face graph with the form of each face
    "trunnion/geometry/facegraph.py": {"surface"},
    # a use of cutters, as catalogue files write it
    "trunnion/shop/cutters.py": {"surface"},
    # what FreeCAD's libraries call a place of the tool changer, and one of its shapes of tools
    "trunnion/shop/exchange/formats/freecad/library.py": {"pocket"},
    "trunnion/shop/exchange/formats/freecad/shapes.py": {"chamfer"},
    # the numbered seat of a tool in a magazine
    "trunnion/shop/crib.py": {"pocket"},
    "trunnion/cli/tools.py": {"pocket"},
    # keys of operations' choices in saved processes: of drives on curved faces, which any planner makes
    "trunnion/plan/freeform/keys.py": {"surface."},
    "trunnion/plan/freeform/lands.py": {"surface."},
    # codes of findings that the strategies on curved faces share, beside what they share
    "trunnion/toolpath/contact_passes/choices.py": {"surface."},
    "trunnion/toolpath/contact_passes/upright/fixed_axis.py": {"surface."},
    # codes of findings on holes, and the settings of drilling, which planners read to know how deep a drill goes
    "trunnion/plan/holes/drive.py": {"hole."},
    "trunnion/plan/holes/settings.py": {"hole."},
    "trunnion/toolpath/motion/hole_access.py": {"hole."},
    "trunnion/toolpath/motion/finished_bores.py": {"hole."},
    # the settings of cutting pits, which planners read to know which cutters get in
    "trunnion/plan/prismatic/pits.py": {"plane."},
    # the kind of features that is recognised alike in parts of every family
    "trunnion/recognize/holes/features.py": {"hole"},
    # what a fit in a STEP file is of, a hole or a shaft
    "trunnion/part/read/step_dimensions.py": {"hole"},
    # an element of the features' schema
    "trunnion/store/features.py": {"island"},
}
"""Words that mean something else where they stand."""


def modules() -> Iterator[tuple[str, Path]]:
    """Give the modules that no family and no strategy has to itself, with a name to report."""
    for house in HOUSES:
        for path in sorted(house.rglob("*.py")):
            name = path.relative_to(house).with_suffix("").as_posix()
            if not any(name == own or name.startswith(f"{own}/") for own in OWN):
                yield f"{house.name}/{name}.py", path


@cache
def nodes_of(path: Path) -> list[ast.AST]:
    """Return the constants and imports of a module."""
    kinds = (ast.Constant, ast.ImportFrom, ast.Import)
    return [n for n in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(n, kinds)]


def words_in(path: Path) -> Iterator[str]:
    """Give the texts of a module that are whole constants, and what stands up to the first dot of dotted ones (`plane.`)."""
    for node in nodes_of(path):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
            head, dot, _ = node.value.partition(".")
            if dot and " " not in node.value:
                yield head + dot


def imported(path: Path) -> Iterator[str]:
    """Give the modules that a module imports, as paths."""
    for node in nodes_of(path):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.replace(".", "/")
        elif isinstance(node, ast.Import):
            yield from (alias.name.replace(".", "/") for alias in node.names)


def test_no_module_outside_a_familys_packages_names_a_family_a_kind_or_a_strategy() -> None:
    named = {}
    for name, path in modules():
        kinds = set() if f"/{OF_KINDS}/" in name else set(feature_kinds())
        asked = (NAMES | DOTTED | kinds) - ALSO_SURFACES_AND_CYCLES - OTHER_WORDS.get(name, set())
        if hits := set(words_in(path)) & asked:
            named[name] = hits
    assert named == {}


def test_no_module_outside_a_familys_packages_imports_from_them() -> None:
    met = {}
    for name, path in modules():
        own = tuple(f"{name.partition('/')[0]}/{package}" for package in OWN)
        hits = {i for i in imported(path) if f"{i}/".startswith(tuple(f"{o}/" for o in own))}
        if hits:
            met[name] = hits
    assert met == {}


def test_words_that_mean_something_else_are_there() -> None:
    """An exception that nobody needs any more goes."""
    there = dict(modules())
    for name, words in OTHER_WORDS.items():
        assert words <= set(words_in(there[name])), name
