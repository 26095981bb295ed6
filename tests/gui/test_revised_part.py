"""A revised part taken up in the window: what was done by hand stays, the project before is not written over."""

from __future__ import annotations

import pytest
from shared_window import shared_window, wait

from revised_panels import PanelDesign
from samples import renumbered, written


@pytest.fixture(scope="module")
def planned(qapp, tmp_path_factory):
    """One window for all tests here, and the project of a panel that is planned and whose first roughing a person made slower."""
    folder = tmp_path_factory.mktemp("planned")
    with shared_window(folder) as window:
        window.document.files.open(written(PanelDesign().shape(), name="panel"))
        wait(window)
        window.document.run("optimize", "Optimize")
        wait(window)
        window.document.change_operation("rough-pocket-01", "Feed", "operation.feed", 3000.0)
        wait(window)
        window.document.files.save(folder / "planned.trunnion")
        wait(window)
        yield window, folder / "planned.trunnion"


@pytest.fixture
def changed(planned, monkeypatch):
    """That window with its project open, and a revision of the panel to choose."""
    window, project = planned
    window.document.files.open(project)
    wait(window)
    revision = written(renumbered(PanelDesign(left_floor=6.0, third=True).shape()), name="panel_b")
    monkeypatch.setattr(window.dialogs, "revised_path", lambda: str(revision))
    return window


def test_a_revised_part_keeps_operations_by_hand_and_is_not_saved_over_the_project(
    changed, idle, tmp_path
):
    window = changed
    window.document.files.save(tmp_path / "a.trunnion")
    idle(window)
    before = window.document.session
    window.registry.action("file.revise").trigger()
    idle(window)
    session = window.document.session
    assert session.part.name == "panel_b" and session.part.digest != before.part.digest
    assert window.document.files.project == "" and window.document.history.is_dirty
    assert len(window.document.mesh.face) and set(window.document.mesh.face) == set(
        range(1, session.part.n_faces + 1)
    )
    assert any("of 48 faces of the part before" in m.text for m in window.docks.messages.findings)
    assert [f.id for f in session.recognition.of_kind("pocket")] == [
        "pocket-01",
        "pocket-02",
        "pocket-03",
    ]
    window.document.run("optimize", "Optimize")
    idle(window)
    rough = window.document.session.process.operation("rough-pocket-01")
    assert rough.by_hand and rough.data.feed == 3000.0


def test_another_part_is_refused_in_a_message_and_the_work_goes_on(
    changed, idle, sample_part, monkeypatch
):
    window, before = changed, changed.document.session
    monkeypatch.setattr(window.dialogs, "revised_path", lambda: str(sample_part))
    window.unsaved.confirms = False
    window.registry.action("file.revise").trigger()
    idle(window)
    assert window.document.session is before
    assert any("it is another part" in m.text for m in window.docks.messages.findings)
    window.document.run("toolpath", "Toolpath")
    idle(window)
    assert window.document.session.paths
