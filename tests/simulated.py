"""Parts programmed and written as a shop gets them, for the simulation to judge."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from simulation.judge import CELL, Stage, stage
from simulation.written import written
from trunnion.cli.programs.proof import proof_dict
from trunnion.pipeline import Engine
from trunnion.pipeline.writing import write_programs
from trunnion.progress import NO_PROGRESS
from trunnion.store.process import write_process


@dataclass(frozen=True, slots=True, eq=False)
class Simulated:
    """One setup's program: what the command line would tell of it, and what its text is judged against."""

    told: Mapping[str, Any]
    on: Stage

    @property
    def text(self) -> str:
        """Return the text as it was written."""
        return self.on.scene.text

    def operation(self, *kinds: str) -> str:
        """Return the first operation of some kinds."""
        return next(o["id"] for o in self.told["operations"] if o["kind"] in kinds)

    def tool(self, operation: str) -> int:
        """Return the number of an operation's tool."""
        return next(o["tool"] for o in self.told["operations"] if o["id"] == operation)


def simulated(part: Path, folder: Path, cell: float = CELL, **choices: Any) -> list[Simulated]:
    """Return the programs of a part, written to a folder without report and pictures; `choices` by setting, `_` for the dot."""
    engine = Engine()
    words = {key.replace("_", ".", 1): value for key, value in choices.items()}
    session = engine.run(engine.with_choices(engine.open(part), words))
    files = write_programs(session, folder, name=part.stem, progress=NO_PROGRESS)
    assert session.process is not None
    tools = [tool.as_dict() for tool in session.process.tools()]
    (folder / f"{part.stem}.tools.json").write_text(json.dumps(tools))
    write_process(session, folder / f"{part.stem}.process.xml")
    told = proof_dict(session, files, {})
    return [Simulated(told, stage(scene, part, cell)) for scene in written(folder, part.stem, told)]
