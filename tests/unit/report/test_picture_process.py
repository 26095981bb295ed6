"""A process that draws: the same pictures as drawn here, cancelled at once, and drawn here where it has ended."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cadquery as cq
import pytest
from vtkmodules.vtkRenderingCore import vtkMapper

from samples import written
from trunnion.findings import Cancelled
from trunnion.geometry.mesh import Mesh
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.report.picture_process import PictureProcess, here


@pytest.fixture(scope="module")
def recognised() -> tuple[Engine, Session]:
    engine = Engine()
    session = engine.open(written(cq.Workplane("XY").box(60.0, 40.0, 20.0).val().wrapped))
    return engine, engine.run(
        engine.with_choices(session, {"recognize.family": "surface"}), "recognize"
    )


def bytes_of(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def folders_in(folder: Path, *names: str) -> list[Path]:
    made = [folder / name for name in names]
    for one in made:
        one.mkdir()
    return made


def test_a_process_draws_the_same_bytes_picture_after_picture(recognised, tmp_path) -> None:
    engine, session = recognised
    mesh = engine.mesh(session)
    folders = folders_in(tmp_path, "here", "there", "again")
    expected = here(session, mesh, folders[0], "block")(NO_PROGRESS)
    with PictureProcess() as process:
        made = [process.begin(session, mesh, f, "block")(NO_PROGRESS) for f in folders[1:]]
    assert made == [expected, expected] and [p.file for p in expected] == ["block.features.png"]
    first, *others = map(bytes_of, folders)
    assert first and all(other == first for other in others)


def test_a_plan_drawn_ahead_is_kept_for_the_same_plan_only(recognised, tmp_path) -> None:
    engine, session = recognised
    mesh = engine.mesh(session)
    folders = folders_in(tmp_path, "here", "same", "changed")
    here(session, mesh, folders[0], "block")(NO_PROGRESS)
    other = replace(session, recognition=replace(session.recognition, features=()))
    with PictureProcess() as process:
        process.ahead(session, mesh)
        # A session that goes on with the same plan is given what was drawn: another mesh would draw other bytes.
        half = Mesh(points=mesh.points, triangles=mesh.triangles[::2], face=mesh.face[::2])
        process.begin(replace(session, choices={}), half, folders[1], "block")(NO_PROGRESS)
        process.begin(other, mesh, folders[2], "block")(NO_PROGRESS)
    expected, same, changed = map(bytes_of, folders)
    assert same == expected != changed


def test_pictures_are_drawn_here_where_the_process_has_ended(recognised, tmp_path) -> None:
    engine, session = recognised
    with PictureProcess() as process:
        process._child.kill()
        made = process.begin(session, engine.mesh(session), tmp_path, "block")(NO_PROGRESS)
    assert [p.file for p in made] == ["block.features.png"]
    assert set(bytes_of(tmp_path)) == {"block.features.png"}


def test_cancel_does_not_wait_for_the_pictures(recognised, tmp_path) -> None:
    engine, session = recognised
    with PictureProcess() as process, pytest.raises(Cancelled):
        drawn = process.begin(session, engine.mesh(session), tmp_path, "block")
        drawn(Progress(cancelled=lambda: True))


def test_what_a_window_set_for_all_of_vtk_changes_no_picture(recognised, tmp_path) -> None:
    engine, session = recognised
    mesh, made = engine.mesh(session), []
    for name, switch in (
        ("window", vtkMapper.SetResolveCoincidentTopologyToPolygonOffset),
        ("none", vtkMapper.SetResolveCoincidentTopologyToOff),
    ):
        switch()
        folder = tmp_path / name
        folder.mkdir()
        here(session, mesh, folder, "block")(NO_PROGRESS)
        made.append(bytes_of(folder))
    assert made[0] == made[1]
