"""Long work of the window's thread in pieces."""

from __future__ import annotations

import time

import pytest
from PySide6.QtCore import QObject, QTimer

from trunnion_gui.pieces import STRETCH_S, PieceExecution

PIECE_S = 0.005


@pytest.fixture
def execution(qapp):
    parent = QObject()
    yield PieceExecution(parent)
    parent.deleteLater()


def working(done, count):
    """Work `PIECE_S` s of the thread's own time for each piece, and note it."""
    for piece in range(count):
        end = time.thread_time() + PIECE_S
        while time.thread_time() < end:
            pass
        done.append(piece)
        yield


def test_short_work_is_done_at_once(execution):
    done = []
    execution.begin(working(done, 2))
    assert done == [0, 1] and not execution.is_running


def test_other_events_come_between_the_pieces_of_long_work(execution, qtbot):
    done, between = [], []
    timer = QTimer()
    timer.timeout.connect(lambda: between.append(len(done)))
    timer.start(0)
    execution.begin(working(done, 40))
    assert 0 < len(done) < 40
    qtbot.waitUntil(lambda: not execution.is_running, timeout=5000)
    timer.stop()
    assert done == list(range(40))
    steps = [b - a for a, b in zip([0, *between], between)]
    assert max(steps) <= STRETCH_S / PIECE_S + 2


def test_another_work_takes_the_place_of_what_is_left(execution, qtbot):
    first, second = [], []
    execution.begin(working(first, 40))
    so_far = len(first)
    execution.begin(working(second, 20))
    qtbot.waitUntil(lambda: not execution.is_running, timeout=5000)
    assert len(first) == so_far and second == list(range(20))


def test_stopped_work_does_not_go_on(execution, qtbot):
    done = []
    execution.begin(working(done, 40))
    so_far = len(done)
    execution.stop()
    qtbot.wait(30)
    assert len(done) == so_far and not execution.is_running
