"""What stands around a floor: the walls of one of its loops, with the blends at their feet passed over (rule 6)."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH
from trunnion.recognize.grow import grown, same_surface
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.side import PanelSide
from trunnion.tolerance import ANGLE, SLIVER

SLOPES = (FaceClass.CROSS, FaceClass.BLEND, FaceClass.OVERHANG)
"""What rises from a fillet and is no wall: the side of a dome."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WallRing:
    """The surroundings of one loop of a floor, as face rows.

    `walls` and `corners` stand on the floor, `fillets` lie at their feet, `drops` are the faces that go down from it over a convex
    edge, `slopes` rise too flat for a wall. `sharp`: some wall meets the floor without a blend.
    """

    walls: tuple[int, ...]
    corners: tuple[int, ...]
    fillets: tuple[int, ...]
    drops: tuple[int, ...]
    slopes: tuple[int, ...]
    sharp: bool

    @property
    def sides(self) -> tuple[int, ...]:
        """Walls and corners."""
        return self.walls + self.corners

    @property
    def is_island(self) -> bool:
        """Whether anything rises from the loop."""
        return bool(self.walls or self.corners or self.fillets or self.slopes)


def ring(view: PanelSide, floor: int, edges: tuple[int, ...]) -> WallRing:
    """Return what stands around the edges of one loop of a floor."""
    graph, rising = view.graph, view.classes.rising
    blends, sides, drops, slopes, sharp = [], [], [], [], False
    for edge in edges:
        other = graph.across(edge, floor)
        if other in view.fillets and graph.convexity[edge] != CONVEX:
            blends.append(other)
        elif graph.convexity[edge] == CONCAVE and rising[other]:
            sides.append(other)
            sharp = True
        elif graph.convexity[edge] == CONVEX:
            drops.append(other)
        elif graph.convexity[edge] == CONCAVE:
            slopes.append(other)
    fillets = grown(
        graph,
        blends,
        lambda edge, _, to: bool(
            to in view.fillets and graph.convexity[edge] == SMOOTH and not _has_floor(view, to)
        ),
    )
    for blend in fillets:
        for edge in graph.edges_of[blend]:
            other = graph.across(edge, blend)
            if rising[other] and graph.convexity[edge] != CONVEX:
                sides.append(other)
            elif (
                other not in (floor, *view.fillets)
                and view.classes.kind[other] in SLOPES
                and graph.convexity[edge] != CONVEX
            ):
                slopes.append(other)
    sides = list(dict.fromkeys(sides))
    whole = grown(
        graph,
        sides,
        lambda edge, face, to: bool(rising[to] and _continues_up(view, edge, face, to)),
    )
    return WallRing(
        walls=tuple(r for r in whole if r not in view.corners),
        corners=tuple(r for r in whole if r in view.corners),
        fillets=fillets,
        drops=tuple(dict.fromkeys(drops)),
        slopes=tuple(dict.fromkeys(slopes)),
        sharp=sharp,
    )


def _has_floor(view: PanelSide, blend: int) -> bool:
    return any(
        view.classes.kind[view.graph.across(e, blend)] is FaceClass.UP
        and view.graph.convexity[e] == SMOOTH
        for e in view.graph.edges_of[blend]
    )


def _continues_up(view: PanelSide, edge: int, face: int, other: int) -> bool:
    """Return whether another face carries a wall on, on the same surface, above the wall's top."""
    graph = view.graph
    at_top = min(graph.start[edge][2], graph.end[edge][2]) > graph.box_high[face][2] - SLIVER
    return bool(
        graph.convexity[edge] == SMOOTH
        and at_top
        and same_surface(graph, face, other, SLIVER, ANGLE)
    )
