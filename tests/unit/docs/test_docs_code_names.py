"""The page on how a program comes about names modules and classes that are there."""

from __future__ import annotations

import importlib
import re

import pytest

from parts import ROOT

PAGE = (ROOT / "docs" / "how-a-program-comes-about.md").read_text()
PACKAGES = sorted(
    p.name for p in (ROOT / "core" / "trunnion").iterdir() if (p / "__init__.py").is_file()
)
NAMES = sorted(set(re.findall(rf"`((?:{'|'.join(PACKAGES)})(?:\.\w+)+)`", PAGE)))
DIAGRAM = sorted(
    {word for block in re.findall(r"(?m)^ {4}.*$", PAGE) for word in re.findall(r"\w+", block)}
)


def there(name: str) -> bool:
    """Say whether a dotted name below `trunnion` is a module, or something in one."""
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(["trunnion", *parts[:k]]))
        except ModuleNotFoundError:
            continue
        for part in parts[k:]:
            if not hasattr(found, part):
                return False
            found = getattr(found, part)
        return True
    return False


@pytest.mark.parametrize("name", NAMES)
def test_every_code_name_on_the_page_is_there(name):
    assert there(name), name


def test_the_page_names_enough_to_be_worth_checking_and_the_check_can_fail():
    assert len(NAMES) > 40
    assert not there("model.session.Sessions")
    assert not there("model.sessions.Session")


def test_the_diagram_uses_names_that_the_page_explains():
    classes = {w for w in DIAGRAM if re.fullmatch(r"(?:[A-Z][a-z]+){2,}", w)}
    assert {"FaceGraph", "ProcessTree", "PlanningStock", "PostedFile"} <= classes
    assert classes - {name.rsplit(".", 1)[-1] for name in NAMES} == set()


def test_every_floor_that_makes_data_stands_on_the_page():
    for package in ("part", "recognize", "plan", "toolpath", "post", "verify", "pipeline", "store"):
        assert any(name.startswith(f"{package}.") for name in NAMES), package
