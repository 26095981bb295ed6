"""The part: its triangles, each face in the colour it is given, and the edges between faces."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista as pv

from trunnion.geometry.mesh import Mesh
from trunnion_gui.colours import Theme, rgb


class PartLayer:
    """Draws one mesh; `paint` and `outline` change colours without making anything anew."""

    def __init__(self, view: Any, mesh: Mesh, theme: Theme) -> None:
        self._view = view
        self._mesh = mesh
        self._surface = _surface(mesh)
        self._surface.cell_data["rgb"] = np.tile(np.array(rgb(theme.part), np.uint8), (len(mesh.triangles), 1))
        self.actor = view.add_mesh(self._surface, scalars="rgb", rgb=True, name="part", smooth_shading=False, ambient=0.38, diffuse=0.68,
                                   specular=0.12, specular_power=12, show_scalar_bar=False, reset_camera=False)
        self.actor.prop.interpolation = "Phong"
        self._ends, self._edge_faces = border_edges(mesh)
        self._edges = view.add_mesh(_lines(mesh.points, self._ends), color=theme.edge, line_width=1.2, opacity=0.55, name="edges",
                                    pickable=False, reset_camera=False, lighting=False, show_scalar_bar=False)
        _pull_forward(self._edges)

    def paint(self, colours: np.ndarray) -> None:
        """Colour every face; `colours` (n + 1, 3) uint8 by face tag."""
        self._surface.cell_data["rgb"][:] = colours[self._mesh.face]
        self._surface.GetCellData().GetArray("rgb").Modified()
        self._surface.Modified()

    def outline(self, name: str, faces: Iterable[int], colour: str, width: float) -> None:
        """Draw a line around some faces, or none."""
        chosen = np.isin(self._edge_faces, np.fromiter(faces, int))
        if not chosen.any():
            self._view.remove_actor(name, render=False)
            return
        actor = self._view.add_mesh(_lines(self._mesh.points, self._ends[chosen]), color=colour, line_width=width, name=name,
                                    pickable=False, reset_camera=False, lighting=False, render_lines_as_tubes=False, show_scalar_bar=False)
        _pull_forward(actor, 6.0)


def border_edges(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges around the faces (e, 2) as rows of points, and the tag of the face each belongs to (e,).

    Points are shared inside a face and not across faces, so an edge of one triangle only is a face's border.
    """
    pairs = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    owner = np.tile(mesh.face, 3)
    ordered = np.sort(pairs, axis=1)
    _, first, count = np.unique(ordered[:, 0] * len(mesh.points) + ordered[:, 1], return_index=True, return_counts=True)
    rows = first[count == 1]
    return pairs[rows], owner[rows]


def _surface(mesh: Mesh) -> pv.PolyData:
    cells = np.hstack([np.full((len(mesh.triangles), 1), 3), mesh.triangles])
    surface = pv.PolyData(np.asarray(mesh.points, dtype=np.float32), cells.ravel())
    surface.point_data["Normals"] = normals_of(mesh)
    surface.GetPointData().SetActiveNormals("Normals")
    return surface


def normals_of(mesh: Mesh) -> np.ndarray:
    """Return the normal at every point (v, 3), smooth inside a face and sharp across its border."""
    a, b, c = np.moveaxis(mesh.corners(), 1, 0)
    across = np.cross(b - a, c - a)
    n, rows = len(mesh.points), mesh.triangles.T.ravel()
    total = np.stack([np.bincount(rows, weights=np.tile(across[:, k], 3), minlength=n) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.zeros_like(total), where=length > 0).astype(np.float32)


def _lines(points: np.ndarray, ends: np.ndarray) -> pv.PolyData:
    lines = np.hstack([np.full((len(ends), 1), 2), ends])
    return pv.PolyData(np.asarray(points, dtype=np.float32), lines=lines.ravel())


def _pull_forward(actor: Any, by: float = 3.0) -> None:
    """Draw lines in front of the surface they lie on."""
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -by)
