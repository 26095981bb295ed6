"""The file that work in progress is kept in, written in a thread of its own: neither the window nor the worker waits for it. No Qt.

Beside `autosave-PID.trunnion` lies `autosave-PID.json`, which says whose work it is: the project's and the part's path, and when it was
kept. Writing and forgetting happen one after the other, in the order of their requests; of writings that wait only the newest is done.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path

from trunnion.findings import TrunnionError
from trunnion.model.session import Session
from trunnion.store.atomic import write_text
from trunnion.store.project import save_project


@dataclass(frozen=True, slots=True, kw_only=True)
class AutosaveOwner:
    """Whose work an autosave is: the project it was opened from or saved to (empty: none yet), its part file, and when it was kept."""

    project: str = ""
    part: str = ""
    time: str = ""

    @property
    def name(self) -> str:
        """The file's name that a person knows the work by."""
        return Path(self.project or self.part).name


class Autosave:
    """One autosave file and what is done to it. `failed` is called, from the thread that writes, with the reason why work could not be
    kept."""

    def __init__(self, path: Path, failed: Callable[[str], None]) -> None:
        self._path, self._failed = path, failed
        self._newest = 0
        self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="autosave")

    def keep(
        self, session: Session, data: bytes, suffix: str, owner: AutosaveOwner
    ) -> Future[None]:
        """Write a session with its part file's bytes and suffix, unless a newer one is requested before its turn comes."""
        self._newest += 1
        return self._writer.submit(self._keep, self._newest, session, data, suffix, owner)

    def forget(self) -> Future[None]:
        """Remove the file: the work is saved elsewhere, or given up."""
        self._newest += 1
        return self._writer.submit(remove, self._path)

    def end(self) -> None:
        """Remove the file and wait until that is done."""
        self.forget()
        self._writer.shutdown(wait=True)

    def _keep(
        self, number: int, session: Session, data: bytes, suffix: str, owner: AutosaveOwner
    ) -> None:
        if number != self._newest:
            return
        try:
            save_project(session, self._path, data, suffix)
            write_text(notes_of(self._path), json.dumps(asdict(owner)))
        except TrunnionError as reason:
            self._failed(str(reason))


def notes_of(path: Path) -> Path:
    """Return the file that says whose work an autosave is."""
    return path.with_suffix(".json")


def autosave_owner(path: Path) -> AutosaveOwner:
    """Return whose work an autosave is; where its notes are missing or damaged, the time it was written is known still."""
    time = datetime.fromtimestamp(path.stat().st_mtime).isoformat(timespec="seconds")
    try:
        noted = json.loads(notes_of(path).read_text("utf-8"))
        return AutosaveOwner(
            **{
                "time": time,
                **{name: str(noted[name]) for name in ("project", "part", "time") if name in noted},
            }
        )
    except (OSError, ValueError, TypeError):
        return AutosaveOwner(time=time)


def take_over(leftover: Path, path: Path) -> None:
    """Make the autosave of a program that ended one's own, its notes too."""
    for before, after in ((leftover, path), (notes_of(leftover), notes_of(path))):
        with contextlib.suppress(FileNotFoundError):
            before.replace(after)


def remove(path: Path) -> None:
    """Remove an autosave and its notes, as far as they are there."""
    for file in (path, notes_of(path)):
        file.unlink(missing_ok=True)
