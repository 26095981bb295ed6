"""How much of the part is finished, face by face, and what is reported of the rest."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, Fix, error, face_tags, info, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.model.tool import Tool
from trunnion.model.verdict import Deviation, FaceProof
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.finish.accessibility import Accessibility
from trunnion.verify.finish.coverage import Samples, on_blank
from trunnion.verify.judge.allowances import KeptLayers, allowance_findings
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.judge.sides import Side
from trunnion.verify.judge.turned import TurningResidual
from trunnion.verify.settings import ProofSettings

DECIMALS = 9
"""Decimals of a share of area: sums of thousands of areas differ in their last digits, and no goal is that fine."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoverageResult:
    """Coverage and what goes with it; `on_tabs` (s,) are the samples with what tabs leave on them."""

    coverage: float
    reachable: float
    faces: tuple[FaceProof, ...]
    deviation: Deviation
    findings: tuple[Finding, ...]
    on_tabs: Bools


def covered(
    samples: Samples,
    tags: Ints,
    sides: Sequence[Side],
    blank: Blank,
    proofs: Sequence[SetupProof],
    tools: Sequence[Tool],
    settings: ProofSettings,
    planned: Collection[int],
    progress: Progress = NO_PROGRESS,
    machines: Sequence[Machine] = (),
    unasked: Collection[int] = (),
    turned: TurningResidual | None = None,
    uncut: Blank | None = None,
    on_tab: Bools | None = None,
    layers: KeptLayers | None = None,
) -> CoverageResult:
    """Return what all setups together finish of the part.

    `samples` are in the frame of the first side; `tags` (f,) those of the face rows; `tools` the catalogue's, tried from every side where
    something is not finished, as if nothing held the part. They lean where the side's own of `machines` does, which
    needs facets of all faces; without machines they are upright. Of faces of tags in `unasked`
    nothing has to be finished, and nothing is told. Where turning has come before, `blank` is what it left, `turned` what it has done to
    the part and `uncut` the blank before it. What stands on samples `on_tab` (s,) is left by intention: their area is neither wanted nor
    finished; neither is what lies under the `layers` of faces that keep material. These are finished where they keep what they are to.
    """
    frame = sides[0].frame
    n = len(tags)
    progress.at(0.0, "Adding up what is finished")
    unasked_face = np.isin(tags, sorted(unasked))
    residual, blank_face = progress.aside(
        lambda _: (
            blank.depth(samples.point, frame),
            on_blank(samples, uncut or blank, frame, n) | unasked_face,
        )
    )
    if turned is not None:
        residual = np.minimum(residual, turned.residual)
    for p in proofs:
        residual = np.minimum(residual, p.residual)
    slack = settings.tolerance + settings.allowance
    finished = np.abs(residual) <= slack
    if layers is not None:
        keeps = (layers.least - settings.tolerance <= residual) & (residual <= layers.most + slack)
        at_edge = layers.at_edges(residual, settings.tolerance)
        finished = np.where(layers.most > 0.0, keeps | at_edge, finished)
    finished &= ~blank_face[samples.face]
    is_open = ~finished & ~blank_face[samples.face] & (residual > 0.0)
    on_tabs = np.zeros(len(samples), bool) if on_tab is None else on_tab & is_open
    on_purpose = on_tabs
    if layers is not None:
        on_purpose = on_tabs | layers.under_others(residual, is_open, settings.tolerance)
    open_rows = np.flatnonzero(is_open & ~on_purpose)
    lost = np.zeros(len(samples), bool)
    lost[_unreached(samples, open_rows, sides, tools, settings, progress, machines)] = True
    area, done, away = (
        _by_face(samples, samples.area * share, n) for share in (~on_purpose, finished, lost)
    )
    wanted = float(area[~blank_face].sum())
    reachable_area = wanted - float(away.sum())
    cut_before = turned.gouge if turned is not None else np.zeros(n)
    gouge = np.max([cut_before, *(p.contact.face_depth[:, 0] for p in proofs)], axis=0)
    is_cut = bool(proofs) or turned is not None
    every = progress.aside(
        lambda _: _faces(
            samples, ~on_purpose, tags, residual, area, done, away, gouge, blank_face, set(planned)
        )
    )
    faces = tuple(f for f in every if f.face not in unasked)
    shown = ~unasked_face[samples.face]
    coverage = round(float(done.sum()) / wanted, DECIMALS) if wanted and is_cut else 0.0
    of_reachable = (
        round(float(done.sum()) / reachable_area, DECIMALS)
        if reachable_area > 0.0 and is_cut
        else 0.0
    )
    return CoverageResult(
        coverage=coverage,
        reachable=of_reachable,
        faces=faces,
        findings=(
            *_findings(faces, of_reachable, settings),
            *(
                allowance_findings(layers, residual, finished, proofs, settings)
                if layers is not None and is_cut
                else ()
            ),
        ),
        on_tabs=on_tabs,
        deviation=Deviation(
            face=tags[samples.face[shown]],
            point=frame.to_world(samples.point[shown]),
            deviation=residual[shown],
        ),
    )


def _unreached(
    samples: Samples,
    rows: Ints,
    sides: Sequence[Side],
    tools: Sequence[Tool],
    settings: ProofSettings,
    progress: Progress,
    machines: Sequence[Machine],
) -> Ints:
    """Return the rows of samples that no cutter reaches from any side."""
    home = sides[0].frame
    for k, (side, machine) in enumerate(zip_longest(sides, machines)):
        here = (
            samples
            if side.frame is home
            else Samples(
                face=samples.face,
                area=samples.area,
                point=side.frame.to_local(home.to_world(samples.point)),
                normal=side.frame.local_direction(home.world_direction(samples.normal)),
            )
        )
        share = progress.part(k / len(sides), (k + 1) / len(sides))
        reached = Accessibility(
            side.part, tools, settings.tolerance, machine, settings.threads
        ).reached(here, rows, share)
        rows = rows[~reached]
    return rows


def _by_face(samples: Samples, weight: Floats, n: int) -> Floats:
    return np.bincount(samples.face, weight, n).astype(np.float64)


def _faces(
    samples: Samples,
    counted: Bools,
    tags: Ints,
    residual: Floats,
    area: Floats,
    done: Floats,
    away: Floats,
    gouge: Floats,
    blank_face: Bools,
    planned: set[int],
) -> tuple[FaceProof, ...]:
    n = len(tags)
    least, most = np.full(n, np.inf), np.full(n, -np.inf)
    np.minimum.at(least, samples.face[counted], residual[counted])
    np.maximum.at(most, samples.face[counted], residual[counted])
    mean = _by_face(samples, samples.area * counted * residual, n) / np.maximum(
        area, tolerance.PARAMETRIC
    )
    least, most = np.where(np.isfinite(least), least, 0.0), np.where(np.isfinite(most), most, 0.0)
    return tuple(
        FaceProof(
            face=int(tags[k]),
            area=float(area[k]),
            finished=float(done[k]),
            gouge=float(gouge[k]),
            left_min=float(least[k]),
            left_mean=float(mean[k]),
            left_max=float(most[k]),
            planned=int(tags[k]) in planned,
            reachable=bool(away[k] == 0.0),
            blank_surface=bool(blank_face[k]),
        )
        for k in range(n)
    )


def _findings(
    faces: tuple[FaceProof, ...], of_reachable: float, settings: ProofSettings
) -> tuple[Finding, ...]:
    found = []
    open_faces = [f for f in faces if not f.blank_surface and f.area - f.finished > tolerance.AREA]
    if of_reachable < settings.coverage:
        found.append(
            error(
                "verify.coverage",
                f"{100 * of_reachable:.2f} % of the reachable area is finished, the goal is "
                f"{100 * settings.coverage:.2f} %",
                *face_tags(f.face for f in open_faces),
                remedy="add operations for these faces, or accept the shortfall by name",
                fix=_coverage_fix(faces, settings.coverage - of_reachable),
            )
        )
    elif open_faces:
        found.append(
            info(
                "verify.unfinished",
                f"{len(open_faces)} faces have places outside the tolerance",
                *face_tags(f.face for f in open_faces),
            )
        )
    missed = [f for f in faces if not f.planned and not f.blank_surface]
    if missed:
        unfinished = [f for f in missed if f.area - f.finished > tolerance.AREA]
        make_finding = warning if unfinished else info
        found.append(
            make_finding(
                "verify.unplanned",
                f"no operation planned {len(missed)} faces, {len(unfinished)} of them are not finished",
                *face_tags(f.face for f in missed),
                remedy="add operations for these faces",
            )
        )
    lost = [f for f in faces if not f.reachable]
    if lost:
        found.append(
            info(
                "verify.unreachable",
                f"no cutter of the catalogue reaches all of {len(lost)} faces from this side",
                *face_tags(f.face for f in lost),
            )
        )
    return tuple(found)


def _coverage_fix(faces: Sequence[FaceProof], short: float) -> Fix | None:
    """Return the fix of a coverage that is short by a share: the planned faces with unfinished places, the least finished first.

    None where these, finished whole, would not make up for it: faces that nobody planned need more than another cutter.
    """
    wanted = [f for f in faces if not f.blank_surface]
    planned = [f for f in wanted if f.planned and f.area - f.finished > tolerance.AREA]
    if sum(f.area - f.finished for f in planned) < short * sum(f.area for f in wanted):
        return None
    return Fix(
        kind="add_operation",
        reason="verify.coverage",
        amount=short,
        faces=tuple(f.face for f in sorted(planned, key=lambda f: f.finished - f.area)),
    )
