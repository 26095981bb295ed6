"""The stock as a closed mesh, at any moment: for the window, for pictures, for comparing volumes."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.mesh import Mesh
from trunnion.verify.kernels.stock import contouring, meshing
from trunnion.verify.stock.bundles import AXES, Bundle
from trunnion.verify.stock.field import Field, cells_along
from trunnion.verify.stock.stock import Stock

MOST = 200_000
"""Triangles that software rendering still turns smoothly."""
EVEN = 0.05
"""Blocks of cells of a height field become one patch when it stays this near to them, in cells."""
ROUGH = 0.25
"""The same, where there would be too many triangles otherwise."""
LEAST_CELLS = 2500
"""A field of fewer cells is not seen coarser."""
MOST_CELLS = 1_000_000
"""A field of more cells is seen in every second, third… row and column: a picture has no room for more."""
MOST_NODES = 30_000_000
"""As many nodes of a lattice are looked at, at most."""


def mesh_of(stock: Stock, most: int = MOST) -> Mesh:
    """Return the stock as a closed mesh in the blank's frame, its triangles anticlockwise from outside and all of face 0.

    At most `most` triangles: where there would be more, a field merges rougher patches and is seen in every second, fourth… row and
    column, bundles in every second, third… ray. Raises `BadInput` for a stock without rays along z.
    """
    points, triangles = (
        mesh_of_field(stock.field, most) if stock.field is not None else mesh_of_rays(stock, most)
    )
    return Mesh(points, triangles, np.zeros(len(triangles), np.int64))


def mesh_of_field(field: Field, most: int = MOST) -> tuple[Floats, Ints]:
    """Return points (v, 3) and triangles (t, 3) of a height field: walls upright, level areas merged."""
    every = max(1, math.ceil(math.sqrt(field.top.size / MOST_CELLS)))
    while True:
        top, pitch = (
            np.ascontiguousarray(field.top[every // 2 :: every, every // 2 :: every]),
            field.pitch * every,
        )
        for bound in (EVEN * pitch, ROUGH * pitch):
            points, triangles = meshing.mesh_zmap(top, *map(float, field.low), pitch, bound)
            if len(triangles) <= most or top.size < LEAST_CELLS:
                return points, triangles
        every *= 2


def mesh_of_rays(stock: Stock, most: int = MOST) -> tuple[Floats, Ints]:
    """Return points (v, 3) and triangles (t, 3) of three bundles by dual contouring: edges and corners stay sharp."""
    if "z" not in stock.rays:
        raise BadInput("stock: a mesh needs the rays along z")
    box = (stock.low, stock.high)
    none = Bundle.of(stock.blank, max(stock.high - stock.low), 0, box)
    bundles = [stock.rays.get(axis, none) for axis in AXES]
    firsts, lows, highs = zip(*(b.packed() for b in bundles), strict=True)
    has = np.array([axis in stock.rays for axis in AXES])
    cells, origin = (
        np.array(cells_along(stock.high - stock.low, stock.pitch)),
        np.asarray(stock.low, dtype=np.float64),
    )
    step = max(
        1, math.ceil((float(cells.prod()) / MOST_NODES) ** (1.0 / 3.0) - tolerance.PARAMETRIC)
    )
    n_points, n_faces = contouring.count_dual_mesh(
        firsts, lows, highs, cells, origin, stock.pitch, step
    )
    if 2 * n_faces > most:
        step = math.ceil(step * math.sqrt(2 * n_faces / most))
        n_points, n_faces = contouring.count_dual_mesh(
            firsts, lows, highs, cells, origin, stock.pitch, step
        )
    return contouring.dual_contour(
        firsts, lows, highs, has, cells, origin, stock.pitch, step, n_points, n_faces
    )
