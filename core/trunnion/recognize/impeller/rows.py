"""Blades in their order round the wheel: rows of main blades and splitters, the way the wheel turns, and one neighbouring pair."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.impeller.blades import Blade
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.recognize.impeller.meridian import HubMeridian
from trunnion.recognize.impeller.settings import ANTICLOCKWISE, AUTOMATIC
from trunnion.units import degrees, radians

SAME_START = 0.04
"""Share of the hub's meridian by which the starts of blades of one row may differ; splitters begin a quarter of it later."""
SAME_AREA = 0.02
"""Share by which the areas of blades of one row may differ."""
EVEN = 0.02
"""Share of the pitch by which a blade may stand beside its place: two copies of a file agree to a thousandth."""
OUTER = 0.3
"""Share of a blade's radial extent, at its outlet, in which its sweep is measured."""
SWEPT = radians(3.0)
"""A blade that leaves the radial direction by less is straight there, in radians."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BladeRows:
    """Blades by their order round the axis (right-handed), `angle` (k,) radians where each stands at the outlet, the `row` (k,) of each
    (0 the main blades, then splitters by their start), `area` (k,) mm2, and `turns`: 1 for a wheel that turns right-handed about the axis
    direction to its inlet, -1 against it, 0 where the blades don't tell. `pair` are the numbers of two nearest neighbours."""

    blades: tuple[Blade, ...]
    angle: Floats
    row: Ints
    area: Floats
    turns: float
    pair: tuple[int, ...]

    @property
    def main(self) -> Ints:
        """The numbers of the main blades, in order."""
        return np.flatnonzero(self.row == 0)

    def uneven(self) -> tuple[int, ...]:
        """Return the numbers of blades that are not where the symmetry of the wheel wants them: each row divides the turn evenly, has as
        many in every channel, and its blades are equal."""
        found: set[int] = set()
        for row in range(int(self.row.max(initial=-1)) + 1):
            mine = np.flatnonzero(self.row == row)
            each = max(1, round(len(mine) / max(1, len(self.main))))
            pitch = 2.0 * np.pi / max(1, len(self.main))
            for first in range(each):
                some = mine[first::each]
                off = (self.angle[some] - np.arange(len(some)) * pitch) % (2.0 * np.pi)
                off = (off - off[0] + np.pi) % (2.0 * np.pi) - np.pi
                off -= np.median(off)
                found.update(some[np.abs(off) > EVEN * pitch].tolist())
            area = self.area[mine]
            found.update(
                mine[np.abs(area - np.median(area)) > SAME_AREA * np.median(area)].tolist()
            )
        return tuple(sorted(found))

    def channel(self, number: int) -> tuple[int, int]:
        """Return the numbers of the main blades before and after a blade."""
        main = self.main
        at = int(np.searchsorted(main, number))
        return int(main[at - 1]), int(main[at % len(main)])


def rows_of(
    graph: FaceGraph,
    samples: CylindricalSamples,
    hub: HubMeridian,
    blades: tuple[Blade, ...],
    rotation: str,
) -> BladeRows:
    """Return the blades in order; the axis of the samples looks to the inlet."""
    angle = np.array([_outlet_angle(graph, samples, b) for b in blades])
    start = np.array([_start(graph, samples, hub, b) for b in blades])
    row = _rows(start, SAME_START * max(float(hub.along[-1]), 1e-9))
    main = np.flatnonzero(row == 0)
    first = angle[main[np.argmin(np.round(angle[main] % (2.0 * np.pi), 6))]]
    order = np.argsort(np.round((angle - first) % (2.0 * np.pi), 6) % (2.0 * np.pi), kind="stable")
    turns = (
        _turns(samples, blades)
        if rotation == AUTOMATIC
        else 1.0
        if rotation == ANTICLOCKWISE
        else -1.0
    )
    area = np.array([float(graph.area[list(blades[k].walls)].sum()) for k in order])
    ordered = tuple(blades[k] for k in order)
    return BladeRows(
        blades=ordered,
        angle=angle[order],
        row=row[order],
        area=area,
        turns=turns,
        pair=_pair(graph, ordered, row[order]),
    )


def _points(graph: FaceGraph, rows: tuple[int, ...], samples: CylindricalSamples) -> Floats:
    """Return the sample and edge points (k, 3) of some faces."""
    edges = sorted({e for r in rows for e in graph.edges_of[r]})
    ends = [getattr(graph, name)[edges] for name in ("start", "middle", "end")]
    return np.concatenate([graph.sample_point[samples.of_all(rows)], *ends])


def _outlet_angle(graph: FaceGraph, samples: CylindricalSamples, blade: Blade) -> float:
    """Return the angle (radians, 0 to a whole turn) at which a blade meets its largest radius."""
    points = _points(graph, blade.walls, samples)
    radius = samples.meridian_of(points)[:, 0]
    angle = samples.angles_of(points[radius > radius.max() - 1e-3 * np.ptp(radius)])
    return float(np.angle(np.exp(1j * angle).mean()) % (2.0 * np.pi))


def _start(graph: FaceGraph, samples: CylindricalSamples, hub: HubMeridian, blade: Blade) -> float:
    """Return how far along the hub a blade begins, mm."""
    points = _points(graph, blade.walls, samples)
    return float(hub.progress(samples.meridian_of(points)).min())


def _rows(start: Floats, near: float) -> Ints:
    """Return the row (k,) of each blade by where it starts: a new row begins at a gap wider than `near`."""
    order = np.argsort(start, kind="stable")
    steps = np.concatenate([[0], np.cumsum(np.diff(start[order]) > near)])
    row = np.zeros(len(start), dtype=np.int64)
    row[order] = steps
    return row


def _turns(samples: CylindricalSamples, blades: tuple[Blade, ...]) -> float:
    """Return the way in which blades are swept back: from their outermost part, or where that is straight from all of them; 0 for neither.

    Along a wall the angle about the axis changes by -n_out / n_around for each length in the radius (along the axis -n_axial / n_around),
    with n its normal; a wheel turns against the sense in which it does so from inlet to outlet.
    """
    walls = samples.of_all(tuple(r for b in blades for r in b.walls))
    normal, meridian = samples.normal[walls], samples.meridian[walls]
    low, high = float(meridian[:, 0].min()), float(meridian[:, 0].max())
    outer = meridian[:, 0] > high - OUTER * (high - low)
    sense = np.sign(normal[:, 1])
    sweep = np.arctan2(-normal[:, 0] * sense, np.abs(normal[:, 1]))
    wrap = np.arctan2(normal[:, 2] * sense, np.abs(normal[:, 1]))
    for angle in (sweep[outer], wrap[~outer]):
        mean = float(angle.mean()) if len(angle) else 0.0
        if abs(mean) > SWEPT:
            return -1.0 if mean > 0.0 else 1.0
    return 0.0


def _pair(graph: FaceGraph, blades: tuple[Blade, ...], row: Ints) -> tuple[int, ...]:
    """Return the numbers of the first main blade and of the neighbour whose tip is nearest to its own."""
    if len(blades) < 2:
        return ()
    tips = [_edge_points(graph, b.tip or b.walls) for b in blades]
    near = [(_gap(tips[0], tips[n]), n) for n in (1, len(blades) - 1)]
    (first, after), (second, before) = near
    return (0, after) if first <= second * (1.0 + 1e-6) else (before, 0)


def _edge_points(graph: FaceGraph, rows: tuple[int, ...]) -> Floats:
    edges = sorted({e for r in rows for e in graph.edges_of[r]})
    inside = graph.sample_point[np.isin(graph.sample_face, rows)]
    return np.concatenate([graph.start[edges], graph.middle[edges], graph.end[edges], inside])


def _gap(a: Floats, b: Floats) -> float:
    return float(np.linalg.norm(a[:, None] - b[None], axis=2).min())


def in_degrees(angle: float) -> float:
    """Return an angle about the axis in degrees from 0 to 360."""
    return degrees(angle % (2.0 * np.pi))
