"""Features given other faces by hand: what follows for roles, sizes and the other features, and what recognition keeps of it."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from trunnion.cli.main import main
from trunnion.findings import BadInput
from trunnion.model.feature import FaceRole
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.face_edits import (
    with_faces,
    with_faces_taken,
    with_feature,
    with_merged,
)
from trunnion.recognize.contract import describable_kinds
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.panel.settings import PanelSettings


@pytest.fixture(scope="module")
def recognised(sample_panel):
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), "recognize")


def faces_of(session, id):
    return {(f.role, f.face) for f in session.recognition.feature(id).faces}


def pockets(session):
    return list(session.recognition.of_kind("pocket", "open_pocket"))


def test_faces_alone_describe_a_feature_as_recognition_does(recognised):
    engine, session = recognised
    graph, family = engine.context_of(session).part.graph(), PanelFamily()
    seen = set()
    for feature in session.recognition:
        if feature.kind not in family.describable:
            continue
        bare = replace(
            feature,
            faces=tuple(FaceRole(role="face", face=t) for t in sorted(feature.tags)),
            sizes={},
        )
        made = family.described(bare, session.recognition, graph, PanelSettings())
        assert {(f.role, f.face) for f in made.faces} == {(f.role, f.face) for f in feature.faces}
        assert dict(made.sizes) == dict(feature.sizes)
        assert dict(made.attributes) == dict(feature.attributes)
        seen.add(feature.kind)
    assert seen == {"pocket", "open_pocket", "island", "rib"}


def test_a_face_that_is_added_leaves_the_feature_that_had_it(recognised):
    engine, session = recognised
    first, second = pockets(session)[:2]
    wall = first.with_role("wall")[0]
    after = with_faces(engine, session, second.id, [wall])
    assert ("wall", wall) in faces_of(after, second.id)
    assert wall not in after.recognition.feature(first.id).tags
    assert all(after.recognition.feature(f.id).by_hand for f in (first, second))
    assert after.recognition.unexplained == session.recognition.unexplained


def test_sizes_follow_the_faces(recognised):
    engine, session = recognised
    pocket = next(p for p in pockets(session) if p.with_role("corner"))
    assert pocket.sizes["corner_radius"] > 0.0
    after = with_faces_taken(engine, session, pocket.id, pocket.with_role("corner"))
    assert "corner_radius" not in after.recognition.feature(pocket.id).sizes
    assert set(pocket.with_role("corner")) <= set(after.recognition.unexplained)


def test_merged_features_keep_the_first_name_and_the_other_is_never_used_again(recognised):
    engine, session = recognised
    first, second = pockets(session)[:2]
    after = with_merged(engine, session, [first.id, second.id])
    assert set(after.recognition.feature(first.id).tags) == {*first.tags, *second.tags}
    assert second.id not in [f.id for f in after.recognition]
    assert second.id in after.recognition.retired
    made = with_feature(engine, after, second.kind, second.tags)
    assert made.recognition.features[-1].id not in (first.id, second.id)
    assert set(made.recognition.feature(first.id).tags) == set(first.tags)


def test_recognition_keeps_a_pocket_that_was_parted(recognised):
    engine, session = recognised
    pocket = pockets(session)[0]
    half = pocket.tags[: len(pocket.tags) // 2]
    parted = with_feature(engine, session, "pocket", half)
    again = engine.run(
        engine.with_choices(parted, {"recognize.panel.slicing_depth": "3"}), "recognize"
    ).recognition
    owners = [f.id for f in again if set(f.tags) & set(pocket.tags) and f.kind == "pocket"]
    assert owners == [f.id for f in parted.recognition if set(f.tags) & set(pocket.tags)]
    assert {f.id: f.faces for f in again if f.by_hand} == {
        f.id: f.faces for f in parted.recognition if f.by_hand
    }


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (
            lambda e, s, p: with_faces(e, s, "pocket-99", [1]),
            "there is no feature pocket-99; known",
        ),
        (lambda e, s, p: with_faces(e, s, p.id, [9999]), "face 9999 is not a face"),
        (lambda e, s, p: with_faces(e, s, p.id, []), "no faces were chosen"),
        (lambda e, s, p: with_faces_taken(e, s, p.id, [9999]), "not one of its faces"),
        (lambda e, s, p: with_faces(e, s, "profile-01", p.tags[:1]), "more than their faces"),
        (lambda e, s, p: with_merged(e, s, [p.id]), "two features or more"),
        (lambda e, s, p: with_feature(e, s, "hole", p.tags[:1]), "kind hole can't be made"),
        (lambda e, s, p: with_feature(e, s, "rib", p.tags[:2]), "a rib is its top"),
        (lambda e, s, p: with_feature(e, s, "island", p.with_role("floor")), "stands on the floor"),
    ],
)
def test_what_can_not_be_is_refused_in_a_line(recognised, edit, words):
    engine, session = recognised
    with pytest.raises(BadInput, match=words):
        edit(engine, session, pockets(session)[0])


def test_families_say_which_features_may_have_other_faces():
    assert describable_kinds("panel") == ("pocket", "open_pocket", "island", "rib", "boss")
    assert describable_kinds("surface") == describable_kinds("no such family") == ()


def test_the_command_keeps_the_change_in_a_project(sample_panel, tmp_path, capsys, recognised):
    first, second = pockets(recognised[1])[:2]
    out = tmp_path / "changed.trunnion"
    words = ["edit", str(sample_panel), "--merge", f"{first.id},{second.id}", "--out", str(out)]
    assert main([*words, "--json"]) == 0
    (told,) = json.loads(capsys.readouterr().out)["features"]
    assert told["id"] == first.id
    engine = Engine()
    kept = engine.open(out)
    assert {f.face for f in kept.recognition.feature(first.id).faces} == {*first.tags, *second.tags}
    assert main(["edit", str(sample_panel), "--add", "nonsense", "--out", str(out)]) == 2
    assert "face numbers with commas" in capsys.readouterr().err
