"""Aircraft integral panels: recognition by slicing, confirmed by the face graph (Yu et al., slicing recognition of generalized pockets)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from trunnion.findings import Finding
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature, Recognition
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import Slicer, Smallest, Suitability
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.describe import DESCRIBABLE, described
from trunnion.recognize.panel.details import make_details
from trunnion.recognize.panel.features import (
    FeatureNumbers,
    SideFeatures,
    make_datum,
    make_features,
    make_profile,
)
from trunnion.recognize.panel.frame import choose_frame
from trunnion.recognize.panel.holes import PanelHoles
from trunnion.recognize.panel.kinds import KINDS
from trunnion.recognize.panel.level import level_features
from trunnion.recognize.panel.pockets.rules import GraphFeatures, pockets_of, without
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.recognize.panel.side import PanelSide
from trunnion.recognize.panel.suitability import suitability
from trunnion.recognize.panel.unexplained import rest_findings
from trunnion.recognize.panel.views import upright_views


class PanelFamily:
    """Plates with pockets, ribs and islands, milled from one side or two."""

    name = "panel"
    noun = "a panel"
    kinds = KINDS
    settings = PanelSettings
    describable = DESCRIBABLE
    smallest: tuple[Smallest, ...] = (
        Smallest(
            name="smallest_corner_radius",
            size="corner_radius",
            kinds=("pocket", "open_pocket", "island"),
        ),
        Smallest(
            name="smallest_floor_fillet",
            size="floor_fillet",
            kinds=("pocket", "open_pocket", "island"),
        ),
        Smallest(name="thinnest_rib", size="thickness", kinds=("rib",)),
        Smallest(name="smallest_hole", size="diameter", kinds=("hole",)),
    )

    def suits(self, graph: FaceGraph) -> Suitability:
        """Return the share of the part's area that a panel's faces may have."""
        return suitability(graph)

    def described(
        self, feature: Feature, found: Recognition, graph: FaceGraph, settings: PanelSettings
    ) -> Feature:
        """Return a feature with the roles and sizes of its faces. Raises `BadInput` where these can't be one of its kind."""
        return described(feature, found, graph, settings)

    def recognize(
        self,
        graph: FaceGraph,
        slicer: Slicer,
        settings: PanelSettings,
        progress: Progress = NO_PROGRESS,
    ) -> Recognition:
        """Return the features of a panel. Raises `BadInput` when the part has no plane face, `Cancelled` when asked to stop."""
        progress.at(0.0, "choosing the frame")
        frame = progress.aside(lambda _: choose_frame(graph, settings))
        progress.at(0.05, "looking for holes")
        holes = progress.aside(partial(_holes, graph, frame, settings))
        above, below = upright_views(
            graph, frame, slicer, settings, holes.rows, progress.part(0.1, 0.7)
        )
        shown = []
        for view, share in ((above, 0.7), (below, 0.8)):
            progress.at(share, "growing pockets")
            shown.append(progress.aside(partial(_shown, view)))
        features: list[Feature] = []
        findings: list[Finding] = []
        numbers = FeatureNumbers()
        for view, seen in zip((above, below), shown, strict=True):
            progress.at(0.9, "naming features")
            done = {tag - 1 for f in features for tag in f.with_role("wall", "corner")}
            made = progress.aside(partial(_made, view, without(seen, done), above.graph, numbers))
            features.extend(made.features)
            findings.extend(made.findings)
        edges = _surroundings(above, shown, features).features
        rest = set(_unexplained(above, (*features, *edges))) - holes.rows
        level = level_features(above, graph, frame, slicer, rest, numbers, progress.part(0.9, 0.95))
        features.extend(level.features)
        findings.extend(level.findings)
        features.extend(holes.features(features, numbers))
        around = _surroundings(above, shown, features)
        features.extend(around.features)
        findings.extend(around.findings)
        features += make_details(above, below, features, _unexplained(above, features), numbers)
        remaining = _unexplained(above, features)
        findings.extend(above.slices.findings)
        findings.extend(
            rest_findings(
                above.graph,
                above.classes,
                remaining,
                {f for seen in shown for f in seen.tops.undercut},
            )
        )
        return Recognition(
            family=self.name,
            frame=frame,
            features=tuple(features),
            unexplained=tuple(r + 1 for r in remaining),
            unexplained_share=float(graph.area[list(remaining)].sum() / graph.area.sum()),
            findings=tuple(findings),
        )


def _unexplained(view: PanelSide, features: Sequence[Feature]) -> tuple[int, ...]:
    """Return the rows of the faces that no feature holds."""
    explained = {tag - 1 for f in features for tag in f.tags}
    return tuple(
        r
        for r, k in enumerate(view.classes.kind)
        if r not in explained and k is not FaceClass.ABSENT
    )


def _holes(
    graph: FaceGraph, frame: Frame, settings: PanelSettings, progress: Progress
) -> PanelHoles:
    found = find_holes(graph, settings.hole_diameter, frame.z, progress)
    return PanelHoles(graph=graph, frame=frame, holes=found)


def _shown(view: PanelSide, progress: Progress) -> GraphFeatures:
    return pockets_of(view)


def _made(
    view: PanelSide,
    seen: GraphFeatures,
    graph: FaceGraph,
    numbers: FeatureNumbers,
    progress: Progress,
) -> SideFeatures:
    return make_features(view, seen, graph, numbers)


def _surroundings(
    above: PanelSide, shown: list[GraphFeatures], features: list[Feature]
) -> SideFeatures:
    """Return the outer profile and the datum faces: what no other feature holds. The outline goes on through holes open on a side."""
    taken = {tag - 1 for f in features if not f.attributes.get("open_side") for tag in f.tags}
    profile = make_profile(above, taken, "profile-01")
    top, bottom = ([f for f in seen.tops.highest if f not in taken] for seen in shown)
    datum = make_datum(top, bottom, above.height, "datum-01")
    return SideFeatures(
        features=profile.features if datum is None else (*profile.features, datum),
        findings=profile.findings,
    )
