"""The rules that make generalized pockets of floors, rings and spaces (rules 4 to 9 of the design)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trunnion.geometry.facegraph import CONVEX
from trunnion.recognize.grow import grown, loops
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.pockets.rings import WallRing, ring
from trunnion.recognize.panel.pockets.tops import Tops, mean_width, sort_tops
from trunnion.recognize.panel.side import PanelSide
from trunnion.tolerance import SLIVER

HEIGHT_DECIMALS = 3
"""Floors whose heights agree to a micrometre are equally high, whatever way the part lies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Island:
    """Something that stands in a pocket, as face rows; `floor` is the one that it stands on."""

    floor: int
    tops: tuple[int, ...]
    walls: tuple[int, ...]
    corners: tuple[int, ...]
    fillets: tuple[int, ...]

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces."""
        return self.tops + self.walls + self.corners + self.fillets


@dataclass(frozen=True, slots=True, kw_only=True)
class Pocket:
    """A generalized pocket before it gets its name: floors from high to low, and what stands around them, as face rows.

    `drops`: the faces that go down from its floors; `parent`: the floor that it is sunk in, None when it opens at the top.
    """

    floors: tuple[int, ...]
    walls: tuple[int, ...]
    corners: tuple[int, ...]
    fillets: tuple[int, ...]
    slopes: tuple[int, ...] = ()
    drops: tuple[int, ...] = ()
    islands: tuple[Island, ...] = ()
    sharp: bool = False
    parent: int | None = None

    @property
    def sides(self) -> tuple[int, ...]:
        """Walls and corners."""
        return self.walls + self.corners

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces of the pocket itself."""
        return self.floors + self.walls + self.corners + self.fillets


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphFeatures:
    """What the graph shows of one side: pockets with their islands, the tops of ribs and of bosses, and what each top is."""

    pockets: tuple[Pocket, ...]
    tops: Tops
    ribs: tuple[int, ...]
    bosses: tuple[int, ...]


def pockets_of(view: PanelSide) -> GraphFeatures:
    """Return the pockets, islands, ribs and bosses that the graph of one side shows."""
    tops = sort_tops(view)
    around = {floor: loops(view.graph, floor) for floor in tops.floors}
    outer = {floor: ring(view, floor, edges.get(0, ())) for floor, edges in around.items()}
    floors = tops.floors
    islands: dict[int, list[Island]] = {f: [] for f in floors}
    sunk: dict[int, int] = {}
    owners: dict[int, list[int]] = {}
    for floor in floors:
        # A fillet that a higher floor cuts off below its wall is all that stands between the two.
        for side in (*outer[floor].sides, *outer[floor].fillets):
            owners.setdefault(side, []).append(floor)
    group = {f: f for f in floors}
    for floor in floors:
        for number, edges in around[floor].items():
            if number == 0:
                continue
            inner = ring(view, floor, edges)
            if not outer[floor].is_island and inner.is_island:
                outer[floor] = replace(inner, drops=(*outer[floor].drops, *inner.drops))
            elif inner.is_island:
                islands[floor].append(island_on(view, floor, inner))
            else:
                sunk.update(
                    {lower: floor for drop in inner.drops for lower in owners.get(drop, ())}
                )
        for drop in outer[floor].drops:
            for lower in owners.get(drop, ()):
                _join(group, floor, lower)
    for a, b in view.graph.edge_face[view.graph.convexity == CONVEX].tolist():
        # Sides of two floors that meet in an outer edge, with no top between them: above that edge the two share their space.
        for lower in owners.get(b, ()):
            for floor in owners.get(a, ()):
                _join(group, floor, lower)
    found = []
    for members in _groups(group, view):
        rings = [outer[f] for f in members]
        found.append(
            Pocket(
                floors=members,
                walls=_once(rings, "walls"),
                corners=_once(rings, "corners"),
                fillets=_once(rings, "fillets"),
                slopes=_once(rings, "slopes"),
                drops=_once(rings, "drops"),
                sharp=any(r.sharp for r in rings),
                islands=tuple(i for f in members for i in islands[f]),
                parent=next(
                    (
                        sunk[f]
                        for f in members
                        if f in sunk and _root(group, sunk[f]) != _root(group, f)
                    ),
                    None,
                ),
            )
        )
    island_tops = {t for p in found for i in p.islands for t in i.tops}
    free = [t for t in tops.islands if t not in island_tops]
    narrow = tuple(t for t in free if mean_width(view, t) <= view.settings.rib_width)
    openings = [
        o
        for face in (*tops.highest, *tops.islands, *tops.ribs, *floors)
        for o in openings_in(view, face, set(owners))
    ]
    return GraphFeatures(
        pockets=(*found, *openings),
        tops=tops,
        ribs=tops.ribs + narrow,
        bosses=tuple(t for t in free if t not in narrow),
    )


def without(shown: GraphFeatures, done: set[int]) -> GraphFeatures:
    """Return what a side shows without the openings whose walls another side has already (they go through)."""
    return replace(
        shown, pockets=tuple(p for p in shown.pockets if p.floors or not done.issuperset(p.sides))
    )


def openings_in(view: PanelSide, face: int, known: set[int]) -> list[Pocket]:
    """Return the pockets without a floor that break through a horizontal face: inner loops whose faces go down to no floor."""
    found = []
    for number, edges in loops(view.graph, face).items():
        inner = ring(view, face, edges)
        sides = inner.drops
        if (
            number == 0
            or inner.is_island
            or not all(view.classes.steep[s] for s in sides)
            or known.intersection(sides)
        ):
            continue
        if not view.holes.issuperset(sides):
            parent = face if view.z(face) < view.height - SLIVER else None
            found.append(
                Pocket(
                    floors=(),
                    walls=tuple(s for s in sides if s not in view.corners),
                    fillets=(),
                    parent=parent,
                    corners=tuple(s for s in sides if s in view.corners),
                    drops=sides,
                )
            )
    return found


def island_on(view: PanelSide, floor: int, foot: WallRing) -> Island:
    """Return the island that stands on one inner loop of a floor: its sides, every top over them, the blends at its foot."""
    graph, steep, kind = view.graph, view.classes.steep, view.classes.kind

    def is_island(edge: int, face: int, to: int) -> bool:
        below = graph.box_low[to][2] < view.z(floor) - SLIVER
        if to in (floor, *foot.fillets) or to in view.holes or below:
            return False
        rising = steep[face] and kind[to] is FaceClass.UP and graph.convexity[edge] == CONVEX
        adjacent = steep[face] and steep[to] and not _crosses_top(view, edge, face)
        higher = kind[face] is FaceClass.UP and steep[to] and graph.convexity[edge] != CONVEX
        return bool(rising or adjacent or higher)

    reached = grown(graph, foot.sides, is_island)
    sides = [r for r in reached if steep[r]]
    return Island(
        floor=floor,
        tops=tuple(r for r in reached if kind[r] is FaceClass.UP),
        fillets=foot.fillets,
        walls=tuple(r for r in sides if r not in view.corners),
        corners=tuple(r for r in sides if r in view.corners),
    )


def _crosses_top(view: PanelSide, edge: int, face: int) -> bool:
    low = min(view.graph.start[edge][2], view.graph.end[edge][2])
    return bool(
        low > view.graph.box_high[face][2] - SLIVER and view.graph.convexity[edge] == CONVEX
    )


def _once(rings: list[WallRing], name: str) -> tuple[int, ...]:
    return tuple(dict.fromkeys(row for r in rings for row in getattr(r, name)))


def _root(group: dict[int, int], face: int) -> int:
    while group[face] != face:
        face = group[face]
    return face


def _join(group: dict[int, int], a: int, b: int) -> None:
    low, high = sorted((_root(group, a), _root(group, b)))
    group[high] = low


def _groups(group: dict[int, int], view: PanelSide) -> list[tuple[int, ...]]:
    members: dict[int, list[int]] = {}
    for face in group:
        members.setdefault(_root(group, face), []).append(face)
    return [
        tuple(sorted(m, key=lambda f: (-round(view.z(f), HEIGHT_DECIMALS), f)))
        for m in members.values()
    ]
