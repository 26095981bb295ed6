"""The loop of `kernels.spline` compiled: only the degree + 1 basis functions that are not 0 at a
position, built up degree by degree (Cox, 1972; de Boor, 1972)."""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats


@njit(cache=True, nogil=True)
def _knot_span(knots: Floats, degree: int, t: float) -> int:
    """Return the knot span that holds t, by bisection; one of no length gives way to the one before
    it."""
    low, high = degree, len(knots) - degree - 1
    if t >= knots[high]:
        low = high - 1
    else:
        while high - low > 1:
            middle = (low + high) // 2
            if t < knots[middle]:
                high = middle
            else:
                low = middle
    while knots[low] == knots[low + 1]:
        low -= 1
    return low


@njit(cache=True, nogil=True)
def _basis_functions(
    knots: Floats, degree: int, t: float, span: int, low: Floats, out: Floats
) -> None:
    """Fill out (3, degree + 1) with the basis functions that are not 0 on a span and their first two
    derivatives; low, as large, is workspace.

    Invariant: after round d rows 0 to 2 hold the functions of degree d and their derivatives. A
    derivative follows from the product rule on the recursion: (x N)^(r) = x N^(r) + r x' N^(r-1), x
    linear in t.
    """
    for order in range(3):
        for k in range(degree + 1):
            out[order, k] = 0.0
            low[order, k] = 0.0
    out[0, 0] = 1.0
    for d in range(1, degree + 1):
        for order in range(3):
            for k in range(d):
                low[order, k] = out[order, k]
                out[order, k] = 0.0
            out[order, d] = 0.0
        for k in range(d):
            right, left = knots[span + 1 + k], knots[span + 1 + k - d]
            each = 1.0 / (right - left)
            # A function of degree d - 1 is shared by two of degree d: rising towards the right one,
            # falling towards the left one.
            rising, falling = (t - left) * each, (right - t) * each
            out[0, k + 1] += rising * low[0, k]
            out[0, k] += falling * low[0, k]
            for order in range(1, 3):
                out[order, k + 1] += rising * low[order, k] + order * each * low[order - 1, k]
                out[order, k] += falling * low[order, k] - order * each * low[order - 1, k]


@njit(cache=True, nogil=True)
def evaluate_surface_loop(
    first: int,
    last: int,
    uv: Floats,
    knots_u: Floats,
    knots_v: Floats,
    degree_u: int,
    degree_v: int,
    poles: Floats,
    out: Floats,
) -> None:
    """Fill out[first:last] (k, 6, 3) with points and derivatives at uv (k, 2); see
    `kernels.spline.evaluate_surface`."""
    along, across = np.zeros((3, degree_u + 1)), np.zeros((3, degree_v + 1))
    work = np.zeros((3, max(degree_u, degree_v) + 1))
    p = np.zeros((6, 4))
    for n in range(first, last):
        u, v = uv[n, 0], uv[n, 1]
        su, sv = _knot_span(knots_u, degree_u, u), _knot_span(knots_v, degree_v, v)
        _basis_functions(knots_u, degree_u, u, su, work, along)
        _basis_functions(knots_v, degree_v, v, sv, work, across)
        p[:] = 0.0
        # Tensor product: sums over v first, then over u, of the homogeneous coordinates A and w and
        # their derivatives.
        for i in range(degree_u + 1):
            for c in range(4):
                row0, row1, row2 = 0.0, 0.0, 0.0
                for j in range(degree_v + 1):
                    pole = poles[su - degree_u + i, sv - degree_v + j, c]
                    row0 += across[0, j] * pole
                    row1 += across[1, j] * pole
                    row2 += across[2, j] * pole
                p[0, c] += along[0, i] * row0
                p[1, c] += along[1, i] * row0
                p[2, c] += along[0, i] * row1
                p[3, c] += along[2, i] * row0
                p[4, c] += along[1, i] * row1
                p[5, c] += along[0, i] * row2
        w = p[0, 3]
        # Back from homogeneous coordinates by the quotient rule.
        for c in range(3):
            s = p[0, c] / w
            du, dv = (p[1, c] - p[1, 3] * s) / w, (p[2, c] - p[2, 3] * s) / w
            out[n, 0, c], out[n, 1, c], out[n, 2, c] = s, du, dv
            out[n, 3, c] = (p[3, c] - 2.0 * p[1, 3] * du - p[3, 3] * s) / w
            out[n, 4, c] = (p[4, c] - p[1, 3] * dv - p[2, 3] * du - p[4, 3] * s) / w
            out[n, 5, c] = (p[5, c] - 2.0 * p[2, 3] * dv - p[5, 3] * s) / w
