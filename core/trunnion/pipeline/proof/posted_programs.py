"""From toolpaths to a verdict: the programs are posted, read back, and what was read is proven, not what was planned."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING

from trunnion import registry
from trunnion.findings import BadCall, BadInput, Finding, Severity, error
from trunnion.model.hole_demand import BoreDemand
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program, section_of
from trunnion.model.process import ProcessTree
from trunnion.model.session import PostedFile, Session
from trunnion.model.setup import Setup
from trunnion.model.tabs import PlannedTab, Tab, tabs_of
from trunnion.model.verdict import Outcome, Verdict
from trunnion.pipeline.context import Context
from trunnion.pipeline.proof.time_bound import with_bounds
from trunnion.pipeline.work_position import work_positions_of
from trunnion.plan import setups
from trunnion.plan.allowances import face_allowances
from trunnion.plan.holes.demand import bore_demands
from trunnion.plan.prismatic.drive import FINISHES_OUTLINE, OF_OUTLINES
from trunnion.post.header import Header
from trunnion.post.readers import read_program
from trunnion.post.settings import OF_MACHINE, PostSettings
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import checked, choose
from trunnion.shop.kinematics import WorkPositions
from trunnion.verify.settings import ProofSettings

if TYPE_CHECKING:
    from trunnion.verify.judge.part_facets import FacetsFork


FACETS_FORK = "trunnion.pipeline.proof.facets_fork"
"""What the proof alone imports is imported with it: it takes a second."""


def program_of(session: Session, setup: Setup) -> Program:
    """Return the motions of one setup: a section for each operation that has a toolpath, in the order they are cut."""
    if session.process is None or session.part is None:
        raise BadCall("no operations yet: generate the route first")
    sections = []
    for operation in session.process.of_setup(setup.name):
        made = session.path_of(operation.id)
        if made is not None and len(made.path):
            sections.append(section_of(operation, made.path, made.guides))
    return Program(
        name=f"{session.part.name}.{setup.name}",
        setup=held(session, setup),
        sections=tuple(sections),
    )


def held(session: Session, setup: Setup) -> Setup:
    """Return a setup with the fixtures that hold the part in it, its clearance over them."""
    fixtures = session.fixtures_of(setup.name)
    if session.blank is None:
        return replace(setup, fixtures=fixtures)
    return setups.held(setup, fixtures, session.blank)


def programs_of(session: Session) -> tuple[Program, ...]:
    """Return the programs of all setups that cut anything."""
    return tuple(p for p in (program_of(session, s) for s in session.setups) if p.sections)


def post_texts(
    session: Session,
    header: Header,
    machines: Mapping[str, Machine],
    progress: Progress = NO_PROGRESS,
) -> tuple[PostedFile, ...]:
    """Return the texts of every program: one for each setup in the dialect of its machine's control, and the CL of all setups."""
    settings, cl = checked(choose(PostSettings, session.choices)), registry.get("dialects", "apt")()
    programs, work_positions = programs_of(session), work_positions_of(session, machines)
    posted = [
        _posted(p, header, settings, machines, work_positions) for p in progress.each(programs)
    ]
    progress.check()
    if programs:
        posted.append(
            PostedFile(
                suffix=cl.suffix,
                dialect=cl.name,
                setup="",
                text=cl.write(programs, header, settings, work_positions),
            )
        )
    return tuple(posted)


def _posted(
    program: Program,
    header: Header,
    settings: PostSettings,
    machines: Mapping[str, Machine],
    work_positions: WorkPositions,
) -> PostedFile:
    setup = program.setup
    dialect = registry.get("dialects", dialect_of(setup, settings, machines))()
    return PostedFile(
        suffix=f"{setup.name}.{dialect.suffix}",
        dialect=dialect.name,
        setup=setup.name,
        text=dialect.write((program,), header, settings, work_positions),
    )


def dialect_of(setup: Setup, settings: PostSettings, machines: Mapping[str, Machine]) -> str:
    """Return the name of the dialect that a setup's program is written in: the one chosen for all, else that of its machine's control."""
    if settings.dialect != OF_MACHINE:
        return settings.dialect
    return machine_of(setup, machines).control


def machine_of(setup: Setup, machines: Mapping[str, Machine]) -> Machine:
    """Return the machine of a setup; raise `BadInput` when the catalogue does not have it."""
    if setup.machine not in machines:
        raise BadInput(
            f"setup {setup.name}: there is no machine {setup.machine} in the catalogue; "
            f"known: {', '.join(sorted(machines))}"
        )
    return machines[setup.machine]


def read_back(
    session: Session,
    posted: tuple[PostedFile, ...],
    machines: Mapping[str, Machine],
    progress: Progress = NO_PROGRESS,
) -> tuple[Program, ...]:
    """Return the motions that the posted texts of the control's dialect say, setup by setup."""
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    process, work_positions = session.process, work_positions_of(session, machines)
    read = (
        read_program(
            f.dialect,
            f.text,
            process.tools(process.setup(f.setup).machine),
            held(session, process.setup(f.setup)),
            work_positions,
        )
        for f in progress.each(posted)
        if f.setup
    )
    return tuple(with_engagement(p, session.process) for p in read)


def with_engagement(program: Program, process: ProcessTree) -> Program:
    """Return a program whose sections know the engagement that their operations' feeds were chosen for: no text says that."""
    known = {o.id: o.data for o in process.operations}
    sections = tuple(
        replace(
            s,
            width=known[s.operation].width,
            depth=known[s.operation].depth,
            feed=known[s.operation].feed,
        )
        if s.operation in known
        else s
        for s in program.sections
    )
    return replace(program, sections=sections)


NOTHING_CUT = Verdict(
    outcome=Outcome.FAILED,
    coverage=0.0,
    reachable=0.0,
    gouge=0.0,
    collisions=0,
    rapids_in_stock=0,
    machining_time_s=0.0,
)
"""The verdict where an error kept anything from being planned: a part of metres that no machine takes is not looked at by the micron."""


def prove_session(
    session: Session, context: Context, progress: Progress
) -> tuple[Verdict, tuple[PostedFile, ...]]:
    """Return the verdict on the posted text of a session, and that text."""
    if session.process is None or session.blank is None or session.part is None:
        raise BadCall("no toolpaths yet: generate them first")
    machines = context.shop.machines
    milling = [
        p.setup for p in programs_of(session) if not any(s.path.work_turns for s in p.sections)
    ]
    with ExitStack() as beside:
        fork = None
        if milling:
            part = context.machined(session.choices, progress).part
            own = [machine_of(s, machines) for s in milling]
            begin = progress.aside(lambda _: importlib.import_module(FACETS_FORK).facets_fork)
            fork = beside.enter_context(begin(part, milling[0].frame, own))
        progress.at(0.0, "posting")
        posted = progress.aside(lambda own: post_texts(session, Header.of(session), machines, own))
        progress.at(0.05, "reading the text back")
        programs = progress.aside(lambda own: read_back(session, posted, machines, own))
        errors = errors_before(session)
        if errors and all(o.suppressed for o in session.process.operations):
            return held_back(NOTHING_CUT, errors), posted
        share = progress.part(0.1, 1.0, "proof")
        verdict = prove_programs(session, context, programs, share, fork)
    return held_back(verdict, errors), posted


def errors_of_part(session: Session) -> tuple[Finding, ...]:
    """Return the errors of the part itself: what they name can't be proven against."""
    return tuple(
        f for f in (session.part.findings if session.part else ()) if f.severity is Severity.ERROR
    )


def errors_before(session: Session) -> tuple[Finding, ...]:
    """Return the errors that the part and the steps before the proof have reported."""
    notes = (
        f for step, record in session.records.items() if step != "verify" for f in record.findings
    )
    return errors_of_part(session) + tuple(f for f in notes if f.severity is Severity.ERROR)


def held_back(verdict: Verdict, errors: Sequence[Finding]) -> Verdict:
    """Return the verdict, failed when there were errors before the proof: a plan that could not be made whole is not released."""
    if not errors:
        return verdict
    codes = ", ".join(dict.fromkeys(f.code for f in errors))
    held = error(
        "verify.errors-before",
        f"{len(errors)} errors were told before the proof ({codes}): {errors[0].text}",
        *errors[0].where,
        remedy="mend what they name, then program the part again",
    )
    return replace(verdict, outcome=Outcome.FAILED, findings=(held, *verdict.findings))


def prove_programs(
    session: Session,
    context: Context,
    programs: tuple[Program, ...],
    progress: Progress,
    fork: FacetsFork | None = None,
) -> Verdict:
    """Return the verdict on programs, wherever their motions come from; `fork` are the part's triangles, where they are begun already."""
    if session.process is None or session.blank is None:
        raise BadCall("no blank or operations: nothing to prove against")
    prove = progress.aside(lambda _: importlib.import_module("trunnion.verify.judge.verdict").prove)
    names = [s.name for s in session.process.setups]
    strange = next((f for f in session.fixtures if f.setup and f.setup not in names), None)
    if strange is not None:
        raise BadInput(
            f"fixture {strange.name} is for setup {strange.setup}; the part has {', '.join(names)}"
        )
    machines = context.shop.machines
    used = [p.setup for p in programs] or session.process.setups[:1]
    planned = {
        tag
        for operation in session.process.operations
        if not operation.suppressed
        for tag in operation.faces
    }
    part = context.machined(session.choices, progress).part
    verdict: Verdict = prove(
        programs,
        part,
        session.blank,
        context.shop.tools,
        [machine_of(s, machines) for s in used],
        checked(choose(ProofSettings, session.choices)),
        progress,
        planned_faces=sorted(planned),
        material=context.shop.materials.get(session.process.material),
        facets_fork=fork,
        bore_demands=_bore_demands(session, context),
        tabs=planned_tabs(session.process),
        allowances=face_allowances(session.recognition, part),
    )
    return progress.aside(
        lambda own: with_bounds(verdict, session, context, programs, own),
        "Finding the least time of each operation",
    )


def planned_tabs(process: ProcessTree) -> tuple[PlannedTab, ...]:
    """Return the tabs that a plan leaves, each once, with the radius of the cutter that is at the wall last: one that finishes the
    outline, else the one that roughs it."""
    found: dict[tuple[str, Tab], tuple[bool, float]] = {}
    for operation in process.operations:
        if operation.suppressed or operation.kind not in OF_OUTLINES:
            continue
        finishes = operation.kind == FINISHES_OUTLINE
        for tab in tabs_of(operation.choices, operation.id):
            known = found.setdefault((operation.setup, tab), (finishes, operation.cutter.radius))
            if finishes > known[0]:
                found[operation.setup, tab] = (finishes, operation.cutter.radius)
    return tuple(
        PlannedTab(setup=setup, tab=tab, radius=radius)
        for (setup, tab), (_, radius) in found.items()
    )


def _bore_demands(session: Session, context: Context) -> tuple[BoreDemand, ...]:
    """Return the threads and fits that the part's bores are to have."""
    found = session.recognition
    return () if found is None else bore_demands(found, context.shop)
