"""The verdict on a whole plan: contact, stock and coverage of every setup's program, judged against the limits.

Reads motions, tools, part, blank and machine, never what the planner meant. `failed` on any gouge, collision, rapid in stock, machine limit
or missing coverage; `passed with remarks` when a person should only look.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial

import numpy as np

from trunnion.findings import Finding, Severity
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.memory import trim_memory
from trunnion.model.allowance import FaceAllowance
from trunnion.model.blank import Blank
from trunnion.model.hole_demand import BoreDemand
from trunnion.model.material import Machine, Material
from trunnion.model.motion.program import Program
from trunnion.model.tabs import PlannedTab
from trunnion.model.tool import Tool
from trunnion.model.verdict import Offer, Outcome, Verdict
from trunnion.part.part import Part
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.part.shape.surfaces import Surfaces, surfaces_of
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.finish.coverage import Samples, samples_of
from trunnion.verify.judge.allowances import KeptLayers, layers_on
from trunnion.verify.judge.bore_demands import demand_findings
from trunnion.verify.judge.coverage import covered
from trunnion.verify.judge.findings import setup_findings
from trunnion.verify.judge.operations import block_proof, operation_proofs
from trunnion.verify.judge.overload import load_findings
from trunnion.verify.judge.part_facets import FacetsFork, part_facets
from trunnion.verify.judge.setups import SetupProof, prove_setup, stock_of
from trunnion.verify.judge.sides import sides_of
from trunnion.verify.judge.tabs import measured, on_tabs, tab_findings
from trunnion.verify.judge.turned import (
    TurnedWork,
    prove_turned,
    turned_blocks,
    turned_faces,
    turned_findings,
    turned_operations,
)
from trunnion.verify.machine.limits import limit_findings
from trunnion.verify.motion import refuse_turning
from trunnion.verify.settings import ProofSettings
from trunnion.verify.turning.moves import in_order

LayersOver = Callable[..., KeptLayers | None]
"""From samples with the tags of their face rows, in a frame, to what faces keep over them (`layers_on`)."""


def prove(
    programs: Sequence[Program],
    part: Part,
    blank: Blank,
    tools: Sequence[Tool],
    machines: Sequence[Machine],
    settings: ProofSettings,
    progress: Progress = NO_PROGRESS,
    planned_faces: Collection[int] = (),
    material: Material | None = None,
    facets_fork: FacetsFork | None = None,
    bore_demands: Sequence[BoreDemand] = (),
    tabs: Sequence[PlannedTab] = (),
    allowances: Sequence[FaceAllowance] = (),
) -> Verdict:
    """Return the verdict on the programs of all setups, in the order they are cut: each finds the stock that those before it left.

    `tools` are the catalogue's, for what could be reached at all; `machines` those of the programs, one each (without a program: the one
    that the part could be reached on); `planned_faces` the tags that some operation means to finish. Without a material nothing is said
    of power. `facets_fork` are the triangles of all faces, where they are begun already; `bore_demands` the threads and fits of bores.
    Turning comes first, in setups of its own: raises `BadInput` where it comes later or the blank is none of revolution. `tabs` are those
    that the plan leaves, in setups of these programs: what stands of them is measured and told, and counts as left by intention. So does
    what faces keep by their `allowances`; less than that on them is an error.
    """
    turning = in_order(programs)
    turned: TurnedWork | None = None
    if turning:
        whole = facets_of(part, blank.frame, progress=progress.part(0.0, 0.05))
        turned = prove_turned(
            programs[:turning], blank, machines[:turning], material, whole, progress.part(0.05, 0.1)
        )
        programs, machines = programs[turning:], machines[turning:]
    frames = [p.setup.frame for p in programs] or [blank.frame]
    surfaces = [surfaces_of(part, f, progress.part(0.1, 0.15)) for f in frames]
    facets = part_facets(
        programs, part, frames[0], surfaces, machines, progress.part(0.15, 0.2), facets_fork
    )
    return prove_surfaces(
        programs,
        surfaces,
        turned.after if turned is not None else blank,
        tools,
        machines,
        settings,
        progress.part(0.2, 1.0),
        planned_faces,
        material,
        facets,
        part.backing,
        turned,
        bore_demands,
        tabs,
        partial(layers_on, allowances, part=part),
    )


def prove_surfaces(
    programs: Sequence[Program],
    surfaces: Sequence[Surfaces],
    blank: Blank,
    tools: Sequence[Tool],
    machines: Sequence[Machine],
    settings: ProofSettings,
    progress: Progress = NO_PROGRESS,
    planned_faces: Collection[int] = (),
    material: Material | None = None,
    facets: Facets | None = None,
    unasked: Collection[int] = (),
    turned: TurnedWork | None = None,
    bore_demands: Sequence[BoreDemand] = (),
    tabs: Sequence[PlannedTab] = (),
    layers_over: LayersOver | None = None,
) -> Verdict:
    """Return the verdict as `prove` does, on faces given in each setup's frame (without a program: in the blank's).

    `facets` are the same faces as triangles, in the first setup's frame: without them no tool may lean. `unasked` are the tags of faces
    that nobody wants finished: they are in the way of tools, and material. `turned` is the turning before these programs, which has made
    the blank what it is; `tabs` are left by intention, and `layers_over` returns what faces keep over samples. Raises `BadInput` for
    turning among them.
    """
    refuse_turning(section for program in programs for section in program.sections)
    frames = [p.setup.frame for p in programs] or [blank.frame]
    held = [p.setup.fixtures for p in programs] or [()]
    sides = progress.aside(
        lambda own: sides_of(frames, surfaces, facets, held, own),
        "Making the faces ready for questions",
    )
    samples = samples_of(surfaces[0], settings.spacing, progress.part(0.0, 0.05), facets)
    stock = progress.aside(
        lambda _: stock_of(programs, blank, settings),
        "Filling the blank with rays",
    )
    trim_memory()
    proofs = []
    for k, (program, side, machine) in enumerate(zip(programs, sides, machines, strict=False)):
        share = progress.part(
            0.05 + 0.75 * k / len(programs),
            0.05 + 0.75 * (k + 1) / len(programs),
            program.setup.name,
        )
        points = _moved(samples, frames[0], side.frame)
        proofs.append(
            prove_setup(program, side.contact, stock, machine, material, settings, points, share)
        )
    findings: list[Finding] = []
    offers: list[Offer] = []
    for p in proofs:
        noted, offered = progress.aside(
            partial(_findings_and_offers, p, surfaces[0].tag, material, settings),
            "Judging the moves",
        )
        findings, offers = findings + noted, offers + offered
    findings += demand_findings(proofs, bore_demands, settings)
    before = None
    if turned is not None:
        before = turned_faces(turned, samples, frames[0], len(surfaces[0].tag))
        findings += turned_findings(turned, samples, frames[0], surfaces[0].tag, material, settings)
    layers = None
    if layers_over is not None:
        layers = layers_over(
            samples=samples,
            tags=surfaces[0].tag,
            frame=frames[0],
            progress=progress.part(0.8, 0.82),
        )
    setup_frames = {p.setup.name: p.setup.frame for p in programs}
    tabs = [t for t in tabs if t.setup in setup_frames]
    whole = covered(
        samples,
        surfaces[0].tag,
        sides,
        blank,
        proofs,
        tools,
        settings,
        planned_faces,
        progress.part(0.82, 1.0),
        machines if facets is not None else (),
        unasked,
        before,
        turned.before if turned is not None else None,
        on_tabs(samples, frames[0], tabs, setup_frames) if tabs else None,
        layers,
    )
    findings += whole.findings
    if tabs:
        walls = np.unique(surfaces[0].tag[samples.face[whole.on_tabs]])
        findings += tab_findings(measured(tabs, setup_frames, stock), walls)
    operations, blocks = progress.aside(
        lambda _: (
            tuple(
                o
                for p in proofs
                for o in operation_proofs(p, surfaces[0].tag, samples.area, settings)
            ),
            tuple(block_proof(p, samples.area) for p in proofs),
        ),
        "Judging the operations",
    )
    if turned is not None:
        operations = (*turned_operations(turned, settings), *operations)
        blocks = (*turned_blocks(turned), *blocks)
    return Verdict(
        outcome=outcome_of(findings),
        coverage=whole.coverage,
        reachable=whole.reachable,
        gouge=max((o.gouge for o in operations), default=0.0),
        collisions=sum(o.collisions for o in operations),
        rapids_in_stock=sum(o.rapids_in_stock for o in operations),
        machining_time_s=sum(o.time_s for o in operations),
        operations=operations,
        faces=whole.faces,
        findings=tuple(findings),
        deviation=whole.deviation,
        blocks=blocks,
        offers=tuple(offers),
    )


def _findings_and_offers(
    proof: SetupProof,
    tags: Ints,
    material: Material | None,
    settings: ProofSettings,
    progress: Progress,
) -> tuple[list[Finding], list[Offer]]:
    """Return the findings on one setup's moves, and what is offered against too much load."""
    findings = setup_findings(proof, tags, settings)
    progress.check()
    load_notes, offers = load_findings(proof, proof.machine, material, settings)
    progress.check()
    limits = limit_findings(
        proof.program.setup.name,
        proof.program.sections,
        proof.moves,
        proof.axis_positions,
        proof.machine,
    )
    return [*findings, *load_notes, *limits], list(offers)


def outcome_of(findings: Sequence[Finding]) -> Outcome:
    """Return what findings make of a program: an error fails it, a warning or a remark is for a person to look at."""
    severities = {f.severity for f in findings}
    if Severity.ERROR in severities:
        return Outcome.FAILED
    return Outcome.REMARKS if severities & {Severity.WARNING, Severity.REMARK} else Outcome.PASSED


def _moved(samples: Samples, frame: Frame, other: Frame) -> Floats:
    return samples.point if frame is other else other.to_local(frame.to_world(samples.point))
