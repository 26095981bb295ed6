"""Whether a part is one of curved surfaces: how much of its area no end mill finishes on its levels and along its walls."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.contract import Suitability
from trunnion.recognize.revolution import reach
from trunnion.recognize.surface.settings import SurfaceSettings
from trunnion.recognize.tunnels import tunnel_walls
from trunnion.settings import choose
from trunnion.tolerance import ANGLE
from trunnion.units import percent, radians

ENOUGH = 0.15
"""Share of the area that is curved on a part that is surely of this family; panels have half of it at most, most of that in fillets."""
GENERAL = 0.9
"""Patches of any part can be grouped, which says nothing about what they are: a kind that explains as much of them is the better answer."""
UPRIGHT = radians(0.5)
"""A face whose normals stay within this of square to a direction stands upright along it, in radians."""
STEEPEST = radians(30.0)
"""A plane that leans less than this out of the upright is a wall, in radians: end mills with a taper or in steps cut it."""
SLIGHT = 0.005
"""Share of the area below which inclined planes are not named."""
MAIN = 0.9
"""Area of parallel planes over that of the largest set of them from which on their normal may be the direction the part is milled from: a
top that waves along a side stands upright along that side, but nobody mills a plate from there."""
HOLE = 0.1
"""Radius over the diagonal of the part's box up to which a hollow cylinder or cone is a hole, a countersink or a fillet."""


def suitability(graph: FaceGraph) -> Suitability:
    """Return how near the curved share of a part's area comes to `ENOUGH`; all patches that are no slivers can be grouped.

    A face is curved when it is no plane, stands upright along none of the part's main directions and is no hole; planes that lie inclined
    to a direction count with them, for no end mill finishes these on its levels either, unless they are walls of tunnels along the part.
    Of faces that enclose no material nothing else can be made than groups.
    """
    whole = float(graph.area.sum())
    if whole == 0.0:
        return Suitability(score=0.0, explained=0.0, reason="the part has no face")
    bent = ~_plain(graph)
    directions = _directions(graph)
    curved = min(
        (float(graph.area[bent & _leans(graph, z)].sum()) for z in directions),
        default=float(graph.area[bent].sum()),
    )
    # Seen along a side's normal an inclined top would be a leaning wall: only the main direction tells.
    inclined = sum(
        float(graph.area[_inclined(graph, z) & ~tunnel_walls(graph, z)].sum())
        for z in directions[:1]
    )
    explained = min(1.0, float(graph.area[~_slivers(graph)].sum()) / whole)
    fits, enclose = (
        (1.0, ", and the faces enclose no material")
        if graph.open_edges
        else (min(1.0, (curved + inclined) / whole / ENOUGH), "")
    )
    flat = f", {percent(inclined / whole)} inclined" if inclined / whole > SLIGHT else ""
    return Suitability(
        score=GENERAL * explained * fits,
        explained=explained,
        reason=f"{percent(curved / whole)} of the area curved{flat}{enclose}",
    )


def _plain(graph: FaceGraph) -> Bools:
    """Return which faces (n,) are planes, or hollow cylinders and cones that are narrow for the part."""
    surface = np.array(graph.surface)
    hollow = np.isin(surface, ("cylinder", "cone")) & (graph.bend < 0)
    return np.asarray(
        (surface == "plane")
        | (hollow & (np.nan_to_num(graph.radius, nan=np.inf) < HOLE * reach(graph)))
    )


def _directions(graph: FaceGraph) -> list[Floats]:
    """Return the normals of the part's main planes."""
    plane = (np.array(graph.surface) == "plane") & (graph.area > 0.0)
    normal, area = graph.normal[plane], graph.area[plane]
    found: list[tuple[float, Floats]] = []
    while area.any():
        direction = normal[int(np.argmax(area))]
        along = np.abs(normal @ direction) > np.cos(ANGLE)
        found.append((float(area[along].sum()), direction))
        area = np.where(along, 0.0, area)
    most = max((size for size, _ in found), default=0.0)
    return [direction for size, direction in found if size >= MAIN * most]


def _inclined(graph: FaceGraph, z: Floats) -> Bools:
    """Return which faces (n,) are planes that lie neither level nor upright in a direction, and less steep than a wall that leans."""
    plane = np.array(graph.surface) == "plane"
    rise = np.abs(graph.normal @ z)
    return np.asarray(plane & (rise < np.cos(ANGLE)) & (rise > np.sin(STEEPEST)))


def _leans(graph: FaceGraph, z: Floats) -> Bools:
    """Return which faces (n,) do not stand upright along a direction all over."""
    found = np.zeros(len(graph), dtype=bool)
    found[graph.sample_face[np.abs(graph.sample_normal @ z) > np.sin(UPRIGHT)]] = True
    return found


def _slivers(graph: FaceGraph) -> Bools:
    """Return which faces (n,) are narrower than slivers by their area over their edges, as far as these join other faces."""
    border = np.bincount(graph.edge_face.ravel(), np.repeat(graph.length, 2), len(graph))
    width = np.divide(2.0 * graph.area, border, out=np.full(len(graph), np.inf), where=border > 0.0)
    return np.asarray(width < choose(SurfaceSettings, {}).sliver_width)
