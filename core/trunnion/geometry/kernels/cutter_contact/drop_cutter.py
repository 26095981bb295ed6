"""Drop-cutter: the height of a cutter's tip when it comes down along its axis on triangles. Plain
reference, every triangle for every point.

A cutter is the graph g(rho) of its lower side over the distance rho from its axis: pieces (p, 6)
with the columns `RHO0` to `C`, adjacent in rho; a piece is straight (height A + B (rho - RHO0)) or
an arc (height B - sqrt(C^2 - (rho - A)^2)). The graph is convex and never falls. The tip stands at

    max over points (x, y, z) of the triangles of z - g(distance of (x, y) from the axis)

and the greatest is on a triangle's plane, one of its edges or one of its corners (the drop-cutter
of opencamlib; Chuang, Chen and Yau, 2002). mm, tool axis +z.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats

RHO0, RHO1, ROUND, A, B, C = range(6)
HALVINGS = 60
"""Steps of a bisection that ends at the last digit."""


def height_at(pieces: Floats, rho: Floats) -> Floats:
    """Return how high above the tip the cutter begins at distances (n,) from the axis; infinite outside of it."""
    rho = np.asarray(rho, dtype=np.float64)
    out = np.full(rho.shape, np.inf)
    for rho0, rho1, is_round, a, b, c in pieces[::-1]:
        z = (
            b - np.sqrt(np.clip(c * c - (rho - a) ** 2, 0.0, None))
            if is_round
            else a + b * (rho - rho0)
        )
        out = np.where((rho >= rho0) & (rho <= rho1), z, out)
    return out


def slope_at(pieces: Floats, rho: Floats) -> Floats:
    """Return how steep the lower side is at distances (n,), towards the axis where it has a bend; infinite outside."""
    rho = np.asarray(rho, dtype=np.float64)
    out = np.full(rho.shape, np.inf)
    for rho0, rho1, is_round, a, b, c in pieces[::-1]:
        root = np.sqrt(np.clip(c * c - (rho - a) ** 2, 0.0, None)) if is_round else None
        k = (
            np.full(rho.shape, b)
            if root is None
            else np.divide(rho - a, root, out=np.full(rho.shape, np.inf), where=root > 0.0)
        )
        out = np.where((rho > rho0) & (rho <= rho1), k, out)
    return np.where(rho <= 0.0, 0.0, out)


def drop_cutter(points: Floats, corners: Floats, pieces: Floats, lowest: float) -> Floats:
    """Return the height (n,) of the tip over plan points (n, 2) when it touches triangles (t, 3, 3), at least `lowest`."""
    out = np.full(len(points), lowest)
    for k, point in enumerate(points):
        out[k] = max(
            [
                lowest,
                _vertex_drop(point, corners, pieces),
                _edge_drop(point, corners, pieces),
                _facet_drop(point, corners, pieces),
            ]
        )
    return out


def _vertex_drop(point: Floats, corners: Floats, pieces: Floats) -> float:
    """Return the greatest height of the tip on any corner of triangles (t, 3, 3)."""
    flat = corners.reshape(-1, 3)
    return float(
        (
            flat[:, 2] - height_at(pieces, np.hypot(flat[:, 0] - point[0], flat[:, 1] - point[1]))
        ).max(initial=-np.inf)
    )


def _facet_drop(point: Floats, corners: Floats, pieces: Floats) -> float:
    """Return the greatest height of the tip where it touches a triangle's plane inside the triangle;
    vertical triangles have no such position."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    up = normal[:, 2] != 0.0
    a, b, c, normal = a[up], b[up], c[up], normal[up]
    gradient = -normal[:, :2] / normal[:, 2:]
    steep = np.hypot(gradient[:, 0], gradient[:, 1])
    # The lower side touches a plane where it is as steep.
    low, high = np.zeros(len(a)), np.full(len(a), pieces[-1, RHO1])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = slope_at(pieces, middle) < steep
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    rho = np.where(steep > 0.0, high, 0.0)
    uphill = np.divide(
        gradient, steep[:, None], out=np.zeros_like(gradient), where=steep[:, None] > 0.0
    )
    contact = point + rho[:, None] * uphill
    inside = _contains(contact, a, b, c)
    z = a[:, 2] + ((contact - a[:, :2]) * gradient).sum(axis=1) - height_at(pieces, rho)
    return float(z[inside].max(initial=-np.inf))


def _contains(point: Floats, a: Floats, b: Floats, c: Floats) -> Bools:
    """Return whether plan points (t, 2) lie inside triangles a, b, c (t, 3), whichever way these turn."""
    sides = np.stack(
        [
            (q[:, 0] - p[:, 0]) * (point[:, 1] - p[:, 1])
            - (q[:, 1] - p[:, 1]) * (point[:, 0] - p[:, 0])
            for p, q in ((a, b), (b, c), (c, a))
        ]
    )
    return np.asarray((sides >= 0.0).all(axis=0) | (sides <= 0.0).all(axis=0))


def _edge_drop(point: Floats, corners: Floats, pieces: Floats) -> float:
    """Return the greatest height of the tip on any edge of triangles (t, 3, 3).

    Along an edge the tip's height is concave: bisection on the sign of its slope, rise - g'(rho) u
    / rho.
    """
    start, end = corners.reshape(-1, 3), corners[:, [1, 2, 0]].reshape(-1, 3)
    run = end - start
    length = np.hypot(run[:, 0], run[:, 1])
    # Foot of the axis on the edge's line, distance beside it, and the stretch under the cutter.
    some = length > 0.0
    start, run, length = start[some], run[some], length[some]
    along, rise = run[:, :2] / length[:, None], run[:, 2] / length
    away = start[:, :2] - point
    foot = -(away * along).sum(axis=1)
    lateral = np.abs(away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0])
    reach = np.sqrt(np.clip(pieces[-1, RHO1] ** 2 - lateral**2, 0.0, None))
    low, high = np.maximum(-foot, -reach), np.minimum(length - foot, reach)
    meets = (lateral <= pieces[-1, RHO1]) & (low <= high)
    start, foot, lateral, rise, low, high = (
        v[meets] for v in (start, foot, lateral, rise, low, high)
    )
    # u runs along the edge from the foot of the axis; the tip's height, z(u) - g(sqrt(beside^2 +
    # u^2)), is concave in it.
    for _ in range(HALVINGS):
        u = 0.5 * (low + high)
        rho = np.hypot(lateral, u)
        share = np.divide(u, rho, out=np.zeros_like(u), where=rho > 0.0)
        slope = np.multiply(slope_at(pieces, rho), share, out=np.zeros_like(u), where=share != 0.0)
        low, high = np.where(slope < rise, u, low), np.where(slope < rise, high, u)
    # Both ends of the last bracket: the better is attained and exact to rounding.
    best = np.full(len(start), -np.inf)
    for u in (low, high):
        best = np.maximum(
            best,
            start[:, 2]
            + rise * (foot + u)
            - height_at(pieces, np.minimum(np.hypot(lateral, u), pieces[-1, RHO1])),
        )
    return float(best.max(initial=-np.inf))
