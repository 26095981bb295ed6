"""How surfaces bend: principal curvatures from first and second derivatives. No CAD."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, floats


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceCurvature:
    """How one face bends, in 1/mm, above 0 where it bulges out of the material and below where it is hollow.

    spread (k, 2) the lesser and the greater principal curvature at positions spread over the trimmed face; least and most the extremes of
    all of it.
    """

    spread: Floats
    least: float
    most: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "spread", floats(self.spread, (None, 2), "principal curvatures"))


def principal_curvatures(du: Floats, dv: Floats, duu: Floats, duv: Floats, dvv: Floats) -> Floats:
    """Return the lesser and the greater principal curvature (k, 2), 1/mm, above 0 where the surface bulges to the side of du x dv.

    From the first and second derivatives (k, 3) of points by the two parameters. NaN where the surface has no tangent plane.

    >>> rows = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    >>> principal_curvatures(*(np.array([row]) for row in rows)).tolist()
    [[0.0, 0.5]]
    """
    e, f, g = _dot(du, du), _dot(du, dv), _dot(dv, dv)
    normal = np.cross(du, dv)
    size = np.sqrt(_dot(normal, normal))
    with np.errstate(divide="ignore", invalid="ignore"):
        l, m, n = (-_dot(normal, second) / size for second in (duu, duv, dvv))
        mean = 0.5 * (e * n - 2.0 * f * m + g * l) / size**2
        product = (l * n - m * m) / size**2
    half = np.sqrt(np.maximum(mean * mean - product, 0.0))
    return np.column_stack([mean - half, mean + half])


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("ij,ij->i", a, b))
