"""Garbage is collected in the window's thread and in no other."""

from __future__ import annotations

import gc
import threading


class Ring:
    """Something that only a collection takes away, and that notes by which thread."""

    def __init__(self, seen: list[int]) -> None:
        self.me, self.seen = self, seen

    def __del__(self) -> None:
        self.seen.append(threading.get_ident())


def test_a_thread_that_makes_much_does_not_take_others_apart(tidy):
    seen: list[int] = []
    Ring(seen)
    busy = threading.Thread(target=lambda: [[k] for k in range(5000)])
    busy.start()
    busy.join()
    assert seen == [] and not gc.isenabled()
    while not seen:
        kept = [[k] for k in range(2000)]
        tidy.look()
    assert seen == [threading.get_ident()] and len(kept) == 2000


def test_what_is_kept_is_not_looked_through_again(tidy):
    before = gc.get_freeze_count()
    things = [[k] for k in range(20_000)]
    tidy.keep()
    assert gc.get_freeze_count() >= before + len(things)
