"""The project file `NAME.trunnion`: a zip with `session.xml`, the part file as it was read, arrays as `.npy` and long texts.

Same session, same bytes. A file from elsewhere is not trusted: limits on size and number, no names that leave the archive, no entities.
"""

from __future__ import annotations

import hashlib
import io
import re
import zipfile
import zlib
from pathlib import Path

from lxml import etree

from trunnion.findings import BadInput
from trunnion.model.session import Session
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.store import xml
from trunnion.store.atomic import write_bytes
from trunnion.store.mapping import Members, from_xml, to_xml

FORMAT = 1
MOST_MEMBERS = 100_000
LARGEST_MEMBER = 1024**3
"""Bytes of one member, opened: above the largest part file that is read."""
LARGEST_PROJECT = 4 * 1024**3
_ROOT, _SESSION = "trunnion-project", "session.xml"
_PART = re.compile(r"part(\.[A-Za-z0-9.]{1,12})?")
_MEMBER = re.compile(r"(arrays/[0-9]{5,}\.npy|texts/[0-9]{5,}\.txt)")
_NO_TIME = (1980, 1, 1, 0, 0, 0)


def save_project(
    session: Session,
    path: str | Path,
    part_bytes: bytes,
    part_suffix: str,
    progress: Progress = NO_PROGRESS,
) -> None:
    """Write a session with its part file's bytes, whole or not at all."""
    data = progress.aside(
        lambda own: project_bytes(session, part_bytes, part_suffix, own), "packing the project"
    )
    progress.at(1.0, "saving the project")
    write_bytes(path, data)


def project_bytes(
    session: Session, part_bytes: bytes, part_suffix: str, progress: Progress = NO_PROGRESS
) -> bytes:
    """Return the bytes of a project file; raise `BadInput` for a suffix that no part file has."""
    name = f"part{part_suffix.lower()}"
    if not _PART.fullmatch(name):
        raise BadInput(f"{part_suffix}: not the suffix of a part file")
    members = Members()
    root = etree.Element(_ROOT, version=str(FORMAT), part=name)
    root.append(to_xml(session, Session, "session", members))
    file = io.BytesIO()
    progress.check()
    with zipfile.ZipFile(file, "w") as archive:
        for member, data in progress.each(
            {_SESSION: xml.written(root), name: part_bytes, **members.files}.items()
        ):
            archive.writestr(
                _entry(member), data, compress_type=zipfile.ZIP_DEFLATED, compresslevel=3
            )
    return file.getvalue()


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, date_time=_NO_TIME)
    entry.create_system, entry.external_attr = 3, 0o644 << 16
    return entry


def load_project(path: str | Path, progress: Progress = NO_PROGRESS) -> tuple[Session, bytes, str]:
    """Return the session of a project file, the bytes of its part file and their suffix; raise `BadInput` with one clear line."""
    path = Path(path)
    return progress.aside(lambda own: _loaded(path, own), f"opening {path.name}")


def _loaded(path: Path, progress: Progress) -> tuple[Session, bytes, str]:
    members = _members(path, progress)
    progress.check()
    root = xml.parse(members.pop(_SESSION), f"{path}: {_SESSION}")
    version = root.get("version", "")
    if root.tag != _ROOT or not version.isdecimal():
        raise BadInput(f"{path}: {_SESSION} is not a project of Trunnion")
    if int(version) != FORMAT:
        raise BadInput(
            f"{path}: written in format {version}; this Trunnion reads format {FORMAT}: use the Trunnion that wrote it"
        )
    name = root.get("part", "")
    if name not in members or not _PART.fullmatch(name):
        raise BadInput(f"{path}: the part file is missing in it")
    part = members.pop(name)
    if len(root) != 1 or root[0].tag != "session":
        raise BadInput(f"{path}: {_SESSION} holds no session")
    try:
        session: Session = from_xml(root[0], Session, Members(members))
    except BadInput as reason:
        raise BadInput(f"{path}: {_SESSION}, {reason}") from None
    if session.part is not None and session.part.digest not in (
        "",
        hashlib.sha256(part).hexdigest(),
    ):
        raise BadInput(f"{path}: the part file in it is not the one that its plan was made for")
    return session, part, name.removeprefix("part")


def _members(path: Path, progress: Progress) -> dict[str, bytes]:
    """Return the members of an archive by name, checked before anything is opened."""
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            _check(path, entries)
            return {entry.filename: archive.read(entry) for entry in progress.each(entries)}
    except OSError as reason:
        raise BadInput(f"{path}: can't be read: {reason.strerror or reason}") from None
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as reason:
        raise BadInput(f"{path}: damaged, or not a project file: {reason}") from None


def _check(path: Path, entries: list[zipfile.ZipInfo]) -> None:
    names = [entry.filename for entry in entries]
    if _SESSION not in names:
        raise BadInput(f"{path}: not a project file: it holds no {_SESSION}")
    if len(names) > MOST_MEMBERS:
        raise BadInput(
            f"{path}: {len(names)} members are more than the {MOST_MEMBERS} that are read"
        )
    if len(set(names)) != len(names):
        raise BadInput(f"{path}: a member stands twice in it")
    for entry in entries:
        if (
            entry.filename != _SESSION
            and not _PART.fullmatch(entry.filename)
            and not _MEMBER.fullmatch(entry.filename)
        ):
            raise BadInput(
                f"{path}: holds {entry.filename!r}, which no project has; it is not opened"
            )
        if entry.file_size > LARGEST_MEMBER:
            raise BadInput(
                f"{path}: {entry.filename} would open to {entry.file_size} bytes; at most {LARGEST_MEMBER} are read"
            )
    total = sum(entry.file_size for entry in entries)
    if total > LARGEST_PROJECT:
        raise BadInput(f"{path}: would open to {total} bytes; at most {LARGEST_PROJECT} are read")
