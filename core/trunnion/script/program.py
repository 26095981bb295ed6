"""A part's program as scripts drive it: opened, computed step by step, edited, proven, written. `trunnion.open` returns it.

program = trunnion.open("panel.step", settings={"post.dialect": "fanuc"})
program.merge(["pocket-01", "pocket-02"])
print(program.repair().outcome)
program.write("out")
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from trunnion.findings import BadCall
from trunnion.geometry.cut import curve_cut, plane_cut
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import SizeEntry
from trunnion.model.verdict import Verdict
from trunnion.pipeline.planning import patches
from trunnion.pipeline.revision import revised
from trunnion.pipeline.writing import checked_name, write_programs
from trunnion.report.picture_process import PictureProcess
from trunnion.script.feature_edits import RECOGNIZED, FeatureEdits
from trunnion.script.operation_edits import PLANNED, OperationEdits
from trunnion.script.recording import recorded
from trunnion.settings import Value

PROVEN = "repair"
"""The step that a program is proven after, as far as it could be repaired."""
Point = tuple[float, float, float]


class PartProgram(FeatureEdits, OperationEdits):
    """The program of one part, from `trunnion.open`.

    The methods named after steps compute what is stale up to there and return what the step made; edits and settings make stale what
    depends on them. What can't be done raises `trunnion.findings.TrunnionError` with one line that says what to do, and leaves the program
    as it was. Lengths are mm, angles degrees, vectors in the part's coordinates.
    """

    # settings and part

    @recorded
    def set(self, settings: Mapping[str, Value]) -> None:
        """Choose settings by key, as `--set` does: `{"plane.rough.slot_feed": 0.4}`, or by name where only one setting is called so."""
        self.session = self.engine.with_choices(self.session, settings)

    @recorded
    def set_fixtures(self, files: Sequence[str]) -> None:
        """Put fixtures, `FILE` or `SETUP=FILE`, in place of those that were there."""
        self.session = self.engine.with_fixtures(self.session, files, self.progress)

    @recorded
    def cut_by_plane(self, face: int, point: Point, normal: Point) -> None:
        """Cut a face in two by a plane; what lies behind it keeps the face's number."""
        cut = plane_cut(face, _point(point), _point(normal))
        self.session = patches.with_cut(self.engine, self.session, cut, self.progress)

    @recorded
    def cut_by_curve(self, face: int, points: Sequence[Point]) -> None:
        """Cut a face in two along points near it; the first once more at the end closes the curve."""
        cut = curve_cut(face, tuple(map(_point, points)))
        self.session = patches.with_cut(self.engine, self.session, cut, self.progress)

    @recorded
    def revise(self, path: str | Path) -> None:
        """Go on with a revised part file: what a person did is kept by matching faces, what can't be is among the findings."""
        was_planned = self.session.process is not None
        self.session = revised(self.engine, self.session, path, self.progress)
        if was_planned:
            self.run(PLANNED)

    # steps

    @recorded
    def recognize(self) -> tuple[Feature, ...]:
        """Return the features of the part."""
        found = self.run(RECOGNIZED).recognition
        assert found is not None
        return found.features

    @recorded
    def size(self) -> tuple[SizeEntry, ...]:
        """Return the table of sizes."""
        return self.run("size").sizes

    @recorded
    def blank(self) -> Blank:
        """Return the blank that the part is cut from."""
        blank = self.run("blank").blank
        assert blank is not None
        return blank

    @recorded
    def route(self) -> tuple[Operation, ...]:
        """Return the operations in the order they are cut, with their tools and the rules behind them."""
        return self._operations("route")

    @recorded
    def optimize(self) -> tuple[Operation, ...]:
        """Return the operations with their cutting data."""
        return self._operations(PLANNED)

    @recorded
    def toolpaths(self) -> tuple[OperationPath, ...]:
        """Return the toolpaths of the operations."""
        return self.run("toolpath").paths

    @recorded
    def verify(self) -> Verdict:
        """Return the proof of the program as it is planned."""
        return self._verdict("verify")

    @recorded
    def repair(self) -> Verdict:
        """Return the proof of the program after what failed was repaired, as far as the planner can."""
        return self._verdict(PROVEN)

    # files

    @recorded
    def write(self, folder: str | Path, *, name: str = "", date: str = "") -> tuple[str, ...]:
        """Prove and repair the program and write it into a folder as `trunnion program` does: NC text, CL, tool list, XML, report with
        pictures, project; return the file names. A program that failed its proof is written as REJECTED."""
        if name:
            checked_name(name)
        with PictureProcess() as pictures:
            self.session = self.engine.run(self.session, PROVEN, self.progress, pictures.ahead)
            return self.engine.write(
                self.session,
                folder,
                name=name,
                date=date,
                drawing=pictures.begin,
                progress=self.progress,
            )

    @recorded
    def post(self, folder: str | Path, *, name: str = "", date: str = "") -> tuple[str, ...]:
        """Prove and repair the program and write its NC and CL texts alone into a folder; return the file names."""
        return write_programs(
            self.run(PROVEN), Path(folder), name=name, date=date, progress=self.progress
        )

    @recorded
    def export(self, groups: Sequence[str], path: str | Path) -> tuple[int, ...]:
        """Write faces of a curved part, groups by their ids or `local`, `remaining`, `dropped`, as IGES or STEP; return their numbers."""
        session = self.run(RECOGNIZED)
        tags = patches.tags_of(session, groups)
        patches.export(self.engine, session, groups, path)
        return tags

    @recorded
    def save(self, path: str | Path) -> None:
        """Write a project file (`.trunnion`), whole or not at all, with all that is computed and done by hand."""
        self.engine.save(self.session, path, self.progress)

    def script(self) -> str:
        """Return the Python text that does again what was done with the program since it was opened."""
        return self.recording.text()

    def record(self, file: str | Path) -> None:
        """Append to a Python file, from now on, what was done with the program and what will be."""
        path = Path(file)
        if path.suffix != ".py":
            raise BadCall(f"a recording is a Python script: name it {path.stem}.py, not {path}")
        self.recording.to_file(path)

    def _operations(self, step: str) -> tuple[Operation, ...]:
        process = self.run(step).process
        assert process is not None
        return process.operations

    def _verdict(self, step: str) -> Verdict:
        verdict = self.run(step).verdict
        assert verdict is not None
        return verdict


def _point(values: Sequence[float]) -> Point:
    """Return three numbers as they are compared and kept; raise `BadCall` for others."""
    if len(values) != len("xyz"):
        raise BadCall(f"a point or a direction has three numbers, not {len(values)}")
    x, y, z = map(float, values)
    return x, y, z
