"""`trunnion change`: one operation set, copied, moved and taken out by hand; the project goes on from there; errors are one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from trunnion.cli.main import BAD, DONE, main


@pytest.fixture(scope="module")
def project(sample_part: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a project of the block with a pocket, routed: roughing made slower by hand."""
    file = tmp_path_factory.mktemp("change") / "block.trunnion"
    ids = route(sample_part)
    assert main([*change(sample_part, ids[0], file), "--feed", "900", "--quiet"]) == DONE
    return file


def route(part: Path) -> list[str]:
    """Return the ids of the operations that are planned for a part."""
    from trunnion.pipeline import Engine

    engine = Engine()
    process = engine.run(engine.open(str(part)), "route").process
    assert process is not None
    return [o.id for o in process.operations]


def change(part: Path, id: str, out: Path) -> list[str]:
    return ["change", str(part), "--operation", id, "--out", str(out)]


def planned(project: Path, capsys: pytest.CaptureFixture[str]) -> list[dict]:
    """Return the operations that a project goes on with."""
    capsys.readouterr()
    assert main(["route", str(project), "--json"]) == DONE
    return json.loads(capsys.readouterr().out)["operations"]


def changed(
    project: Path, id: str, capsys: pytest.CaptureFixture[str], *words: str
) -> tuple[dict, list[dict]]:
    """Return an operation as the command says it is now, and all that its project has then."""
    out = project.with_name("changed.trunnion")
    capsys.readouterr()
    assert main([*change(project, id, out), *words, "--json"]) == DONE
    return json.loads(capsys.readouterr().out)["operation"], planned(out, capsys)


def test_a_copy_gets_what_is_given_and_the_original_stays(project, capsys):
    before = planned(project, capsys)
    last = before[-1]
    copy, after = changed(
        project, last["id"], capsys, "--copy", "--feed", "700", "--own", "overlap=1.5"
    )
    assert (copy["id"], copy["copy_of"]) == (f"{last['id']}-copy", last["id"])
    assert copy["data"]["feed"] == 700.0
    assert [v for k, v in copy["choices"].items() if k.endswith(".overlap")] == [1.5]
    assert [o["id"] for o in after] == [*(o["id"] for o in before), copy["id"]]
    assert after[:-1] == before


def test_an_operation_moves_and_stays_there_in_a_new_route(project, capsys, tmp_path):
    before = [o["id"] for o in planned(project, capsys)]
    copy, after = changed(
        project, before[-1], capsys, "--copy", "--before", before[-1], "--suppress"
    )
    assert (copy["moved"], copy["suppressed"]) == (True, True)
    order = [*before[:-1], copy["id"], before[-1]]
    assert [o["id"] for o in after] == order
    # Another allowance: the route is made again.
    kept = project.with_name("changed.trunnion")
    assert main(["route", str(kept), "--set", "route.floor_allowance=0.31", "--json"]) == DONE
    again = json.loads(capsys.readouterr().out)["operations"]
    assert [o["id"] for o in again] == order
    resumed, _ = changed(kept, copy["id"], capsys, "--resume", "--last")
    assert not resumed["suppressed"]


def test_an_operation_is_led_by_the_faces_that_are_left(project, capsys):
    wall = next(o for o in planned(project, capsys) if o["strategy"] == "plane.wall")
    gone = wall["faces"][0]
    led, after = changed(project, wall["id"], capsys, "--leave-out", str(gone))
    assert led["own_faces"] and gone not in led["faces"]
    assert next(o for o in after if o["id"] == wall["id"])["faces"] == led["faces"]
    kept = project.with_name("changed.trunnion")
    again = kept.with_name("again.trunnion")
    assert main([*change(kept, wall["id"], again), "--add-faces", str(gone), "--json"]) == DONE
    back = json.loads(capsys.readouterr().out)["operation"]
    assert set(back["faces"]) == set(wall["faces"])


def test_what_is_taken_out_stays_out(project, capsys):
    before = [o["id"] for o in planned(project, capsys)]
    gone, after = changed(project, before[-1], capsys, "--delete")
    assert gone is None and [o["id"] for o in after] == before[:-1]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "nothing to change"),
        (["--delete", "--feed", "1"], "nothing else can be changed"),
        (["--own", "climb"], "--own wants KEY=VALUE"),
        (["--own", "colour=red"], "has no setting colour; it has "),
        (["--before", "nothing"], "there is no operation nothing; known: "),
        (["--copy", "--tool", "nothing"], "there is no tool nothing"),
        (["--on", "pocket-01"], "--on is for a copy"),
        (["--leave-out", "12,x"], "--leave-out wants face numbers"),
        (["--leave-out", "999"], "face 999 is not one of its faces"),
        (["--add-faces", "999"], "on face 999; they are on face"),
        (["--copy", "--on", "nothing"], "there is no feature nothing; known: "),
    ],
)
def test_what_can_not_be_is_one_line_and_nothing_is_written(project, capsys, tmp_path, words, said):
    last, out = planned(project, capsys)[-1]["id"], tmp_path / "new.trunnion"
    assert main([*change(project, last, out), *words]) == BAD
    error = capsys.readouterr().err.strip()
    assert said in error and len(error.splitlines()) == 1 and not out.exists()


def test_finishing_before_roughing_is_refused(project, capsys, tmp_path):
    first, *_, last = (o["id"] for o in planned(project, capsys))
    assert main([*change(project, last, tmp_path / "a.trunnion"), "--before", first]) == BAD
    assert f"{last} must come after" in capsys.readouterr().err
