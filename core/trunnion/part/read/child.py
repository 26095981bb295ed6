"""The process that reads a part file: a damaged file may crash, bloat or hang the CAD kernel, and then only this process ends.

Started afresh (never forked) as `python -m trunnion.part.read.child FOLDER`. The folder holds the request and the file's bytes; the answer
is written there. Where it is to stay, it then does work on the part (`part.work`), pickled on its standard input, until that ends. Where it
can, it does that in copies of itself, one after another: only the end of a process gives back all the memory that the CAD kernel takes up.
"""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from functools import partial
from itertools import count
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from trunnion.findings import BadInput, OutOfMemory, TrunnionError
from trunnion.forks import Fork, copies
from trunnion.memory import trim_memory
from trunnion.part.read.limits import ReadLimits
from trunnion.part.read.request import ReadRequest
from trunnion.part.work import PartWork
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

_LOOK = 0.02
_CHECK = 0.1
_REFUSED, _NO_MEMORY = 3, 4
_MEGA = 1 << 20
_MAPPED = str(_MEGA)
"""Bytes from which on glibc gives each array memory of its own, and back with it: else it keeps up to 32 MB in pieces (other systems don't
read this)."""
_PART = "result"


class ReadingProcess:
    """A fresh process that reads a part from a file's bytes, within limits, until its `end`; one that stays does work on the part then."""

    def __init__(
        self, request: ReadRequest, data: bytes, limits: ReadLimits, stays: bool = False
    ) -> None:
        self._request, self._limits, self._stays = request, limits, stays
        self._begun: dict[PartWork, Path] = {}
        self._folder = tempfile.TemporaryDirectory(prefix="trunnion-read-")
        directory = Path(self._folder.name)
        (directory / "part").write_bytes(data)
        (directory / "request.json").write_text(
            json.dumps({"request": asdict(request), "memory": limits.memory, "stays": stays}),
            encoding="utf-8",
        )
        self._began = time.monotonic()
        with (directory / "words").open("wb") as words:
            # -P: nothing is imported from the folder that the program happens to be started in.
            self._child = subprocess.Popen(
                [sys.executable, "-P", "-m", "trunnion.part.read.child", self._folder.name],
                stdin=subprocess.PIPE if stays else subprocess.DEVNULL,
                stdout=words,
                stderr=words,
                env=os.environ | {"PYTHONIOENCODING": "utf-8", "MALLOC_MMAP_THRESHOLD_": _MAPPED},
            )

    def end(self) -> None:
        """End the process, at whatever it is, and remove its files."""
        self._child.kill()
        self._child.wait()
        if self._stays:
            # What was written to it and not read is lost with it.
            assert self._child.stdin is not None
            with suppress(BrokenPipeError):
                self._child.stdin.close()
        self._folder.cleanup()

    def response(self, progress: Progress) -> bytes:
        """Return the bytes of the part (`Part.to_bytes`) once it is read."""
        self._wait(progress)
        code = 0 if self._has_read() else self._child.returncode
        return _response(code, Path(self._folder.name), self._request, self._limits)

    def begin(self, work: PartWork) -> None:
        """Let the process do some work on the part it has read, after what was begun before; nothing where it doesn't stay or has ended."""
        if not self._stays or work in self._begun:
            return
        requests = self._child.stdin
        assert requests is not None
        with suppress(BrokenPipeError, ValueError):
            pickle.dump(work, requests, protocol=pickle.HIGHEST_PROTOCOL)
            requests.flush()
            self._begun[work] = Path(self._folder.name) / f"work-{len(self._begun)}"

    def made(self, work: PartWork, progress: Progress) -> Any | None:
        """Return what came of some work, waiting for it; None where it was not begun or failed: then it is to be done here."""
        file = self._begun.get(work)
        if file is None:
            return None
        while not file.is_file():
            if self._child.poll() is not None and not file.is_file():
                return None
            progress.check()
            time.sleep(_LOOK)
        with file.open("rb") as stream:
            return pickle.load(stream)

    def _has_read(self) -> bool:
        return self._stays and (Path(self._folder.name) / _PART).is_file()

    def _wait(self, progress: Progress) -> None:
        file, limit = self._request.file, self._limits.seconds
        looked = self._began
        progress.aside(lambda _: _load(), f"reading {file}")
        while self._child.poll() is None and not self._has_read():
            now = time.monotonic()
            if now - self._began > limit:
                raise BadInput(
                    f"{file}: reading took longer than {limit:g} s and was stopped; export the part again"
                )
            if now - looked > _CHECK:
                progress.at(min(0.9, (now - self._began) / limit), f"reading {file}")
                looked = now
            time.sleep(_LOOK)


def _load() -> None:
    """Load what the part is wanted with next: that costs no time now, the other process is at work."""
    import trunnion.part.topology.boundary  # noqa: F401
    from trunnion.geometry.surface.spline import load_splines

    load_splines()


def _response(code: int, directory: Path, request: ReadRequest, limits: ReadLimits) -> bytes:
    refusal = directory / "refused"
    if code == 0 and (directory / _PART).is_file():
        return (directory / _PART).read_bytes()
    if code == _REFUSED and refusal.is_file():
        raise BadInput(refusal.read_text(encoding="utf-8"))
    last = (directory / "words").read_bytes()[-4096:]
    if code == _NO_MEMORY or b"bad_alloc" in last or b"MemoryError" in last:
        raise OutOfMemory(
            f"{request.file}: reading it needs more than {limits.memory} MB of memory; raise the limit or split the part"
        )
    raise BadInput(
        f"{request.file}: the CAD kernel failed on this file (exit code {code}); export it again, as STEP AP214 if possible"
    )


def main(folder: str) -> int:
    """Read the part that a folder's request names and write the answer there; return the exit code."""
    directory = Path(folder)
    order = json.loads((directory / "request.json").read_text(encoding="utf-8"))
    limit_memory(order["memory"])
    try:
        from trunnion.part.read.transfer import read_file

        data = read_file(directory / "part", ReadRequest(**order["request"])).to_bytes()
    except TrunnionError as reason:
        (directory / "refused").write_text(str(reason), encoding="utf-8")
        return _REFUSED
    except MemoryError:
        return _NO_MEMORY
    with _whole(directory / _PART) as stream:
        stream.write(data)
    if order["stays"]:
        _work_on(data, directory)
    return 0


def _work_on(data: bytes, directory: Path) -> None:
    """Do work on a part, given as bytes, as long as some is asked for; what fails is answered with None."""
    from trunnion.part.part import Part

    # The part as the other process has it, so that both would make the same of it.
    part = Part.from_bytes(data)
    for number in count():
        trim_memory()
        try:
            work: PartWork = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        # Once for all copies.
        work.load()
        job = partial(_work_to_file, work, part, directory / f"work-{number}")
        if copies():
            Fork(job).result(NO_PROGRESS)
        else:
            job(NO_PROGRESS)


def _work_to_file(work: PartWork, part: Part, file: Path, progress: Progress) -> None:
    """Do some work and write what came of it, None where it failed: then the other process does it, and says why it can't."""
    made = None
    with suppress(TrunnionError, MemoryError):
        made = work.done(part, progress)
    with _whole(file) as stream:
        pickle.dump(made, stream, protocol=pickle.HIGHEST_PROTOCOL)


@contextmanager
def _whole(file: Path) -> Iterator[IO[bytes]]:
    """Open a file that is there only once it is whole."""
    begun = file.with_suffix(".begun")
    with begun.open("wb") as stream:
        yield stream
    begun.replace(file)


def limit_memory(megabytes: int) -> None:
    """Keep this process's address space below a limit, where the system can."""
    try:
        import resource
    except ImportError:
        return
    most = megabytes * _MEGA
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(
        resource.RLIMIT_AS, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard)
    )


if __name__ == "__main__":
    # The kernel's destructors are not waited for: they cost time and may crash on damaged shapes after the answer is written.
    code = main(sys.argv[1])
    sys.stdout.flush()
    os._exit(code)
