"""Scores a recognition against a part's known truth with the scorer that comes with the parts."""

from __future__ import annotations

import importlib.util
import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from parts import PARTS
from trunnion.model.feature import Recognition

Move = Callable[[list[float]], list[float]]


@cache
def scorer_named(name: str) -> Any:
    """Return a scorer that comes with the parts, as a module; a test that needs one is skipped where it is not there."""
    path = (PARTS or Path()).parent / "tools" / f"{name}.py"
    if not path.is_file():
        pytest.skip(f"{path.name} is not beside the parts")
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def truth_of(name: str, family: str = "panel") -> dict[str, Any]:
    """Return the truth of a part."""
    assert PARTS is not None
    return json.loads((PARTS / family / f"{name}.truth.json").read_text())


def scored(
    name: str, file: Path, found: Recognition, move: Move = list, family: str = "panel"
) -> dict[str, Any]:
    """Return recall, precision, faces and roles, and per kind (in the truth, found, matched); `move` says where the truth's points are."""
    scorer, truth = scorer_named("score_recognition"), truth_of(name, family)
    for feature in truth["features"]:
        for face in feature["faces"]:
            face["at"] = move(face["at"])
    faces = scorer.read_faces(file)
    want, lost = scorer.truth_items(truth, scorer.Locator(faces), 1e-3)
    items, faults = scorer.result_items(
        {"features": [f.as_dict() for f in found.features]}, len(faces)
    )
    assert not faults
    return dict(scorer.score(want, items, lost))


def faces_by_kind(family: str, name: str, file: Path) -> dict[str, set[int]]:
    """Return the tags of a file's faces by the kinds of features that the truth of a part has them in."""
    assert PARTS is not None
    scorer = scorer_named("score_recognition")
    truth = json.loads((PARTS / family / f"{name}.truth.json").read_text())
    items, lost = scorer.truth_items(truth, scorer.Locator(scorer.read_faces(file)), 1e-3)
    assert not lost
    found: dict[str, set[int]] = {}
    for item in items:
        found.setdefault(item.kind, set()).update(item.faces)
    return found
