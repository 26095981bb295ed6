"""A batch from its parts to its page: what an earlier run did is taken over, the rest is programmed, and all is kept as it comes."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.batch.parts import BatchPart, batch_parts, name_in
from trunnion.batch.request import PartRequest, common_digest, file_digest
from trunnion.batch.workers import BatchWorkers, PartProgress, at, local, usual_jobs
from trunnion.findings import BadInput
from trunnion.model.part_result import (
    CRASHED,
    OUT_OF_MEMORY,
    OVER_TIME,
    WITHOUT_VERDICT,
    PartResult,
)
from trunnion.model.session import Session
from trunnion.report.batch_page import batch_page
from trunnion.script.open_part import check_user_folder
from trunnion.settings import Value, digest
from trunnion.store.atomic import write_text
from trunnion.store.ledger import PAGE_FILE, LedgerEntry, read_ledger, write_ledger
from trunnion.store.programs import remove_programs

if TYPE_CHECKING:
    from trunnion.pipeline import Engine

Finished = Callable[[PartResult, bool], None]
"""Is told each part's result as it comes, and whether it was taken over from an earlier run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """What a batch is of: part `files` as they were named, the `output` folder, settings by key, and what `PartRequest` has of them.

    `jobs` parts are programmed at once on this computer (0: as many as suit it), or those that the workers of a Dask `scheduler` take.
    `memory` MB and `seconds` are each part's limits, 0 as in `PartRequest`. With `again` nothing is taken over.
    """

    files: Sequence[str]
    output: Path
    settings: Mapping[str, Value]
    solid: int | None = None
    fixtures: tuple[str, ...] = ()
    user_folder: Path | None = None
    jobs: int = 0
    scheduler: str = ""
    memory: float = 0.0
    seconds: float = 0.0
    again: bool = False


def run_batch(
    batch: Batch, finished: Finished, report: Callable[[PartProgress], None]
) -> tuple[PartResult, ...]:
    """Program the parts of a batch, or take over what the ledger in its folder has of them, and return the results in the parts' order.

    Ledger and page are written after each part. Raises `BadInput` for settings, files or a scheduler that can't be used, before anything is
    programmed. Stopped by whatever is raised meanwhile, it leaves the ledger with all that was finished.
    """
    from trunnion.pipeline import Engine

    check_user_folder(batch.user_folder)
    engine = Engine(batch.user_folder)
    settings = engine.with_choices(Session(), batch.settings).choices
    _check_fixtures(batch.fixtures)
    batch.output.mkdir(parents=True, exist_ok=True)
    with _alone_in(batch.output):
        work = _Work(replace(batch, settings=settings), engine, finished)
        waiting = work.take_over()
        if waiting:
            with _workers(batch) as workers:
                for result in workers.results(waiting, report):
                    work.add(result)
        return work.results()


class _Work:
    """The state of a batch: its parts, their digests, and the ledger's entries by the parts' files."""

    def __init__(self, batch: Batch, engine: Engine, finished: Finished) -> None:
        self._batch, self._finished = batch, finished
        self._entries = {e.file: e for e in read_ledger(batch.output)}
        output = Path(os.path.realpath(batch.output))
        known = {
            os.path.realpath(output / file): entry.result.folder
            for file, entry in self._entries.items()
        }
        self._parts = batch_parts(batch.files, known)
        self._keys = {p.folder: os.path.relpath(p.file, output) for p in self._parts}
        common = common_digest(engine, batch.settings, batch.solid, batch.fixtures)
        self._digests = {p.folder: digest(common, file_digest(p.file)) for p in self._parts}
        self._done: dict[str, PartResult] = {}

    def take_over(self) -> list[PartRequest]:
        """Take over what still holds and return the requests of the other parts."""
        waiting = []
        for part in self._parts:
            entry = self._entries.get(self._keys[part.folder])
            if entry is not None and not self._batch.again and self._holds(part, entry):
                result = replace(entry.result, part=part.part)
                self._done[part.folder] = result
                self._finished(result, True)
            else:
                waiting.append(self._request(part))
        self._write_page()
        return waiting

    def add(self, result: PartResult) -> None:
        """Keep a part's result in the ledger and on the page; programs of an earlier run don't stay where there is no verdict now."""
        key = self._keys[result.folder]
        if result.verdict in WITHOUT_VERDICT:
            remove_programs(self._batch.output / result.folder, name_in(Path(result.part)))
        self._entries[key] = LedgerEntry(
            file=key, digest=self._digests[result.folder], result=result
        )
        self._done[result.folder] = result
        write_ledger(self._batch.output, [e for _, e in sorted(self._entries.items())])
        self._write_page()
        self._finished(result, False)

    def results(self) -> tuple[PartResult, ...]:
        """Return the results in the parts' order."""
        return tuple(self._done[p.folder] for p in self._parts)

    def _holds(self, part: BatchPart, entry: LedgerEntry) -> bool:
        """Return whether an earlier result would come again: from the same input, its files there. A crash is tried again always, and what
        ended at a limit where that is higher now."""
        result, batch = entry.result, self._batch
        folder = batch.output / result.folder
        if entry.digest != self._digests[part.folder] or result.verdict == CRASHED:
            return False
        if result.verdict == OUT_OF_MEMORY:
            return 0.0 < batch.memory <= result.memory_limit
        if result.verdict == OVER_TIME:
            return 0.0 < batch.seconds <= result.time_limit
        return all((folder / file).is_file() for file in result.files)

    def _request(self, part: BatchPart) -> PartRequest:
        batch = self._batch
        return PartRequest(
            part=part.part,
            start=str(Path.cwd()),
            output=str(batch.output.absolute()),
            folder=part.folder,
            settings=dict(batch.settings),
            solid=batch.solid,
            fixtures=tuple(batch.fixtures),
            user_folder=str(batch.user_folder or ""),
            memory=batch.memory,
            seconds=batch.seconds,
        )

    def _write_page(self) -> None:
        results = [self._done[p.folder] for p in self._parts if p.folder in self._done]
        page = batch_page(results, len(self._parts))
        write_text(self._batch.output / PAGE_FILE, page)


def _check_fixtures(words: Sequence[str]) -> None:
    from trunnion.pipeline.engine import setup_file

    for word in words:
        if not (file := setup_file(word)[1]).is_file():
            raise BadInput(f"{file}: no such file of a fixture")


def _workers(batch: Batch) -> AbstractContextManager[BatchWorkers]:
    return at(batch.scheduler) if batch.scheduler else local(batch.jobs or usual_jobs())


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Keep other batches out of a folder: they would write its ledger too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BadInput(
                f"{folder}: another batch is at work in this folder; wait for its end or choose another folder"
            ) from None
        yield
    finally:
        os.close(handle)
