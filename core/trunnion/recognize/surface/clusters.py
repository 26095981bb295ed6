"""Clusters of connected faces on a part of curved surfaces: blades, bosses, bumps, hollows, and the fillets at their feet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.boundary import Boundary
from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH, FaceGraph
from trunnion.recognize.revolution import main_axis, of_revolution
from trunnion.recognize.surface.fillets import fillets, mostly
from trunnion.recognize.surface.size import PatchSizes, diameter

SECTORS = 12
"""Parts of a turn that each have some boundary of what goes round an axis."""
EVEN = 0.95
"""Least over largest radius, by parts of a turn, of a boundary that goes round an axis; a square has 0.73."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceClusters:
    """Faces that belong together.

    cluster (n,) the number of the cluster of each face row; size (c,) the largest distance of two boundary points of a cluster, mm, what
    carries all others as large as the largest; together (c,) the same, but of fillets that of the smallest other cluster they join; area
    (c,) mm2; fillet (n,) whether a face is of a fillet.
    """

    cluster: Ints
    size: Floats
    together: Floats
    area: Floats
    fillet: Bools


def clusters_of(graph: FaceGraph, sizes: PatchSizes, hollow: Floats) -> FaceClusters:
    """Return the clusters of a part from the sizes of its patches and their middle hollow curvature (k,), 1/mm.

    Faces are of one cluster when they meet in a smooth or convex edge that is no hole of either; fillets are clusters of their own. What is
    turned about the part's axis is one cluster where it is the one of most area, and carries all others.
    """
    width, bend = np.zeros(len(graph)), np.zeros(len(graph))
    width[sizes.tag - 1], bend[sizes.tag - 1] = sizes.width, hollow
    fillet, hub = fillets(graph, width, bend), turned(graph, sizes.outline)
    cluster = _connected(graph, fillet & ~hub, hub)
    if hub.any() and cluster[np.argmax(hub)] != np.argmax(np.bincount(cluster, graph.area)):
        hub = np.zeros_like(hub)
        cluster = _connected(graph, fillet, hub)
    size = _sizes(cluster, sizes.outline)
    size[cluster[hub]] = size.max()
    return FaceClusters(
        cluster=cluster,
        size=size,
        together=_with_feet(graph, fillet & ~hub, cluster, size),
        area=np.asarray(np.bincount(cluster, graph.area), dtype=np.float64),
        fillet=fillet & ~hub,
    )


def turned(graph: FaceGraph, outline: Boundary) -> Bools:
    """Return which faces (n,) are turned about the part's main axis: of revolution and round it, alone or with those that run on smoothly.

    The tips and trailing edges of blades are of revolution too, but end in outer corners along most of their boundary.
    """
    axis = main_axis(graph)
    if axis is None:
        return np.zeros(len(graph), dtype=bool)
    on = of_revolution(graph, axis)
    a, b = graph.edge_face.T
    on &= ~mostly(graph, (graph.convexity == CONVEX) & (on[a] != on[b]))
    run = (graph.convexity == SMOOTH) & on[a] & on[b]
    piece = components(len(graph), a[run], b[run])
    across = axis.away(outline.point) @ np.linalg.svd(axis.direction[None])[2][1:].T
    of_piece = piece[outline.face[outline.edge] - 1]
    round_it = [p for p in np.unique(piece[on]) if _goes_round(across[of_piece == p])]
    return np.asarray(on & np.isin(piece, round_it))


def _goes_round(across: Floats) -> bool:
    """Return whether boundary points (k, 2) in a plane across an axis at the origin reach equally far all round it."""
    sector = np.floor(np.arctan2(across[:, 1], across[:, 0]) * SECTORS / (2.0 * np.pi)).astype(int)
    reach = np.zeros(SECTORS)
    np.maximum.at(reach, sector % SECTORS, np.linalg.norm(across, axis=1))
    return bool(reach.max() > 0.0 and reach.min() >= EVEN * reach.max())


def _connected(graph: FaceGraph, fillet: Bools, hub: Bools) -> Ints:
    """Return the number of the cluster of every face (n,)."""
    a, b = graph.edge_face.T
    rim = (graph.edge_loop > 0).any(axis=1)
    alike = (fillet[a] == fillet[b]) & (hub[a] == hub[b])
    joined = alike & (fillet[a] | ((graph.convexity != CONCAVE) & ~rim))
    rows = np.flatnonzero(hub)
    return components(len(graph), np.append(a[joined], rows[:-1]), np.append(b[joined], rows[1:]))


def components(count: int, a: Ints, b: Ints) -> Ints:
    """Return the number (count,) of the component that each of some rows is in, joined by pairs a, b (m,)."""
    links = coo_array((np.ones(len(a)), (a, b)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _sizes(cluster: Ints, outline: Boundary) -> Floats:
    """Return the largest distance of two boundary points of every cluster (c,), mm."""
    owner = cluster[outline.face[outline.edge] - 1]
    return np.array([diameter(outline.point[owner == c]) for c in range(int(cluster.max()) + 1)])


def _with_feet(graph: FaceGraph, fillet: Bools, cluster: Ints, size: Floats) -> Floats:
    """Return the sizes of clusters (c,), those of fillets that of the smallest other cluster they join."""
    a, b = np.concatenate([graph.edge_face, graph.edge_face[:, ::-1]]).T
    foot = fillet[a] & ~fillet[b]
    joined = np.full(len(size), np.inf)
    np.minimum.at(joined, cluster[a[foot]], size[cluster[b[foot]]])
    return np.where(np.isfinite(joined), joined, size)
