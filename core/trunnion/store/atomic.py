"""Files written whole or not at all: a kill, a full disk or a pulled plug leaves the last good file where it was."""

from __future__ import annotations

import contextlib
import os
import re
import threading
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from trunnion.findings import BadInput

_UNFINISHED = ".saving"
_ONE_AT_A_TIME = threading.Lock()
"""Two threads of one process would share the name of the unfinished file."""


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write a file whole or not at all; raise `BadInput` when the folder can't be written to."""
    write_with(path, lambda file: file.write(data))


def write_text(path: str | Path, text: str) -> None:
    """Write a text in UTF-8 with the line ends it has, whole or not at all."""
    write_bytes(path, text.encode("utf-8"))


def write_with(path: str | Path, fill: Callable[[BinaryIO], object]) -> None:
    """Write a file by a function that fills it: beside it first, synced, then renamed over it, then the folder synced."""
    with _ONE_AT_A_TIME:
        _write(Path(os.path.realpath(path)), fill)


def _write(target: Path, fill: Callable[[BinaryIO], object]) -> None:
    temporary = target.with_name(f".{target.name}.{os.getpid()}{_UNFINISHED}")
    try:
        _remove_unfinished(target)
        with open(temporary, "xb") as file:
            fill(file)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, target)
        _sync_folder(target.parent)
    except OSError as reason:
        _forget(temporary)
        raise BadInput(
            f"{target}: can't be written: {reason.strerror or reason}; the file there is as it was"
        ) from None
    except BaseException:
        _forget(temporary)
        raise


def _forget(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink()


def _remove_unfinished(target: Path) -> None:
    """Remove what writers left that no longer run."""
    mine = re.compile(re.escape(f".{target.name}.") + r"([0-9]+)" + re.escape(_UNFINISHED))
    for leftover in target.parent.iterdir():
        found = mine.fullmatch(leftover.name)
        if found and (int(found.group(1)) == os.getpid() or not _runs(int(found.group(1)))):
            _forget(leftover)


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


def _sync_folder(folder: Path) -> None:
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
