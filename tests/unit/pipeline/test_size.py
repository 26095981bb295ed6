"""The size table: names, faces and points of what was measured."""

from __future__ import annotations

from dataclasses import replace

import pytest

from blockparts import terrace
from trunnion import registry
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.session import SizeEntry
from trunnion.plan.size import size_table
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.contract import Smallest
from trunnion.recognize.panel import PanelFamily
from trunnion.settings import choose

PART = terrace(
    (0, 10, 50, 54, 90, 100),
    (0, 10, 50, 60),
    [[40.0] * 5, [40.0, 5.0, 30.0, 8.0, 40.0], [40.0] * 5],
)


@pytest.fixture(scope="module")
def table() -> tuple[SizeEntry, ...]:
    graph = PART.graph()
    return size_table(
        PanelFamily().recognize(graph, PART, choose(PanelFamily.settings, {}), NO_PROGRESS), graph
    )


def one(table: tuple[SizeEntry, ...], feature: str, name: str) -> SizeEntry:
    (entry,) = [e for e in table if e.feature == feature and e.name == name]
    return entry


def test_the_part_has_length_width_and_height(table: tuple[SizeEntry, ...]) -> None:
    assert [one(table, "part", n).value for n in ("length", "width", "height")] == [
        100.0,
        60.0,
        40.0,
    ]


def test_a_depth_is_measured_at_the_floor(table: tuple[SizeEntry, ...]) -> None:
    entry = one(table, "pocket-01", "depth")
    assert entry.unit == "mm" and len(entry.faces) == 1
    assert entry.at[2] + entry.value == 40.0


def test_a_rib_has_thickness_and_heights(table: tuple[SizeEntry, ...]) -> None:
    assert [
        one(table, "rib-01", n).value for n in ("thickness", "height", "lower_height", "length")
    ] == [4.0, 25.0, 22.0, 40.0]


def test_the_thinnest_rib_is_a_size_of_the_part(table: tuple[SizeEntry, ...]) -> None:
    assert one(table, "part", "thinnest_rib").value == 4.0


def test_leans_are_degrees_one_entry_each(table: tuple[SizeEntry, ...]) -> None:
    entry = one(table, "pocket-01", "lean")
    assert (entry.value, entry.unit) == (0.0, "degrees")


def test_every_size_is_of_a_feature_or_of_the_part(table: tuple[SizeEntry, ...]) -> None:
    assert {e.feature for e in table} == {
        "part",
        "pocket-01",
        "pocket-02",
        "rib-01",
        "profile-01",
        "datum-01",
    }


@pytest.mark.parametrize(
    ("name", "unit"),
    [("area", "mm2"), ("size_ratio", ""), ("lean", "degrees"), ("boundary_length", "mm")],
)
def test_a_size_is_in_the_unit_that_its_name_says(name: str, unit: str) -> None:
    graph = PART.graph()
    feature = Feature(
        id="group-01", kind="group", faces=(FaceRole(role="face", face=1),), sizes={name: 0.5}
    )
    assert (
        one(
            size_table(Recognition(family="surface", features=(feature,)), graph), "group-01", name
        ).unit
        == unit
    )


def test_the_part_s_smallest_sizes_are_those_that_the_family_says(monkeypatch):
    class Wedges:
        smallest = (Smallest(name="thinnest_wedge", size="thickness", kinds=("wedge",)),)

    known, names = registry.get, registry.names
    monkeypatch.setattr(
        registry, "get", lambda kind, name: Wedges if name == "wedges" else known(kind, name)
    )
    monkeypatch.setattr(registry, "names", lambda kind: (*names(kind), "wedges"))
    wedges = [
        Feature(
            id=f"wedge-{n}",
            kind="wedge",
            faces=(FaceRole(role="top", face=n),),
            sizes={"thickness": thickness},
        )
        for n, thickness in ((1, 4.0), (2, 3.0))
    ]
    found = Recognition(
        family="wedges",
        features=(*wedges, replace(wedges[0], id="rib-1", kind="rib", sizes={"thickness": 1.0})),
    )
    entry = one(size_table(found, PART.graph()), "part", "thinnest_wedge")
    assert (entry.value, entry.faces) == (3.0, (2,))
    assert not [e for e in size_table(found, PART.graph()) if e.name == "thinnest_rib"]
