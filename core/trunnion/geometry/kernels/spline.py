"""Points and derivatives of B-spline surfaces, the plain way: the recursive definition of the base functions, place by place.

A surface is two rows of knots, each as often as it counts, two degrees, and poles (m, n, 4) with weights: x w, y w, z w, w. What comes
back for a place is (6, 3): the point, its derivatives by u and v, and the second ones by u twice, by both, by v twice. A place beyond the
knots is on the continued first or last piece.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats


def surface_at(places: Floats, knots_u: Floats, knots_v: Floats, degree_u: int, degree_v: int, poles: Floats) -> Floats:
    """Return points and derivatives (k, 6, 3) at places (k, 2)."""
    out = np.empty((len(places), 6, 3))
    for k, (u, v) in enumerate(places):
        along = [_bases(knots_u, degree_u, u, order) for order in range(3)]
        across = [_bases(knots_v, degree_v, v, order) for order in range(3)]
        p, pu, pv, puu, puv, pvv = (np.einsum("i,j,ijc->c", along[i], across[j], poles)
                                    for i, j in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))
        w, s = p[3], p[:3] / p[3]
        su, sv = (pu[:3] - pu[3] * s) / w, (pv[:3] - pv[3] * s) / w
        out[k] = (s, su, sv, (puu[:3] - 2.0 * pu[3] * su - puu[3] * s) / w, (puv[:3] - pu[3] * sv - pv[3] * su - puv[3] * s) / w,
                  (pvv[:3] - 2.0 * pv[3] * sv - pvv[3] * s) / w)
    return out


def span_of(knots: Floats, degree: int, t: float) -> int:
    """Return which piece between two knots holds a parameter: the last one at or before it that has a length."""
    last = len(knots) - degree - 2
    span = int(np.clip(np.searchsorted(knots, t, side="right") - 1, degree, last))
    while knots[span] == knots[span + 1]:
        span -= 1
    return span


def _bases(knots: Floats, degree: int, t: float, order: int) -> Floats:
    """Return a derivative of all base functions of a degree at t, on the piece that holds t."""
    span = span_of(knots, degree, t)
    return np.array([_base(knots, i, degree, span, t, order) for i in range(len(knots) - degree - 1)])


def _base(knots: Floats, i: int, degree: int, span: int, t: float, order: int) -> float:
    if degree == 0:
        return float(i == span and order == 0)
    total = 0.0
    for k, sign, from_, run in ((i, 1.0, t - knots[i], knots[i + degree] - knots[i]),
                                (i + 1, -1.0, knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1])):
        if run > 0.0:
            share = sign * degree * _base(knots, k, degree - 1, span, t, order - 1) if order else (
                from_ * _base(knots, k, degree - 1, span, t, 0))
            total += share / run
    return total
