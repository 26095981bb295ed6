"""Real parts that others have published: holes as counted in their index, faces as their labels say, and no face without a word."""

from __future__ import annotations

import csv
import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from parts import PARTS, needs_parts
from scoring import scorer_named
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(900), needs_parts]
PUBLIC = (PARTS or Path()) / "public"
HOLED = (
    "nist/nist_ctc_01_asme1_ap242_colored.stp",
    "nist/nist_ctc_02_asme1_ap242-1.stp",
    "prismatic/ANC101.stp",
    "prismatic/control_arm.step",
    "prismatic/frame.step",
    "prismatic/nist_mtc_crada_plate.STEP",
)
WIDEST = "200"
"""mm: the index counts bores of any width, which are pockets to a panel otherwise."""


def counted() -> dict[str, int]:
    """Return the number of axes with a whole hollow cylinder of each of the parts, as the index has them."""
    with (PUBLIC / "INDEX.tsv").open() as index:
        rows = list(csv.DictReader(index, delimiter="\t"))
    return {
        r["path"]: int(r["hole_axes_full_concave_cylinders"]) for r in rows if r["path"] in HOLED
    }


def recognised(file: Path, **choices: str) -> tuple[Engine, Any]:
    engine = Engine()
    session = engine.with_choices(engine.open(file), choices)
    return engine, engine.run(session, until="recognize")


def hole_axes(engine: Engine, session: Any) -> int:
    """Return the number of lines that holes lie on which are closed all round."""
    graph, lines = engine.context_of(session).part.graph(), list[tuple[np.ndarray, np.ndarray]]()
    for hole in session.recognition.of_kind("hole"):
        if hole.attributes.get("open_side"):
            continue
        row = next(t - 1 for t in hole.tags if graph.surface[t - 1] == "cylinder")
        axis, point = graph.axis[row], graph.axis_point[row]
        if not any(
            abs(axis @ other) > 1.0 - 1e-9 and np.linalg.norm(np.cross(point - there, axis)) < 0.01
            for other, there in lines
        ):
            lines.append((axis, point))
    return len(lines)


@pytest.mark.parametrize("name", HOLED)
def test_every_hole_axis_of_the_index_is_found(name) -> None:
    found = recognised(PUBLIC / name, **{"recognize.panel.hole_diameter": WIDEST})
    assert hole_axes(*found) == counted()[name]


def test_faces_of_mfcad_are_what_their_labels_say_and_none_is_without_a_word() -> None:
    scorer, right = scorer_named("score_mfcad"), Counter[bool]()
    for file in sorted((PUBLIC / "mfcad").glob("*.step")):
        _, session = recognised(file)
        found, n_faces = session.recognition, session.part.n_faces
        named = {w for f in session.findings() for w in f.where}
        covered = {t for f in found for t in f.tags}
        silent = [t for t in range(1, n_faces + 1) if t not in covered and f"face {t}" not in named]
        assert not silent, f"{file.name}: no word on faces {silent}"
        labels = json.loads(file.with_suffix(".labels.json").read_text())["labels"]
        classes = scorer.result_classes(
            {"features": [f.as_dict() for f in found.features]}, n_faces
        )
        for tag, label in labels.items():
            wanted = scorer.label_class(label)
            if wanted != "stock":
                right[wanted == classes[int(tag) - 1]] += 1
    assert right[True] / right.total() >= 0.90
