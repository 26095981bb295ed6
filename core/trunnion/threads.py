"""Work in equal pieces on all cores: the same result for any number of threads, and cancel within a fraction of a second."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait

from trunnion.progress import Progress

LOOK = 0.05
"""Seconds between two looks at cancel."""


def in_parallel(
    work: Callable[[int, int], None],
    count: int,
    chunk: int,
    progress: Progress,
    text: str,
    threads: int = 0,
) -> None:
    """Call `work(first, last)` for all of `count` rows in chunks, on `threads` threads (0: one a core).

    `work` must let go of the interpreter's lock, touch nothing but its own rows, and end a chunk in a tenth of a second or so. Raises what
    progress raises on cancel, and what `work` raises; chunks at work end first.
    """
    starts = range(0, count, chunk)
    threads = min(threads or os.cpu_count() or 1, len(starts))
    if threads <= 1:
        for first in starts:
            progress.at(first / count, text)
            work(first, min(first + chunk, count))
        return
    # An iterator over a range hands out each start once, to whichever thread is free, without a lock.
    left, taken = iter(starts), [0]

    def loop() -> None:
        for first in left:
            taken[0] = first
            work(first, min(first + chunk, count))

    progress.at(0.0, text)
    with ThreadPoolExecutor(threads) as pool:
        waiting = {pool.submit(loop) for _ in range(threads)}
        try:
            while waiting:
                done, waiting = wait(waiting, timeout=LOOK, return_when=FIRST_EXCEPTION)
                for future in done:
                    future.result()
                progress.at(taken[0] / count, text)
        finally:
            # After an error or a cancel nobody takes another chunk.
            for _ in left:
                pass
