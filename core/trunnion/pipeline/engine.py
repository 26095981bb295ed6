"""The engine: owns the CAD part and the shop, runs what is stale, opens, saves and writes sessions."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.findings import BadCall, BadInput, Fix, has_errors
from trunnion.geometry.cut import Cut
from trunnion.geometry.kernels.compiling import compiling
from trunnion.geometry.mesh import Mesh
from trunnion.memory import trim_memory
from trunnion.model.fixture import Fixture
from trunnion.model.guides import OperationGuides
from trunnion.model.operation import Operation
from trunnion.model.playback import Moment, Timeline
from trunnion.model.repair import words_of
from trunnion.model.session import Session
from trunnion.pipeline.context import Context, Contexts
from trunnion.pipeline.execution import run_step
from trunnion.pipeline.part_work import before_recognition
from trunnion.pipeline.step import Step
from trunnion.pipeline.steps import STEP_TABLE, STEPS, shop_of_fixes, step_named
from trunnion.plan.manual.operation_change import OperationChange, with_change
from trunnion.plan.repair.contract import RepairJob, applied
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.report.picture_process import Ahead, Drawing, here
from trunnion.settings import Declared, Value, checked, choose, declared, digest
from trunnion.shop import Shop, load_shop
from trunnion.shop.library import PlanLibrary, library_file
from trunnion.shop.user_folder import shop_folder
from trunnion.store.project_file import PROJECT_SUFFIX
from trunnion.verify.settings import ProofSettings

if TYPE_CHECKING:
    from trunnion.part.read.part_file import PartReading
    from trunnion.pipeline.guides import PlanGuides
    from trunnion.pipeline.proof.playback import Playback
    from trunnion.report.deviation import DeviationMap

FRESH = ("done", "problem")
"""States of a step whose result belongs to what it reads now."""
_LAID = "toolpath"
"""The step after which a plan can be drawn."""


class Engine:
    """The one door to the core. Sessions go in and come out; only the part and the catalogues stay here.

    `user_folder` is a folder of a shop's own tools, materials, machines and plans, with its tool cribs and its plan `library`; without it
    the user's data folder is that, which need not be there.
    """

    def __init__(self, user_folder: Path | None = None) -> None:
        self.folder = shop_folder(user_folder)
        self._shop = load_shop(self.folder)
        self.library = PlanLibrary(library_file(user_folder))
        self._contexts: Contexts | None = None
        self._file: tuple[bytes, str] = (b"", "")
        self._playback: Playback | None = None
        self._guides: PlanGuides | None = None

    def open(
        self,
        path: str | Path,
        *,
        solid: int | None = None,
        reading: PartReading | None = None,
        progress: Progress = NO_PROGRESS,
    ) -> Session:
        """Return a new session of a part file (STEP, IGES, gzipped STEP) or the saved session of a project file.

        `reading` is the part file's, where it was begun before.
        """
        path, progress = Path(path), progress.afresh()
        if path.suffix.lower() == PROJECT_SUFFIX:
            return self._open_project(path, progress)
        from trunnion.part.read.part_file import read_part

        with compiling(progress):
            share = progress.part(0.0, 0.7)
            part = reading.part(share) if reading else read_part(path, solid=solid, progress=share)
            with part.watched(progress.part(0.7, 1.0)):
                part.graph()
                before_recognition(part)
        self._contexts = Contexts(part, self._shop, self.library)
        self._file = (path.read_bytes(), path.suffix)
        return Session(part=self.context.facts)

    def _open_project(self, path: Path, progress: Progress) -> Session:
        from trunnion.store.project import load_project

        session, data, suffix = load_project(path, progress.part(0.0, 0.3))
        self._take(session, data, suffix, progress.part(0.3, 1.0))
        return session

    def _take(self, session: Session, data: bytes, suffix: str, progress: Progress) -> None:
        from trunnion.part.read.part_file import read_part_bytes

        if session.part is None:
            raise BadInput("the project holds no part: open the part file instead")
        with compiling(progress):
            part = read_part_bytes(
                data,
                session.part.name,
                suffix,
                solid=session.part.solid,
                progress=progress.part(0.0, 0.9),
            )
        if part.digest != session.part.digest:
            raise BadInput(
                f"{session.part.name}: the part kept with the project is not the one its plan was made for; open the part anew"
            )
        contexts = Contexts(part, self._shop, self.library)
        contexts.after(session.cuts, progress.part(0.9, 1.0))
        self._contexts, self._file = contexts, (data, suffix)

    def beside(self) -> Engine:
        """Return an engine of the same shop and plan library in which no part is open."""
        made = copy(self)
        made._contexts, made._file, made._playback, made._guides = None, (b"", ""), None, None
        return made

    def take_over(self, other: Engine) -> None:
        """Go on with the part that is open in another engine."""
        self._contexts, self._file = other._contexts, other._file
        self._playback, self._guides = None, None

    @property
    def shop(self) -> Shop:
        """The catalogues with the user's folder over them."""
        return self._shop

    def reload_shop(self) -> None:
        """Read the catalogues again after a file of the user's folder was changed; what was planned with others is stale then.

        Raises `BadInput` for a file that can't be used; the catalogues are as they were then.
        """
        self._shop = load_shop(self.folder)
        if self._contexts is not None:
            self._contexts.use_shop(self._shop)

    def keep(self) -> tuple[bytes, str]:
        """Return the bytes and the suffix of the part file as it was read, so that another engine can take over with `attach`."""
        return self._file

    def attach(
        self,
        session: Session,
        data: bytes = b"",
        suffix: str = "",
        progress: Progress = NO_PROGRESS,
    ) -> None:
        """Take over a session after a restart: from the part file's bytes when given, else from where the part was read."""
        if session.part is None:
            return
        if not data:
            path = Path(session.part.path)
            if not path.is_file():
                raise BadInput(f"{path}: the part file is gone; open it again from where it is now")
            data, suffix = path.read_bytes(), path.suffix
        self._take(session, data, suffix, progress)

    @property
    def context(self) -> Context:
        """The part as read and the shop; raises `BadCall` while no part is open."""
        if self._contexts is None:
            raise BadCall("no part is open: open a STEP or IGES file first")
        return self._contexts.after(())

    def context_of(self, session: Session, progress: Progress = NO_PROGRESS) -> Context:
        """Return the part after the session's cuts, and the shop; raises `BadCall` while no part is open."""
        if self._contexts is None:
            return self.context
        return self._contexts.after(session.cuts, progress)

    def mesh(self, session: Session, progress: Progress = NO_PROGRESS) -> Mesh:
        """Return the triangles of the part that a window shows, with the tag of each one's face."""
        progress = progress.afresh()
        part = self.context_of(session, progress).part
        with part.watched(progress):
            return part.mesh(part.view_chord)

    @property
    def catalogue_digest(self) -> str:
        """A digest of the shop's catalogues and of its plan library: of all that plans are made from beside part and settings."""
        return digest(self._shop.digest, [[p.name, p.digest] for p in self.library.plans()])

    def settings(self) -> dict[str, tuple[type, ...]]:
        """Return the groups of settings that each step declares."""
        return {step.name: step.settings() for step in STEP_TABLE}

    def declared(self) -> tuple[Declared, ...]:
        """Return every declared setting once."""
        groups = dict.fromkeys(g for groups in self.settings().values() for g in groups)
        return tuple(d for group in groups for d in declared(group))

    def with_choices(self, session: Session, words: Mapping[str, Value]) -> Session:
        """Return the session with settings chosen by key, `plane.rough.slot_feed` or `slot_feed` alone where only one is named so.

        Raises `BadInput` for a wrong key or value.
        """
        known = {d.key: d for d in self.declared()}
        values: dict[str, Value] = {}
        for key, value in words.items():
            if key not in known:
                near = [k for k in known if k.rsplit(".", 1)[-1] == key.rsplit(".", 1)[-1]]
                if len(near) != 1 or "." in key:
                    advice = (
                        f"did you mean {' or '.join(near)}?"
                        if near
                        else "`trunnion settings` lists them"
                    )
                    raise BadInput(f"unknown setting {key}; {advice}")
                key = near[0]
            values[key] = known[key].parse(value)
        return replace(session, choices={**session.choices, **values})

    def with_cuts(
        self, session: Session, cuts: tuple[Cut, ...], progress: Progress = NO_PROGRESS
    ) -> Session:
        """Return the session with its part's faces divided by cuts, in their order; raise `BadInput` when one of them can't be made."""
        after = replace(session, cuts=cuts)
        facts = self.context_of(after, progress).facts
        return replace(
            after, part=facts if session.part is None else replace(facts, path=session.part.path)
        )

    def with_fixtures(
        self, session: Session, words: Sequence[str], progress: Progress = NO_PROGRESS
    ) -> Session:
        """Return the session with the fixtures of some files (`FILE`, or `SETUP=FILE` for one setup) in place of those it had.

        The files' coordinates are the part's. Raises `BadInput` for a file that can't be read.
        """
        from trunnion.part.read.fixture import read_fixture

        found = []
        for n, word in enumerate(words):
            setup, file = setup_file(word)
            mesh = read_fixture(file, progress=progress.part(n / len(words), (n + 1) / len(words)))
            found.append(Fixture(name=file.stem, mesh=mesh, setup=setup))
        return replace(session, fixtures=tuple(found))

    def with_fix(self, session: Session, fix: Fix) -> Session:
        """Return the session with one fix in its process, to be computed and proven again; raise `BadInput` where nothing can be done."""
        if session.process is None:
            raise BadCall("no operations yet: generate the route first")
        shop = shop_of_fixes(session, self.context_of(session).shop)
        job = RepairJob(shop=shop, choices=session.choices)
        if fix.operation and fix.operation not in {o.id for o in session.process.operations}:
            raise BadInput(f"{fix.operation} is not in the plan any more: verify again")
        changed = applied(session.process, fix, job)
        if changed is not None:
            return replace(session, process=changed)
        raise BadInput(
            f"{words_of(fix)}: no tool of the catalogue serves, or a person set the operation by hand; follow the remedy by hand"
        )

    def with_operation_change(self, session: Session, id: str, change: OperationChange) -> Session:
        """Return the session with an operation's tool, spindle speed or feed changed by hand, to be computed and proven again.

        Raises `BadInput` for what can't be.
        """
        if session.process is None:
            raise BadCall("no operations yet: generate the route first")
        shop = self.context_of(session).shop
        changed = with_change(session.process, id, change, shop, session.choices)
        return session if changed is session.process else replace(session, process=changed)

    def states(self, session: Session) -> dict[str, str]:
        """Return for each step whether it is `empty`, `stale`, `done`, or done with a `problem`."""
        found: dict[str, str] = {}
        for step in STEP_TABLE:
            state = self._state(session, step)
            upstream = all(found[name] in FRESH for name in step.after)
            found[step.name] = state if upstream or state == "empty" else "stale"
        return found

    def _state(self, session: Session, step: Step, _progress: Progress = NO_PROGRESS) -> str:
        record = session.records.get(step.name)
        if record is None or not step.done(session):
            return "empty"
        if self._contexts is None or record.key != step.key(session, self.context_of(session)):
            return "stale"
        return "problem" if has_errors(record.findings) else "done"

    def run(
        self,
        session: Session,
        until: str = STEPS[-1],
        progress: Progress = NO_PROGRESS,
        ahead: Ahead | None = None,
    ) -> Session:
        """Return the session with every stale step up to `until` computed again; the one given stays as it was.

        `ahead` is asked for the pictures of the plan as soon as its toolpaths are laid, if there are any.
        """
        last, progress = STEPS.index(step_named(until).name), progress.afresh()
        for n, step in enumerate(progress.each(STEP_TABLE[: last + 1])):
            if progress.aside(partial(self._state, session, step)) in FRESH:
                continue
            share = progress.part(n / (last + 1), (n + 1) / (last + 1))
            share.at(0.0, step.title)
            session = run_step(session, step, self.context_of(session, share), share, STEPS)
            trim_memory()
            if ahead is not None and step.name == _LAID and session.paths:
                ahead(session, self._picture_mesh(session, share))
        progress.at(1.0, "done")
        return session

    def _picture_mesh(self, session: Session, progress: Progress) -> Mesh:
        part = self.context_of(session).part
        with part.watched(progress):
            return part.mesh(part.picture_chord)

    def playback(
        self, session: Session, cell: float = 0.0, progress: Progress = NO_PROGRESS
    ) -> Timeline:
        """Take up a plan for playback and return its blocks over time; `moment` then shows its stock."""
        from trunnion.pipeline.proof.playback import Playback

        progress = progress.afresh()
        with compiling(progress):
            self._playback = Playback(session, self.context_of(session), cell, progress)
        return self._playback.timeline

    def moment(
        self,
        key: str,
        position: float,
        seconds: float = float("inf"),
        progress: Progress = NO_PROGRESS,
    ) -> Moment:
        """Return the stock of the plan that is played (by its timeline's key) at a position, or on the way there after some seconds."""
        if self._playback is None or self._playback.timeline.key != key:
            raise BadCall("this plan is not played any more: start the playback again")
        progress = progress.afresh()
        with compiling(progress):
            return self._playback.towards(position, seconds, progress)

    def guides(
        self, session: Session, id: str, progress: Progress = NO_PROGRESS
    ) -> OperationGuides:
        """Return the guide lines and guide faces of an operation; raise `BadCall` where the plan has none of that id."""
        progress = progress.afresh()
        return self._plan_guides(session, progress).of(id, progress)

    def operation_guides(
        self, session: Session, operation: Operation, progress: Progress = NO_PROGRESS
    ) -> OperationGuides:
        """Return the guide lines and guide faces of an operation as it is given, in the place of the plan's of its id."""
        progress = progress.afresh()
        return self._plan_guides(session, progress).of_operation(operation, progress)

    def _plan_guides(self, session: Session, progress: Progress) -> PlanGuides:
        from trunnion.pipeline.guides import PlanGuides, digest_of

        if self._guides is None or self._guides.digest != digest_of(session):
            self._guides = PlanGuides(session, self.context_of(session, progress))
        return self._guides

    def deviation_map(self, session: Session, progress: Progress = NO_PROGRESS) -> DeviationMap:
        """Return the deviation of the finished part as triangles to be drawn; raise `BadCall` before a proof."""
        from trunnion.report.deviation import deviation_map

        if session.verdict is None:
            raise BadCall("nothing is proven yet: verify first")
        values = checked(choose(ProofSettings, session.choices))
        progress = progress.afresh()
        part = self.context_of(session).part
        with part.watched(progress.part(0.0, 0.2)):
            mesh = part.mesh()
        return deviation_map(
            mesh,
            session.verdict.deviation,
            values.tolerance,
            values.allowance,
            progress.part(0.2, 1.0),
        )

    def save(self, session: Session, path: str | Path, progress: Progress = NO_PROGRESS) -> None:
        """Write the project file, whole or not at all."""
        from trunnion.store.project import save_project

        data, suffix = self._file
        save_project(session, Path(path), data, suffix, progress)

    def write(
        self,
        session: Session,
        folder: str | Path,
        *,
        name: str = "",
        date: str = "",
        drawing: Drawing = here,
        progress: Progress = NO_PROGRESS,
    ) -> tuple[str, ...]:
        """Write everything of a proven session into a folder (NC, CL, XML, tool list, report, project); return the file names."""
        from trunnion.pipeline.planning.finishing_estimate import estimate
        from trunnion.pipeline.writing import name_of, write_documents

        if self.states(session)["verify"] not in FRESH:
            raise BadCall("something changed since the proof: verify again before anything leaves")
        context, progress = self.context_of(session), progress.afresh()
        with compiling(progress), context.part.watched(progress):
            files = write_documents(
                session,
                partial(self._picture_mesh, session, progress),
                Path(folder),
                name=name,
                date=date,
                estimate=estimate(session, context),
                cribs=self._shop.cribs,
                drawing=drawing,
                progress=progress.part(0.1, 0.9),
            )
        project = f"{name_of(session, name)}{PROJECT_SUFFIX}"
        progress.at(0.9, "saving the project")
        self.save(session, Path(folder) / project, progress.part(0.9, 1.0))
        return (*files, project)


def setup_file(word: str) -> tuple[str, Path]:
    """Return the setup (empty: all) and the file that a word names: `FILE`, or `S2=FILE`.

    >>> setup_file("S2=clamp.stl")
    ('S2', PosixPath('clamp.stl'))
    """
    setup, equals, file = word.partition("=")
    if equals and re.fullmatch(r"S[0-9]+", setup):
        return setup, Path(file)
    return "", Path(word)
