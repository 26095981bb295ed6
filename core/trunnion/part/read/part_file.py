"""Reads a part file: looks at its text, lets a separate process with limits read it, and says what it found."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.findings import BadInput
from trunnion.part.read.child import ReadingProcess
from trunnion.part.read.limits import ReadLimits
from trunnion.part.read.request import ReadRequest
from trunnion.part.read.text import check_iges, check_step, kind_of
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

SUFFIXES = (".step", ".stp", ".stpz", ".igs", ".iges")
_GZIP = b"\x1f\x8b"
_MEGA = 1 << 20


def read_part(
    path: str | os.PathLike[str],
    *,
    solid: int | None = None,
    limits: ReadLimits | None = None,
    progress: Progress = NO_PROGRESS,
) -> Part:
    """Return the part of a STEP, gzipped STEP or IGES file, recognised by its content.

    `solid` chooses one of several solids, from 1; without it the largest is taken and a finding names the others. Raises `BadInput`
    with one line for a file that can't be used, `OutOfMemory` when reading needs more than `limits` allow, `Cancelled` on request.
    """
    with PartReading.of_file(path, solid=solid, limits=limits) as reading:
        return reading.part(progress)


def read_part_bytes(
    data: bytes,
    name: str,
    suffix: str,
    *,
    solid: int | None = None,
    limits: ReadLimits | None = None,
    progress: Progress = NO_PROGRESS,
) -> Part:
    """Return the part of a file's bytes, as `read_part` does; `name` and `suffix` are the file's."""
    file = name if name.endswith(suffix) else name + suffix
    with PartReading(data, file, file, solid, limits or ReadLimits()) as reading:
        return reading.part(progress)


class PartReading:
    """The reading of a part file by a process of its own, from its beginning on; used in a `with` block, at whose end it is over.

    A process that stays does work on the part beside, until the end of the block.
    """

    def __init__(
        self,
        data: bytes,
        file: str,
        path: str,
        solid: int | None,
        limits: ReadLimits,
        stays: bool = False,
    ) -> None:
        """Begin to read the part of a file's bytes; raises `BadInput` where they are no part file's."""
        plain = _unpacked(data, file, limits)
        kind = kind_of(plain, file)
        listed = check_step(plain, file) if kind == "step" else check_iges(plain, file)
        request = ReadRequest(
            file=file,
            path=path,
            name=part_name(file),
            digest=hashlib.sha256(data).hexdigest(),
            kind=kind,
            listed=listed,
            solid=solid,
            size=len(plain),
        )
        self._process, self._stays = ReadingProcess(request, plain, limits, stays), stays

    @staticmethod
    def of_file(
        path: str | os.PathLike[str],
        *,
        solid: int | None = None,
        limits: ReadLimits | None = None,
        stays: bool = False,
    ) -> PartReading:
        """Begin to read a part file; raises `BadInput` for a file that is none."""
        limits, file = limits or ReadLimits(), Path(path)
        return PartReading(_bytes_of(file, limits), file.name, str(file), solid, limits, stays)

    def part(self, progress: Progress = NO_PROGRESS) -> Part:
        """Return the part once it is read; raises what `read_part` does."""
        progress.at(0.0, "reading")
        read = self._process.response(progress)
        # The CAD kernel takes a second to load: the process that reads the file has been at work meanwhile.
        from trunnion.part.part import Part

        part = Part.from_bytes(read)
        return part.accompanied(self._process) if self._stays else part

    def __enter__(self) -> PartReading:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.end()


def _bytes_of(file: Path, limits: ReadLimits) -> bytes:
    try:
        if file.is_dir():
            raise BadInput(f"{file}: is a folder; give the part file in it")
        if not file.exists() and not file.is_symlink():
            raise BadInput(f"{file}: no such file")
        if file.exists() and not file.is_file():
            raise BadInput(f"{file}: not a plain file")
        with file.open("rb") as stream:
            data = stream.read(limits.size * _MEGA + 1)
    except (OSError, RuntimeError, ValueError) as reason:
        words = getattr(reason, "strerror", None) or str(reason)
        raise BadInput(f"{file}: can't be read ({words})") from None
    if len(data) > limits.size * _MEGA:
        raise BadInput(f"{file}: larger than the limit of {limits.size} MB for a part file")
    return data


def _unpacked(data: bytes, name: str, limits: ReadLimits) -> bytes:
    if not data.startswith(_GZIP):
        return data
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
            plain = stream.read(limits.size * _MEGA + 1)
    except (OSError, EOFError) as reason:
        raise BadInput(f"{name}: the gzipped file is damaged ({reason}); copy it again") from None
    if len(plain) > limits.size * _MEGA:
        raise BadInput(f"{name}: larger than the limit of {limits.size} MB when unpacked")
    return plain


def part_name(file: str) -> str:
    """Return the name of the part in a file: the file's own without the endings of part files.

    >>> part_name("rib.stp.gz"), part_name("rib.2.STEP"), part_name("rib.2")
    ('rib', 'rib.2', 'rib.2')
    """
    name = file[:-3] if file.lower().endswith(".gz") else file
    stem, suffix = os.path.splitext(name)
    return stem if suffix.lower() in SUFFIXES else name
