"""Family is a seam: outside its own packages no module names a family, a kind of feature or a strategy."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import trunnion
from trunnion import registry

CORE = Path(trunnion.__file__).parent
OWN = (
    "recognize/panel",
    "recognize/surface",
    "recognize/casing",
    "recognize/impeller",
    "plan/panel",
    "plan/surface",
    "toolpath/plane",
    "toolpath/surface",
)
"""Packages of families and of strategies, which may name what is theirs."""
OF_KINDS = ("plan/prismatic",)
"""Packages with rules for kinds of features, which any planner calls."""
KINDS = frozenset({"pocket", "open_pocket", "island", "rib", "profile", "datum", "group"})
OTHER_WORDS = {
    "geometry/facegraph.py": {
        "surface"
    },  # the column of a face graph that has the form of each face
    "shop/cutters.py": {"surface"},  # a use of cutters
}
"""Words that mean something else where they stand."""
STILL = {
    "report/palette.py": {"group"},  # colours of groups: a family's legend is to come from its view
    "store/features.py": {
        "pocket",
        "open_pocket",
        "island",
    },  # the paper's model of a pocket in the features' XML
}
"""What is left to become a declaration."""


def words_in(path: Path) -> Iterator[str]:
    """Give the texts of a module that are whole constants, apart from docstrings' sentences."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def named() -> dict[str, set[str]]:
    """Return the words of families, kinds and strategies by the module that has them, own packages left out."""
    families = {
        *registry.names("families"),
        *registry.names("part_kinds"),
        *registry.names("planners"),
    }
    strategies = set(registry.names("strategies"))
    words = families | strategies | {f"{name.partition('.')[0]}." for name in strategies}
    found: dict[str, set[str]] = {}
    for path in sorted(CORE.rglob("*.py")):
        name = path.relative_to(CORE).as_posix()
        if not name.startswith(tuple(f"{own}/" for own in OWN)):
            asked = (
                words if name.startswith(tuple(f"{own}/" for own in OF_KINDS)) else words | KINDS
            )
            found[name] = (set(words_in(path)) & asked) - OTHER_WORDS.get(name, set())
    return {name: hits for name, hits in found.items() if hits}


def test_no_module_outside_a_family_s_packages_names_a_family_a_kind_or_a_strategy() -> None:
    assert named() == STILL


def test_kinds_are_those_that_families_make() -> None:
    made = {word for own in OWN for path in (CORE / own).rglob("*.py") for word in words_in(path)}
    assert made >= KINDS
