"""Bosses: a top that lies on turned ground, the sides that fall from it, and the fillets at their foot.

Every top has a boss of its own ("one boss per flat top"): one that a higher rib cuts is two, and a side common to two tops, flush between
them, belongs to both.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH
from trunnion.recognize.casing.faces import ALIGNED, CasingFaces
from trunnion.recognize.grow import grown, same_surface
from trunnion.tolerance import ANGLE, SLIVER


@dataclass(frozen=True, slots=True, kw_only=True)
class BossFaces:
    """A boss by face rows: `top` (one face, or the pieces of one), `sides` with what rounds their rim off, `fillets` at their foot, and the
    turned `ground` that it stands on."""

    top: tuple[int, ...]
    sides: tuple[int, ...]
    fillets: tuple[int, ...]
    ground: tuple[int, ...]

    @property
    def rows(self) -> tuple[int, ...]:
        """All face rows."""
        return (*self.top, *self.sides, *self.fillets)


def find_bosses(faces: CasingFaces) -> tuple[BossFaces, ...]:
    """Return the bosses of a casing, in the order of their tops' rows."""
    proposed = {p.top: p for p in _proposals(faces)}
    area = faces.graph.area
    kept = [
        p
        for p in proposed.values()
        if not any(
            other is not p
            and set(p.top) & set(other.sides)
            and set(other.top) & set(p.sides)
            and (area[list(other.top)].sum(), other.top) > (area[list(p.top)].sum(), p.top)
            for other in proposed.values()
        )
    ]
    tops = {r for p in kept for r in p.top}
    sides = {r for p in kept for r in p.sides} - tops
    owned = _fillets(faces, kept, tops | sides)
    return tuple(
        BossFaces(
            top=p.top,
            sides=tuple(r for r in p.sides if r not in tops),
            fillets=owned[n],
            ground=p.ground,
        )
        for n, p in enumerate(kept)
    )


def _proposals(faces: CasingFaces) -> Iterator[BossFaces]:
    """Yield a boss for each face that may be a top: nothing but convex edges leads from it to sides that stand on ground it is aligned
    with, and it does not touch that ground itself. A ring that holes have cut into arcs has nothing but turned sides."""
    seen: set[int] = set()
    for row in faces.present:
        if row in seen or not _may_be_top(faces, row):
            continue
        top = _whole(faces, row)
        seen.update(top)
        sides = _sides(faces, top)
        ground = sorted(
            {
                g
                for s in sides
                for g in faces.ground_of[s]
                if all(faces.alignment(t, g) > ALIGNED for t in top)
            }
        )
        if (
            ground
            and not any(faces.ground_of[t].intersection(ground) for t in top)
            and not (faces.turned[row] and all(faces.turned[s] for s in sides))
        ):
            yield BossFaces(top=top, sides=sides, fillets=(), ground=tuple(ground))


def _may_be_top(faces: CasingFaces, row: int) -> bool:
    """Return whether a face may be a top: a plane, or a turned face that falls off all round to faces that are not turned."""
    graph = faces.graph
    if row in faces.holes or faces.runs_round(row):
        return False
    if not faces.turned[row]:
        return graph.surface[row] == "plane"
    rim = [
        (graph.convexity[e], graph.across(e, row))
        for e in graph.edges_of[row]
        if graph.across(e, row) not in faces.holes
    ]
    return bool(rim) and all(c == CONVEX and not faces.runs_round(n) for c, n in rim)


def _whole(faces: CasingFaces, row: int) -> tuple[int, ...]:
    """Return all faces of a top that the file has in pieces."""
    graph = faces.graph
    return tuple(
        sorted(
            grown(
                graph,
                [row],
                lambda edge, a, b: (
                    b not in faces.holes
                    and graph.convexity[edge] == SMOOTH
                    and same_surface(graph, a, b, SLIVER, ANGLE)
                ),
            )
        )
    )


def _sides(faces: CasingFaces, top: tuple[int, ...]) -> tuple[int, ...]:
    """Return what falls from a top: faces over convex edges, on through chamfers and pieces of sides to those that stand on ground."""
    graph = faces.graph

    def falls(edge: int, a: int, b: int) -> bool:
        if b in faces.holes or faces.runs_round(b):
            return False
        if a in top:
            return bool(graph.convexity[edge] != CONCAVE)
        return bool(
            not faces.ground_of[a] and graph.convexity[edge] != CONCAVE and not faces.is_root(b)
        )

    return tuple(sorted(set(grown(graph, top, falls)) - set(top)))


def _fillets(faces: CasingFaces, bosses: list[BossFaces], taken: set[int]) -> list[tuple[int, ...]]:
    """Return the root fillets of bosses: blends that run smoothly into a side, and those that run into these at corners.

    One between two bosses belongs to both.
    """
    sides_of = {s: n for n, boss in enumerate(bosses) for s in boss.sides}
    return [_fillets_of(faces, n, boss, sides_of, taken) for n, boss in enumerate(bosses)]


def _fillets_of(
    faces: CasingFaces, mine: int, boss: BossFaces, sides_of: dict[int, int], taken: set[int]
) -> tuple[int, ...]:
    graph = faces.graph

    def may(row: int) -> bool:
        return row not in taken and faces.is_blend(row)

    def joins(edge: int, a: int, b: int) -> bool:
        return bool(
            graph.convexity[edge] == SMOOTH
            and may(b)
            and not _owner_beyond(faces, sides_of, b, mine)
        )

    seeds = [n for s in boss.sides for n in graph.neighbours(s, SMOOTH) if may(n)]
    return tuple(sorted(grown(graph, dict.fromkeys(seeds), joins)))


def _owner_beyond(faces: CasingFaces, sides_of: dict[int, int], row: int, mine: int) -> bool:
    """Return whether a blend runs into sides of other bosses alone."""
    owners = {sides_of[n] for n in faces.graph.neighbours(row, SMOOTH) if n in sides_of}
    return bool(owners) and mine not in owners
