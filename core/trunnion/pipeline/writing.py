"""What a session leaves in a folder: programs, tool list, XML, report with pictures, project. Each file whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from trunnion.findings import BadCall, BadInput
from trunnion.geometry.mesh import Mesh
from trunnion.model.session import Session
from trunnion.plan.freeform.estimate.finishing_time import Estimate
from trunnion.post.release import release
from trunnion.progress import Progress
from trunnion.report.picture_process import Drawing, here
from trunnion.shop.crib import NO_CRIBS, Cribs, tools_listed
from trunnion.store.atomic import write_text
from trunnion.store.programs import write_programs as write_texts


def write_programs(
    session: Session, folder: Path, *, name: str = "", date: str = "", progress: Progress
) -> tuple[str, ...]:
    """Write the programs of a proven session as their verdict allows and return the file names."""
    progress.at(0.0, "writing programs")
    return write_texts(folder, name_of(session, name), release(session, name=name, date=date))


def write_documents(
    session: Session,
    mesh_of: Callable[[], Mesh],
    folder: Path,
    *,
    name: str,
    date: str,
    estimate: Estimate | None = None,
    cribs: Cribs = NO_CRIBS,
    drawing: Drawing = here,
    progress: Progress,
) -> tuple[str, ...]:
    """Write programs, tool list, XML, pictures and report of a proven session and return the file names.

    The report has the times of areas where an `estimate` of them is given, tool list and report the pockets and wear of the tools in
    `cribs`; `drawing` draws its pictures of the triangles that `mesh_of`
    returns, which is asked once programs are there: what is refused needs none.
    """
    from trunnion.report.html import report_html
    from trunnion.store.features import write_features
    from trunnion.store.process import write_process

    if session.process is None:
        raise BadCall("nothing is programmed yet: run the whole line first")
    stem = name_of(session, name)
    files = list(
        write_programs(session, folder, name=stem, date=date, progress=progress.part(0.0, 0.1))
    )
    drawn = drawing(session, mesh_of(), folder, stem)
    progress.at(0.1, "writing XML and tool list")
    listed = tools_listed(session.process, cribs)
    tools = [t.as_dict() for t in listed]
    write_text(
        folder / f"{stem}.tools.json", json.dumps(tools, indent=1, ensure_ascii=False) + "\n"
    )
    progress.at(0.15, "writing the features")
    write_features(session, folder / f"{stem}.features.xml")
    progress.at(0.2, "writing the process")
    write_process(session, folder / f"{stem}.process.xml")
    pictures = drawn(progress.part(0.3, 0.9))
    progress.at(0.9, "writing the report")
    page = report_html(session, stem, pictures, folder, date, estimate, listed)
    write_text(folder / f"{stem}.report.html", page)
    progress.at(1.0, "report written")
    return (
        *files,
        f"{stem}.tools.json",
        f"{stem}.features.xml",
        f"{stem}.process.xml",
        *(p.file for p in pictures),
        f"{stem}.report.html",
    )


def name_of(session: Session, name: str) -> str:
    """Return the NAME of a session's files: the given one, else the part's; raise `BadInput` when it can't be a file name."""
    return checked_name(name or (session.part.name if session.part else ""))


def checked_name(name: str) -> str:
    """Return a name that files can have; raise `BadInput` when they can't."""
    if not name or name in (".", "..") or any(c in name for c in "/\\\0\n"):
        raise BadInput(f"{name!r} can't be the name of files: choose one without slashes")
    return name
