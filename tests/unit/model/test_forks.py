"""Work in copies of the process: what comes back, what is raised, and what becomes of a copy that is ended."""

from __future__ import annotations

import os
import select
import signal
from functools import partial

import numpy as np
import pytest

from trunnion.findings import Cancelled, Refused
from trunnion.forks import Fork
from trunnion.progress import NO_PROGRESS, Progress

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system can't copy processes")


def is_running(process) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def endless(progress):
    while True:
        progress.at(0.5)


def test_an_answer_of_any_size_comes_back_from_another_process() -> None:
    known = np.arange(2_000_000)
    fork = Fork(lambda progress: (os.getpid(), known * 2))
    process, doubled = fork.result(NO_PROGRESS)
    assert process != os.getpid() and (doubled == known * 2).all()
    assert not is_running(process)


def test_two_pieces_of_work_go_on_beside_each_other() -> None:
    """Each sends a byte that the other one waits for: in turn neither would come to an end."""
    pipes = [os.pipe(), os.pipe()]

    def work(progress, n):
        os.write(pipes[1 - n][1], b"x")
        return os.read(pipes[n][0], 1)

    forks = [Fork(partial(work, n=n)) for n in range(2)]
    assert [f.result(NO_PROGRESS) for f in forks] == [b"x", b"x"]
    for end in (*pipes[0], *pipes[1]):
        os.close(end)


def test_what_the_work_raises_is_raised_where_its_answer_is_wanted() -> None:
    def work(progress):
        raise Refused("no cutter")

    with pytest.raises(Refused, match="no cutter"):
        Fork(work).result(NO_PROGRESS)


def test_how_far_the_work_is_is_told_while_it_is_waited_for() -> None:
    """The work goes on by a step whenever its last one was told."""
    heard, hears = os.pipe()

    def work(progress):
        for n in range(1, 5):
            progress.at(n / 5)
            os.read(heard, 1)

    told = []

    def tell(fraction, text):
        if fraction and fraction not in told:
            told.append(fraction)
            os.write(hears, b"x")

    Fork(work).result(Progress(tell))
    assert told == [0.2, 0.4, 0.6, 0.8]
    os.close(heard)
    os.close(hears)


def test_a_cancel_while_waiting_leaves_the_copy_to_be_stopped() -> None:
    fork = Fork(endless)
    with pytest.raises(Cancelled):
        fork.result(Progress(cancelled=lambda: True))
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
    """Both copies hold the writing end of a pipe: what reads it comes to its end when neither is left."""
    reads, writes = os.pipe()

    def parent(progress):
        return Fork(endless).process

    Fork(parent).result(NO_PROGRESS)
    os.close(writes)
    ready, _, _ = select.select([reads], [], [], 10.0)
    assert ready and os.read(reads, 1) == b""
    os.close(reads)
