"""NC and CL texts into an output folder: programs of earlier runs go first, so nothing stale can be run by mistake."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.model.session import PostedFile
from trunnion.post.release import checked_files, is_program_of
from trunnion.store.atomic import write_text


def write_programs(folder: str | Path, name: str, posted: Iterable[PostedFile]) -> tuple[str, ...]:
    """Write released or rejected texts as `NAME.SUFFIX`, after removing every program of NAME; return the file names.

    Raises `Refused` for a text whose name and stamp differ, before anything is touched.
    """
    folder, files = Path(folder), checked_files(posted)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as reason:
        raise _not_writable(folder, reason) from None
    remove_programs(folder, name)
    for file in files:
        write_text(folder / f"{name}.{file.suffix}", file.text)
    return tuple(f"{name}.{file.suffix}" for file in files)


def remove_programs(folder: Path, name: str) -> None:
    """Remove every program of NAME from a folder, which need not be there; raise `BadInput` where one can't be removed."""
    if not folder.is_dir():
        return
    try:
        for old in sorted(folder.iterdir()):
            if old.is_file() and is_program_of(name, old.name):
                old.unlink()
    except OSError as reason:
        raise _not_writable(folder, reason) from None


def _not_writable(folder: Path, reason: OSError) -> BadInput:
    return BadInput(f"{folder}: can't be written to: {reason.strerror or reason}")
