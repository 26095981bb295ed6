"""Work in equal pieces on all cores: the same result for any number of threads, and cancel within a fraction of a second."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

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
    progress raises on cancel; chunks at work end first.
    """
    starts = list(range(0, count, chunk))
    threads = min(threads or os.cpu_count() or 1, len(starts))
    if threads <= 1:
        for first in starts:
            progress.at(first / count, text)
            work(first, min(first + chunk, count))
        return
    with ThreadPoolExecutor(threads) as pool:
        waiting: set[Future[None]] = set()
        try:
            for n, first in enumerate(starts):
                while len(waiting) >= 2 * threads:
                    waiting = _collected(waiting)
                    progress.at((n - len(waiting)) / len(starts), text)
                waiting.add(pool.submit(work, first, min(first + chunk, count)))
            while waiting:
                progress.at((len(starts) - len(waiting)) / len(starts), text)
                waiting = _collected(waiting)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _collected(waiting: set[Future[None]]) -> set[Future[None]]:
    done, rest = wait(waiting, timeout=LOOK, return_when=FIRST_COMPLETED)
    for future in done:
        future.result()
    return rest
