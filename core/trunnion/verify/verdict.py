"""The verdict on a whole plan: contact, stock and coverage of every setup's program, judged against the limits.

Reads motions, tools, part, blank and machine, never what the planner meant. `failed` on any gouge, collision, rapid in stock, machine limit
or missing coverage; `passed with remarks` when a person should only look.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, Severity, error, face_tags, info, remark, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.model.program import Program, ProgramSection
from trunnion.model.tool import Tool
from trunnion.model.verdict import Deviation, FaceProof, OperationProof, Outcome, Verdict
from trunnion.part.part import Part
from trunnion.part.surfaces import Surfaces, surfaces_of
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact import Contact, PartContact
from trunnion.verify.coverage import Reach, Samples, depth_in_blank, on_blank, samples_of
from trunnion.verify.limits import limit_findings, times_of
from trunnion.verify.motion import Moves, moves_of
from trunnion.verify.settings import ProofSettings
from trunnion.verify.stock import Field, StockRun, blank_box, run_stock
from trunnion.verify.sweep import Sweep

NEAR = 2.0
"""mm: material left beyond this is only known to be more, unless the blank's surface is nearer."""
MOST_FINDINGS = 5
"""Places that one operation's finding list names of each kind; the worst come first."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SetupProof:
    """What was measured in one setup."""

    program: Program
    moves: Moves
    contact: Contact
    stock: StockRun
    times: Floats
    left: Floats


def prove(programs: Sequence[Program], part: Part, blank: Blank, tools: Sequence[Tool], machine: Machine, settings: ProofSettings,
          progress: Progress = QUIET, planned_faces: Collection[int] = ()) -> Verdict:
    """Return the verdict on the programs of all setups.

    `tools` are the catalogue's, for what could be reached at all; `planned_faces` the tags that some operation means to finish.
    """
    frames = [p.setup.frame for p in programs] or [blank.frame]
    surfaces = [surfaces_of(part, f, progress.part(0.0, 0.05)) for f in frames]
    return prove_surfaces(programs, surfaces, blank, tools, machine, settings, progress.part(0.05, 1.0), planned_faces)


def prove_surfaces(programs: Sequence[Program], surfaces: Sequence[Surfaces], blank: Blank, tools: Sequence[Tool], machine: Machine,
                   settings: ProofSettings, progress: Progress = QUIET, planned_faces: Collection[int] = ()) -> Verdict:
    """Return the verdict as `prove` does, on faces given in each setup's frame (without a program: in the blank's)."""
    frame = programs[0].setup.frame if programs else blank.frame
    samples = samples_of(surfaces[0], settings.spacing, progress.part(0.0, 0.05))
    contacts = [PartContact(s) for s in surfaces]
    proofs = []
    for k, program in enumerate(programs):
        share = progress.part(0.05 + 0.75 * k / len(programs), 0.05 + 0.75 * (k + 1) / len(programs))
        proofs.append(_prove_setup(program, contacts[k], blank, machine, settings, _moved(samples, frame, program.setup.frame), share))
    findings = [f for p in proofs for f in _findings(p, surfaces[0], settings)]
    findings += [f for p in programs for f in limit_findings(p.setup.name, p.sections, machine)]
    if len(programs) > 1:
        findings.append(remark("verify.stock-per-setup", "each setup is proven against a full blank: material that an earlier setup has "
                               "removed still counts as standing", remedy="read rapids in stock of later setups with this in mind"))
    covered = _coverage(samples, surfaces[0], contacts[0], blank, frame, proofs, tools, settings, progress.part(0.8, 1.0), planned_faces)
    findings += covered.findings
    operations = tuple(o for p in proofs for o in _operations(p, machine, settings))
    return Verdict(
        outcome=_outcome(findings), coverage=covered.coverage, reachable=covered.reachable,
        gouge=max((o.gouge for o in operations), default=0.0), collisions=sum(o.collisions for o in operations),
        rapids_in_stock=sum(o.rapids_in_stock for o in operations), machining_time_s=sum(o.time_s for o in operations),
        operations=operations, faces=covered.faces, findings=tuple(findings), deviation=covered.deviation)


def _moved(samples: Samples, frame: Frame, other: Frame) -> Floats:
    return samples.point if frame is other else other.to_local(frame.to_world(samples.point))


def _prove_setup(program: Program, contact: PartContact, blank: Blank, machine: Machine, settings: ProofSettings, points: Floats,
                 progress: Progress) -> SetupProof:
    moves = moves_of(program.sections)
    sweep = Sweep.of(moves, NEAR)
    touched = contact.along(moves, progress.part(0.0, 0.4))
    field = Field.of(blank, program.setup.frame, settings.cell)
    stock = run_stock(field, moves, sweep, progress.part(0.4, 0.7))
    low, high = blank_box(blank, program.setup.frame)
    left, _ = sweep.left(points, np.minimum(depth_in_blank(points, low, high), NEAR), progress.part(0.7, 1.0))
    return SetupProof(program=program, moves=moves, contact=touched, stock=stock, times=times_of(moves, machine), left=left)


def _operations(proof: SetupProof, machine: Machine, settings: ProofSettings) -> list[OperationProof]:
    found = []
    for k, section in enumerate(proof.program.sections):
        rows = proof.moves.section == k
        collides = _collides(proof, settings) & rows
        rapids = rows & (proof.stock.rapid_depth > 0.0)
        gouge = float(proof.contact.depth[rows, 0].max(initial=0.0))
        feeds = rows & ~proof.moves.rapid
        run = float(proof.moves.length[feeds].sum())
        air = float(proof.moves.length[feeds & (proof.stock.removed <= 0.0)].sum())
        failed = gouge > settings.tolerance or collides.any() or rapids.any()
        new_tool = k == 0 or proof.program.sections[k - 1].tool.number != section.tool.number
        found.append(OperationProof(
            operation=section.operation, setup=proof.program.setup.name, outcome=Outcome.FAILED if failed else Outcome.PASSED, gouge=gouge,
            collisions=int(collides.sum()), rapids_in_stock=int(rapids.sum()),
            time_s=float(proof.times[rows].sum()) + machine.tool_change_s * new_tool, removed=float(proof.stock.removed[rows].sum()),
            air_share=air / run if run > 0.0 else 0.0))
    return found


def _collides(proof: SetupProof, settings: ProofSettings) -> Bools:
    return (proof.contact.depth[:, 1] > settings.tolerance) | (proof.stock.body_depth > settings.tolerance)


def _findings(proof: SetupProof, surfaces: Surfaces, settings: ProofSettings) -> list[Finding]:
    found = []
    for k, section in enumerate(proof.program.sections):
        rows = np.flatnonzero(proof.moves.section == k)
        found += _gouges(proof, section, rows, surfaces, settings)
        found += _collisions(proof, section, rows, surfaces, settings)
        found += _rapids(proof, section, rows)
    return found


def _gouges(proof: SetupProof, section: ProgramSection, rows: Ints, surfaces: Surfaces, settings: ProofSettings) -> list[Finding]:
    depth = proof.contact.depth[rows, 0]
    found = []
    faces = proof.contact.face[rows, 0]
    for face in _worst(faces, depth, settings.tolerance):
        row = rows[np.argmax(np.where(faces == face, depth, -1.0))]
        found.append(error("verify.gouge", f"{section.operation} cuts {proof.contact.depth[row, 0]:.3f} mm into face "
                           f"{surfaces.tag[face]} at {_place(proof.contact.place[row, 0])}", section.operation, _block(proof, section, row),
                           f"face {surfaces.tag[face]}", remedy="keep the cutter off this face, or choose a cutter that fits"))
    return found


def _worst(faces: Ints, depth: Floats, limit: float) -> list[int]:
    """Return the faces entered deeper than a limit, the deepest first, at most a few."""
    bad = depth > limit
    worst = {int(f): float(depth[bad & (faces == f)].max()) for f in np.unique(faces[bad])}
    return sorted(worst, key=lambda f: (-worst[f], f))[:MOST_FINDINGS]


def _collisions(proof: SetupProof, section: ProgramSection, rows: Ints, surfaces: Surfaces, settings: ProofSettings) -> list[Finding]:
    found = []
    depth, faces = proof.contact.depth[rows, 1], proof.contact.face[rows, 1]
    for face in _worst(faces, depth, settings.tolerance):
        row = rows[np.argmax(np.where(faces == face, depth, -1.0))]
        found.append(error("verify.collision", f"shank or holder of {section.tool.name} enters face {surfaces.tag[face]} by "
                           f"{proof.contact.depth[row, 1]:.3f} mm at {_place(proof.contact.place[row, 1])}", section.operation,
                           _block(proof, section, row), f"face {surfaces.tag[face]}", remedy="choose a longer or slimmer tool"))
    body = proof.stock.body_depth[rows]
    if body.max(initial=0.0) > settings.tolerance:
        row = rows[np.argmax(body)]
        found.append(error("verify.collision-stock", f"shank or holder of {section.tool.name} enters standing stock by {body.max():.3f} mm "
                           f"near {_place(_end(proof.moves, row))}", section.operation, _block(proof, section, row),
                           remedy="clear the stock around first, or choose a longer tool"))
    return found


def _rapids(proof: SetupProof, section: ProgramSection, rows: Ints) -> list[Finding]:
    depth = proof.stock.rapid_depth[rows]
    worst = rows[np.argsort(-depth, kind="stable")[:MOST_FINDINGS]]
    return [error("verify.rapid-in-stock", f"a rapid of {section.operation} goes {proof.stock.rapid_depth[row]:.3f} mm into stock at "
                  f"{_place(proof.stock.rapid_place[row])}", section.operation, _block(proof, section, row),
                  remedy="lift the rapid, or make it a feed move") for row in worst if proof.stock.rapid_depth[row] > 0.0]


def _block(proof: SetupProof, section: ProgramSection, row: int) -> str:
    block = int(proof.moves.block[row])
    return f"line {section.block_lines[block]}" if block < len(section.block_lines) else f"block {block}"


def _place(point: Floats) -> str:
    return "x {:.2f} y {:.2f} z {:.2f}".format(*(float(v) + 0.0 for v in point))


def _end(moves: Moves, row: int) -> Floats:
    return moves.row[row, [3, 4, 14]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Covered:
    """Coverage and what goes with it."""

    coverage: float
    reachable: float
    faces: tuple[FaceProof, ...]
    deviation: Deviation
    findings: tuple[Finding, ...]


def _coverage(samples: Samples, surfaces: Surfaces, contact: PartContact, blank: Blank, frame: Frame, proofs: Sequence[SetupProof],
              tools: Sequence[Tool], settings: ProofSettings, progress: Progress, planned_faces: Collection[int]) -> Covered:
    low, high = blank_box(blank, frame)
    left = depth_in_blank(samples.point, low, high)
    for p in proofs:
        left = np.minimum(left, p.left)
    n = len(surfaces.tag)
    blank_face = on_blank(samples, low, high, n)
    finished = (np.abs(left) <= settings.tolerance + settings.allowance) & ~blank_face[samples.face]
    open_rows = np.flatnonzero(~finished & ~blank_face[samples.face] & (left > 0.0))
    reached = Reach(contact, tools, settings.tolerance).reached(samples, open_rows, progress)
    lost = np.zeros(len(samples), bool)
    lost[open_rows[~reached]] = True
    area, done, away = (_by_face(samples, samples.area * share, n) for share in (1.0, finished, lost))
    wanted = float(area[~blank_face].sum())
    reachable_area = wanted - float(away.sum())
    gouge = np.max([np.zeros(n), *(p.contact.face_depth[:, 0] for p in proofs)], axis=0)
    planned = set(planned_faces)
    faces = _faces(samples, surfaces, left, area, done, away, gouge, blank_face, planned)
    # Sums of thousands of areas differ in their last digits: nine decimals are far finer than any goal.
    coverage = round(float(done.sum()) / wanted, 9) if wanted and proofs else 0.0
    of_reachable = round(float(done.sum()) / reachable_area, 9) if reachable_area > 0.0 and proofs else 0.0
    return Covered(coverage=coverage, reachable=of_reachable, faces=faces, findings=_coverage_findings(faces, of_reachable, settings),
                   deviation=Deviation(face=surfaces.tag[samples.face], point=frame.to_world(samples.point), deviation=left))


def _by_face(samples: Samples, weight: Floats, n: int) -> Floats:
    return np.bincount(samples.face, weight, n).astype(np.float64)


def _faces(samples: Samples, surfaces: Surfaces, left: Floats, area: Floats, done: Floats, away: Floats, gouge: Floats,
           blank_face: Bools, planned: set[int]) -> tuple[FaceProof, ...]:
    n = len(surfaces.tag)
    least, most = np.full(n, np.inf), np.full(n, -np.inf)
    np.minimum.at(least, samples.face, left)
    np.maximum.at(most, samples.face, left)
    mean = _by_face(samples, samples.area * left, n) / np.maximum(area, tolerance.PARAMETRIC)
    least, most = np.where(np.isfinite(least), least, 0.0), np.where(np.isfinite(most), most, 0.0)
    return tuple(FaceProof(face=int(surfaces.tag[k]), area=float(area[k]), finished=float(done[k]), gouge=float(gouge[k]),
                           left_min=float(least[k]), left_mean=float(mean[k]), left_max=float(most[k]),
                           planned=int(surfaces.tag[k]) in planned, reachable=bool(away[k] == 0.0), blank_surface=bool(blank_face[k]))
                 for k in range(n))


def _coverage_findings(faces: tuple[FaceProof, ...], of_reachable: float, settings: ProofSettings) -> tuple[Finding, ...]:
    found = []
    open_faces = [f for f in faces if not f.blank_surface and f.area - f.finished > tolerance.AREA]
    if of_reachable < settings.coverage:
        found.append(error("verify.coverage", f"{100 * of_reachable:.2f} % of the reachable area is finished, the goal is "
                           f"{100 * settings.coverage:.2f} %", *face_tags(f.face for f in open_faces),
                           remedy="add operations for these faces, or accept the shortfall by name"))
    elif open_faces:
        found.append(info("verify.unfinished", f"{len(open_faces)} faces have places outside the tolerance",
                          *face_tags(f.face for f in open_faces)))
    missed = [f for f in faces if not f.planned and not f.blank_surface]
    if missed:
        unfinished = [f for f in missed if f.area - f.finished > tolerance.AREA]
        say = warning if unfinished else info
        found.append(say("verify.unplanned", f"no operation planned {len(missed)} faces, {len(unfinished)} of them are not finished",
                         *face_tags((f.face for f in missed), most=len(missed)), remedy="add operations for these faces"))
    lost = [f for f in faces if not f.reachable]
    if lost:
        found.append(info("verify.unreachable", f"no cutter of the catalogue reaches all of {len(lost)} faces from this side",
                          *face_tags((f.face for f in lost), most=len(lost))))
    return tuple(found)


def _outcome(findings: Sequence[Finding]) -> Outcome:
    severities = {f.severity for f in findings}
    if Severity.ERROR in severities:
        return Outcome.FAILED
    return Outcome.REMARKS if severities & {Severity.WARNING, Severity.REMARK} else Outcome.PASSED
