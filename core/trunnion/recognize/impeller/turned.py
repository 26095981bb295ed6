"""What is turned of a wheel besides its hub: bore, end planes, and the profile of all other faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.facegraph import CONCAVE, SMOOTH, FaceGraph
from trunnion.recognize.grow import grown
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.impeller.body import WheelBody
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.recognize.revolution import RevolutionAxis
from trunnion.tolerance import ANGLE, SLIVER


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurnedFaces:
    """Rows of the hub's faces, of the end planes at each height (the inlet's first), and of all other turned faces."""

    hub: tuple[int, ...]
    planes: tuple[tuple[int, ...], ...]
    profile: tuple[int, ...]


def bore_among(
    graph: FaceGraph, samples: CylindricalSamples, holes: tuple[Hole, ...]
) -> tuple[Hole | None, tuple[Hole, ...]]:
    """Return the bore, and the holes beside the axis. A recess round the axis with anything inside it is no bore."""
    beside = tuple(h for h in holes if not _on(samples.axis, h))
    bore = None
    for hole in holes:
        if _on(samples.axis, hole):
            others = ~np.isin(graph.sample_face, hole.faces)
            inner = float(samples.meridian[others, 0].min(initial=np.inf))
            if min(s.narrow for s in hole.segments) <= inner + SLIVER:
                bore = hole
    return bore, beside


def turned_faces(
    graph: FaceGraph, samples: CylindricalSamples, body: WheelBody, reach: float
) -> TurnedFaces:
    """Return the turned faces of a wheel's body by what they are; blades reach to a radius (mm).

    The hub goes on smoothly over faces inside that radius that look out or to the inlet. A plane is an end where its normal looks out of
    the wheel and nothing rises from it; the floor of a groove is of the profile.
    """
    rest = body.body.copy()
    hub = grown(
        graph,
        body.hub,
        lambda edge, face, other: (
            bool(body.body[other])
            and graph.convexity[edge] == SMOOTH
            and _is_hub(graph, samples, other, reach)
        ),
    )
    rest[list(hub)] = False
    planes: dict[float, list[int]] = {}
    for row in np.flatnonzero(rest).tolist():
        if _is_end(graph, samples, row):
            height = float(samples.meridian[samples.of(row), 1].mean())
            level = next((z for z in planes if abs(z - height) < SLIVER), height)
            planes.setdefault(level, []).append(row)
    ends = {r for rows in planes.values() for r in rows}
    return TurnedFaces(
        hub=tuple(sorted(hub)),
        planes=tuple(tuple(planes[z]) for z in sorted(planes, reverse=True)),
        profile=tuple(r for r in np.flatnonzero(rest).tolist() if r not in ends),
    )


def _on(axis: RevolutionAxis, hole: Hole) -> bool:
    along = abs(float(hole.direction @ axis.direction))
    return bool(along > np.cos(ANGLE) and np.linalg.norm(axis.away(hole.mouth[None])[0]) < SLIVER)


def _is_hub(graph: FaceGraph, samples: CylindricalSamples, row: int, reach: float) -> bool:
    mine = samples.of(row)
    normal = samples.normal[mine]
    return bool(
        graph.surface[row] != "plane"
        and samples.meridian[mine, 0].max() < reach - SLIVER
        and normal[:, 0].min() > 0.0
    )


def _is_end(graph: FaceGraph, samples: CylindricalSamples, row: int) -> bool:
    normal = samples.normal[samples.of(row), 2]
    return bool(
        np.abs(normal).min() > np.cos(ANGLE)
        and not any(graph.convexity[e] == CONCAVE for e in graph.edges_of[row])
    )
