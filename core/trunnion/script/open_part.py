"""Opening a part: its reading begins in a process of its own while the program is still being loaded.

Nothing heavy is imported with this module; `trunnion.pipeline` is, once the part is being read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.findings import BadInput
from trunnion.part.read.part_file import PartReading
from trunnion.progress import NO_PROGRESS, Progress, Report
from trunnion.script.recording import Recording
from trunnion.settings import Value
from trunnion.store.project_file import PROJECT_SUFFIX

if TYPE_CHECKING:
    from trunnion.model.session import Session
    from trunnion.pipeline import Engine
    from trunnion.script.program import PartProgram


OPENED = 0.1
"""Share of the work that opening is."""


def open_part(
    file: str | Path,
    *,
    settings: Mapping[str, Value] | None = None,
    solid: int | None = None,
    fixtures: Sequence[str] = (),
    user_folder: Path | None = None,
    progress: Progress = NO_PROGRESS,
    running: ExitStack | None = None,
) -> tuple[Engine, Session]:
    """Return an engine and the session of a part or project file, with settings chosen and fixtures in place, nothing computed yet.

    The process that reads the part stays while the caller is `running`, and does work on it beside. Raises `BadInput` for a file, a
    setting or a folder that can't be used.
    """
    check_user_folder(user_folder)
    with ExitStack() as begun:
        reading = None
        if Path(file).suffix.lower() != PROJECT_SUFFIX:
            reading = (running or begun).enter_context(
                PartReading.of_file(file, solid=solid, stays=running is not None)
            )
        # While a process of its own reads the part, the program is loaded, and with its settings all families.
        from trunnion.pipeline import Engine

        engine = Engine(user_folder)
        engine.settings()
        session = engine.open(file, solid=solid, reading=reading, progress=progress)
    session = engine.with_choices(session, settings or {})
    if fixtures:
        session = engine.with_fixtures(session, fixtures, progress)
    return engine, session


def open_program(
    path: str | Path,
    *,
    settings: Mapping[str, Value] | None = None,
    solid: int | None = None,
    fixtures: Sequence[str] = (),
    user_folder: str | Path | None = None,
    report: Report | None = None,
    running: ExitStack | None = None,
) -> PartProgram:
    """Return the program of a part or project file; `trunnion.open` says what is given, `open_part` what `running` is."""
    progress, recording = Progress(report), Recording()
    options = {
        "settings": settings,
        "solid": solid,
        "fixtures": fixtures,
        "user_folder": user_folder,
    }
    recording.opened(path, {k: v for k, v in options.items() if v or v == 0})
    engine, session = open_part(
        path,
        settings=settings,
        solid=solid,
        fixtures=fixtures,
        user_folder=Path(user_folder) if user_folder is not None else None,
        progress=progress.part(0.0, OPENED),
        running=running,
    )
    # Once the part is being read: with this the whole program is loaded.
    from trunnion.script.program import PartProgram

    return PartProgram(engine, session, recording, progress)


def check_user_folder(folder: Path | None) -> None:
    """Raise `BadInput` where a shop's own folder is named and not there."""
    if folder is not None and not folder.is_dir():
        raise BadInput(f"{folder}: no such folder of tools, materials, machines and plans")
