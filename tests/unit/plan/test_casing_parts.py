"""Casings with known truth: features, bounds of bosses, bands and regions, and what cutters leave."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest

from parts import PARTS, needs_parts
from scoring import scored, truth_of
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.part.read.part_file import read_part
from trunnion.plan.casing.bottoms import casing_bottoms
from trunnion.plan.casing.regions.plan import casing_regions
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.casing.uncut.boss_pieces import pieces_inside
from trunnion.plan.casing.uncut.throat import milled_boss, pieces_between
from trunnion.recognize.casing import CasingFamily, CasingSettings
from trunnion.settings import choose

pytestmark = needs_parts
PERFECT = {"recall": 1.0, "precision": 1.0, "faces": 1.0, "roles": 1.0}
FILES = ("A1.step", "A3.step")
MORE = ("A1.igs", "A2.step", "A2.igs", "A3.igs", "A4.step", "A4.igs", "A5.step", "A5.igs")
files = pytest.mark.parametrize(
    "file", [*FILES, *(pytest.param(f, marks=pytest.mark.long) for f in MORE)]
)
names = pytest.mark.parametrize(
    "file",
    [*FILES, *(pytest.param(f"{n}.step", marks=pytest.mark.long) for n in ("A2", "A4", "A5"))],
)


def path_of(file: str) -> Path:
    assert PARTS is not None
    return PARTS / "casing" / file


@cache
def found_in(file: str) -> tuple[FaceGraph, Recognition]:
    part = read_part(path_of(file))
    return part.graph(), CasingFamily().recognize(part.graph(), part, choose(CasingSettings, {}))


def name_of(file: str) -> str:
    return file.split(".")[0]


def off(a: float, b: float) -> float:
    """Return the difference of two angles in degrees, whole turns apart."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


def boss_for(entry: dict[str, Any], found: Recognition) -> Feature:
    """Return the boss that a truth's entry means: the one with the nearest bounds."""

    def away(f: Feature) -> float:
        sizes: Any = f.sizes
        (low, high), (z_low, z_high) = entry["theta_bounds"], entry["z_bounds"]
        return (
            off(sizes["theta_low"], low)
            + off(sizes["theta_high"], high)
            + abs(sizes["z_low"] - z_low)
            + abs(sizes["z_high"] - z_high)
        )

    return min(found.of_kind("boss"), key=away)


def named(file: str) -> dict[str, str]:
    """Return the truth's names of bosses by ours."""
    bosses = truth_of(name_of(file), "casing")["planning"]["bosses"]
    found = {boss_for(b, found_in(file)[1]).id: b["id"] for b in bosses}
    assert len(found) == len(bosses)
    return found


@files
def test_all_features_are_found(file: str) -> None:
    found = found_in(file)[1]
    score = scored(name_of(file), path_of(file), found, family="casing")
    assert {k: score[k] for k in PERFECT} == PERFECT
    assert found.unexplained == () and found.findings == ()
    assert found.counts() == truth_of(name_of(file), "casing")["counts"]


@names
def test_bounds_of_bosses_with_and_without_fillets_are_those_of_the_truth(file: str) -> None:
    for entry in truth_of(name_of(file), "casing")["planning"]["bosses"]:
        sizes: Any = boss_for(entry, found_in(file)[1]).sizes
        for prefix, words in (("", ""), ("toe_", "_with_fillet")):
            for side, end in enumerate(("low", "high")):
                theta = sizes.get(f"{prefix}theta_{end}", sizes[f"theta_{end}"])
                z = sizes.get(f"{prefix}z_{end}", sizes[f"z_{end}"])
                assert off(theta, entry[f"theta_bounds{words}"][side]) < 1e-3, entry["id"]
                assert z == pytest.approx(entry[f"z_bounds{words}"][side], abs=2e-3), entry["id"]
        assert sizes["root_fillet"] == pytest.approx(entry["root_fillet"], abs=2e-3)


@names
@pytest.mark.parametrize("fillets", [False, True])
def test_bands_gaps_and_regions_are_those_of_the_truth(file: str, fillets: bool) -> None:
    graph, found = found_in(file)
    chosen = choose(RegionSettings, {"threshold": 60.0, "widening": 0.0, "fillets": fillets})
    plans = [p.as_dict() for p in casing_regions(found, graph, chosen)]
    ours = named(file)
    for pocket in truth_of(name_of(file), "casing")["planning"]["pockets"]:
        truth = pocket.get("bands_with_fillets" if fillets else "bands")
        if truth is None:
            continue
        mine = min(
            (p for p in plans if p["full_circle"]), key=lambda p: abs(p["z"][0] - pocket["z"][0])
        )
        assert mine["uncovered"] < 1e-6
        assert len(mine["free_z"]) == len(truth["free_z"])
        for a, b in zip(mine["free_z"], truth["free_z"], strict=True):
            assert a == pytest.approx(b, abs=0.01)
        for a, b in zip(mine["bands"], truth["bands"], strict=True):
            assert a["kind"] == b["kind"]
            arcs = {(ours[g["after"]], ours[g["before"]]): g["arc"] for g in a["gaps"]}
            assert arcs == pytest.approx(
                {(g["after"], g["before"]): g["arc"] for g in b["gaps"]}, abs=0.01
            )
        for key in ("merged", "merged_by_kind"):
            runs = [(r["kind"], sorted(ours[b] for b in r["bosses"])) for r in mine[key]]
            assert runs == [(r["kind"], sorted(r["bosses"])) for r in truth[key]]
        assert shown(mine["regions"], ours) == shown(truth["regions"], None)


def shown(regions: list[dict[str, Any]], names: dict[str, str] | None) -> list[tuple[Any, ...]]:
    def named(boss: str) -> str:
        return names[boss] if names and boss else boss

    return sorted(
        (
            *(round(z, 2) for z in r["z"]),
            r["kind"],
            *(round(t, 2) for t in r["theta"]),
            named(r.get("after", "")),
            named(r.get("before", "")),
        )
        for r in regions
    )


@names
def test_what_a_cutter_leaves_inside_outlines_is_that_of_the_truth(file: str) -> None:
    graph, found = found_in(file)
    ours = {truth: own for own, truth in named(file).items()}
    standing = {b.id: (b, q.meridian) for q in casing_bottoms(found, graph) for b in q.bosses}
    for entry in truth_of(name_of(file), "casing")["planning"]["undercut_class1"]["bosses"]:
        boss, meridian = standing[ours[entry["boss"]]]
        for result in entry["results"]:
            pieces = pieces_inside(boss, meridian, 2.0 * result["cutter_radius"])
            area = sum(p.area for p in pieces)
            assert area == pytest.approx(result["area"], rel=5e-3, abs=1e-3), entry["boss"]


@pytest.mark.parametrize("file", ["A3.step", pytest.param("A2.step", marks=pytest.mark.long)])
def test_throats_between_bosses_are_those_of_the_truth(file: str) -> None:
    graph, found = found_in(file)
    ours = {truth: own for own, truth in named(file).items()}
    standing = {b.id: (b, q.meridian) for q in casing_bottoms(found, graph) for b in q.bosses}
    for entry in truth_of(name_of(file), "casing")["planning"]["undercut_class2"]["pairs"]:
        (a, meridian), (b, _) = (standing[ours[name]] for name in entry["bosses"])
        radius = 0.5 * entry["cutter_diameter"]
        sides = [milled_boss(x, meridian, radius, 0.0) for x in (a, b)]
        pieces = pieces_between(*sides, meridian, 2.0 * radius)
        assert sum(p.volume for p in pieces) == pytest.approx(
            entry["throat_volume_side"], rel=0.05, abs=20.0
        ), entry["bosses"]
