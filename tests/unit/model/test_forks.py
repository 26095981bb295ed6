"""Work in copies of the process: what comes back, what is raised, and what becomes of a copy that is ended."""

from __future__ import annotations

import os
import signal
import time

import numpy as np
import pytest

from trunnion.findings import Cancelled, Refused
from trunnion.forks import Fork, copies
from trunnion.progress import NO_PROGRESS, Progress

pytestmark = pytest.mark.skipif(copies() == 0, reason="this process can't be copied")


def is_running(process) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def ended(process) -> bool:
    """Return whether a process ends within two seconds."""
    for _ in range(200):
        if not is_running(process):
            return True
        time.sleep(0.01)
    return False


def endless(progress):
    while True:
        progress.at(0.5)
        time.sleep(0.01)


def test_an_answer_of_any_size_comes_back_from_another_process() -> None:
    known = np.arange(2_000_000)
    fork = Fork(lambda progress: (os.getpid(), known * 2))
    process, doubled = fork.result(NO_PROGRESS)
    assert process != os.getpid() and (doubled == known * 2).all()
    assert not is_running(process)


def test_two_pieces_of_work_go_on_beside_each_other() -> None:
    begun = time.monotonic()
    forks = [Fork(lambda progress, n=n: (time.sleep(1.0), n)[1]) for n in range(2)]
    assert [f.result(NO_PROGRESS) for f in forks] == [0, 1]
    assert time.monotonic() - begun < 1.8


def test_what_the_work_raises_is_raised_where_its_answer_is_wanted() -> None:
    def work(progress):
        raise Refused("no cutter")

    with pytest.raises(Refused, match="no cutter"):
        Fork(work).result(NO_PROGRESS)


def test_how_far_the_work_is_is_told_while_it_is_waited_for() -> None:
    def work(progress):
        for n in range(5):
            progress.at(n / 5)
            time.sleep(0.1)

    told = []
    Fork(work).result(Progress(lambda fraction, text: told.append(fraction)))
    assert set(told) <= {0.0, 0.2, 0.4, 0.6, 0.8} and len(set(told)) >= 3


def test_a_cancel_while_waiting_leaves_the_copy_to_be_stopped() -> None:
    fork, since = Fork(endless), time.monotonic()
    with pytest.raises(Cancelled):
        fork.result(Progress(cancelled=lambda: time.monotonic() - since > 0.3))
    assert not fork.is_done()
    fork.stop()
    assert fork.is_done() and not is_running(fork.process)


def test_work_whose_copy_is_ended_from_outside_is_done_here() -> None:
    def work(progress):
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return os.getpid()

    here = os.getpid()
    assert Fork(work).result(NO_PROGRESS) == here


def test_a_copy_ends_soon_after_the_process_it_is_of() -> None:
    def parent(progress):
        return Fork(endless).process

    left = Fork(parent).result(NO_PROGRESS)
    assert ended(left)
