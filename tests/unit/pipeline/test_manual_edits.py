"""What a person deleted, changed or made stays so when its step runs again."""

from __future__ import annotations

from dataclasses import replace

import pytest

from programs import process_tree, recognition
from trunnion import registry
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.pipeline.engine import Engine
from trunnion.pipeline.planning.manual_edits import with_manual_features
from trunnion.plan.manual.manual_operations import with_manual_operations
from trunnion_resources import sample

FOUND = replace(
    recognition(),
    features=tuple(replace(f, by_hand=False) for f in recognition()),
    removed=(),
    findings=(),
)
MADE = replace(
    process_tree(),
    operations=tuple(replace(o, by_hand=False) for o in process_tree().operations),
    removed=(),
)


@pytest.fixture(scope="module")
def routed():
    engine = Engine()
    return engine, engine.run(engine.open(sample("B1")), "route")


def ids(found: Recognition) -> list[str]:
    return [f.id for f in found]


def test_what_nobody_touched_is_what_was_found():
    assert with_manual_features(FOUND, FOUND) is FOUND
    assert with_manual_features(None, FOUND) is FOUND


def test_a_deleted_feature_is_not_taken_up_again_and_its_faces_stay_unexplained():
    after = with_manual_features(FOUND.without("rib-01"), FOUND)
    assert ids(after) == ["pocket-01", "pocket-02", "island-01"]
    assert after.unexplained == (12, 40, 41)
    assert after.removed == ((12,),)
    (told,) = after.findings
    assert (told.code, told.where) == ("recognize.deleted", ("face 12",))


def test_the_share_of_unexplained_faces_follows_a_deletion_and_a_run_after_it(routed):
    engine, session = routed
    found = session.recognition
    gone = next(f for f in found if f.kind == "pocket")
    loose = set(gone.tags) - {tag for f in found if f.id != gone.id for tag in f.tags}
    area = engine.context_of(session).part.graph().area
    expected = pytest.approx(
        found.unexplained_share + float(area[[t - 1 for t in loose]].sum() / area.sum())
    )
    deleted = found.without(gone.id)
    assert deleted.unexplained_share == expected
    assert deleted.unexplained_share > found.unexplained_share
    again = engine.run(
        replace(session, recognition=deleted, choices={"recognize.panel.rib_width": 12.5}),
        "recognize",
    )
    assert again.recognition.unexplained_share == expected


def test_a_deleted_feature_is_known_by_its_faces_when_numbers_change():
    renumbered = replace(
        FOUND, features=tuple(replace(f, id=f.id.replace("01", "09")) for f in FOUND)
    )
    assert ids(with_manual_features(FOUND.without("pocket-01"), renumbered)) == [
        "pocket-02",
        "island-09",
        "rib-09",
    ]


def test_a_feature_that_shares_few_faces_with_a_deleted_one_is_taken_up():
    other = Feature(
        id="pocket-03",
        kind="pocket",
        faces=tuple(FaceRole(role="wall", face=n) for n in (3, 4, 30, 31)),
    )
    assert "pocket-03" in ids(
        with_manual_features(FOUND.without("pocket-01"), replace(FOUND, features=(other,)))
    )


def test_a_feature_made_by_hand_where_one_was_deleted_stays():
    before = FOUND.without("pocket-01")
    mine = Feature(
        id="mine",
        kind="island",
        by_hand=True,
        faces=(FaceRole(role="wall", face=4), FaceRole(role="top", face=3)),
    )
    after = with_manual_features(replace(before, features=(*before.features, mine)), FOUND)
    assert ids(after) == ["pocket-02", "island-01", "rib-01", "mine"]
    assert after.unexplained == (5, 6, 40, 41)


def test_a_deleted_operation_is_not_made_again_and_holds_nothing_up():
    after = with_manual_operations(MADE.without("pocket-01.rough"), MADE)
    assert [o.id for o in after.operations] == ["wall-01", "wall-02", "face-02"]
    assert all(o.after == () for o in after.operations)
    assert after.removed == ("pocket-01.rough",)


def test_an_operation_changed_by_hand_stays_beside_a_deleted_one():
    slower = replace(MADE.operation("face-02"), suppressed=True, by_hand=True)
    after = with_manual_operations(MADE.with_operation(slower).without("wall-01"), MADE)
    assert after.operation("face-02") == slower
    assert "wall-01" not in [o.id for o in after.operations]


def test_a_deleted_feature_stays_deleted_when_recognition_runs_again(routed):
    engine, session = routed
    gone = session.recognition.feature("rib-01")
    edited = replace(session, recognition=session.recognition.without("rib-01"), records={})
    again = engine.run(edited, "recognize").recognition
    assert "rib-01" not in ids(again)
    assert set(gone.tags) <= set(again.unexplained) | {tag for f in again for tag in f.tags}
    assert len(again.features) == len(session.recognition.features) - 1


def test_a_deleted_operation_stays_deleted_when_the_route_is_made_again(routed):
    engine, session = routed
    gone = session.process.operations[-1].id
    edited = replace(session, process=session.process.without(gone))
    again = engine.run(engine.with_choices(edited, {"route.floor_allowance": 0.31}), "optimize")
    assert again.records["route"].key != session.records["route"].key
    assert gone not in [o.id for o in again.process.operations]
    assert again.process.removed == (gone,)


def test_kinds_that_share_out_faces_are_what_the_family_says(monkeypatch):
    class Wedges:
        exclusive = ("wedge",)

    known, names = registry.get, registry.names
    monkeypatch.setattr(
        registry, "get", lambda kind, name: Wedges if name == "wedges" else known(kind, name)
    )
    monkeypatch.setattr(registry, "names", lambda kind: (*names(kind), "wedges"))

    def wedge(id, *tags, by_hand=False):
        return Feature(
            id=id,
            kind="wedge",
            faces=tuple(FaceRole(role="face", face=t) for t in tags),
            by_hand=by_hand,
        )

    found = Recognition(
        family="wedges", features=(wedge("wedge-01", 1, 2, 3, 4), wedge("wedge-02", 5, 6))
    )
    before = replace(found, features=(wedge("wedge-01", 4, 5, 6, by_hand=True),))
    after = with_manual_features(before, found)
    assert {f.id: f.tags for f in after} == {"wedge-01": (4, 5, 6), "wedge-02": (1, 2, 3)}
    other = replace(before, family="panel"), replace(found, family="panel")
    assert {f.id: f.tags for f in with_manual_features(*other)} == {"wedge-01": (4, 5, 6)}
