"""The worker process: progress, cancel, crash, and what becomes of the session."""

from __future__ import annotations

import time

import numpy as np
import pytest

from trunnion_gui.worker.shared_memory import packed, unpacked
from trunnion_gui.worker.steps import TITLES
from trunnion_gui.worker.worker import GRACE_S, WRITING_GRACE_S, Worker


def opened(make_window, factory, part_file, idle):
    window = make_window(f"fake_engine:{factory}")
    window.document.files.open(part_file)
    idle(window)
    return window


def test_a_job_that_is_cancelled_before_anything_is_finished_leaves_the_session_as_it_was(
    make_window, part_file, idle, qtbot
):
    window = opened(make_window, "SlowEngine", part_file, idle)
    before, pid = window.document.session, window.document.jobs.worker.pid
    window.document.program()
    qtbot.waitUntil(lambda: window.document.running_step == "recognize", timeout=10000)
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=10000)
    assert window.document.jobs.worker.pid == pid  # it obeyed
    assert window.document.session is window.document.shown is before
    assert window.document.history.undo_label == ""
    assert (
        "was cancelled at: Recognize" in window.viewport.notice.text
        and "as it was" in window.viewport.notice.remedy
    )


@pytest.mark.parametrize("factory", ["SlowEngine", "DeafEngine"])
def test_steps_that_were_finished_before_a_cancel_are_kept_and_the_place_is_named(
    make_window, part_file, idle, qtbot, factory
):
    window = opened(make_window, factory, part_file, idle)
    before, pid = window.document.session, window.document.jobs.worker.pid
    window.document.program()
    last, kept = ("toolpath", "optimize") if factory == "DeafEngine" else ("size", "recognize")
    qtbot.waitUntil(lambda: window.document.running_step == last, timeout=20000)
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=2000)
    assert (window.document.jobs.worker.pid == pid) == (
        factory == "SlowEngine"
    )  # one that hears nothing is ended
    idle(window)
    assert window.document.states[kept] == "done" and window.document.states[last] == "empty"
    assert f"was cancelled at: {TITLES[last]}" in window.viewport.notice.text
    assert (
        TITLES[kept] in window.viewport.notice.remedy
        and TITLES[last] not in window.viewport.notice.remedy
    )
    window.document.undo()
    assert window.document.session is before


def test_a_person_who_cancels_waits_half_a_second_at_most():
    assert GRACE_S <= 0.4
    assert WRITING_GRACE_S > GRACE_S  # half a folder of programs is worse


def test_what_is_done_so_far_is_shown_while_the_rest_runs(make_window, part_file, idle, qtbot):
    window = opened(make_window, "SlowEngine", part_file, idle)
    window.document.program()
    qtbot.waitUntil(lambda: window.document.shown.recognition is not None, timeout=10000)
    assert window.document.is_busy
    assert window.document.session.recognition is None
    # The step counts as running until the worker names the next one.
    qtbot.waitUntil(lambda: window.panels["recognize"].state == "done", timeout=5000)
    qtbot.waitUntil(lambda: window.panels["size"].state == "running", timeout=5000)
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=5000)
    assert window.document.session is window.document.shown


@pytest.mark.cold
def test_a_job_that_does_not_listen_is_ended_with_its_process(make_window, part_file, idle, qtbot):
    window = opened(make_window, "DeafEngine", part_file, idle)
    pid = window.document.jobs.worker.pid
    window.document.program()
    qtbot.waitUntil(lambda: window.document.running_step == "toolpath", timeout=10000)
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=8000)
    assert window.document.jobs.worker.pid != pid
    window.document.choose("fake.blank.side", "Allowance", 7.0)
    window.document.run("route", "Generate route")
    idle(window)
    assert window.document.states["route"] == "done"


def test_a_crash_costs_the_job_and_not_the_session(make_window, part_file, idle, qtbot):
    window = opened(make_window, "CrashingEngine", part_file, idle)
    window.document.run("route", "Generate route")
    idle(window)
    before, pid = window.document.session, window.document.jobs.worker.pid
    window.document.program()
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=10000)
    idle(window)
    assert window.isVisible()
    assert "was lost" in window.viewport.notice.text and "Optimize" in window.viewport.notice.remedy
    assert window.document.states["optimize"] == "done"  # finished before the crash
    window.document.undo()
    assert window.document.session is before
    assert window.document.jobs.worker.is_alive and window.document.jobs.worker.pid != pid
    window.document.run("optimize", "Optimise")
    idle(window)
    assert window.document.states["optimize"] == "done"


@pytest.mark.cold
def test_a_killed_worker_starts_again_and_has_the_part(make_window, part_file, idle, qtbot):
    window = opened(make_window, "FakeEngine", part_file, idle)
    pid = window.document.jobs.worker.pid
    window.document.jobs.worker._process.kill()
    qtbot.waitUntil(lambda: window.document.jobs.worker.pid not in (0, pid), timeout=10000)
    idle(window)
    window.document.program()
    idle(window)
    assert window.document.session.verdict is not None


def test_a_fault_of_the_program_is_one_line_and_the_session_stays(make_window, part_file, idle):
    window = opened(make_window, "FaultyEngine", part_file, idle)
    before = window.document.session
    window.document.program()
    idle(window)
    assert "ZeroDivisionError" in window.viewport.notice.text
    assert "Blank" in window.viewport.notice.remedy
    assert window.document.states["blank"] == "done" and window.document.states["route"] == "empty"
    window.document.undo()
    assert window.document.session is before


def test_what_was_done_before_a_step_refused_is_kept(make_window, part_file, idle):
    window = opened(make_window, "RefusingEngine", part_file, idle)
    before = window.document.session
    window.document.program()
    idle(window)
    assert "not planned yet" in window.viewport.notice.text
    assert window.document.session.recognition is not None
    assert window.panels["recognize"].state == window.panels["blank"].state == "done"
    assert window.panels["route"].state == "empty"
    window.document.undo()
    idle(window)
    assert window.document.session is before
    window.document.run("route", "Generate route")
    idle(window)
    assert window.panels["recognize"].state == "done"
    window.document.run("route", "Generate route")
    idle(window)
    assert "not planned yet" in window.viewport.notice.text


def test_an_edit_while_a_job_runs_is_refused_in_words(make_window, part_file, idle, qtbot):
    window = opened(make_window, "SlowEngine", part_file, idle)
    window.document.program()
    window.panels["blank"].forms[0].field("fake.blank.side").setValue(9.0)
    assert "not while Program runs" in window.viewport.notice.text
    assert window.panels["blank"].forms[0].field("fake.blank.side").value() == 5.0
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=5000)


def test_the_window_never_waits_for_the_worker(make_window, part_file, idle, qtbot):
    window = opened(make_window, "SlowEngine", part_file, idle)
    from PySide6.QtCore import QTimer

    # Time of the window's own thread tells how long it works at a stretch, whatever others take of the machine; the clock on the wall
    # would show it waiting for a step of the worker, which takes three seconds.
    work, gaps, last = [], [], [(time.thread_time(), time.monotonic())]

    def tick():
        now = (time.thread_time(), time.monotonic())
        work.append(now[0] - last[0][0])
        gaps.append(now[1] - last[0][1])
        last[0] = now

    timer = QTimer()
    timer.timeout.connect(tick)
    timer.start(10)
    window.document.run("blank", "Create blank")
    qtbot.waitUntil(lambda: window.document.shown.recognition is not None, timeout=30000)
    window.registry.run("job.cancel")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=10000)
    assert sorted(work)[-3] < 0.35  # drawing a frame without a graphics card
    assert max(gaps) < 2.0


@pytest.mark.parametrize("rows", [10, 200_000])
def test_arrays_arrive_as_they_were_sent(rows):
    array = np.arange(rows * 3, dtype=np.float64).reshape(rows, 3)
    array.setflags(write=False)
    parcel = packed({"points": array, "name": "tray"})
    back = unpacked(parcel)
    assert bool(parcel.block) == (rows > 1000)
    assert back["name"] == "tray"
    assert np.array_equal(back["points"], array) and not back["points"].flags.writeable


def test_a_cancel_ends_with_the_worker_that_was_asked(qtbot):
    from shiboken6 import delete

    worker = Worker("fake_engine:FakeEngine")
    worker.cancel(worker.send("settings"))
    delete(worker)
    qtbot.wait(int(GRACE_S * 1000) + 200)  # what is raised meanwhile fails the test
    worker._end()
