"""Aero-engine casings: bosses, holes, profiles and pockets about one axis ("Feature-based automatic NC programming for aero-engine
casings", 3; the attributed adjacency graph with blends suppressed)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Recognition
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.casing.bosses import BossFaces, find_bosses
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.features import made_features
from trunnion.recognize.casing.foot import foot_middle
from trunnion.recognize.casing.frame import casing_frame, turned_about, turned_faces
from trunnion.recognize.casing.holes import casing_holes
from trunnion.recognize.casing.kinds import KINDS
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import boss_outline
from trunnion.recognize.casing.settings import BOSS, CasingSettings
from trunnion.recognize.casing.suitability import suitability
from trunnion.recognize.casing.unexplained import rest_findings
from trunnion.recognize.contract import Bounded, Suitability
from trunnion.recognize.holes.hole import Hole


class CasingFamily:
    """Engine casings and other shells of revolution, turned first and milled between their bosses."""

    name = "casing"
    noun = "a casing"
    kinds = KINDS
    settings = CasingSettings
    blank = "ring-turned"

    def suits(self, graph: FaceGraph) -> Suitability:
        """Return the share of the part's area in faces of revolution about its main axis and in what stands on them."""
        return suitability(graph)

    def recognize(
        self,
        graph: FaceGraph,
        part: Bounded,
        settings: CasingSettings,
        progress: Progress = NO_PROGRESS,
    ) -> Recognition:
        """Return the features of a casing. Raises `BadInput` for a part without an axis, `Cancelled` when asked to stop."""
        progress.at(0.0, "looking for the main axis")
        frame = progress.aside(lambda _: casing_frame(graph))
        progress.at(0.2, "looking for holes")
        holes = progress.aside(partial(casing_holes, graph, frame, settings))
        progress.at(0.6, "growing bosses")
        faces = progress.aside(lambda _: _in_frame(graph, frame, holes))
        bosses = progress.aside(lambda _: find_bosses(faces))
        if settings.x == BOSS and bosses:
            frame = turned_about(frame, _outstanding(faces, bosses))
            faces = _in_frame(graph, frame, holes)
        progress.at(0.8, "naming features")
        made = progress.aside(lambda _: made_features(faces, bosses, holes, frame, graph))
        held = {tag - 1 for feature in made for tag in feature.tags}
        left = tuple(r for r in faces.present if r not in held)
        return Recognition(
            family=self.name,
            frame=frame,
            features=made,
            unexplained=tuple(r + 1 for r in left),
            unexplained_share=float(graph.area[list(left)].sum() / graph.area.sum()),
            findings=rest_findings(faces, left),
        )


def _in_frame(graph: FaceGraph, frame: Frame, holes: Sequence[Hole]) -> CasingFaces:
    return CasingFaces(
        graph=graph.in_frame(frame),
        turned=turned_faces(graph, frame),
        holes=frozenset(f for h in holes for f in h.faces),
    )


def _outstanding(faces: CasingFaces, bosses: Sequence[BossFaces]) -> Floats:
    """Return where the boss with its top farthest from the axis stands (3,), in the casing's frame; of equal ones the largest."""
    area = faces.graph.area

    def rank(boss: BossFaces) -> tuple[float, float]:
        away = float(np.linalg.norm(boss_outline(faces, boss).frame.origin[:2]))
        return round(away, 2), float(area[list(boss.top)].sum())

    best = max(bosses, key=rank)
    return foot_middle(boss_outline(faces, best), Meridian.of(faces, best.ground))
