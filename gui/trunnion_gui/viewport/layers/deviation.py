"""The deviation map on the part: gouges in one family of colours, material left in another, what is finished neutral."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk

from trunnion_gui.viewport.layers.stock import surface_of
from trunnion_gui.viewport.pick import FacePicker
from trunnion_gui.worker.drawing import DrawnMap


class DeviationLayer:
    """Draws one map and answers what it says at a pixel."""

    def __init__(self, view: Any, drawn: DrawnMap) -> None:
        self._map = shown = drawn.map
        surface = surface_of(
            shown.points, shown.triangles, np.zeros((len(shown.triangles), 3), np.uint8)
        )
        surface.GetCellData().Initialize()
        painted = numpy_to_vtk(drawn.colours, deep=True)
        painted.SetName("rgb")
        surface.GetPointData().SetScalars(painted)
        surface.GetPointData().SetNormals(numpy_to_vtk(drawn.normals, deep=True))
        self.actor = view.add_mesh(
            surface,
            scalars="rgb",
            rgb=True,
            name="deviation",
            reset_camera=False,
            show_scalar_bar=False,
            ambient=0.42,
            diffuse=0.62,
            specular=0.05,
            copy_mesh=False,
        )
        self.actor.prop.interpolation = "Phong"
        self._picker: FacePicker | None = None

    def at(
        self, x: float, y: float, renderer: Any
    ) -> tuple[int, float, tuple[float, float, float]] | None:
        """Return face tag, deviation in mm and place at a pixel (from the lower left corner); None beside the part."""
        if self._picker is None:
            self._picker = FacePicker(self.actor, np.arange(1, len(self._map.triangles) + 1))
        row = self._picker.at(x, y, renderer) - 1
        if row < 0:
            return None
        position = self._picker.point
        corners = self._map.triangles[row]
        away = np.linalg.norm(self._map.points[corners] - np.asarray(position), axis=1)
        return int(self._map.face[row]), float(self._map.value[corners[np.argmin(away)]]), position
