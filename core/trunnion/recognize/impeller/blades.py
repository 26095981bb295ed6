"""The blades of a wheel: what stands on its hub, part by part, and the role of each of their faces.

Sides are told by the sense of their normals round the axis, which no lean and no wrap changes: a wall has one sense all over. Edges turn
from one sense to the other or have none, and lie at one of three ends of the blade: tip, inlet or outlet.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trunnion.geometry.arrays import Bools
from trunnion.geometry.facegraph import CONVEX, SMOOTH, FaceGraph
from trunnion.recognize.grow import grown
from trunnion.recognize.impeller.body import WheelBody
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.recognize.impeller.kinds import (
    LEADING_EDGE,
    PRESSURE,
    ROOT_FILLET,
    SHROUD,
    SUCTION,
    TRAILING_EDGE,
)
from trunnion.recognize.impeller.meridian import HubMeridian
from trunnion.recognize.revolution import OUT_OF_MERIDIAN

ONE_SENSE = 0.9
"""Share of a wall's samples whose normals have its sense round the axis: fitted surfaces turn back at a corner."""
WALL = 0.4
"""Area over that of the largest face of its sense from which on a face is a wall of its own, not half of a rounded edge."""

RAKED = 3.0
"""Slope up to which an edge that stands on the hub is raked back: some 70 degrees."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Blade:
    """A blade or splitter by face rows, yet without pressure and suction: `ahead` are walls whose normals look round the axis, `behind`
    those that look back; the others by role."""

    ahead: tuple[int, ...] = ()
    behind: tuple[int, ...] = ()
    tip: tuple[int, ...] = ()
    leading: tuple[int, ...] = ()
    trailing: tuple[int, ...] = ()
    fillets: tuple[int, ...] = ()

    @property
    def walls(self) -> tuple[int, ...]:
        """The walls of both sides."""
        return (*self.ahead, *self.behind)

    @property
    def core(self) -> tuple[int, ...]:
        """All faces but the root fillets."""
        return (*self.walls, *self.tip, *self.leading, *self.trailing)

    @property
    def rows(self) -> tuple[int, ...]:
        """All faces."""
        return (*self.core, *self.fillets)

    def roles(self, turns: float) -> tuple[tuple[str, tuple[int, ...]], ...]:
        """Return the rows by role for a wheel that turns with (1) or against (-1) the right-handed sense about its axis."""
        pressure, suction = (self.ahead, self.behind) if turns > 0.0 else (self.behind, self.ahead)
        return (
            (SHROUD, self.tip),
            (PRESSURE, pressure),
            (SUCTION, suction),
            (LEADING_EDGE, self.leading),
            (TRAILING_EDGE, self.trailing),
            (ROOT_FILLET, self.fillets),
        )


def blades_of(
    graph: FaceGraph, samples: CylindricalSamples, body: WheelBody, hub: HubMeridian
) -> tuple[Blade, ...]:
    """Return what stands on the hub and has walls of both senses, in the order of its first rows."""
    own = body.free | (body.turned & ~body.body)
    fillet = _fillets(graph, body)
    sense = {r: _sense(samples, r) for r in np.flatnonzero(own).tolist()}
    cores: list[tuple[int, ...]] = []
    loose: list[tuple[int, ...]] = []
    for rows in _parts(graph, own & ~fillet):
        senses = {sense[r] for r in rows}
        (cores if {1, -1} <= senses else loose).append(rows)
    beside = set(body.hub) | set(np.flatnonzero(fillet).tolist())
    blades = [_roles(graph, samples, hub, rows, sense, beside) for rows in cores]
    blades = [b for b in blades if any(n in beside for r in b.core for n in graph.neighbours(r))]
    return _with_roots(graph, blades, fillet, loose)


def _fillets(graph: FaceGraph, body: WheelBody) -> Bools:
    """Return which free faces (n,) run smoothly into the hub: root fillets."""
    found = np.zeros(len(graph), dtype=bool)
    for row in body.hub:
        found[[r for r in graph.neighbours(row, SMOOTH) if body.free[r]]] = True
    return found


def _parts(graph: FaceGraph, own: Bools) -> list[tuple[int, ...]]:
    """Return some faces in parts that hang together, each in the order of its rows."""
    found: list[tuple[int, ...]] = []
    seen: set[int] = set()
    for row in np.flatnonzero(own).tolist():
        if row not in seen:
            part = grown(graph, [row], lambda edge, face, other: bool(own[other]))
            seen.update(part)
            found.append(tuple(sorted(part)))
    return found


def _sense(samples: CylindricalSamples, row: int) -> int:
    """Return 1 or -1 for a face whose normals look round the axis in one sense all over, 0 for one whose don't."""
    around = samples.normal[samples.of(row), 1]
    for sense in (1, -1):
        if len(around) and (around * sense > np.sin(OUT_OF_MERIDIAN)).mean() >= ONE_SENSE:
            return sense
    return 0


def _roles(
    graph: FaceGraph,
    samples: CylindricalSamples,
    hub: HubMeridian,
    rows: tuple[int, ...],
    sense: dict[int, int],
    roots: set[int],
) -> Blade:
    """Return the faces of a blade by role."""
    largest = {s: max(float(graph.area[r]) for r in rows if sense[r] == s) for s in (1, -1)}
    small = {r for r in rows if sense[r] and graph.area[r] < WALL * largest[sense[r]]}
    halves = {r for r in small if _is_half(graph, r, rows, sense) or _is_cut(graph, r, rows, sense)}
    ends: dict[str, list[int]] = {SHROUD: [], LEADING_EDGE: [], TRAILING_EDGE: []}
    edges = [r for r in rows if not sense[r] or r in halves]
    for row in edges:
        rooted = not roots.isdisjoint(graph.neighbours(row))
        ends[_end(samples, hub, row, rooted=rooted)].append(row)
    for row in sorted(small - halves):
        if _rounds_tip(graph, row, ends[SHROUD]):
            ends[SHROUD].append(row)
            edges.append(row)
    walls = [r for r in rows if r not in edges]
    return Blade(
        ahead=tuple(r for r in walls if sense[r] > 0),
        behind=tuple(r for r in walls if sense[r] < 0),
        tip=tuple(sorted(ends[SHROUD])),
        leading=tuple(ends[LEADING_EDGE]),
        trailing=tuple(ends[TRAILING_EDGE]),
    )


def _is_half(graph: FaceGraph, row: int, rows: tuple[int, ...], sense: dict[int, int]) -> bool:
    """Return whether a face runs smoothly into one of the other sense: half of an edge that is rounded in two pieces."""
    return any(sense.get(o, 0) == -sense[row] and o in rows for o in graph.neighbours(row, SMOOTH))


def _is_cut(graph: FaceGraph, row: int, rows: tuple[int, ...], sense: dict[int, int]) -> bool:
    """Return whether walls of both senses fall away from a face at sharp edges: an end that is cut off square to the blade."""
    sharp = {
        sense[o]
        for o in graph.neighbours(row, CONVEX)
        if o in rows and graph.area[o] > graph.area[row]
    }
    return {1, -1} <= sharp


def _rounds_tip(graph: FaceGraph, row: int, tip: list[int]) -> bool:
    """Return whether a small face runs smoothly into the tip: its edge with a wall is rounded."""
    return graph.bend[row] > 0 and bool(set(graph.neighbours(row, SMOOTH)) & set(tip))


def _end(samples: CylindricalSamples, hub: HubMeridian, row: int, *, rooted: bool) -> str:
    """Return at which end of its blade a face without a sense lies, by where its normals look in the meridian: an edge that stands on the
    hub or its fillets (`rooted`) may be raked so far back that they look more off the hub than along it."""
    mine = samples.of(row)
    normal = samples.normal[mine].mean(axis=0)[[0, 2]]
    along, up = hub.directions(samples.meridian[mine].mean(axis=0)[None])
    flow, span = float(normal @ along[0]), float(normal @ up[0])
    if span > abs(flow) * (RAKED if rooted else 1.0):
        return SHROUD
    return TRAILING_EDGE if flow > 0.0 else LEADING_EDGE


def _with_roots(
    graph: FaceGraph, blades: list[Blade], fillet: Bools, loose: list[tuple[int, ...]]
) -> tuple[Blade, ...]:
    """Return the blades with their root fillets: each face of them with the blade that it shares most of its edges with, those that touch
    fillets alone with the blade of these."""
    owner = {r: n for n, b in enumerate(blades) for r in b.core}
    waiting = [*np.flatnonzero(fillet).tolist(), *(r for rows in loose for r in rows)]
    roots: list[list[int]] = [[] for _ in blades]
    while True:
        shared = {r: _shared(graph, r, owner) for r in waiting}
        found = {r: max(s, key=lambda n: (s[n], -n)) for r, s in shared.items() if s}
        if not found:
            break
        for row, n in found.items():
            owner[row] = n
            roots[n].append(row)
        waiting = [r for r in waiting if r not in found]
    return tuple(replace(b, fillets=tuple(sorted(roots[n]))) for n, b in enumerate(blades))


def _shared(graph: FaceGraph, row: int, owner: dict[int, int]) -> dict[int, float]:
    """Return the length in mm of the edges, sharp outer ones left out, that a face shares with each blade."""
    found: dict[int, float] = {}
    for edge in graph.edges_of[row]:
        other = graph.across(edge, row)
        if other in owner and graph.convexity[edge] != CONVEX:
            found[owner[other]] = found.get(owner[other], 0.0) + float(graph.length[edge])
    return found
