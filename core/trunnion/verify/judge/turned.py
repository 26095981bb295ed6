"""What the turning setups of a plan come to: their findings, the stock that they hand on, and what they finish of the part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.findings import BadInput, Finding, error, remark
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.geometry.meridian_outline import meridian_outline
from trunnion.model.blank import Blank, Revolved
from trunnion.model.material import Machine, Material, WorkSpindle
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.verdict import BlockProof, OperationProof, Outcome
from trunnion.part.shape.facets import Facets
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE
from trunnion.verify.finish.coverage import Samples
from trunnion.verify.judge.load import NEWTON_METRES
from trunnion.verify.settings import ProofSettings
from trunnion.verify.turning.moves import MeridianFrame
from trunnion.verify.turning.proof import TurningProof, prove_turning

MOST_FINDINGS = 3
"""Findings of each kind for an operation, the worst first."""
SIMPLE = 1e-4
"""mm: points of the stock's meridian that lie off the line between their neighbours by less are left out."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurnedWork:
    """The turning of a plan: its proofs setup by setup, the blank before it and what is left of it after."""

    proofs: tuple[TurningProof, ...]
    before: Blank
    after: Revolved


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurningResidual:
    """What turning has finished: residual (s,) mm on the samples, below 0 where it has cut into the part, infinite where only the stock
    knows; gouge (f,) mm on the faces."""

    residual: Floats
    gouge: Floats


def prove_turned(
    programs: Sequence[Program],
    blank: Blank,
    machines: Sequence[Machine],
    material: Material | None,
    facets: Facets,
    progress: Progress = NO_PROGRESS,
) -> TurnedWork:
    """Return what turning programs come to; `facets` are all of the part's faces in the blank's frame.

    Raises `BadInput` for a blank that is none of revolution, and where a setup turns about another axis.
    """
    if not isinstance(blank, Revolved) or blank.axis != "z":
        raise BadInput("only a blank of revolution is turned: choose blank.kind = turned")
    try:
        part = shapely.Polygon(meridian_outline(facets.points, facets.triangles, facets.face))
    except ValueError as reason:
        raise BadInput(f"the part can't be held against turning: {reason}") from None
    stock: BaseGeometry = shapely.Polygon(blank.outline)
    proofs = []
    for k, (program, machine) in enumerate(zip(programs, machines, strict=False)):
        plane = MeridianFrame.of(program.setup.frame, blank.frame, program.setup.name)
        share = progress.part(k / len(programs), (k + 1) / len(programs), program.setup.name)
        made = prove_turning(program, plane, part, stock, machine, material, share)
        proofs.append(made)
        pieces = _polygons(made.left)
        if not pieces:
            raise BadInput(f"setup {program.setup.name} turns all of the stock away")
        stock = max(pieces, key=lambda p: p.area)
    return TurnedWork(proofs=tuple(proofs), before=blank, after=_with_outline(blank, stock))


def _polygons(shape: BaseGeometry) -> list[shapely.Polygon]:
    return [
        p
        for p in shapely.get_parts(shape)
        if isinstance(p, shapely.Polygon) and p.area > tolerance.AREA
    ]


def _with_outline(blank: Revolved, meridian: BaseGeometry) -> Revolved:
    simple = shapely.orient_polygons(shapely.simplify(meridian, SIMPLE))
    outline = shapely.get_coordinates(shapely.get_exterior_ring(simple))[:-1]
    return Revolved(
        frame=blank.frame,
        outline=np.maximum(outline, [0.0, -np.inf]),
        material=blank.material,
        density=blank.density,
    )


def turned_faces(work: TurnedWork, samples: Samples, frame: Frame, n_faces: int) -> TurningResidual:
    """Return what turning does to samples given in a frame, and to the faces that they are of."""
    radius, height = _meridian(samples, frame, work.before.frame).T
    residual, gouge = np.full(len(samples), np.inf), np.zeros(n_faces)
    for proof in work.proofs:
        cut = proof.cut
        shapely.prepare(cut)
        rows = np.flatnonzero(shapely.contains_xy(cut, radius, height))
        if len(rows):
            points = shapely.points(np.column_stack([radius[rows], height[rows]]))
            deep = shapely.distance(shapely.boundary(cut), points)
            residual[rows] = np.minimum(residual[rows], -deep)
            np.maximum.at(gouge, samples.face[rows], deep)
    return TurningResidual(residual=residual, gouge=gouge)


def _meridian(samples: Samples, frame: Frame, work: Frame) -> Floats:
    own = work.to_local(frame.to_world(samples.point))
    return np.column_stack([np.hypot(own[:, 0], own[:, 1]), own[:, 2]])


def turned_findings(
    work: TurnedWork,
    samples: Samples,
    frame: Frame,
    tags: Ints,
    material: Material | None,
    settings: ProofSettings,
) -> list[Finding]:
    """Return what is to be told of the turning setups; `samples` in a frame tell which face is entered."""
    found: list[Finding] = []
    nearest = cKDTree(_meridian(samples, frame, work.before.frame)) if len(samples) else None

    def face_at(point: Floats) -> int:
        return int(tags[samples.face[int(nearest.query(point)[1])]]) if nearest is not None else 0

    for proof in work.proofs:
        for k, section in enumerate(proof.program.sections):
            rows = proof.rows_of(k)
            for row in _worst(proof.gouge, rows, settings.tolerance):
                face = face_at(proof.gouge_at[row])
                found.append(
                    _entered(
                        proof,
                        section,
                        row,
                        "verify.gouge",
                        f"cuts {proof.gouge[row]:.3f} mm into face {face}",
                        proof.gouge_at[row],
                        face,
                        "keep the insert off this face, or choose one that fits",
                    )
                )
            for row in _worst(proof.collision, rows, settings.tolerance):
                into = face_at(proof.collision_at[row])
                what = "standing stock" if proof.in_stock[row] else f"face {into}"
                code = "verify.collision-stock" if proof.in_stock[row] else "verify.collision"
                found.append(
                    _entered(
                        proof,
                        section,
                        row,
                        code,
                        f"moves the holder of {section.tool.name} {proof.collision[row]:.3f} mm into {what}",
                        proof.collision_at[row],
                        into,
                        "clear the stock around first, or choose another tool",
                    )
                )
            for row in _worst(proof.rapid_depth, rows, 0.0):
                found.append(
                    _entered(
                        proof,
                        section,
                        row,
                        "verify.rapid-in-stock",
                        f"goes {proof.rapid_depth[row]:.3f} mm into stock in a rapid",
                        proof.moves.end[row],
                        0,
                        "lift the rapid, or make it a feed move",
                    )
                )
            found += _loads(proof, section, rows, material, settings)
            found += _limits(proof, section)
            found += _air(proof, section, rows, settings)
        found += _travel(proof)
        for piece in _polygons(proof.left)[1:]:
            found.append(
                error(
                    "verify.comes-loose",
                    f"setup {proof.program.setup.name} turns a ring of {piece.area:.1f} mm2 loose: it falls into the tool's way",
                    proof.program.setup.name,
                    remedy="turn it off in chips",
                )
            )
    return found


def _entered(
    proof: TurningProof,
    section: ProgramSection,
    row: int,
    code: str,
    what: str,
    at: Floats,
    face: int,
    remedy: str,
) -> Finding:
    x, z = float(at[0]), proof.plane.up * (float(at[1]) - proof.plane.zero)
    where = [section.operation, block_text(proof, section, row)] + (
        [f"face {face}"] if face else []
    )
    return error(
        code, f"{section.operation} {what} at radius {x:.2f} z {z:.2f}", *where, remedy=remedy
    )


def block_text(proof: TurningProof, section: ProgramSection, row: int) -> str:
    """Return where a move stands in its program: the line of the text when it was read back, else the block of its operation."""
    block = int(proof.moves.block[row])
    lines = section.block_lines
    return f"line {lines[block]}" if block < len(lines) else f"block {block}"


def _worst(depth: Floats, rows: Ints, limit: float) -> list[int]:
    bad = rows[depth[rows] > limit]
    return [int(r) for r in bad[np.argsort(-depth[bad], kind="stable")[:MOST_FINDINGS]]]


def _loads(
    proof: TurningProof,
    section: ProgramSection,
    rows: Ints,
    material: Material | None,
    settings: ProofSettings,
) -> list[Finding]:
    """Return errors where a section asks more power than the table gives, or cuts far deeper than its data say."""
    found = []
    cuts = rows[proof.removed[rows] > 0.0]
    table = proof.machine.work_spindle
    if table is not None and material is not None and len(cuts):
        limit = settings.power * np.array(
            [table.power_at(float(n)) for n in proof.moves.turns[cuts]]
        )
        worst = int(np.argmax(proof.power[cuts] / np.maximum(limit, tolerance.PARAMETRIC)))
        row = int(cuts[worst])
        if proof.power[row] > limit[worst] * (1.0 + tolerance.PARAMETRIC):
            found.append(
                error(
                    "verify.power",
                    f"{section.operation} asks {proof.power[row]:.1f} kW of the table at {proof.moves.turns[row]:.0f} 1/min, "
                    f"{proof.machine.title} gives {limit[worst]:.1f} kW",
                    section.operation,
                    block_text(proof, section, row),
                    remedy="take a smaller depth of cut or a lower feed",
                )
            )
    if section.depth > 0.0 and len(cuts):
        row = int(cuts[np.argmax(proof.depth[cuts])])
        if proof.depth[row] > settings.removal * section.depth:
            found.append(
                error(
                    "verify.engagement",
                    f"{section.operation} cuts {proof.depth[row]:.2f} mm deep where {section.depth:.2f} mm are chosen",
                    section.operation,
                    block_text(proof, section, row),
                    remedy="rough what stands there first, or take smaller layers",
                )
            )
    return found


def _limits(proof: TurningProof, section: ProgramSection) -> list[Finding]:
    """Return errors where a section exceeds the machine's feeds or its table's speeds."""
    found, machine = [], proof.machine
    table: WorkSpindle | None = machine.work_spindle
    if table is None:
        return [
            error(
                "verify.no-work-spindle",
                f"{section.operation} turns the work, {machine.title} has no table that does",
                section.operation,
                remedy="choose a machine that turns (casing.lathe)",
            )
        ]
    fastest = float(section.path.feed.max(initial=0.0))
    if fastest > machine.feed_max * (1 + tolerance.COINCIDENT):
        found.append(
            error(
                "verify.feed",
                f"{section.operation} feeds at {fastest:.0f} mm/min, {machine.title} allows {machine.feed_max:.0f}",
                section.operation,
                remedy="lower the feed",
            )
        )
    turns = section.turns()
    low, high = float(turns.min(initial=math.inf)), float(turns.max(initial=0.0))
    if high > table.high * (1 + tolerance.COINCIDENT) or low < table.low:
        found.append(
            error(
                "verify.spindle",
                f"{section.operation} turns the table at {low:.0f} to {high:.0f} 1/min, {machine.title} has "
                f"{table.low:.0f} to {table.high:.0f}",
                section.operation,
                remedy="change the cutting speed",
            )
        )
    return found


def _air(
    proof: TurningProof, section: ProgramSection, rows: Ints, settings: ProofSettings
) -> list[Finding]:
    share = _air_share(proof, rows)
    if share <= settings.air:
        return []
    return [
        remark(
            "verify.air",
            f"{section.operation} cuts nothing on {100.0 * share:.0f} % of its feed moves' way",
            section.operation,
            remedy="trim the operation to where stock stands, or suppress it",
        )
    ]


def _air_share(proof: TurningProof, rows: Ints) -> float:
    feeds = rows[~proof.moves.rapid[rows]]
    whole = float(proof.moves.length[feeds].sum())
    return (
        1.0 - float(proof.moves.length[feeds[proof.removed[feeds] > 0.0]].sum()) / whole
        if whole > 0.0
        else 1.0
    )


def _travel(proof: TurningProof) -> list[Finding]:
    """Return an error for an axis that has less travel than the setup needs, or a part that is too large to turn."""
    if not len(proof.moves):
        return []
    found, machine, setup = [], proof.machine, proof.program.setup.name
    points = np.vstack([proof.moves.start, proof.moves.end])
    for k, name in enumerate(("X", "Z")):
        axis, needed = machine.axis(name), float(np.ptp(points[:, k]))
        if needed > axis.high - axis.low:
            found.append(
                error(
                    "verify.travel",
                    f"setup {setup} needs {needed:.0f} mm of {name}, {machine.title} has {axis.high - axis.low:.0f} mm",
                    setup,
                    remedy="choose a larger machine",
                )
            )
    return found


def turned_operations(work: TurnedWork, settings: ProofSettings) -> list[OperationProof]:
    """Return the measurements of every turning operation, in order."""
    found = []
    for proof in work.proofs:
        sections, table = proof.program.sections, proof.machine.work_spindle
        for k, section in enumerate(sections):
            rows = proof.rows_of(k)
            collides, rapids = (
                proof.collision[rows] > settings.tolerance,
                proof.rapid_depth[rows] > 0.0,
            )
            gouge = float(proof.gouge[rows].max(initial=0.0))
            new_tool = k == 0 or sections[k - 1].tool.number != section.tool.number
            removed = float(proof.removed[rows].sum())
            cuts = rows[proof.removed[rows] > 0.0]
            cutting = float(proof.seconds[cuts].sum())
            slowest = float(proof.moves.turns[cuts].min(initial=math.inf))
            power = float(proof.power[rows].max(initial=0.0))
            failed = gouge > settings.tolerance or collides.any() or rapids.any()
            found.append(
                OperationProof(
                    operation=section.operation,
                    setup=proof.program.setup.name,
                    outcome=Outcome.FAILED if failed else Outcome.PASSED,
                    gouge=gouge,
                    collisions=int(collides.sum()),
                    rapids_in_stock=int(rapids.sum()),
                    time_s=float(proof.seconds[rows].sum())
                    + section.dwell
                    + proof.machine.tool_change_s * new_tool,
                    removed=removed,
                    air_share=_air_share(proof, rows),
                    depth=float(proof.depth[rows].max(initial=0.0)),
                    rate=float(proof.rate[rows].max(initial=0.0)),
                    rate_mean=removed / MM_PER_METRE * SECONDS_PER_MINUTE / cutting
                    if cutting > 0.0
                    else 0.0,
                    power=power,
                    power_limit=table.power_at(slowest) if table is not None and len(cuts) else 0.0,
                    torque=NEWTON_METRES * power / slowest if len(cuts) else 0.0,
                    chip=float(proof.chip[rows].max(initial=0.0)),
                    cutting_s=cutting,
                    air_s=float(
                        proof.seconds[
                            rows[~proof.moves.rapid[rows] & (proof.removed[rows] <= 0.0)]
                        ].sum()
                    ),
                    rapid_s=float(proof.seconds[rows[proof.moves.rapid[rows]]].sum()),
                )
            )
    return found


def turned_blocks(work: TurnedWork) -> list[BlockProof]:
    """Return what was measured block by block in the turning setups."""

    def small(values: Floats) -> np.ndarray:
        return values.astype(np.float32)

    return [
        BlockProof(
            setup=p.program.setup.name,
            section=p.moves.section.astype(np.int32),
            time=small(p.seconds),
            gouge=small(p.gouge),
            collision=small(p.collision),
            removed=small(p.removed),
            engaged=small(np.zeros(len(p.moves))),
            depth=small(p.depth),
            rate=small(p.rate),
            power=small(p.power),
            left_min=small(np.full(len(p.moves), np.nan)),
            left_mean=small(np.full(len(p.moves), np.nan)),
            left_max=small(np.full(len(p.moves), np.nan)),
        )
        for p in work.proofs
    ]
