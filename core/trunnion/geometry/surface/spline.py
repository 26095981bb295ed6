"""A B-spline surface as arrays, evaluated with its derivatives at many points at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, floats
from trunnion.geometry.kernels.spline_compiled import evaluate_surface_loop


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SplineSurface:
    """Knots along u and v, each as often as it counts; degrees; poles (m, n, 4) as x w, y w, z w, w;
    period (2,) along u and v, 0 for none."""

    knots_u: Floats
    knots_v: Floats
    degree_u: int
    degree_v: int
    poles: Floats
    period: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        m, n = len(self.knots_u) - self.degree_u - 1, len(self.knots_v) - self.degree_v - 1
        object.__setattr__(self, "knots_u", floats(self.knots_u, (None,), "spline knots along u"))
        object.__setattr__(self, "knots_v", floats(self.knots_v, (None,), "spline knots along v"))
        object.__setattr__(self, "poles", floats(self.poles, (m, n, 4), "spline poles"))

    def at(self, uv: Floats) -> Floats:
        """Return points and derivatives (k, 6, 3) at uv (k, 2): point, by u, by v, by u twice, by both, by v twice."""
        uv = np.array(uv, dtype=np.float64)
        for axis, (knots, degree, period) in enumerate(
            (
                (self.knots_u, self.degree_u, self.period[0]),
                (self.knots_v, self.degree_v, self.period[1]),
            )
        ):
            if period:
                low, high, t = knots[degree], knots[-degree - 1], uv[:, axis]
                uv[:, axis] = np.where((t < low) | (t > high), low + np.mod(t - low, period), t)
        out = np.empty((len(uv), 6, 3))
        evaluate_surface_loop(
            0,
            len(uv),
            uv,
            self.knots_u,
            self.knots_v,
            self.degree_u,
            self.degree_v,
            self.poles,
            out,
        )
        return out


def load_splines() -> None:
    """Load what evaluates splines: a part of a second, once in a process."""
    flat = SplineSurface(
        knots_u=np.array([0.0, 0.0, 1.0, 1.0]),
        knots_v=np.array([0.0, 0.0, 1.0, 1.0]),
        degree_u=1,
        degree_v=1,
        poles=np.ones((2, 2, 4)),
    )
    flat.at(np.zeros((1, 2)))
