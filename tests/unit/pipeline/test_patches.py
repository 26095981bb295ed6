"""Patches by hand: cuts, local features and moved faces that survive a re-run and a project file, and the export of areas."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from shaped_parts import bowl, face_towards, plate
from trunnion.cli.main import BAD, DONE, PROBLEMS, main
from trunnion.findings import BadCall, BadInput
from trunnion.geometry.cut import plane_cut
from trunnion.model.session import Session
from trunnion.part.read.part_file import read_part
from trunnion.part.topology.measure import area_of
from trunnion.part.write import write_faces, write_step
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.patches import (
    export,
    tags_of,
    with_cut,
    with_local,
    with_moved,
    without_cut,
)
from trunnion.recognize.surface.accuracy import size_errors

SURFACE = {"recognize.family": "surface"}


@pytest.fixture(scope="module")
def engine():
    return Engine()


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("part") / "bowl.step"
    write_step(bowl(40.0, 30.0, 12.0, 10.0).shape, path)
    return path


@pytest.fixture(scope="module")
def opened(engine, file):
    return engine.with_choices(engine.open(file), SURFACE)


@pytest.fixture
def found(engine, opened):
    engine.context_of(opened)
    return engine.run(opened, "recognize")


def hollow_of(engine, session) -> int:
    graph = engine.context_of(session).part.graph()
    return 1 + graph.surface.index("sphere")


def group_of(session: Session, face: int) -> str:
    return next(f.id for f in session.recognition if face in f.tags)


def shared_out(session: Session) -> list[int]:
    found = session.recognition
    return sorted([*found.unexplained, *(t for f in found for t in f.tags)])


def test_groups_called_local_by_hand_stay_so_when_recognition_runs_again(engine, found):
    largest = found.recognition.features[0]
    assert not largest.attributes["local"]
    local = with_local(found, [largest.id], True)
    again = engine.run(
        engine.with_choices(local, {"recognize.surface.tolerance": 0.04}), "recognize"
    )
    assert again.records["recognize"].key != found.records["recognize"].key
    assert again.recognition.feature(largest.id).attributes["local"]
    assert shared_out(again) == list(range(1, 8))


def test_moved_faces_stay_where_they_were_put_and_every_group_is_measured_anew(engine, found):
    hollow = hollow_of(engine, found)
    into = found.recognition.features[0]
    moved = with_moved(engine, found, [hollow], into.id)
    grown = moved.recognition.feature(into.id)
    assert set(grown.tags) == {*into.tags, hollow}
    assert grown.sizes["area"] == pytest.approx(
        into.sizes["area"] + engine.context_of(found).part.graph().area[hollow - 1]
    )
    assert grown.sizes["concave_radius"] == pytest.approx(10.0)
    assert shared_out(moved) == list(range(1, 8))
    again = engine.run(engine.with_choices(moved, {"grouping": "aligned"}), "recognize")
    assert group_of(again, hollow) == into.id
    assert shared_out(again) == list(range(1, 8))


def test_faces_moved_to_a_new_group_are_as_local_as_they_were(engine, found):
    hollow = hollow_of(engine, found)
    local = with_local(found, [group_of(found, hollow)], True)
    moved = with_moved(engine, local, [hollow])
    made = moved.recognition.feature(group_of(moved, hollow))
    assert (made.tags, made.attributes["local"], made.by_hand) == ((hollow,), True, True)


def test_groups_found_again_take_free_names_beside_those_made_by_hand(engine, found):
    moved = with_moved(engine, found, [1, 2], found.recognition.features[-1].id)
    again = engine.run(engine.with_choices(moved, {"grouping": "aligned"}), "recognize")
    ids = [f.id for f in again.recognition]
    assert len(set(ids)) == len(ids)
    assert shared_out(again) == list(range(1, 8))


def emptied(engine, found, *faces):
    """Return the session after faces went to a new group and on to the first one, and the name that group had."""
    made = with_moved(engine, found, faces)
    name = group_of(made, faces[0])
    return with_moved(engine, made, faces, made.recognition.features[0].id), name


def test_the_name_of_an_emptied_group_is_not_given_again(engine, found):
    hollow = hollow_of(engine, found)
    session, name = emptied(engine, found, hollow)
    assert name not in {f.id for f in session.recognition}
    again = with_moved(engine, session, [hollow])
    assert group_of(again, hollow) not in {name, *(f.id for f in found.recognition)}


def test_names_that_were_given_survive_a_project_file(engine, found, tmp_path):
    hollow = hollow_of(engine, found)
    session, name = emptied(engine, found, hollow)
    engine.save(session, tmp_path / "bowl.trunnion")
    other = Engine()
    opened = other.open(tmp_path / "bowl.trunnion")
    assert name in opened.recognition.retired
    assert group_of(with_moved(other, opened, [hollow]), hollow) != name


def test_recognition_gives_no_name_again_that_an_emptied_group_had(engine, found):
    first, *_, last = found.recognition.features
    moved = with_moved(engine, found, last.tags, first.id)
    again = engine.run(engine.with_choices(moved, {"grouping": "aligned"}), "recognize")
    assert last.id not in {f.id for f in again.recognition}
    assert shared_out(again) == list(range(1, 8))
    hollow = hollow_of(engine, again)
    assert group_of(with_moved(engine, again, [hollow]), hollow) != last.id


def test_the_name_of_a_deleted_group_is_not_given_again(engine, found):
    gone, kept, *_ = found.recognition.features
    session = replace(found, recognition=found.recognition.without(gone.id))
    assert group_of(with_moved(engine, session, kept.tags[:1]), kept.tags[0]) != gone.id


def test_a_cut_makes_recognition_stale_and_its_pieces_are_found_as_patches(engine, found):
    hollow = hollow_of(engine, found)
    cut = with_cut(engine, found, plane_cut(hollow, (20.0, 15.0, 8.0), (0.0, 0.0, 1.0)))
    assert engine.states(cut)["recognize"] == "stale"
    assert (found.part.n_faces, cut.part.n_faces) == (7, 8)
    after = engine.run(cut, "recognize")
    assert shared_out(after) == list(range(1, 9))
    assert set(engine.mesh(after).face.tolist()) == set(range(1, 9))


def test_undoing_a_cut_needs_no_reading(engine, found):
    cut = with_cut(
        engine, found, plane_cut(hollow_of(engine, found), (20.0, 15.0, 8.0), (0.0, 0.0, 1.0))
    )
    engine.run(cut, "recognize")
    assert engine.states(found)["recognize"] == "done"
    assert set(engine.mesh(found).face.tolist()) == set(range(1, 8))


def test_faces_of_a_cut_that_is_taken_back_leave_the_groups_made_by_hand(engine, found):
    hollow = hollow_of(engine, found)
    cut = engine.run(
        with_cut(engine, found, plane_cut(hollow, (20.0, 15.0, 8.0), (0.0, 0.0, 1.0))), "recognize"
    )
    by_hand = with_local(cut, [group_of(cut, 8)], True)
    back = engine.run(without_cut(engine, by_hand, 0), "recognize")
    assert (back.cuts, back.part.n_faces) == ((), 7)
    assert shared_out(back) == list(range(1, 8))


def test_a_project_opens_with_its_cuts_and_what_was_done_by_hand(engine, found, tmp_path):
    hollow = hollow_of(engine, found)
    cut = engine.run(
        with_cut(engine, found, plane_cut(hollow, (20.0, 15.0, 8.0), (0.0, 0.0, 1.0))), "recognize"
    )
    saved = with_local(cut, [group_of(cut, 8)], False)
    engine.save(saved, tmp_path / "bowl.trunnion")
    other = Engine()
    again = other.open(tmp_path / "bowl.trunnion")
    assert again.cuts == saved.cuts
    assert other.states(again)["recognize"] == "done"
    assert area_of(other.context_of(again).part.face_shape(8)) == area_of(
        engine.context_of(saved).part.face_shape(8)
    )


@pytest.mark.parametrize("suffix", [".igs", ".step"])
def test_local_features_and_the_rest_are_exported_each_alone(engine, found, tmp_path, suffix):
    hollow = hollow_of(engine, found)
    top = face_towards(engine.context_of(found).part, 0, 0, 1)
    session = with_local(found, [f.id for f in found.recognition], False)
    session = with_local(with_moved(engine, session, [hollow, top]), ["group-01"], False)
    session = with_local(session, [group_of(session, hollow)], True)
    assert export(engine, session, ["local"], tmp_path / f"local{suffix}") == 2
    assert export(engine, session, ["remaining"], tmp_path / f"rest{suffix}") == 5
    area = engine.context_of(found).part.graph().area
    for name, tags in (("local", {hollow, top}), ("rest", set(range(1, 8)) - {hollow, top})):
        back = read_part(tmp_path / f"{name}{suffix}")
        assert sorted(back.graph().area) == pytest.approx(
            sorted(area[t - 1] for t in tags), rel=1e-4
        )
        assert not back.is_closed


def test_faces_go_to_iges_without_surfaces_of_revolution(tmp_path):
    part = bowl(40.0, 30.0, 12.0, 10.0)
    write_faces([part.face_shape(t) for t in part.tags], tmp_path / "bowl.igs")
    entities = {
        line[:8].strip()
        for line in (tmp_path / "bowl.igs").read_text().splitlines()
        if line[72:73] == "D"
    }
    assert {"144", "128", "108"} <= entities
    assert "120" not in entities
    assert read_part(tmp_path / "bowl.igs").is_closed


def test_words_that_mean_no_face_are_refused(engine, opened, found):
    none = with_local(found, [f.id for f in found.recognition], False)
    with pytest.raises(
        BadInput, match="local: no face of the part belongs to it; name other groups"
    ):
        tags_of(none, ["local"])
    with pytest.raises(BadInput, match="no faces were chosen; name local, remaining"):
        tags_of(found, [])
    with pytest.raises(BadInput, match="no group group-77; known: group-01 to"):
        tags_of(found, ["group-77"])
    with pytest.raises(BadInput, match=r"\.igs"):
        export(engine, found, ["remaining"], "rest.stl")
    with pytest.raises(BadInput, match="face 99"):
        with_moved(engine, found, [99])
    with pytest.raises(BadCall, match="recognize first"):
        with_local(opened, ["group-01"], True)
    with pytest.raises(BadInput, match="no cut 1"):
        without_cut(engine, found, 0)


def test_more_points_on_the_edges_leave_a_smaller_error(engine, opened):
    part = engine.context_of(opened).part
    none, few, many, repair, exact = size_errors(part, part.tags, (0, 2, 60))
    assert none.points < few.points < many.points
    assert none.largest > few.largest > many.largest >= 0.0
    assert many.largest < 1e-3
    assert repair.on_edge == -1
    assert (exact.on_edge, exact.largest, exact.mean) == (-2, 0.0, 0.0)
    assert exact.points > none.points and exact.seconds > 0.0
    with pytest.raises(BadInput, match="from 0"):
        size_errors(part, part.tags, (-3,))


def test_three_points_on_a_ring_give_the_box_that_can_be_worked_out(engine, tmp_path):
    write_step(plate(30.0, 30.0, 5.0, hole=10.0).shape, tmp_path / "ring.step")
    part = read_part(tmp_path / "ring.step")
    bare, *_ = size_errors(part, part.tags, (0,))
    # One vertex a ring is all that stands on the hole's edges: of its box, 20 x 20 x 5, only the height is left.
    assert bare.largest == pytest.approx(1.0 - 5.0 / (2.0 * 10.0**2 * 4.0 + 25.0) ** 0.5, rel=1e-6)


def test_boundary_curves_made_by_the_kernel_lie_on_their_surfaces(engine, opened):
    assert max(engine.context_of(opened).part.boundary_error().values()) < 1e-6


def test_the_command_line_cuts_regroups_exports_and_measures(file, tmp_path, capsys):
    project, kept = tmp_path / "cut.trunnion", tmp_path / "kept.trunnion"
    hollow = bowl(40.0, 30.0, 12.0, 10.0).graph().surface.index("sphere") + 1
    plane = ["--plane", "20", "15", "8", "0", "0", "1"]
    assert (
        main(["cut", str(file), "--face", str(hollow), *plane, "--out", str(project), "--json"])
        == DONE
    )
    assert json.loads(capsys.readouterr().out)["faces"] == [hollow, 8]
    words = [
        "recognize",
        str(project),
        "--set",
        "family=surface",
        "--move",
        f"8,{hollow}=new",
        "--save",
        str(kept),
        "--json",
    ]
    assert main(words) == DONE
    made = next(
        f
        for f in json.loads(capsys.readouterr().out)["features"]
        if {r["face"] for r in f["faces"]} == {8, hollow}
    )
    assert (
        main(
            [
                "export",
                str(kept),
                "--local",
                made["id"],
                "--groups",
                made["id"],
                "--out",
                str(tmp_path / "a.igs"),
                "--json",
            ]
        )
        == DONE
    )
    assert json.loads(capsys.readouterr().out)["faces"] == sorted([8, hollow])
    assert main(["patches", str(kept), "--points", "0,3", "--json"]) == DONE
    told = json.loads(capsys.readouterr().out)
    assert [row["points_on_edge"] for row in told["size_errors"]] == [0, 3, -1, -2]
    assert told["boundary_error"]["mm"] < 1e-3


def dropping(engine, opened):
    """Return the bowl's session with its hollow below the smallest feature size."""
    return engine.run(
        engine.with_choices(opened, {"recognize.surface.smallest": 25.0}), "recognize"
    )


def test_dropped_patches_are_in_no_export_but_their_own(engine, opened):
    engine.context_of(opened)
    session = dropping(engine, opened)
    hollow = hollow_of(engine, session)
    assert session.recognition.dropped == (hollow,)
    assert tags_of(session, ["remaining"]) == tuple(sorted(set(range(1, 8)) - {hollow}))
    assert tags_of(session, ["dropped"]) == (hollow,)
    grouped = with_moved(engine, session, [hollow])
    assert grouped.recognition.dropped == () and hollow in tags_of(grouped, ["remaining"])


def test_faces_of_a_deleted_group_are_not_dropped(engine, found):
    gone = found.recognition.features[0]
    session = replace(found, recognition=found.recognition.without(gone.id))
    assert session.recognition.unexplained == gone.tags and session.recognition.dropped == ()
    assert set(gone.tags) <= set(tags_of(session, ["remaining"]))


def test_the_command_line_names_what_is_dropped(file, tmp_path, capsys):
    hollow = bowl(40.0, 30.0, 12.0, 10.0).graph().surface.index("sphere") + 1
    words = [str(file), "--set", "family=surface", "--set", "recognize.surface.smallest=25"]
    assert main(["recognize", *words]) == DONE
    assert f"1 dropped patch (face {hollow})" in capsys.readouterr().out
    rest = ["export", *words, "--groups", "remaining", "--out", str(tmp_path / "rest.igs")]
    assert main(rest) == DONE
    said = capsys.readouterr().out
    assert "6 faces written" in said and f"1 dropped patch (face {hollow}): not written" in said
    assert main([*rest, "--json"]) == DONE
    told = json.loads(capsys.readouterr().out)
    assert told["dropped"] == [hollow] and hollow not in told["faces"]
    assert len(read_part(tmp_path / "rest.igs").tags) == 6


@pytest.fixture(scope="module")
def open_file(tmp_path_factory):
    """An IGES file of five faces that enclose nothing."""
    path = tmp_path_factory.mktemp("open") / "open.igs"
    part = bowl(40.0, 30.0, 12.0, 10.0)
    write_faces([part.face_shape(t) for t in part.tags[2:]], path)
    return path


def test_an_open_part_is_grouped_exported_and_measured_with_exit_code_0(
    open_file, tmp_path, capsys
):
    grouped = [str(open_file), "--set", "family=surface"]
    assert main(["recognize", *grouped]) == DONE
    assert "warning part.open" in capsys.readouterr().err
    out = str(tmp_path / "rest.step")
    assert main(["export", *grouped, "--groups", "remaining", "--out", out]) == DONE
    assert main(["patches", str(open_file), "--points", "1"]) == DONE
    assert "exact" in capsys.readouterr().out


def test_an_open_part_that_no_side_sees_stays_an_error_where_material_matters(open_file, capsys):
    assert main(["info", str(open_file)]) == DONE
    assert "warning part.open" in capsys.readouterr().err
    assert main(["recognize", str(open_file), "--set", "family=panel"]) in (PROBLEMS, BAD)
    assert main(["route", str(open_file), "--set", "family=surface"]) == BAD


@pytest.mark.parametrize(
    "words", [["--out", "a.trunnion"], ["--plane", "0", "0", "0", "0", "0", "1", "--out", "a.step"]]
)
def test_a_cut_that_lacks_its_plane_or_its_project_is_one_line(file, words, capsys):
    assert main(["cut", str(file), "--face", "1", *words]) == BAD
    assert capsys.readouterr().err.count("\n") == 1
