"""A revised part taken up by the session of the one before: names and what a person did are kept, what is gone is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from revised_panels import PanelDesign
from samples import block_with_pocket, renumbered, written
from trunnion.findings import BadCall, BadInput
from trunnion.geometry.cut import plane_cut
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.face_edits import with_feature
from trunnion.pipeline.planning.guide_faces import with_guide_faces
from trunnion.pipeline.revision import revised
from trunnion.plan.manual.operation_change import OperationChange
from trunnion.plan.manual.operation_copy import with_copy

BASE = PanelDesign()


def file_of(design: PanelDesign, turned_round: bool = False):
    """Return the STEP file of a design, its faces in the opposite order where `turned_round`."""
    shape = design.shape()
    return written(renumbered(shape) if turned_round else shape, name="panel")


@pytest.fixture(scope="module")
def planned():
    """A session of the panel before its revision, planned."""
    engine = Engine()
    return engine.run(engine.open(file_of(BASE)), until="optimize")


def opened(session) -> Engine:
    """Return an engine of its own that works on the session of the panel before."""
    engine = Engine()
    engine.open(file_of(BASE))
    assert engine.context_of(session).part.digest == session.part.digest
    return engine


def codes(session) -> dict[str, str]:
    return {f.code: f.text for f in session.part.findings if f.code.startswith("revision.")}


def floors(engine, session) -> dict[str, tuple[float, ...]]:
    """Return the middle of each pocket's floor by the pocket's name."""
    graph = engine.context_of(session).part.graph()
    return {
        f.id: tuple(np.round(graph.box_low[tag - 1] + graph.box_high[tag - 1], 2)[[0, 2]] / 2.0)
        for f in session.recognition.of_kind("pocket")
        for tag in f.with_role("floor")
    }


def the(session, id):
    return session.process.operation(id)


@pytest.mark.parametrize("turned_round", [False, True])
def test_features_keep_their_names_where_others_are_new_or_changed(planned, turned_round) -> None:
    engine = opened(planned)
    before = floors(engine, planned)
    revision = PanelDesign(left_floor=6.0, third=True)
    made = revised(engine, planned, file_of(revision, turned_round))
    after = floors(engine, made)
    assert set(before) == {"pocket-01", "pocket-02"}
    assert set(after) == {*before, "pocket-03"} and after["pocket-03"][0] == pytest.approx(143.0)
    assert {id: x for id, (x, _) in after.items() if id in before} == {
        id: x for id, (x, _) in before.items()
    }
    assert sorted(z for _, z in after.values()) == [4.0, 6.0, 8.0]
    assert set(codes(made)) == {"revision.faces"}
    # The island stands in the pocket that has its name still.
    (island,) = made.recognition.of_kind("island")
    assert after[island.attributes["in"]][1] == 6.0
    words = {w for f in made.recognition.findings for w in f.where}
    assert not {w for w in words if w.startswith("pocket-")} - set(after)


def test_operations_by_hand_and_their_faces_are_kept_and_proven(planned) -> None:
    engine = opened(planned)
    wall = the(planned, "wall-pocket-02")
    graph = engine.context_of(planned).part.graph()
    face = next(t for t in wall.faces if graph.surface[t - 1] == "plane")
    normal = graph.normal[face - 1]
    session = with_guide_faces(engine, planned, wall.id, leave_out=[face])
    session = engine.with_operation_change(session, "rough-pocket-01", OperationChange(feed=3000.0))
    session = replace(session, process=with_copy(session.process, "wall-pocket-01")[0])

    made = revised(engine, session, file_of(PanelDesign(right_length=51.0), turned_round=True))
    states = engine.states(made)
    assert states["recognize"] == "done" and states["route"] == "stale"
    made = engine.run(made)
    assert made.verdict.gouge <= 0.02 and not made.verdict.collisions
    led, rough = the(made, wall.id), the(made, "rough-pocket-01")
    assert led.own_faces and rough.by_hand and rough.data.feed == 3000.0
    assert the(made, "wall-pocket-01-copy").copy_of == "wall-pocket-01"
    after = engine.context_of(made).part.graph()
    assert len(led.faces) == len(wall.faces) - 2
    pocket = made.recognition.feature("pocket-02")
    (out,) = set(pocket.with_role("wall")) - set(led.faces)
    assert after.normal[out - 1] == pytest.approx(normal)
    unplanned = next(f for f in made.findings() if f.code == "verify.unplanned")
    assert f"face {out}" in unplanned.where


def test_what_has_no_counterpart_is_told(planned) -> None:
    engine = opened(planned)
    island = planned.recognition.of_kind("island")[0]
    choices = {
        **planned.choices,
        "surface.point.first_guide": f"face {island.tags[0]}",
        "surface.point.second_guide": f"face {planned.recognition.of_kind('profile')[0].tags[0]}",
    }
    drill = the(planned, "drill-hole-01")
    session = with_guide_faces(engine, planned, drill.id, leave_out=drill.faces[:1])
    made = revised(
        engine,
        replace(session, choices=choices),
        file_of(PanelDesign(island=False, holes=((145.0, 20.0),)), turned_round=True),
    )
    assert set(codes(made)) == {
        "revision.faces",
        "revision.setting-lost",
        "revision.operation-faces",
    }
    assert "surface.point.first_guide" not in made.choices
    kept = made.choices["surface.point.second_guide"]
    assert kept.startswith("face ") and kept != choices["surface.point.second_guide"]
    routed = engine.run(made, until="optimize")
    assert not the(routed, drill.id).own_faces and len(the(routed, drill.id).faces) == 1


def test_features_by_hand_are_measured_anew_or_told_to_be_gone(planned) -> None:
    engine = opened(planned)
    pocket = planned.recognition.feature("pocket-01")
    session = with_feature(engine, planned, "pocket", pocket.with_role("floor"))
    made_by_hand = next(f for f in session.recognition if f.by_hand and f.id != "pocket-01")
    made = revised(engine, session, file_of(PanelDesign(left_floor=7.0), turned_round=True))
    again = made.recognition.feature(made_by_hand.id)
    assert again.by_hand and again.sizes["floor_z"] == 7.0 != made_by_hand.sizes["floor_z"]
    assert made.recognition.feature("pocket-01").by_hand

    island = planned.recognition.of_kind("island")[0]
    engine = opened(planned)
    own = replace(
        planned.recognition,
        features=tuple(
            replace(f, by_hand=True) if f is island else f for f in planned.recognition.features
        ),
    )
    gone = revised(engine, replace(planned, recognition=own), file_of(PanelDesign(island=False)))
    assert "island-01, made or changed by hand, had faces" in codes(gone)["revision.feature-lost"]
    assert not gone.recognition.of_kind("island") and "island-01" in gone.recognition.retired


def test_cuts_are_made_again_where_their_face_is_still_there(planned) -> None:
    engine = opened(planned)
    base = engine.open(file_of(BASE))
    graph = engine.context_of(base).part.graph()
    floor = next(
        r + 1
        for r in range(len(graph))
        if graph.surface[r] == "plane" and np.allclose(graph.box_high[r, 2], 4.0)
    )
    island = next(
        r + 1
        for r in range(len(graph))
        if graph.surface[r] == "plane" and np.allclose(graph.box_low[r, 2], 14.0)
    )
    low, high = graph.box_low[floor - 1], graph.box_high[floor - 1]
    middle = tuple((0.5 * (low + high)).tolist())
    over = tuple(graph.centre[island - 1].tolist())
    cuts = (
        plane_cut(island, over, (0.0, 1.0, 0.0)),
        plane_cut(floor, middle, (0.0, 1.0, 0.0)),
    )
    session = engine.with_cuts(base, cuts)
    made = revised(engine, session, file_of(PanelDesign(island=False), turned_round=True))
    assert len(made.cuts) == 1 and "revision.cut-lost" in codes(made)
    after = engine.context_of(made).part.graph()
    row = made.cuts[0].face - 1
    assert after.box_high[row, 2] == pytest.approx(4.0)
    assert len(after) == 46 + 1


def test_another_part_is_refused_and_the_engine_keeps_its_own(planned, tmp_path) -> None:
    engine = opened(planned)
    digest = engine.context.part.digest
    with pytest.raises(BadInput, match="it is another part, or lies elsewhere"):
        revised(engine, planned, block_with_pocket())
    with pytest.raises(BadInput, match="no such file"):
        revised(engine, planned, tmp_path / "panel.step")
    with pytest.raises(BadInput, match="is a project"):
        revised(engine, planned, tmp_path / "panel.trunnion")
    assert engine.context.part.digest == digest
    with pytest.raises(BadCall, match="no part is open"):
        revised(Engine(), planned, file_of(BASE))


def test_a_session_of_which_nothing_is_recognised_is_just_opened(planned) -> None:
    engine = opened(planned)
    session = replace(engine.open(file_of(BASE)), choices={"route.wall_allowance": 0.4})
    made = revised(engine, session, file_of(PanelDesign(third=True)))
    assert made.recognition is None and made.choices == session.choices
    assert set(engine.states(made).values()) == {"empty"}
