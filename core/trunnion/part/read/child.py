"""The process that reads a part file: a damaged file may crash, bloat or hang the CAD kernel, and then only this process ends.

Started afresh (never forked) as `python -m trunnion.part.read.child FOLDER`. The folder holds the request and the file's bytes; the answer
is written there.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from trunnion.findings import BadInput, OutOfMemory, TrunnionError
from trunnion.part.read.limits import ReadLimits
from trunnion.part.read.request import ReadRequest
from trunnion.progress import Progress

_LOOK = 0.02
_CHECK = 0.1
_REFUSED, _NO_MEMORY = 3, 4
_MEGA = 1 << 20


class ReadingProcess:
    """A fresh process that reads a part from a file's bytes, within limits, until its `end`."""

    def __init__(self, request: ReadRequest, data: bytes, limits: ReadLimits) -> None:
        self._request, self._limits = request, limits
        self._folder = tempfile.TemporaryDirectory(prefix="trunnion-read-")
        directory = Path(self._folder.name)
        (directory / "part").write_bytes(data)
        (directory / "request.json").write_text(
            json.dumps({"request": asdict(request), "memory": limits.memory}), encoding="utf-8"
        )
        self._began = time.monotonic()
        with (directory / "words").open("wb") as words:
            # -P: nothing is imported from the folder that the program happens to be started in.
            self._child = subprocess.Popen(
                [sys.executable, "-P", "-m", "trunnion.part.read.child", self._folder.name],
                stdin=subprocess.DEVNULL,
                stdout=words,
                stderr=words,
                env=os.environ | {"PYTHONIOENCODING": "utf-8"},
            )

    def end(self) -> None:
        """End the process, at whatever it is, and remove its files."""
        self._child.kill()
        self._child.wait()
        self._folder.cleanup()

    def response(self, progress: Progress) -> bytes:
        """Return the bytes of the part (`Part.to_bytes`) once it is read."""
        self._wait(progress)
        return _response(
            self._child.returncode, Path(self._folder.name), self._request, self._limits
        )

    def _wait(self, progress: Progress) -> None:
        file, limit = self._request.file, self._limits.seconds
        looked = self._began
        progress.aside(lambda _: _load(), f"reading {file}")
        while self._child.poll() is None:
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
    from trunnion.geometry.surface.spline import SplineSurface

    flat = SplineSurface(
        knots_u=np.array([0.0, 0.0, 1.0, 1.0]),
        knots_v=np.array([0.0, 0.0, 1.0, 1.0]),
        degree_u=1,
        degree_v=1,
        poles=np.ones((2, 2, 4)),
    )
    flat.at(np.zeros((1, 2)))


def _response(code: int, directory: Path, request: ReadRequest, limits: ReadLimits) -> bytes:
    refusal = directory / "refused"
    if code == 0 and (directory / "answer").is_file():
        return (directory / "answer").read_bytes()
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

        part = read_file(directory / "part", ReadRequest(**order["request"]))
        (directory / "answer").write_bytes(part.to_bytes())
    except TrunnionError as reason:
        (directory / "refused").write_text(str(reason), encoding="utf-8")
        return _REFUSED
    except MemoryError:
        return _NO_MEMORY
    return 0


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
