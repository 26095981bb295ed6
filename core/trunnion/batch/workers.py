"""Parts handed to the workers of Dask: of this process, or of a cluster's scheduler. Its documentation: https://distributed.dask.org.

On this computer the workers are threads of this process that each wait for the process of one part, and scheduler and workers speak
within memory: what could crash or swell is in the parts' processes only. Each task watches whether it is wanted any more, for Dask
itself ends no task that is at work; that holds for a cluster too, where a client that is gone takes its tasks with it.
"""

from __future__ import annotations

import logging
import os
import socket
import tempfile
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from trunnion.batch.part_process import part_processed
from trunnion.batch.request import PartRequest
from trunnion.findings import BadInput
from trunnion.model.part_result import CRASHED, REFUSED, PartResult
from trunnion.version import __version__

if TYPE_CHECKING:
    from distributed import Client, Worker

SHARE_OF_MEMORY = 0.8
"""Share of a computer's memory that its parts may have together: the rest is the system's and other programs'."""
WAIT_S = 10.0
"""Seconds that a scheduler's answer, and its first worker, are waited for."""
BEAT_S = 0.25
"""Seconds between two looks at what tasks report."""
LOOPBACK = "127.0.0.1:0"
"""Where the servers that Dask starts in any case listen: no other computer reaches them; they serve nothing."""
_MEGA = 1 << 20


@dataclass(frozen=True, slots=True, kw_only=True)
class PartProgress:
    """How far a part is: `folder` names it, `fraction` from 0 to 1, `text` says what is done."""

    folder: str
    fraction: float
    text: str


class BatchWorkers:
    """Workers that program parts, from `local` or `at` on, in their `with` blocks."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._topic = f"trunnion-batch-{uuid.uuid4().hex}"
        self._news: SimpleQueue[tuple[str, Any]] = SimpleQueue()

    def results(
        self, requests: Sequence[PartRequest], report: Callable[[PartProgress], None]
    ) -> Iterator[PartResult]:
        """Yield the results of parts as they come, while `report` is told in this thread how far the others are.

        When the iteration ends early, by whatever is raised meanwhile, no part is at work any more on this computer, and those on others
        are told to stop.
        """
        self._client.subscribe_topic(self._topic, self._take_progress)
        futures = {}
        for request in requests:
            key = f"{self._topic}-{request.folder}"
            future = self._client.submit(
                program_on_worker, request, self._topic, key=key, pure=False, retries=0
            )
            futures[key] = (future, request)
            future.add_done_callback(lambda done: self._news.put(("done", done.key)))
        try:
            while futures:
                try:
                    kind, value = self._news.get(timeout=BEAT_S)
                except Empty:
                    continue
                if kind == "progress":
                    report(value)
                    continue
                future, request = futures.pop(value)
                yield _result_of(future, request)
        finally:
            self._client.cancel([future for future, _ in futures.values()], force=True)
            self._client.unsubscribe_topic(self._topic)

    def _take_progress(self, event: tuple[float, tuple[str, float, str]]) -> None:
        folder, fraction, text = event[1]
        self._news.put(("progress", PartProgress(folder=folder, fraction=fraction, text=text)))


@contextmanager
def local(jobs: int) -> Iterator[BatchWorkers]:
    """Give workers of this process for so many parts at once."""
    import dask
    from distributed import Client, LocalCluster

    # Without routes the servers have no pages, and without "dashboard" no bokeh is looked for.
    alone: dict[str, list[str]] = {
        "distributed.scheduler.http.routes": [],
        "distributed.worker.http.routes": [],
    }
    with (
        _without_log(),
        dask.config.set(alone),
        tempfile.TemporaryDirectory(prefix="trunnion-batch-") as scratch,
        LocalCluster(
            n_workers=1,
            threads_per_worker=jobs,
            processes=False,
            protocol="inproc://",
            dashboard_address=LOOPBACK,
            worker_dashboard_address=LOOPBACK,
            scheduler_kwargs={"dashboard": False},
            memory_limit=None,
            local_directory=scratch,
            silence_logs=logging.CRITICAL + 1,
        ) as cluster,
        Client(cluster) as client,
    ):
        yield BatchWorkers(client)


@contextmanager
def at(address: str) -> Iterator[BatchWorkers]:
    """Give the workers of a cluster by its scheduler's address, as in `tcp://10.0.0.5:8786`.

    Raises `BadInput` where nobody answers there, or a worker has not this version of the program.
    """
    from distributed import Client

    with _without_log():
        try:
            client = Client(address, timeout=WAIT_S, set_as_default=False)
        except (OSError, ValueError) as reason:
            raise BadInput(
                f"{address}: no scheduler of Dask answers there ({_line(reason)}); start one with `dask scheduler`"
            ) from None
        with client:
            _check_workers(client, address)
            yield BatchWorkers(client)


def _check_workers(client: Client, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=WAIT_S)
    except TimeoutError:
        raise BadInput(
            f"{address}: the scheduler has no workers; start some with `dask worker {address}`"
        ) from None
    versions = client.run(worker_version, on_error="return")
    for worker, version in sorted(versions.items()):
        if version != __version__:
            had = f"version {version}" if isinstance(version, str) else _line(version)
            raise BadInput(
                f"{address}: the worker {worker} can't program parts ({had}): install trunnion {__version__} there"
            )


def worker_version() -> str:
    """Return the version of the program where this is called."""
    return __version__


def program_on_worker(request: PartRequest, topic: str) -> PartResult:
    """Program a part where a worker of Dask calls this: within the worker's share of memory if the request gives no limit."""
    from distributed import get_worker

    worker = get_worker()
    key = worker.get_current_task()
    before: list[tuple[float, str]] = []

    def is_stopped() -> bool:
        task = worker.state.tasks.get(key)
        return task is None or task.state == "cancelled"

    def report(fraction: float, text: str) -> None:
        if [(fraction, text)] != before:
            before[:] = [(fraction, text)]
            worker.log_event(topic, (request.folder, fraction, text))

    host = socket.gethostname()
    for folder in (request.start, request.output):
        if not Path(folder).is_dir():
            return _without(
                request,
                REFUSED,
                f"the folder {folder} is not there on {host}: start the batch where all computers of the cluster see its folders",
            )
    limited = request if request.memory else request.with_memory(_share_of_memory(worker))
    return replace(part_processed(limited, report, is_stopped), host=host)


def _share_of_memory(worker: Worker) -> float:
    """Return the memory that each of a worker's parts may have, MB."""
    from distributed.system import MEMORY_LIMIT

    whole = worker.memory_manager.memory_limit or SHARE_OF_MEMORY * MEMORY_LIMIT
    return float(whole // worker.state.nthreads // _MEGA)


def _result_of(future: Any, request: PartRequest) -> PartResult:
    """Return a task's result; what it raises is the part's crash: workers that went with it (KilledWorker), or an error of ours.

    Raises `BadInput` where the scheduler is gone.
    """
    if future.status in ("lost", "cancelled"):
        raise BadInput(
            "the scheduler of Dask is gone; the same call goes on with the parts that were not done"
        )
    try:
        made: PartResult = future.result()
    except Exception as reason:  # noqa: BLE001 - one part's end must not be that of the others
        return _without(request, CRASHED, f"{type(reason).__name__}: {_line(reason)}")
    return made


def _without(request: PartRequest, verdict: str, note: str) -> PartResult:
    return PartResult(part=request.part, folder=request.folder, verdict=verdict, note=note)


def _line(reason: object) -> str:
    """Return the first line of why something failed."""
    return (str(reason).strip().splitlines() or [type(reason).__name__])[0]


@contextmanager
def _without_log() -> Iterator[None]:
    """Keep Dask's own log from standard error: what matters to a person is in the parts' results."""
    # The loggers below have levels of their own: their lines all end in the handlers of this one.
    handlers = [(h, h.level) for h in logging.getLogger("distributed").handlers]
    for handler, _ in handlers:
        handler.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for handler, level in handlers:
            handler.setLevel(level)


def usual_jobs() -> int:
    """Return how many parts are programmed at once on this computer: one for two cores, for a part's own work keeps about two busy."""
    return max(1, len(os.sched_getaffinity(0)) // 2) if hasattr(os, "sched_getaffinity") else 1
