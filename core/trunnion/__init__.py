"""Trunnion: from the CAD model of an aerospace part to a proven NC program.

    import trunnion

    program = trunnion.open("panel.step")
    program.write("out")

`open` returns a `trunnion.script.program.PartProgram`; nothing heavy is imported before it is called.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.version import __version__

if TYPE_CHECKING:
    from trunnion.script.program import PartProgram

__all__ = ["__version__", "open"]

# Linear algebra is of small matrices here, thousands of them: threads of its library would only wait for each other, at full load. Our own
# threads and processes keep all cores at work. It is read when numpy is first imported, which comes after this.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def open(
    path: str | Path,
    *,
    settings: Mapping[str, float | int | bool | str] | None = None,
    solid: int | None = None,
    fixtures: Sequence[str] = (),
    user_folder: str | Path | None = None,
    report: Callable[[float, str], None] | None = None,
) -> PartProgram:
    """Open a part (STEP, gzipped STEP, IGES) or a project (`.trunnion`) and return its program; nothing is computed yet.

    `settings` by key as `--set` takes them; `solid` which one of several, from 1; `fixtures` files of what holds the part, `FILE` or
    `SETUP=FILE`; `user_folder` a shop's own tools, materials, machines and plans. `report` is told how far work is, from 0 to 1, and what
    is done. Raises `trunnion.findings.TrunnionError` for what can't be used.
    """
    from trunnion.script.open_part import open_program

    return open_program(
        path,
        settings=settings,
        solid=solid,
        fixtures=fixtures,
        user_folder=user_folder,
        report=report,
    )
