"""Material that faces are to keep, held against what the programs leave on their samples.

What is to remain is the part with a layer over these faces, each as thick as its allowance. The layer ends where another face does, and it
covers the strips of other faces beside it: a sample of a face that keeps less lies under it where the layer's face is no farther than the
layer is thick (left on purpose, neither wanted nor finished), and a sample of the layer's own face may keep less where a face that keeps
less comes nearer than that: cutters that are there have taken the layer's edge off by right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import Finding, error, face_tags, remark
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.faces_of_points import triangle_distances
from trunnion.geometry.frame import Frame
from trunnion.model.allowance import FaceAllowance
from trunnion.part.part import Part
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import trimmed
from trunnion.verify.finish.coverage import Samples
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings

RINGS = 2
"""How many faces away from one that keeps material others are looked at: they may end its layer, or lie under it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptLayers:
    """What faces keep, by rows of the samples: `least`, `most` (s,) mm, 0 on faces that keep nothing; `facets` are these faces and those
    around them, in the frame of the samples."""

    allowances: tuple[FaceAllowance, ...]
    samples: Samples
    tags: Ints
    facets: Facets
    least: Floats
    most: Floats

    @staticmethod
    def of(
        allowances: Sequence[FaceAllowance],
        samples: Samples,
        tags: Ints,
        frame: Frame,
        facets: Facets,
    ) -> KeptLayers:
        """Return the layers over samples in a frame, whose face rows have `tags` (f,)."""
        least, most = np.zeros(len(samples)), np.zeros(len(samples))
        # What all of it keeps stands before what is between two areas.
        for kept in sorted(allowances, key=lambda a: a.own is None):
            rows = np.flatnonzero(tags[samples.face] == kept.face)
            own, between = rows, rows[:0]
            if kept.own is not None and kept.others is not None:
                plan = kept.frame.to_local(frame.to_world(samples.point[rows]))[:, :2]
                inside, beside = kept.own.contains(plan), kept.others.contains(plan)
                own, between = rows[inside], rows[~inside & ~beside]
            least[own] = np.where(most[own] > 0.0, least[own], kept.least)
            most[own] = np.maximum(most[own], kept.most)
            most[between] = np.maximum(most[between], kept.most)
        return KeptLayers(
            allowances=tuple(allowances),
            samples=samples,
            tags=tags,
            facets=facets,
            least=least,
            most=most,
        )

    def under_others(self, residual: Floats, is_open: Bools, slack: float) -> Bools:
        """Return which open samples (s,) lie under the layer of another face, no thicker than it is, within `slack` mm."""
        found = np.zeros(len(residual), bool)
        for kept in self.allowances:
            rows = np.flatnonzero(
                is_open & ~found & (self.most < kept.most) & (residual <= kept.most + slack)
            )
            found[rows[self._is_near(kept.face, rows, kept.most + slack)]] = True
        return found

    def at_edges(self, residual: Floats, slack: float) -> Bools:
        """Return which samples (s,) keep less than they are to, but no less than a face that keeps less is away, within `slack` mm."""
        short = (self.most > 0.0) & (residual < self.least - slack)
        found = np.zeros(len(residual), bool)
        least = {a.face: a.least for a in self.allowances}
        for tag in self.facets.tag[np.unique(self.facets.face)].tolist():
            rows = np.flatnonzero(short & ~found & (self.least > least.get(tag, 0.0)))
            found[rows[self._is_near(tag, rows, residual[rows] + slack)]] = True
        return found

    def _is_near(self, tag: int, rows: Ints, within: Floats | float) -> Bools:
        """Return which samples of some rows are no farther from a face than `within` mm; none of the face's own."""
        found = np.zeros(len(rows), bool)
        corners = self.facets.points[
            self.facets.triangles[self.facets.tag[self.facets.face] == tag]
        ]
        if not len(corners) or not len(rows):
            return found
        points = self.samples.point[rows]
        reach = np.broadcast_to(np.asarray(within, dtype=np.float64), len(rows))
        low, high = corners.min(axis=1), corners.max(axis=1)
        around = np.flatnonzero(
            (points >= low.min(axis=0) - reach[:, None]).all(axis=1)
            & (points <= high.max(axis=0) + reach[:, None]).all(axis=1)
            & (self.tags[self.samples.face[rows]] != tag)
        )
        for n in around.tolist():
            beside = (low <= points[n] + reach[n]).all(axis=1) & (high >= points[n] - reach[n]).all(
                axis=1
            )
            if beside.any():
                distance = triangle_distances(points[n], corners[beside]).min()
                found[n] = distance <= reach[n] + self.facets.bound
        return found


def layers_on(
    allowances: Sequence[FaceAllowance],
    samples: Samples,
    tags: Ints,
    part: Part,
    frame: Frame,
    progress: Progress = NO_PROGRESS,
) -> KeptLayers | None:
    """Return the layers of what faces keep over samples in a frame; None where no face keeps anything."""
    there = [a for a in allowances if a.face in part.tags]
    if not there:
        return None
    near = {a.face for a in there}
    pairs = part.graph().edge_face + 1
    for _ in range(RINGS):
        near |= set(pairs[np.isin(pairs, sorted(near)).any(axis=1)].ravel().tolist())
    facets = facets_of(part, frame, progress=progress, only=near & set(part.tags))
    return KeptLayers.of(there, samples, tags, frame, facets)


def allowance_findings(
    layers: KeptLayers,
    residual: Floats,
    finished: Bools,
    proofs: Sequence[SetupProof],
    settings: ProofSettings,
) -> list[Finding]:
    """Return what is told of each feature that keeps material: how much stays on how much of its area, and an error where less stays than
    is demanded. `finished` (s,) are the samples that keep what they are to."""
    found = []
    samples = layers.samples
    for feature in dict.fromkeys(a.feature for a in layers.allowances):
        own = [a for a in layers.allowances if a.feature == feature]
        faces = [a.face for a in own]
        mine = np.isin(layers.tags[samples.face], faces)
        short = mine & ~finished & (residual < layers.least - settings.tolerance)
        area, as_wanted = (float(samples.area[rows].sum()) for rows in (mine, mine & finished))
        amounts = " and ".join(
            trimmed(a, 3) for a in sorted({a.most for a in own if a.least == a.most})
        )
        if short.any():
            found.append(
                error(
                    "verify.allowance",
                    f"{feature} is to keep {amounts} mm, and keeps only {trimmed(float(residual[short].min()), 3)} mm where it is "
                    f"thinnest; {float(samples.area[short].sum()):.0f} mm2 keep less",
                    feature,
                    *_cut_by(short, residual, proofs),
                    *face_tags(np.unique(layers.tags[samples.face[short]]).tolist()),
                    remedy="see which operation cuts there, or take the allowance away",
                )
            )
        found.append(
            remark(
                "verify.kept",
                f"{feature} keeps {amounts} mm on purpose on {100.0 * as_wanted / max(area, settings.tolerance):.1f} % of its "
                f"{area:.0f} mm2",
                feature,
                *face_tags(faces),
                remedy="finish it by what comes later; it does not count as unfinished",
            )
        )
    return found


def _cut_by(rows: Bools, residual: Floats, proofs: Sequence[SetupProof]) -> tuple[str, ...]:
    """Return the operations that came nearest to samples."""
    names: dict[str, None] = {}
    for p in proofs:
        moves = p.nearest[rows & (p.residual <= residual) & (p.nearest >= 0)]
        for section in np.unique(p.moves.section[moves]).tolist():
            names[p.program.sections[section].operation] = None
    return tuple(names)
