"""Progress that never stands still: repeated, never backwards, kept up while compiled code or another thread is at work."""

from __future__ import annotations

import threading
import time
from functools import partial

import numpy as np
import pytest
from numba import njit

from trunnion import progress as module
from trunnion.findings import Cancelled, Refused
from trunnion.geometry.kernels.compiling import TEXT, compiling
from trunnion.progress import BEAT_S, NO_PROGRESS, Progress
from trunnion.threads import in_parallel


class Watch:
    """Takes reports, counts looks, and cancels at one of them (0: never)."""

    def __init__(self, stop_at: int = 0) -> None:
        self.reports: list[tuple[float, str]] = []
        self.looks, self._stop_at = 0, stop_at

    def progress(self) -> Progress:
        return Progress(lambda fraction, text: self.reports.append((fraction, text)), self._look)

    def _look(self) -> bool:
        self.looks += 1
        return self.looks == self._stop_at

    @property
    def fractions(self) -> list[float]:
        return [fraction for fraction, _ in self.reports]


def test_a_look_repeats_a_report_that_is_old(monkeypatch) -> None:
    now, watch = [100.0], Watch()
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    progress = watch.progress()
    progress.at(0.25, "cutting")
    progress.check()
    assert watch.reports == [(0.25, "cutting")]
    now[0] += 1.01 * BEAT_S
    progress.part(0.5, 1.0).check()
    progress.check()
    assert watch.reports == [(0.25, "cutting")] * 2


def test_what_is_told_of_one_piece_of_work_never_goes_back() -> None:
    watch = Watch()
    progress = watch.progress()
    progress.part(0.0, 0.5).at(1.0)
    progress.part(0.0, 0.5).at(0.2)
    progress.afresh().at(0.1)
    assert watch.fractions == [0.5, 0.5, 0.1]


def test_parts_with_a_name_say_it_before_their_texts() -> None:
    watch = Watch()
    watch.progress().part(0.0, 1.0, "proof").part(0.0, 1.0, "S1").at(0.5, "contact")
    watch.progress().part(0.0, 1.0, "proof").at(0.5)
    assert [text for _, text in watch.reports] == ["proof: S1: contact", "proof"]


def test_what_the_work_does_now_is_told_as_far_as_it_was() -> None:
    watch = Watch()
    progress = watch.progress()
    progress.at(0.4, "cutting")
    progress.doing("making a picture")
    assert watch.reports[-1] == (0.4, "making a picture")


def test_slices_cover_all_rows_and_tell_how_far_they_are() -> None:
    watch = Watch()
    assert [list(range(10))[some] for some in watch.progress().slices(10, 4, "rows")] == [
        [0, 1, 2, 3],
        [4, 5, 6, 7],
        [8, 9],
    ]
    assert watch.reports == [(0.0, "rows"), (0.4, "rows"), (0.8, "rows")]


def test_work_in_a_thread_of_its_own_is_looked_at_and_answers() -> None:
    watch = Watch()
    assert (
        watch.progress().aside(lambda own: (time.sleep(0.3), threading.current_thread().name)[1])
        == "trunnion-aside"
    )
    assert watch.looks >= 3
    assert NO_PROGRESS.aside(lambda own: threading.current_thread() is threading.main_thread())


def test_work_in_a_thread_of_its_own_raises_its_own_errors() -> None:
    def work(own: Progress) -> None:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        Watch().progress().aside(work)


def test_cancel_does_not_wait_for_work_in_a_thread_of_its_own_and_ends_it() -> None:
    ended = threading.Event()

    def work(own: Progress) -> None:
        try:
            while True:
                own.check()
                time.sleep(0.001)
        except Cancelled:
            ended.set()
            raise

    with pytest.raises(Cancelled):
        Watch(stop_at=3).progress().aside(work)
    assert ended.wait(5.0)


def test_pieces_of_work_are_done_in_turn_in_one_thread_while_others_go_on() -> None:
    done: list[tuple[int, str]] = []

    def piece(n: int, own: Progress) -> int:
        own.check()
        time.sleep(0.01 * (3 - n))
        done.append((n, threading.current_thread().name))
        return n

    with Watch().progress().in_turn() as begin:
        waits = [begin(partial(piece, n)) for n in range(3)]
        assert [wait() for wait in waits] == [0, 1, 2]
    assert [n for n, _ in done] == [0, 1, 2]
    (name,) = {name for _, name in done}
    assert name != threading.current_thread().name


def test_a_piece_in_turn_raises_its_own_error_where_it_is_waited_for() -> None:
    def work(own: Progress) -> None:
        raise Refused("no room")

    with Watch().progress().in_turn() as begin:
        waits = begin(work), begin(lambda own: "done")
        assert waits[1]() == "done"
        with pytest.raises(Refused, match="no room"):
            waits[0]()


def test_cancel_ends_the_piece_at_work_and_drops_those_in_turn() -> None:
    begun: list[str] = []

    def endless(own: Progress) -> None:
        begun.append("endless")
        while True:
            own.check()
            time.sleep(0.01)

    with pytest.raises(Cancelled), Watch(stop_at=3).progress().in_turn() as begin:
        wait = begin(endless)
        begin(lambda own: begun.append("dropped"))
        wait()
    assert begun == ["endless"]


@pytest.mark.parametrize("threads", [1, 2])
def test_rows_done_in_parallel_are_told_while_the_last_of_them_run(threads) -> None:
    watch, done = Watch(), np.zeros(12, bool)

    def work(first: int, last: int) -> None:
        time.sleep(0.01)
        done[first:last] = True

    in_parallel(work, 12, 2, watch.progress(), "rows", threads)
    assert done.all() and watch.fractions == sorted(watch.fractions) and watch.fractions[-1] >= 0.5


def fresh_kernel():
    """Return a kernel that nobody has compiled yet."""

    @njit
    def inner(x):
        return x * x + 1.0

    @njit
    def total(values):
        found = 0.0
        for k in range(len(values)):
            found += inner(values[k])
        return found

    return total


def test_the_compiler_is_looked_at_between_its_passes() -> None:
    watch, kernel = Watch(), fresh_kernel()
    progress = watch.progress()
    progress.at(0.3, "cutting")
    with compiling(progress):
        assert kernel(np.ones(3)) == 6.0
    assert watch.looks > 20 and watch.reports[-1] == (0.3, TEXT)
    told = len(watch.reports)
    with compiling(progress):
        kernel(np.ones(4))
    assert len(watch.reports) == told


def test_cancel_ends_the_compiler_and_the_kernel_works_afterwards() -> None:
    kernel = fresh_kernel()
    for stop_at in (5, 20, 40):
        with pytest.raises(Cancelled), compiling(Watch(stop_at).progress()):
            kernel(np.ones(3))
    assert kernel(np.ones(3)) == 6.0
