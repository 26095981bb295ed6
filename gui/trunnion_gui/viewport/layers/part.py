"""The part: its triangles, each face in the colour it is given, and the edges between faces."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista as pv

from trunnion_gui.look.colours import Theme, rgb
from trunnion_gui.worker.drawing import DrawnMesh


class PartLayer:
    """Draws one mesh; `paint` and `outline` change colours without making anything anew."""

    def __init__(self, view: Any, drawing: DrawnMesh, theme: Theme) -> None:
        mesh = drawing.mesh
        self._view = view
        self._mesh = mesh
        self._surface = _surface(drawing)
        self._surface.cell_data["rgb"] = np.tile(
            np.array(rgb(theme.part), np.uint8), (len(mesh.triangles), 1)
        )
        self.actor = view.add_mesh(
            self._surface,
            scalars="rgb",
            rgb=True,
            name="part",
            smooth_shading=False,
            ambient=0.38,
            diffuse=0.68,
            specular=0.12,
            specular_power=12,
            show_scalar_bar=False,
            reset_camera=False,
        )
        self.actor.prop.interpolation = "Phong"
        self._ends, self._edge_faces = drawing.borders, drawing.owners
        self._edges = view.add_mesh(
            _lines(mesh.points, self._ends),
            color=theme.edge,
            line_width=1.2,
            opacity=0.55,
            name="edges",
            pickable=False,
            reset_camera=False,
            lighting=False,
            show_scalar_bar=False,
        )
        _pull_forward(self._edges)

    def paint(self, colours: np.ndarray) -> None:
        """Colour every face; `colours` (n + 1, 3) uint8 by face tag."""
        self._surface.cell_data["rgb"][:] = colours[self._mesh.face]
        self._surface.GetCellData().GetArray("rgb").Modified()
        self._surface.Modified()

    def on_face(self, tag: int, points: np.ndarray) -> np.ndarray:
        """Return the positions (k, 3) on a face that are nearest to points (k, 3)."""
        face = self._surface.extract_cells(np.flatnonzero(self._mesh.face == tag))
        if not face.n_cells or not len(points):
            return points
        _, near = face.find_closest_cell(points, return_closest_point=True)
        return np.asarray(near).reshape(-1, 3)

    def outline(self, name: str, faces: Iterable[int], colour: str, width: float) -> None:
        """Draw a line around some faces, or none."""
        is_selected = np.isin(self._edge_faces, np.fromiter(faces, int))
        if not is_selected.any():
            self._view.remove_actor(name, render=False)
            return
        actor = self._view.add_mesh(
            _lines(self._mesh.points, self._ends[is_selected]),
            color=colour,
            line_width=width,
            name=name,
            pickable=False,
            reset_camera=False,
            lighting=False,
            render_lines_as_tubes=False,
            show_scalar_bar=False,
        )
        _pull_forward(actor, 6.0)


def _surface(drawing: DrawnMesh) -> pv.PolyData:
    mesh = drawing.mesh
    cells = np.hstack([np.full((len(mesh.triangles), 1), 3), mesh.triangles])
    surface = pv.PolyData(np.asarray(mesh.points, dtype=np.float32), cells.ravel())
    surface.point_data["Normals"] = drawing.normals
    surface.GetPointData().SetActiveNormals("Normals")
    return surface


def _lines(points: np.ndarray, ends: np.ndarray) -> pv.PolyData:
    lines = np.hstack([np.full((len(ends), 1), 2), ends])
    return pv.PolyData(np.asarray(points, dtype=np.float32), lines=lines.ravel())


def _pull_forward(actor: Any, by: float = 3.0) -> None:
    """Draw lines in front of the surface they lie on."""
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -by)
