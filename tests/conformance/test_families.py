"""What every registered family must do, whoever wrote it: ours, and those of packages in `tests/families`."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from importlib.resources import files

import numpy as np
import pytest

import samples
from subjects import (
    FAMILIES,
    check_cancel,
    check_settings,
    engines,
    foreign,
    is_one_line,
    own,
    part_of,
)
from trunnion import registry
from trunnion.findings import BadInput
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Recognition
from trunnion.pipeline.planning.family import ratings
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.contract import exclusive_kinds, feature_kinds, smallest_sizes
from trunnion.report.palette import rgb
from trunnion.settings import choose

by_name = pytest.mark.parametrize("name", FAMILIES)
SAME = {"abs": 2e-3, "rel": 1e-4}
"""How near sizes of a part are that was moved and written anew."""


def family_of(name):
    return registry.get("families", name)()


def recognized(name, part, progress=NO_PROGRESS) -> Recognition:
    family = family_of(name)
    return family.recognize(part.graph(), part, choose(family.settings, {}), progress)


def own_part(name):
    return part_of(own(name)[0])


def told_of(found: Recognition) -> set[str]:
    return {word for finding in found.findings for word in finding.where}


def summary(found: Recognition, area) -> list[tuple]:
    """Return the features without their names and tags: kinds, areas of faces by role, sizes; in an order of their own."""
    rows = []
    for f in found:
        faces = tuple(sorted((r.role, round(float(area[r.face - 1]), 1)) for r in f.faces))
        turning = feature_kinds()[f.kind].along_axes
        sizes = {
            k: v
            for k, v in sorted(f.sizes.items())
            if isinstance(v, (int, float)) and k not in turning
        }
        rows.append((f.kind, faces, sizes))
    return sorted(rows, key=lambda row: (row[0], row[1], str(sorted(row[2])), *row[2].values()))


def same(a: Recognition, area_a, b: Recognition, area_b) -> None:
    first, second = summary(a, area_a), summary(b, area_b)
    assert [row[:2] for row in second] == [row[:2] for row in first]
    for mine, other in zip(first, second, strict=True):
        assert other[2] == pytest.approx(mine[2], **SAME)


def test_a_family_of_a_package_is_among_them():
    assert set(FAMILIES) > {"panel", "surface"}


@by_name
def test_it_has_the_name_that_it_is_registered_under_and_words_for_its_parts(name):
    family = family_of(name)
    assert family.name == name
    assert family.noun.split()[0] in ("a", "an") and is_one_line(family.__doc__.split("\n")[0])


@by_name
def test_its_settings_are_complete(name):
    check_settings(family_of(name).settings)
    assert f"recognize.{name}" == family_of(name).settings.GROUP


@by_name
def test_its_kinds_have_words_and_colours(name):
    kinds = family_of(name).kinds
    assert len({k.name for k in kinds}) == len(kinds) > 0
    for kind in kinds:
        labels = [kind.label, *(c.label for c in kind.classes)]
        assert all(label and "_" not in label for label in labels), kind.name
        for colour in (kind.colour, *(c for each in kind.classes for c in each.colours)):
            rgb(kind.name, colour)


@by_name
def test_its_words_are_translated(name):
    words = {name, family_of(name).noun, *(kind.label for kind in family_of(name).kinds)}
    languages = [
        f.name
        for f in (files("trunnion_resources") / "translations").iterdir()
        if f.name[-5:] == ".json"
    ]
    for language in languages:
        known: set[str] = set()
        for folder in registry.resource_folders("translations"):
            if (folder / language).is_file():
                known |= set(json.loads((folder / language).read_text("utf-8")))
        assert words - known == set()


@by_name
def test_it_says_how_well_it_suits_its_part_and_why(name):
    found = family_of(name).suits(own_part(name).graph())
    assert found == family_of(name).suits(own_part(name).graph())
    assert 0.5 <= found.score <= 1.0 and 0.0 < found.explained <= 1.0
    assert is_one_line(found.reason) and any(c.isdigit() for c in found.reason)
    assert ratings(own_part(name).graph())[0].name == name


@by_name
def test_every_face_is_in_a_feature_or_in_a_finding(name):
    for engine, _ in engines().values():
        part = part_of(engine)
        try:
            found = recognized(name, part)
        except BadInput as refused:
            assert part is not own_part(name) and is_one_line(str(refused))
            continue
        held = {tag for f in found for tag in f.tags}
        assert held | set(found.unexplained) == set(part.tags)
        assert held & set(found.unexplained) == set()
        assert {f"face {tag}" for tag in found.unexplained} <= told_of(found)


@by_name
def test_what_it_makes_is_what_it_declares(name):
    found, family = recognized(name, own_part(name)), family_of(name)
    assert found.family == name
    assert {f.kind for f in found} <= {k.name for k in family.kinds}
    assert len({f.id for f in found}) == len(found.features) > 0
    assert all(f.faces and f.id.startswith(f.kind) for f in found)
    shared = [tag for f in found.of_kind(*exclusive_kinds(name)) for tag in f.tags]
    assert len(set(shared)) == len(shared)
    assert {k for s in smallest_sizes(name) for k in s.kinds} <= {k.name for k in family.kinds}


@by_name
def test_it_gives_the_same_answer_twice(name):
    first, second = (recognized(name, own_part(name)) for _ in (0, 1))
    assert [f.as_dict() for f in first] == [f.as_dict() for f in second]
    assert (first.findings, first.unexplained) == (second.findings, second.unexplained)
    assert first.frame.as_dict() == second.frame.as_dict()


@by_name
def test_it_gives_the_same_answer_wherever_the_part_lies(name):
    part = own_part(name)
    moved = samples.read(samples.moved(samples.turned(part.shape, (1, 2, 3), 40.0), (300, -70, 20)))
    same(recognized(name, part), part.graph().area, recognized(name, moved), moved.graph().area)


@by_name
def test_it_gives_the_same_answer_whatever_the_numbers_of_the_faces(name):
    part = own_part(name)
    other = samples.read(samples.renumbered(part.shape))
    assert other.graph().surface != part.graph().surface
    same(recognized(name, part), part.graph().area, recognized(name, other), other.graph().area)


@by_name
def test_a_part_of_another_kind_is_refused_or_answered_in_words(name):
    for part in foreign(name):
        suits = family_of(name).suits(part.graph())
        assert is_one_line(suits.reason) and suits.score < 1.0
        try:
            found = recognized(name, part)
        except BadInput as refused:
            assert is_one_line(str(refused))
            continue
        assert all(is_one_line(f.text) for f in found.findings)


def empty() -> FaceGraph:
    """Return a face graph without faces."""
    full = part_of(next(iter(engines().values()))[0]).graph()
    columns = {f.name: getattr(full, f.name) for f in fields(full)}
    cut = {
        k: v[:0] if isinstance(v, (tuple, np.ndarray)) else v
        for k, v in columns.items()
        if k != "open_edges"
    }
    return replace(full, **cut)


@by_name
def test_a_part_without_faces_is_refused_or_answered_in_words(name):
    suits = family_of(name).suits(empty())
    assert suits.score == 0.0 and is_one_line(suits.reason)
    family = family_of(name)
    try:
        found = family.recognize(empty(), own_part(name), choose(family.settings, {}), NO_PROGRESS)
    except BadInput as refused:
        assert is_one_line(str(refused))
        return
    assert (found.features, found.unexplained) == ((), ())


@by_name
def test_it_stops_soon_after_it_was_asked_to(name):
    recognized(name, own_part(name))
    check_cancel(lambda progress: recognized(name, own_part(name), progress))
