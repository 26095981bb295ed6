"""The steps of the work, what each one reads, and the plain function behind it.

A step's key is the digest of what it is given: the settings it uses, the results it reads and a version that its author raises when
the answer changes. A step whose key differs from its record is stale; nothing keeps a list of setting names. Of families, planners and
strategies a session uses its own ones' settings alone.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial, wraps
from typing import Any

from trunnion import registry
from trunnion.findings import BadCall, BadInput
from trunnion.model.feature import Recognition
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.execution import run_step
from trunnion.pipeline.part_work import before_blank, before_proof, before_route
from trunnion.pipeline.planning.blank import blank_of, source_of, too_small
from trunnion.pipeline.planning.family import RecognizeSettings, recognised
from trunnion.pipeline.planning.hole_demands import with_demands
from trunnion.pipeline.planning.library import library_choice, library_key, routed
from trunnion.pipeline.planning.machine import with_machine
from trunnion.pipeline.planning.manual_edits import with_manual_features
from trunnion.pipeline.planning.open_faces import OpenSettings, frame_and_finding
from trunnion.pipeline.planning.scene import SessionContext
from trunnion.pipeline.proof.posted_programs import prove_session
from trunnion.pipeline.repair.findings import repair_findings
from trunnion.pipeline.repair.rounds import repaired
from trunnion.pipeline.repair.settings import RepairSettings
from trunnion.pipeline.step import Result, Step, Work
from trunnion.pipeline.toolpaths import findings_of, make_paths, strategy_settings
from trunnion.plan.allowances import allowance_words, on_operations, with_allowances_kept
from trunnion.plan.blank import BlankSettings
from trunnion.plan.contract import RouteJob, planner_for
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimization.settings import GeneticSettings, OptimizeSettings
from trunnion.plan.cutting.optimize import balance
from trunnion.plan.cutting.peak import overloads
from trunnion.plan.holes.demand import demand_words
from trunnion.plan.library.settings import LibrarySettings
from trunnion.plan.loaded_tools import loaded_findings, planning_shop
from trunnion.plan.manual.manual_operations import with_manual_operations
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.settings import KEPT_KEYS
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.plan.size import size_table
from trunnion.post.settings import PostSettings
from trunnion.progress import Progress
from trunnion.recognize.contract import Measuring, registered_family, usual_blank
from trunnion.registry import FAMILIES, FIXES, PART_KINDS, PLANNERS, STRATEGIES
from trunnion.settings import checked, choose
from trunnion.shop import Shop
from trunnion.verify.settings import ProofSettings


def _family_settings() -> tuple[type, ...]:
    return (
        RecognizeSettings,
        *(registry.get(FAMILIES, name).settings for name in registry.names(FAMILIES)),
    )


def _used_to_recognize(session: Session) -> tuple[type, ...]:
    """Return the settings of recognition and of the family that was recognised: which one that is depends on no family's settings."""
    known = _served(session, FAMILIES)
    return (
        (RecognizeSettings, registry.get(FAMILIES, known).settings)
        if known
        else (RecognizeSettings,)
    )


def _used_to_route(session: Session) -> tuple[type, ...]:
    known = _served(session, PLANNERS)
    return (SetupSettings, *registry.get(PLANNERS, known).settings) if known else (SetupSettings,)


def _served(session: Session, kind: str) -> str:
    """Return the name of a session's family where it is registered as a kind, else an empty name."""
    family = session.recognition.family if session.recognition else ""
    return family if family in registry.names(kind) else ""


def _strategies_used(session: Session) -> tuple[type, ...]:
    """Return the settings of the strategies in use."""
    used = sorted({o.strategy for o in session.process.operations}) if session.process else ()
    return tuple(registry.get(STRATEGIES, name).settings for name in used)


def _route_settings() -> tuple[type, ...]:
    """Return the settings of setups and of every planner, each group once."""
    return tuple(
        dict.fromkeys(
            (
                SetupSettings,
                LibrarySettings,
                *(
                    group
                    for name in registry.names(PLANNERS)
                    for group in registry.get(PLANNERS, name).settings
                ),
            )
        )
    )


def _recognize(session: Session, context: Context, progress: Progress) -> Result:
    graph = context.part.graph()
    found = replace(
        recognised(session, context, progress), face_area=graph.area, neighbours=graph.edge_face + 1
    )
    if not context.part.is_closed:
        found = _seen_from_side(found, session, context)
    kept = with_manual_features(session.recognition, found)
    after = replace(session, recognition=kept)
    measured = _recognition(after if kept is found else measured_anew(after, context))
    whole = with_demands(measured, session.recognition, context.part.dimensions, context.shop)
    whole = with_allowances_kept(whole, session.recognition)
    return Result(session=replace(session, recognition=whole), findings=whole.findings)


def _seen_from_side(found: Recognition, session: Session, context: Context) -> Recognition:
    """Return what was recognised of open faces in the frame that they are machined in, if there is one, with what is said of it."""
    frame, finding = frame_and_finding(context.part, session.choices)
    return replace(found, frame=frame or found.frame, findings=(*found.findings, finding))


def measured_anew(session: Session, context: Context) -> Session:
    """Return the session with the sizes of features whose faces a person changed, where the family can measure them."""
    found = _recognition(session)
    family = registered_family(found.family)
    if not isinstance(family, Measuring):
        return session
    settings: Any = checked(choose(family.settings, session.choices))
    return replace(
        session, recognition=family.measured(found, context.part.graph(), context.part, settings)
    )


def _recognition(session: Session) -> Recognition:
    if session.recognition is None:
        raise BadCall("no features yet: recognize first")
    return session.recognition


def _certain(session: Session) -> Recognition:
    """Return what was recognised; raise `BadInput` while recognition doubts what kind of part it is and no family is chosen."""
    found = _recognition(session)
    if found.doubt:
        raise BadInput(found.doubt)
    return found


def _on_machined(work: Work) -> Work:
    """Return a step's work as done on the part as it is planned and proven: open faces with their backing (`Context.machined`)."""

    @wraps(work)
    def done(session: Session, context: Context, progress: Progress) -> Result:
        machined = context.machined(session.choices, progress)
        with machined.part.watched(progress):
            return work(session, machined, progress)

    return done


def _size(session: Session, context: Context, progress: Progress) -> Result:
    progress.at(0.0, "measuring")
    found = _certain(session)
    with context.part.watched(progress):
        sizes = size_table(found, context.part.graph(), context.part, progress)
    return Result(session=replace(session, sizes=sizes))


@_on_machined
def _blank(session: Session, context: Context, progress: Progress) -> Result:
    progress.at(0.0, "blank")
    recognition = _certain(session)
    blank = blank_of(session, context, recognition.frame, progress)
    return Result(session=replace(session, blank=blank), findings=too_small(blank, context))


@_on_machined
def _route(session: Session, context: Context, progress: Progress) -> Result:
    recognition = _certain(session)
    if session.blank is None:
        raise BadCall("no blank yet: create the blank first")
    planner = planner_for(recognition.family)
    choices = with_machine(planner, session.blank, session.choices, context.shop)
    setups = make_setups(recognition, session.blank, checked(choose(SetupSettings, choices)))
    planner.can_plan(context.part)
    shop = planning_shop(context.shop, (s.machine for s in setups), choices)
    job = RouteJob(
        recognition=recognition,
        sizes=session.sizes,
        blank=session.blank,
        setups=setups,
        shop=shop,
        context=SessionContext(context, session),
        choices=choices,
        progress=progress,
    )
    process = routed(planner, job, library_choice(session, context))
    kept = with_manual_operations(session.process, process, context.shop.cribs)
    process = on_operations(kept, recognition)
    loaded = loaded_findings(process, context.shop, session.choices)
    process = replace(process, findings=(*process.findings, *loaded))
    return Result(
        session=replace(session, setups=process.setups or setups, process=process),
        findings=process.findings,
    )


def _optimize(session: Session, context: Context, progress: Progress) -> Result:
    progress.at(0.0, "speeds and feeds")
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    routed, found = session.process, session.recognition
    if found is not None:
        routed = on_operations(routed, found)
    balanced = balance(
        routed,
        context.shop,
        checked(choose(CuttingSettings, session.choices)),
        session.choices,
        progress,
    )
    return Result(
        session=replace(session, process=balanced), findings=overloads(balanced.operations)
    )


@_on_machined
def _toolpath(session: Session, context: Context, progress: Progress) -> Result:
    paths = make_paths(session, context, progress)
    found = findings_of(paths, session.process) if session.process else ()
    return Result(session=replace(session, paths=paths), findings=found)


@_on_machined
def _verify(session: Session, context: Context, progress: Progress) -> Result:
    verdict, posted = prove_session(session, context, progress)
    return Result(
        session=replace(session, verdict=verdict, posted=posted), findings=verdict.findings
    )


def _repair(session: Session, context: Context, progress: Progress) -> Result:
    after = repaired(
        session,
        RepairJob(shop=shop_of_fixes(session, context.shop), choices=session.choices),
        checked(choose(RepairSettings, session.choices)),
        partial(_proven, context),
        progress,
    )
    return Result(session=after, findings=repair_findings(after))


def shop_of_fixes(session: Session, shop: Shop) -> Shop:
    """Return the shop that a fix of a session's plan may choose from, as `planning_shop` does for its route."""
    setups = session.process.setups if session.process is not None else session.setups
    return planning_shop(shop, (s.machine for s in setups), session.choices)


def _proven(context: Context, session: Session, progress: Progress) -> Session:
    """Return a session whose process was changed with data, toolpaths and proof made again."""
    for n, name in enumerate(PROVING):
        share = progress.part(n / len(PROVING), (n + 1) / len(PROVING))
        session = run_step(session, step_named(name), context, share, STEPS)
    return session


PROVING = ("optimize", "toolpath", "verify")
"""The steps that a changed process goes through before it is judged."""


def _record_key(session: Session, step: str) -> str:
    record = session.records.get(step)
    return record.key if record else ""


def _operations_without_data(session: Session) -> tuple[Any, ...]:
    if session.process is None:
        return ()
    return tuple(
        (
            o.id,
            o.strategy,
            o.all_features,
            o.tool,
            {k: v for k, v in o.choices.items() if not k.startswith(KEPT_KEYS)},
            o.by_hand,
            o.suppressed,
        )
        for o in session.process.operations
    )


def _strategy_settings(session: Session) -> tuple[Any, ...]:
    """Return what is chosen for the strategies in use: it says how large an engagement each can meet."""
    return tuple(checked(choose(group, session.choices)) for group in _strategies_used(session))


STEP_TABLE: tuple[Step, ...] = (
    Step(
        name="recognize",
        title="Recognize",
        after=(),
        settings=_family_settings,
        uses=_used_to_recognize,
        work=_recognize,
        reads=lambda s, b: (
            b.part.digest,
            b.part.solid,
            registry.names(FAMILIES),
            registry.names(PART_KINDS),
            *((b.shop.digest,) if b.part.dimensions else ()),
        ),
        done=lambda s: s.recognition is not None,
        foresees=(before_blank, before_route),
        version=2,
    ),
    Step(
        name="size",
        title="Size analysis",
        after=("recognize",),
        settings=lambda: (),
        work=_size,
        reads=lambda s, b: (s.recognition,),
        done=lambda s: "size" in s.records,
        version=2,
    ),
    Step(
        name="blank",
        title="Blank",
        after=("recognize",),
        settings=lambda: (BlankSettings, OpenSettings),
        uses=lambda s: (BlankSettings,),
        work=_blank,
        reads=lambda s, b: (
            b.part.digest,
            s.recognition.frame if s.recognition else None,
            usual_blank(s.recognition.family) if s.recognition else "",
            b.shop.digest,
            source_of(s),
        ),
        done=lambda s: s.blank is not None,
        version=2,
    ),
    Step(
        name="route",
        title="Process route",
        after=("size", "blank"),
        work=_route,
        settings=_route_settings,
        uses=_used_to_route,
        reads=lambda s, b: (
            b.part.digest,
            s.recognition,
            s.blank,
            b.shop.digest,
            *library_key(s, b),
        ),
        done=lambda s: s.process is not None,
        foresees=(before_proof,),
    ),
    Step(
        name="optimize",
        title="Optimize",
        after=("route",),
        settings=lambda: (CuttingSettings, OptimizeSettings, GeneticSettings),
        work=_optimize,
        reads=lambda s, b: (
            _record_key(s, "route"),
            _operations_without_data(s),
            *allowance_words(s.recognition),
            _strategy_settings(s),
            b.shop.digest,
        ),
        done=lambda s: s.process is not None,
        version=2,
    ),
    Step(
        name="toolpath",
        title="Toolpaths",
        after=("optimize",),
        settings=strategy_settings,
        uses=_strategies_used,
        work=_toolpath,
        reads=lambda s, b: (
            b.part.digest,
            s.recognition,
            s.blank,
            s.setups,
            s.process,
            *((s.fixtures,) if s.fixtures else ()),
        ),
        done=lambda s: "toolpath" in s.records,
    ),
    Step(
        name="verify",
        title="Verify and post",
        after=("toolpath",),
        settings=lambda: (PostSettings, ProofSettings),
        work=_verify,
        reads=lambda s, b: (
            b.part.digest,
            s.blank,
            s.setups,
            s.process,
            tuple(p.key for p in s.paths),
            s.fixtures,
            *demand_words(s.recognition),
            *allowance_words(s.recognition),
        ),
        done=lambda s: s.verdict is not None,
        version=2,
    ),
    Step(
        name="repair",
        title="Repair",
        after=("verify",),
        settings=lambda: (RepairSettings,),
        work=_repair,
        reads=lambda s, b: (_record_key(s, "verify"), registry.names(FIXES)),
        done=lambda s: "repair" in s.records,
    ),
)

STEPS: tuple[str, ...] = tuple(step.name for step in STEP_TABLE)
"""The names of the steps in the order of the work."""


def step_named(name: str) -> Step:
    """Return a step by its name; raise `BadCall` with the known names."""
    for step in STEP_TABLE:
        if step.name == name:
            return step
    raise BadCall(f"there is no step {name}; known: {', '.join(STEPS)}")
