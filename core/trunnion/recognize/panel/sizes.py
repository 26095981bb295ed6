"""Sizes of panel features, named as the words of the trade and the catalogue of truths have them; heights as `side.py` has them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, CONVEX
from trunnion.model.feature import Size
from trunnion.recognize.grow import bend_radius
from trunnion.recognize.panel.classes import FaceClass
from trunnion.recognize.panel.pockets.rules import Island, Pocket
from trunnion.recognize.panel.pockets.tops import mean_width
from trunnion.recognize.panel.side import PanelSide
from trunnion.tolerance import ANGLE, SLIVER
from trunnion.units import rounded

LEAN_STEP = 0.05
"""degrees: leans closer than this are one lean."""


def pocket_sizes(view: PanelSide, pocket: Pocket, ribs: Iterable[int]) -> dict[str, Size]:
    """Return the sizes of a pocket: depth from its deepest floor to its highest rim, radii for the cutter, leans, rims."""
    graph = view.graph
    top = max(float(graph.box_high[f][2]) for f in pocket.sides or pocket.floors)
    deep = min(view.z(f) for f in pocket.floors or pocket.sides)
    sizes: dict[str, Size] = {
        "depth": rounded(top - deep),
        "floor_z": view.named_height(deep),
        "top_z": view.named_height(top),
    }
    sizes.update(side_sizes(view, pocket.walls, pocket.corners))
    sizes["floor_fillet"] = fillet_radius(view, pocket.fillets, pocket.sharp)
    # A rib that is lower than the fillets at its foot are high meets these, and no wall.
    rims = [view.z(r) for r in ribs if _meets(view, r, (*pocket.sides, *pocket.fillets))]
    if rims and min(rims) < top - SLIVER:
        sizes["lowest_rim_z"] = view.named_height(min(rims))
    flat = [f for f in pocket.floors if view.classes.kind[f] is FaceClass.UP]
    if len(flat) > 1:
        sizes["floors_z"] = tuple(view.named_height(view.z(f)) for f in flat)
    return sizes


def island_sizes(view: PanelSide, island: Island) -> dict[str, Size]:
    """Return the sizes of an island: its highest top, its height over the floor that it stands on, radii and leans."""
    top = max(
        [view.z(t) for t in island.tops] or [float(view.graph.box_high[w][2]) for w in island.walls]
    )
    sizes: dict[str, Size] = {
        "top_z": view.named_height(top),
        "height": rounded(top - view.z(island.floor)),
    }
    sizes.update(side_sizes(view, island.walls, island.corners))
    sizes["floor_fillet"] = fillet_radius(view, island.fillets, not island.fillets)
    return sizes


def rib_sizes(view: PanelSide, top: int, floors: Iterable[int]) -> dict[str, Size]:
    """Return the sizes of a rib: thickness at its top, length along its middle line, heights over the floors beside it."""
    z = view.z(top)
    sizes: dict[str, Size] = {"top_z": view.named_height(z), "below_top": rounded(view.height - z)}
    thickness, length = strip(view, top)
    adjacent = [view.z(f) for f in floors]
    sizes["thickness"] = rounded(thickness)
    if adjacent:
        sizes.update(height=rounded(z - min(adjacent)), lower_height=rounded(z - max(adjacent)))
    sizes["length"] = round(length, 3)
    if len(_ends(view, top)) > 2:
        sizes["compound"] = True
    return sizes


def boss_sizes(view: PanelSide, top: int) -> dict[str, Size]:
    """Return the sizes of a boss: the height of its top, how far that is below the part's, and its area in mm2."""
    z = view.z(top)
    return {
        "top_z": view.named_height(z),
        "below_top": rounded(view.height - z),
        "area": rounded(float(view.graph.area[top])),
    }


def side_sizes(view: PanelSide, walls: Sequence[int], corners: Sequence[int]) -> dict[str, Size]:
    """Return the corner radius (0 when two walls meet in a sharp inner edge; none when nothing is hollow) and the leans."""
    sizes: dict[str, Size] = {}
    radius = corner_radius(view, (*walls, *corners))
    if radius is not None:
        sizes["corner_radius"] = radius
    leans: list[float] = []
    for lean in sorted(float(view.classes.lean[w]) for w in walls):
        if not leans or lean - leans[-1] > LEAN_STEP:
            leans.append(lean)
    sizes["leans"] = tuple(round(lean, 2) + 0.0 for lean in leans)
    return sizes


def corner_radius(view: PanelSide, sides: Sequence[int]) -> float | None:
    """Return the smallest radius of the blends of some sides (hollow ones first), 0 for a sharp inner edge, None when there is none."""
    graph, own = view.graph, set(sides)
    if any(
        graph.convexity[e] == CONCAVE and own.issuperset(graph.edge_face[e].tolist())
        for s in sides
        for e in graph.edges_of[s]
    ):
        return 0.0
    hollow = [
        bend_radius(graph, s) for s in sides if graph.bend[s] < 0 and graph.surface[s] != "plane"
    ]
    blends = hollow or [bend_radius(graph, s) for s in sides if s in view.corners]
    return rounded(min(blends)) if blends else None


def fillet_radius(view: PanelSide, fillets: Sequence[int], sharp: bool) -> float:
    """Return the smallest radius at the foot of walls, 0 when one of them stands sharply on the floor."""
    return (
        0.0 if sharp or not fillets else rounded(min(bend_radius(view.graph, f) for f in fillets))
    )


def strip(view: PanelSide, face: int) -> tuple[float, float]:
    """Return thickness and length of a rib's top: between the parallel edges that run beside each other longest, and along their middle.

    A curved top has none: its thickness is then the mean width, its length what the area leaves.
    """
    graph = view.graph
    sides = [
        e for e in graph.edges_of[face] if graph.curve[e] == "line" and graph.convexity[e] == CONVEX
    ]
    best: tuple[float, float, Floats, Floats] | None = None
    for i, a in enumerate(sides):
        direction = graph.end[a] - graph.start[a]
        direction = direction / np.linalg.norm(direction)
        for b in sides[i + 1 :]:
            other = (graph.end[b] - graph.start[b]) / np.linalg.norm(graph.end[b] - graph.start[b])
            gap = (graph.middle[b] - graph.middle[a]) - (
                (graph.middle[b] - graph.middle[a]) @ direction
            ) * direction
            width = float(np.linalg.norm(gap))
            spans = [np.sort([p[e] @ direction for p in (graph.start, graph.end)]) for e in (a, b)]
            adjacent = float(min(s[1] for s in spans) - max(s[0] for s in spans))
            parallel = (
                np.linalg.norm(np.cross(direction, other)) < ANGLE
                and width > SLIVER
                and adjacent > width
            )
            if parallel and (
                best is None or (round(adjacent, 3), -width) > (round(best[1], 3), -best[0])
            ):
                best = (width, adjacent, direction, graph.middle[a] + 0.5 * gap)
    if best is None:
        width = mean_width(view, face)
        return width, float(graph.area[face] / width)
    width, _, direction, middle = best
    reach = [
        _crossing(graph.start[e], graph.end[e], middle, direction)
        for end in _ends(view, face)
        for e in end
        if np.linalg.norm(np.cross(graph.end[e] - graph.start[e], direction)) > SLIVER
    ]
    across = [t for t in reach if t is not None]
    if len(across) < 2:
        along = [
            float((p[e] - middle) @ direction)
            for e in graph.edges_of[face]
            for p in (graph.start, graph.end)
        ]
        return width, max(along) - min(along)
    return width, max(across) - min(across)


def _crossing(start: Floats, end: Floats, point: Floats, direction: Floats) -> float | None:
    """Return where a line through a point meets the line of an edge, seen along z; None when it passes the edge by."""
    edge, normal = end - start, np.array([-direction[1], direction[0], 0.0])
    share = float((point - start) @ normal / (edge @ normal))
    return (
        float((start + share * edge - point) @ direction)
        if -SLIVER < share < 1.0 + SLIVER
        else None
    )


def _ends(view: PanelSide, face: int) -> list[list[int]]:
    """Return the edges where a rib's top runs into something higher, those that touch together."""
    graph = view.graph
    feet = [e for e in graph.edges_of[face] if graph.convexity[e] == CONCAVE]
    groups: list[list[int]] = []
    for e in feet:
        touching = [g for g in groups if any(_overlap(view, e, f) for f in g)]
        merged = [e, *(f for g in touching for f in g)]
        groups = [g for g in groups if g not in touching] + [merged]
    return groups


def _overlap(view: PanelSide, a: int, b: int) -> bool:
    graph = view.graph
    return any(
        np.linalg.norm(p - q) < SLIVER
        for p in (graph.start[a], graph.end[a])
        for q in (graph.start[b], graph.end[b])
    )


def _meets(view: PanelSide, rib: int, sides: Sequence[int]) -> bool:
    return any(
        view.graph.across(e, rib) in sides and view.graph.convexity[e] == CONVEX
        for e in view.graph.edges_of[rib]
    )
