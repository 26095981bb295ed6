"""The curvatures of a trimmed face: at positions spread over it and along its edges, and the extremes, searched closer around the best."""

from __future__ import annotations

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.GeomAbs import GeomAbs_Cylinder, GeomAbs_Plane, GeomAbs_Sphere
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_IN, TopAbs_REVERSED
from OCP.TopoDS import TopoDS

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.surface.curvature import FaceCurvature, principal_curvatures
from trunnion.part.shape.evaluate import evaluator_of
from trunnion.part.topology.identity import Shape, edges_of

_GRID, _ALONG = 7, 17
"""Positions along either parameter, and along each edge."""
_ZOOM, _ZOOMS = 5, 4
"""How often the surroundings of the best position are looked at again, and with how many positions along either parameter."""
_SAME_EVERYWHERE = (GeomAbs_Plane, GeomAbs_Cylinder, GeomAbs_Sphere)


class _Bending:
    """The principal curvatures of one face, as it lies in the solid, at positions of its parameters."""

    def __init__(self, face: Shape) -> None:
        self.adaptor = BRepAdaptor_Surface(face)
        self._evaluate = evaluator_of(self.adaptor)
        self._hollow = face.Orientation() == TopAbs_REVERSED
        self._trim = BRepTopAdaptor_FClass2d(face, tolerance.COINCIDENT)

    def inside(self, uv: Floats) -> Bools:
        """Return which uv (k, 2) lie inside the trim."""
        return np.array(
            [self._trim.Perform(gp_Pnt2d(u, v)) == TopAbs_IN for u, v in uv.tolist()],
            dtype=bool,
        )

    def at(self, uv: Floats) -> Floats:
        """Return the lesser and the greater principal curvature (k, 2) at uv (k, 2)."""
        rows = self._evaluate(uv)
        bends = principal_curvatures(*(rows[:, n] for n in range(1, 6)))
        return -bends[:, ::-1] if self._hollow else bends

    def grid(self) -> tuple[Floats, Floats]:
        """Return positions in the middles of cells over the face's bounds, and a cell's size."""
        a = self.adaptor
        low = np.array([a.FirstUParameter(), a.FirstVParameter()])
        step = (np.array([a.LastUParameter(), a.LastVParameter()]) - low) / _GRID
        share = np.arange(_GRID) + 0.5
        return low + step * np.stack(np.meshgrid(share, share, indexing="ij"), axis=-1).reshape(
            -1, 2
        ), step


def bend_of(face: Shape) -> FaceCurvature:
    """Return how a face, as it lies in the solid, bends."""
    bending = _Bending(face)
    grid, step = bending.grid()
    if bending.adaptor.GetType() in _SAME_EVERYWHERE:
        spread = bending.at(grid[:1])
        return FaceCurvature(spread=spread, least=float(spread[0, 0]), most=float(spread[0, 1]))
    inside = grid[bending.inside(grid)]
    uv = np.vstack([inside, _along_edges(face)])
    bends = bending.at(uv)
    known = np.asarray(np.isfinite(bends).all(axis=1))
    if not known.any():
        return FaceCurvature(spread=np.zeros((0, 2)), least=0.0, most=0.0)
    within = bends[: len(inside)][known[: len(inside)]]
    least, most = _extremes(bending, uv[known], bends[known], step)
    return FaceCurvature(spread=within if len(within) else bends[known], least=least, most=most)


def _along_edges(shape: Shape) -> Floats:
    """Return positions along the edges of a face: surfaces often bend most where they end."""
    found = []
    for edge in edges_of(shape):
        curve = BRepAdaptor_Curve2d(edge, TopoDS.Face_s(shape))
        found += [
            curve.Value(t).Coord()
            for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), _ALONG).tolist()
        ]
    return np.array(found).reshape(-1, 2)


def _extremes(bending: _Bending, uv: Floats, bends: Floats, reach: Floats) -> tuple[float, float]:
    """Return the least and the greatest curvature at uv (k, 2) and around the best of them, in smaller and smaller steps."""
    best = np.array([-bends[:, 0].min(), bends[:, 1].max()])
    centre = uv[[int(bends[:, 0].argmin()), int(bends[:, 1].argmax())]]
    share = np.linspace(-1.0, 1.0, _ZOOM)
    around = np.stack(np.meshgrid(share, share, indexing="ij"), axis=-1).reshape(-1, 2)
    for _ in range(_ZOOMS):
        reach = reach / (_ZOOM - 1)
        here = centre[:, None] + around * reach
        found = bending.at(here.reshape(-1, 2)).reshape(2, -1, 2)
        for k, values in enumerate((-found[0, :, 0], found[1, :, 1])):
            # Only a better candidate is tested against the trim: that costs more than the curvature.
            better = np.flatnonzero(values > best[k])
            better = better[bending.inside(here[k, better])]
            if len(better):
                row = int(better[values[better].argmax()])
                best[k], centre[k] = values[row], here[k, row]
    return -float(best[0]), float(best[1])
