"""Points and derivatives of rational B-spline surfaces (NURBS) by the recursive definition of the
basis functions. Plain reference.

Cox and de Boor's recursion (Piegl and Tiller, The NURBS Book, 1997, 2.2). A surface is two rows of
knots, each as often as it counts, two degrees, and poles (m, n, 4) with weights: x w, y w, z w, w.
What comes back for a position (u, v) is (6, 3): the point S, its derivatives S_u, S_v, S_uu, S_uv,
S_vv. A position beyond the knots is on the continued first or last piece.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats


def evaluate_surface(
    uv: Floats, knots_u: Floats, knots_v: Floats, degree_u: int, degree_v: int, poles: Floats
) -> Floats:
    """Return points and derivatives (k, 6, 3) at uv (k, 2), in mm and mm per unit of the
    parameters.

    With A = w S the quotient rule gives S_u = (A_u - w_u S) / w, S_uu = (A_uu - 2 w_u S_u - w_uu S)
    / w, S_uv = (A_uv - w_u S_v - w_v S_u - w_uv S) / w (The NURBS Book, 4.5).
    """
    out = np.empty((len(uv), 6, 3))
    for k, (u, v) in enumerate(uv):
        along = [_basis_functions(knots_u, degree_u, u, order) for order in range(3)]
        across = [_basis_functions(knots_v, degree_v, v, order) for order in range(3)]
        # Tensor product in homogeneous coordinates: A and w with the derivatives that are asked
        # for.
        p, pu, pv, puu, puv, pvv = (
            np.einsum("i,j,ijc->c", along[i], across[j], poles)
            for i, j in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        )
        # Back by the quotient rule.
        w, s = p[3], p[:3] / p[3]
        su, sv = (pu[:3] - pu[3] * s) / w, (pv[:3] - pv[3] * s) / w
        out[k] = (
            s,
            su,
            sv,
            (puu[:3] - 2.0 * pu[3] * su - puu[3] * s) / w,
            (puv[:3] - pu[3] * sv - pv[3] * su - puv[3] * s) / w,
            (pvv[:3] - 2.0 * pv[3] * sv - pvv[3] * s) / w,
        )
    return out


def knot_span(knots: Floats, degree: int, t: float) -> int:
    """Return the knot span that holds a parameter: the last one of positive length that begins at or
    before it, held to the surface's own."""
    last = len(knots) - degree - 2
    span = int(np.clip(np.searchsorted(knots, t, side="right") - 1, degree, last))
    while knots[span] == knots[span + 1]:
        span -= 1
    return span


def _basis_functions(knots: Floats, degree: int, t: float, order: int) -> Floats:
    """Return a derivative, of order 0 to 2, of all basis functions of a degree at t, by the
    polynomials of the span that holds t."""
    span = knot_span(knots, degree, t)
    return np.array(
        [_basis_function(knots, i, degree, span, t, order) for i in range(len(knots) - degree - 1)]
    )


def _basis_function(knots: Floats, i: int, degree: int, span: int, t: float, order: int) -> float:
    """Return a derivative of basis function i of a degree at t.

    N_i,p = (t - t_i) / (t_i+p - t_i) N_i,p-1 + (t_i+p+1 - t) / (t_i+p+1 - t_i+1) N_i+1,p-1, its
    derivative p (N_i,p-1 / (t_i+p - t_i) - N_i+1,p-1 / (t_i+p+1 - t_i+1)); a quotient over no
    length is 0.
    """
    if degree == 0:
        return float(i == span and order == 0)
    total = 0.0
    # Both terms of the recursion: basis function, sign of its derivative, linear factor, length of
    # its support.
    for k, sign, from_, run in (
        (i, 1.0, t - knots[i], knots[i + degree] - knots[i]),
        (i + 1, -1.0, knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1]),
    ):
        if run > 0.0:
            share = (
                sign * degree * _basis_function(knots, k, degree - 1, span, t, order - 1)
                if order
                else (from_ * _basis_function(knots, k, degree - 1, span, t, 0))
            )
            total += share / run
    return total
