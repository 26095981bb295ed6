"""The stock while it is being cut: what was cut looks like bare metal, the blank's own surface is duller."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray

from trunnion.model.playback import Moment
from trunnion_gui.look.colours import Theme, rgb, stock_colours


def draw_stock(view: Any, moment: Moment | None, theme: Theme) -> None:
    """Show the stock at a moment, or none."""
    if moment is None:
        view.remove_actor("stock", render=False)
        return
    palette = np.array([rgb(c) for c in stock_colours(theme)], np.uint8)
    surface = surface_of(moment.points, moment.triangles, palette[moment.fresh.astype(np.int8)])
    actor = view.actors.get("stock")
    if actor is not None:
        actor.mapper.SetInputData(surface)
        return
    actor = view.add_mesh(
        surface,
        scalars="rgb",
        rgb=True,
        name="stock",
        pickable=False,
        reset_camera=False,
        show_scalar_bar=False,
        ambient=0.30,
        diffuse=0.74,
        specular=0.10,
        specular_power=16,
        copy_mesh=False,
    )
    actor.prop.interpolation = "Flat"


def surface_of(points: np.ndarray, triangles: np.ndarray, colours: np.ndarray) -> pv.PolyData:
    """Return triangles (t, 3) with a colour each (t, 3) uint8; the arrays are taken over, not copied where they fit."""
    n = len(triangles)
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, 3 * n + 1, 3, dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True),
    )
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float32), deep=True))
    surface = pv.PolyData()
    surface.SetPoints(vtk_points)
    surface.SetPolys(cells)
    shown = numpy_to_vtk(np.ascontiguousarray(colours), deep=True)
    shown.SetName("rgb")
    surface.GetCellData().SetScalars(shown)
    return surface
