"""The plan library and a session: which plan its route follows and why, what its finished process teaches.

What is taken from the library is part of what the route reads (`library_key`); an empty library changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from trunnion import registry
from trunnion.findings import BadCall, BadInput, Finding, info, warning
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.machine import MACHINE, with_machine
from trunnion.plan.contract import Planner, RouteJob, planner_for
from trunnion.plan.library.follow import followed
from trunnion.plan.library.principal_sizes import principal_sizes
from trunnion.plan.library.settings import AUTOMATIC, OFF, LibrarySettings
from trunnion.plan.library.teach import TaughtResult, taught_plan
from trunnion.registry import PLANNERS, STRATEGIES
from trunnion.settings import Value, checked, choose, declared
from trunnion.shop import TypicalPlan
from trunnion.shop.library import PartSignature, PlanLibrary, PlanMatch, Similarity, TaughtPlan
from trunnion.shop.library.signature import part_signature
from trunnion.shop.library.similarity import similarity
from trunnion.units import percent

CODE = "route.library"
"""Code of findings on the plan that a route follows."""
PLAN = "route.plan"
"""Key of the setting that names a typical plan: who names one is not given another."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryChoice:
    """The taught plan that a route follows, if any, with the similarity of its part, and findings on the library."""

    plan: TaughtPlan | None = None
    similarity: Similarity | None = None
    findings: tuple[Finding, ...] = ()


NOTHING = LibraryChoice()
"""Nothing is taken, and there is nothing to be told."""


def signature_of(session: Session, context: Context) -> PartSignature | None:
    """Return the signature of a session's part; None before it has features and a blank, and where its family is not planned."""
    found, blank = session.recognition, session.blank
    if found is None or blank is None or found.family not in registry.names(PLANNERS):
        return None
    planner, named = planner_for(found.family), session.choices.get(MACHINE) or ""
    unknown = named and named not in context.shop.machines
    if unknown or blank.material not in context.shop.materials:
        return None
    choices = with_machine(planner, blank, session.choices, context.shop)
    return part_signature(
        found.family,
        found.features,
        principal_sizes(planner, session.sizes),
        context.shop.material(blank.material),
        context.shop.machine(str(choices[MACHINE])),
    )


def matches(session: Session, context: Context) -> tuple[PlanMatch, ...]:
    """Return the library's plans for the family of a session's part with their similarity, the most similar first.

    Raises `BadCall` before the part has features and a blank, `BadInput` for a library that can't be read.
    """
    signature = signature_of(session, context)
    if signature is None:
        raise BadCall(
            "no plan can be looked for yet: recognize the part and create its blank first"
        )
    return context.library.matches(signature) if context.library is not None else ()


def library_choice(session: Session, context: Context) -> LibraryChoice:
    """Return the plan that the route of a session follows, and findings that say why; raise `BadInput` for a named one that can't be.

    A plan that this very part has taught is followed only where it is named: a finished process is not stale because it was added.
    """
    settings = checked(choose(LibrarySettings, session.choices))
    signature, library = signature_of(session, context), context.library
    if settings.use == OFF or signature is None or library is None:
        return NOTHING
    if settings.use != AUTOMATIC:
        return _named(library, settings.use, signature)
    if session.choices.get(PLAN):
        return NOTHING
    own = session.part.digest if session.part is not None else ""
    try:
        all_found = library.matches(signature)
        found = tuple(m for m in all_found if m.plan.part_digest != own)
        others = len(library.names()) - len(all_found) + len(found)
    except BadInput as reason:
        return LibraryChoice(
            findings=(
                warning(
                    CODE,
                    f"no plan is taken from the library: {reason}",
                    remedy="or choose route.library.use = off",
                ),
            )
        )
    if not others:
        return NOTHING
    return _most_similar(found, settings.similarity)


def _named(library: PlanLibrary, name: str, signature: PartSignature) -> LibraryChoice:
    plan = library.plan(name)
    reason = _misfit(plan, signature.family)
    if reason:
        raise BadInput(f"{library.path}: {name} can't be followed: {reason}; choose another plan")
    return LibraryChoice(plan=plan, similarity=similarity(signature, plan.signature))


def _most_similar(found: tuple[PlanMatch, ...], least: float) -> LibraryChoice:
    findings: list[Finding] = []
    for match in found:
        if match.similarity.value < least:
            break
        reason = _misfit(match.plan, match.plan.family)
        if not reason:
            return LibraryChoice(
                plan=match.plan, similarity=match.similarity, findings=tuple(findings)
            )
        findings.append(
            warning(
                CODE,
                f"the plan {match.plan.name} of the library can't be followed: {reason}",
                remedy="remove it from the library, and add it anew",
            )
        )
    nearest = (
        f"the nearest is {found[0].plan.name} with {percent(found[0].similarity.value)}: {found[0].similarity.words}"
        if found
        else "it has none for parts of this family"
    )
    findings.append(
        info(
            CODE,
            f"no plan of the library is similar enough ({percent(least)} is asked for); {nearest}",
            remedy="name a plan (route.library.use), or allow less (route.library.similarity), to follow one all the same",
        )
    )
    return LibraryChoice(findings=tuple(findings))


def _misfit(plan: TaughtPlan, family: str) -> str:
    """Return why a plan can't be followed by parts of a family, empty where it can: what it names must still be there."""
    if plan.family != family:
        return f"it is for parts of the family {plan.family}"
    rules = planner_for(family).cutter_rules
    for stage in plan.stages:
        if stage.cutter not in rules:
            return f"its stage {stage.name} has the cutter rule {stage.cutter}, which is not known any more"
        if stage.strategy not in registry.names(STRATEGIES):
            return f"its stage {stage.name} has the strategy {stage.strategy}, which is not known any more"
    return ""


def library_key(session: Session, context: Context) -> tuple[Any, ...]:
    """Return what a route's digest is made of for the library: what is taken from it and what is told of it, nothing where that is nothing.

    A setting of the plan that the session sets itself is not taken, so the keys of these belong to it.
    """
    try:
        choice = library_choice(session, context)
    except BadInput as reason:
        return (str(reason),)
    if choice is NOTHING:
        return ()
    plan = choice.plan
    own = tuple(sorted(set(plan.settings) & set(session.choices))) if plan is not None else ()
    return (
        "library",
        plan.digest if plan is not None else "",
        choice.similarity.words if choice.similarity is not None else "",
        own,
        tuple(f.text for f in choice.findings),
    )


def routed(planner: Planner, job: RouteJob, choice: LibraryChoice) -> ProcessTree:
    """Return the process of a job, by the taught plan that was found for it or, where there is none, by the typical plan.

    Raises what the planner raises.
    """
    plan = choice.plan
    if plan is None:
        process = planner.route(job)
        if not choice.findings:
            return process
        return replace(process, findings=(*choice.findings, *process.findings))
    choices = {**plan.settings, **job.choices, PLAN: plan.name}
    # It is named, and the first one too, for planners that have no setting for it.
    others = {name: typical for name, typical in job.shop.plans.items() if name != plan.name}
    shop = replace(job.shop, plans={plan.name: plan.typical(), **others})
    made = planner.route(replace(job, shop=shop, choices=choices))
    result = followed(made, plan, job.recognition, job.shop, choices)
    process = _with_strategy_settings(result.process, plan, job.choices)
    return replace(
        process,
        findings=(
            *choice.findings,
            _followed_finding(plan, choice.similarity, result.taught, result.other_cutter, process),
            *process.findings,
        ),
    )


def _followed_finding(
    plan: TaughtPlan, found: Similarity | None, taught: int, others: int, process: ProcessTree
) -> Finding:
    how = f" (similarity {percent(found.value)}: {found.words})" if found is not None else ""
    cutters = f", {others} of them with another cutter" if others else ""
    return info(
        CODE,
        f"the route follows the plan {plan.name} of the library{how}; {taught} of {len(process.operations)} operations come from "
        f"it{cutters}",
        remedy="to plan without it choose route.library.use = off",
    )


def _with_strategy_settings(
    process: ProcessTree, plan: TaughtPlan, own: Mapping[str, Value]
) -> ProcessTree:
    """Return a process whose operations have the plan's settings of their strategies, but for what planner or session say themselves."""
    operations = []
    for o in process.operations:
        keys = {d.key for d in declared(registry.get(STRATEGIES, o.strategy).settings)}
        taken = {k: v for k, v in plan.settings.items() if k in keys and k not in own}
        operations.append(replace(o, choices={**taken, **o.choices}) if taken else o)
    return replace(process, operations=tuple(operations))


def teach(session: Session, context: Context, *, name: str, date: str) -> TaughtResult:
    """Return the plan that a session's process teaches, under a name and with a date as given; nothing is stored.

    Raises `BadCall` before there is a process, `BadInput` where the plan that it was made by is gone.
    """
    part, process, recognition = session.part, session.process, session.recognition
    signature = signature_of(session, context)
    if part is None or recognition is None or signature is None:
        raise BadCall("no operations yet: recognize the part first, and add the finished process")
    if process is None or not process.operations:
        raise BadCall("no operations yet: generate the route first, and add the finished process")
    base, settings = _base(process, context, recognition.family)
    planner = planner_for(recognition.family)
    groups = {
        *planner.settings,
        *(registry.get(STRATEGIES, o.strategy).settings for o in process.operations),
    }
    kept = {
        d.key
        for group in groups
        for d in declared(group)
        # What names a thing of a catalogue belongs to the part: cutters are taught by the operations.
        if not d.catalogue and d.key != PLAN
    }
    own = {k: v for k, v in session.choices.items() if k in kept}
    return taught_plan(
        process,
        recognition,
        base,
        signature,
        name=name,
        date=date,
        part=part.name,
        part_digest=part.digest,
        settings={**settings, **own},
    )


def add_to_library(session: Session, context: Context, *, name: str, date: str) -> TaughtResult:
    """Add what a session's process teaches to the library and return it (`teach`).

    Raises `BadInput` for a name that is in use or that has a meaning of its own, and for a library that can't be written.
    """
    if context.library is None:
        raise BadCall("there is no plan library: the program was started without a user's folder")
    if name in (AUTOMATIC, OFF) or name in context.shop.plans:
        what = "a typical plan" if name in context.shop.plans else "a value of route.library.use"
        raise BadInput(f"{name} is the name of {what}: choose another name for the plan")
    result = teach(session, context, name=name, date=date)
    context.library.add(result.plan)
    return result


def _base(
    process: ProcessTree, context: Context, family: str
) -> tuple[TypicalPlan, Mapping[str, Value]]:
    """Return the plan that a process was made by, typical or taught, and the settings that came with it."""
    library = context.library
    if library is not None and process.plan in library.names():
        plan = library.plan(process.plan)
        if plan.family == family:
            return plan.typical(), plan.settings
    if process.plan not in context.shop.plans:
        raise BadInput(
            f"the plan {process.plan}, by which the process was made, is in the library no more: generate the route anew, then add it"
        )
    return context.shop.plan_for(family, process.plan), {}
