"""Centrifugal impellers: blades, splitters, hub, bore and turned faces, by axis, symmetry and adjacency (Yu et al., automatic NC
programming of aero-engine centrifugal impellers), made to hold on files with split faces, without fillets and in any position."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from trunnion.findings import Finding
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.model.session import SizeEntry
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import Suitability
from trunnion.recognize.holes.features import hole_feature, pattern_attributes
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.patterns import hole_patterns
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.impeller import unexplained
from trunnion.recognize.impeller.blades import Blade, blades_of
from trunnion.recognize.impeller.body import WheelBody, wheel_body
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.recognize.impeller.features import blade_features, blade_names, turned_features
from trunnion.recognize.impeller.frame import wheel_frame
from trunnion.recognize.impeller.kinds import HOLE, KINDS
from trunnion.recognize.impeller.meridian import HubMeridian
from trunnion.recognize.impeller.rows import BladeRows, rows_of
from trunnion.recognize.impeller.settings import ImpellerSettings
from trunnion.recognize.impeller.sizes import ImpellerSizes
from trunnion.recognize.impeller.suitability import suitability
from trunnion.recognize.impeller.turned import bore_among, turned_faces
from trunnion.recognize.revolution import RevolutionAxis, main_axis, of_revolution

if TYPE_CHECKING:
    from trunnion.part.part import Part


class ImpellerFamily:
    """Open wheels of radial and mixed-flow compressors, pumps and fans."""

    name = "impeller"
    noun = "an impeller"
    kinds = KINDS
    settings = ImpellerSettings
    blank = "finish-turned"

    def suits(self, graph: FaceGraph) -> Suitability:
        """Return the share of the part's area in its blades, the faces of revolution and all that is repeated about the axis."""
        return suitability(graph)

    def recognize(
        self,
        graph: FaceGraph,
        part: object,
        settings: ImpellerSettings,
        progress: Progress = NO_PROGRESS,
    ) -> Recognition:
        """Return the features of a wheel: blades in order, then hub, bore, planes, profile and holes.

        Faces of the passages of a closed wheel, and what is neither blade nor turned nor hole, are unexplained. Raises `Cancelled` when a
        person asked to stop.
        """
        progress.at(0.0, "looking for the axis")
        axis = progress.aside(lambda _: main_axis(graph)) if len(graph) else None
        if axis is None:
            return _found(
                self.name, graph, (), Recognition(family=self.name), (unexplained.no_wheel(),)
            )
        progress.at(0.2, "looking for holes")
        wheel = progress.aside(lambda p: _wheel(graph, axis, settings, p))
        progress.at(0.8, "naming features")
        made = progress.aside(lambda _: _features(graph, wheel))
        frame = wheel_frame(graph, wheel.samples)
        return _found(
            self.name, graph, made[0], Recognition(family=self.name, frame=frame), made[1]
        )

    def analysed(
        self, found: Recognition, graph: FaceGraph, part: Part, progress: Progress
    ) -> tuple[SizeEntry, ...]:
        """Return the sizes of the wheel and of one blade of each row (`sizes`)."""
        progress.doing("measuring channels and blades")
        sizes = ImpellerSizes(found=found, graph=graph, part=part, progress=progress)
        return tuple(sizes.entries())


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Wheel:
    """What the rules found on a wheel: its axis looks to the inlet."""

    samples: CylindricalSamples
    body: WheelBody
    bore: Hole | None
    holes: tuple[Hole, ...]
    blades: tuple[Blade, ...]
    rows: BladeRows | None


def _wheel(
    graph: FaceGraph, axis: RevolutionAxis, settings: ImpellerSettings, progress: Progress
) -> _Wheel:
    """Return the wheel about an axis."""
    samples = CylindricalSamples(graph=graph, axis=axis)
    turned = of_revolution(graph, axis)
    reach = float(samples.meridian[:, 0].max())
    found = find_holes(graph, 2.0 * reach, axis.direction, progress)
    bore, beside = bore_among(graph, samples, found)
    largest = 2.0 * reach * settings.hole_diameter
    holes = tuple(h for h in beside if 2.0 * min(s.narrow for s in h.segments) <= largest)
    apart = frozenset(r for h in (*holes, *([bore] if bore else [])) for r in h.faces)
    body = wheel_body(graph, samples, turned, apart)
    if body.inlet < 0.0:
        axis = RevolutionAxis(point=axis.point, direction=-axis.direction)
        samples = CylindricalSamples(graph=graph, axis=axis)
        body = replace(body, inlet=1.0)
    blades: tuple[Blade, ...] = ()
    rows = None
    if body.hub:
        hub = HubMeridian.of(samples, body.hub, body.inlet)
        blades = blades_of(graph, samples, body, hub)
        if blades:
            rows = rows_of(graph, samples, hub, blades, settings.rotation)
    return _Wheel(samples=samples, body=body, bore=bore, holes=holes, blades=blades, rows=rows)


def _features(graph: FaceGraph, wheel: _Wheel) -> tuple[tuple[Feature, ...], tuple[Finding, ...]]:
    """Return the features of a wheel and what is doubtful about them."""
    rows, findings = wheel.rows, []
    features: list[Feature] = []
    reach = float(wheel.samples.meridian[:, 0].max())
    turned = turned_faces(graph, wheel.samples, wheel.body, reach)
    if rows is None:
        findings.append(unexplained.no_wheel())
    elif wheel.body.is_covered:
        inside = sorted({r for b in wheel.blades for r in b.rows})
        findings.append(unexplained.covered(inside, len(wheel.blades)))
    else:
        features.extend(blade_features(rows))
        findings.extend(unexplained.of_rows(rows, blade_names(rows)))
    features.extend(turned_features(turned, wheel.bore))
    frame = wheel_frame(graph, wheel.samples)
    patterns = pattern_attributes(hole_patterns(graph, list(wheel.holes), frame))
    for n, hole in enumerate(wheel.holes):
        made = hole_feature(hole, f"{HOLE}-{n + 1:02}", frame)
        features.append(replace(made, attributes={**made.attributes, **patterns.get(n, {})}))
    return tuple(features), tuple(findings)


def _found(
    name: str,
    graph: FaceGraph,
    features: tuple[Feature, ...],
    found: Recognition,
    findings: tuple[Finding, ...],
) -> Recognition:
    """Return the recognition with features, and a finding on the faces that none of them holds."""
    held = {tag - 1 for f in features for tag in f.tags}
    remaining = [r for r in np.flatnonzero(graph.area > 0.0).tolist() if r not in held]
    whole = float(graph.area.sum())
    return replace(
        found,
        features=features,
        unexplained=tuple(r + 1 for r in remaining),
        unexplained_share=float(graph.area[remaining].sum()) / whole if whole else 0.0,
        findings=(*findings, *unexplained.rest(graph, remaining)),
    )
