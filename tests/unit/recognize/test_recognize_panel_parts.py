"""Panels with known truth: everything of today's scope is found, the rest is named."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from long_mark import mostly_long
from parts import PARTS, needs_parts
from scoring import scored, truth_of
from trunnion.model.feature import Recognition
from trunnion.part.part import Part
from trunnion.part.read.part_file import read_part
from trunnion.plan.size import size_table
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.settings import choose

pytestmark = needs_parts
PERFECT = {"recall": 1.0, "precision": 1.0, "faces": 1.0, "roles": 1.0}


def file_of(name: str) -> Path:
    assert PARTS is not None
    return PARTS / "panel" / name


def recognized(part: Part) -> Recognition:
    return PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, {}), NO_PROGRESS
    )


@cache
def part_of(name: str) -> tuple[Part, Recognition]:
    part = read_part(file_of(name))
    return part, recognized(part)


def figures(score: dict[str, Any]) -> dict[str, float]:
    return {name: score[name] for name in PERFECT}


@pytest.mark.parametrize("name", ["B1.step", "B1.igs"])
def test_all_of_the_first_panel_is_found(name: str) -> None:
    found = part_of(name)[1]
    assert figures(scored("B1", file_of(name), found)) == PERFECT
    assert found.unexplained == () and found.findings == ()


def test_the_first_panel_lies_in_the_frame_that_a_programmer_would_choose() -> None:
    frame, truth = part_of("B1.step")[1].frame, truth_of("B1")["frame"]
    assert (frame.origin.tolist(), frame.x.tolist(), frame.z.tolist()) == (
        truth["origin"],
        truth["x"],
        truth["z"],
    )


def moved(part: Part, kind: str) -> tuple[Any, Callable[[list[float]], list[float]]]:
    """Return the part's shape moved, and where a point of it is then."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

    way = gp_Trsf()
    if kind == "turned":
        way.SetRotation(gp_Ax1(gp_Pnt(10, 20, 30), gp_Dir(1, 2, 3)), 1.234)
    elif kind == "mirrored":
        way.SetMirror(gp_Ax2(gp_Pnt(5, 0, 0), gp_Dir(1, 1, 0.4)))
    elif kind == "far away":
        way.SetTranslation(gp_Vec(6000, -7000, 4000))

    def move(point: list[float]) -> list[float]:
        return list(gp_Pnt(*point).Transformed(way).Coord())

    return BRepBuilderAPI_Transform(part.as_read, way, True).Shape(), move


@pytest.mark.parametrize(
    ("name", "kind", "unit", "suffix"),
    [
        ("B1", "turned", "mm", "step"),
        ("B1", "mirrored", "mm", "igs"),
        ("B1", "far away", "mm", "step"),
        pytest.param("B1", "", "inch", "step", marks=pytest.mark.long),
        ("B1", "turned", "inch", "igs"),
        pytest.param("B3", "turned", "mm", "igs", marks=pytest.mark.long),
        pytest.param("B3", "mirrored", "mm", "step", marks=pytest.mark.long),
        pytest.param("B3", "far away", "inch", "step", marks=pytest.mark.long),
    ],
)
def test_a_panel_is_found_wherever_it_lies_and_in_inches(
    name: str, kind: str, unit: str, suffix: str, tmp_path: Path
) -> None:
    from trunnion.part.write import write_iges, write_step

    shape, move = moved(part_of(f"{name}.step")[0], kind)
    file = tmp_path / f"{name}.{suffix}"
    (write_step if suffix == "step" else write_iges)(shape, file, unit=unit)
    assert figures(scored(name, file, recognized(read_part(file)), move)) == PERFECT


@pytest.mark.parametrize(
    "name",
    mostly_long(
        [f"B{n}.{suffix}" for n in (2, 3, 4, 5) for suffix in ("step", "igs")],
        "B2.step",
        "B3.step",
        "B5.igs",
    ),
)
def test_all_of_panels_with_pockets_ribs_holes_and_details_is_found(name: str) -> None:
    found = part_of(name)[1]
    score = scored(name[:2], file_of(name), found)
    assert figures(score) == PERFECT and found.unexplained == ()
    wanted, printed, matched = score["kinds"]["hole"]
    assert wanted == printed == matched


@pytest.mark.parametrize(
    "name", mostly_long(["B2.step", "B3.igs", "B4.step", "B5.igs"], "B2.step", "B5.igs")
)
def test_the_sizes_of_holes_are_the_truths(name: str) -> None:
    found, truth = part_of(name)[1], truth_of(name[:2])
    wanted, holes = truth["features"], 0
    straight = found.frame.x @ truth["frame"]["x"] > 0.0
    for i, j in scored(name[:2], file_of(name), found)["given"].items():
        if wanted[i]["kind"] == "hole":
            sizes = found.features[j].sizes
            named = {k: v for k, v in wanted[i]["sizes"].items() if straight or k not in "xy"}
            assert {k: sizes[k] for k in named} == pytest.approx(named, abs=2e-3), wanted[i]["id"]
            holes += 1
    assert holes == truth["counts"]["hole"]


@pytest.mark.parametrize("name", mostly_long(["B3.step", "B3.igs"], "B3.step"))
def test_the_sizes_of_chamfers_and_pits_are_the_truths(name: str) -> None:
    found, wanted = part_of(name)[1], truth_of("B3")["features"]
    seen = []
    for i, j in scored("B3", file_of(name), found)["given"].items():
        if wanted[i]["kind"] in ("chamfer", "pit"):
            sizes, named = found.features[j].sizes, wanted[i]["sizes"]
            assert {k: sizes[k] for k in named} == pytest.approx(named, abs=2e-3), wanted[i]["id"]
            seen.append(wanted[i]["kind"])
    assert sorted(seen) == ["chamfer", "pit", "pit"]


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("B2.step", "panel.leaning-wall"),
        ("B3.step", "panel.curved-floor"),
    ],
)
def test_what_is_not_handled_yet_is_a_finding(name: str, code: str) -> None:
    assert code in {f.code for f in part_of(name)[1].findings}


def test_every_pocket_with_a_leaning_wall_is_told_of_and_none_is_refused() -> None:
    found = part_of("B2.step")[1]
    told = {w for f in found.findings if f.code == "panel.leaning-wall" for w in f.where}
    assert {p.id for p in found.of_kind("pocket")} <= told
    assert not [p.id for p in found.of_kind("pocket") if "refused" in p.attributes]


def test_the_sizes_of_the_first_panel_are_the_truths() -> None:
    found, truth = part_of("B1.step")[1], truth_of("B1")["features"]
    for i, j in scored("B1", file_of("B1.step"), found)["given"].items():
        sizes = found.features[j].sizes
        for name, value in truth[i]["sizes"].items():
            wanted = tuple(value) if isinstance(value, list) else value
            assert name == "in" or sizes[name] == pytest.approx(wanted, abs=2e-3), (
                truth[i]["id"],
                name,
            )


def test_the_size_table_of_the_first_panel_holds_the_planners_sizes() -> None:
    part, found = part_of("B1.step")
    planning, table = truth_of("B1")["planning"], size_table(found, part.graph())
    sizes = {e.name: e.value for e in table if e.feature == "part"}
    assert sizes["smallest_corner_radius"] == planning["smallest_corner_radius"]
    assert [sizes[f"stock_box_{n}"] for n in ("length", "width", "height")] == pytest.approx(
        planning["stock_box"]["size"], abs=1e-3
    )
    assert sorted(e.value for e in table if e.name == "depth") == sorted(
        p["depth"] for p in planning["pockets"]
    )
