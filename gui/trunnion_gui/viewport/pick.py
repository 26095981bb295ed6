"""Which face lies under the mouse."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator
from vtkmodules.vtkRenderingCore import vtkCellPicker


class FacePicker:
    """Answers which face of the part a point of the view shows; a cell locator makes it take microseconds."""

    def __init__(self, actor: Any, faces: np.ndarray) -> None:
        """`actor` draws the part's triangles, `faces` (t,) are their tags."""
        self._faces = faces
        self._locator = (
            vtkStaticCellLocator()
        )  # built at the first question: nobody points while a part is being opened
        actor.mapper.Update()
        self._locator.SetDataSet(actor.mapper.GetInput())
        self._picker = vtkCellPicker()
        self._picker.AddLocator(self._locator)
        self._picker.SetTolerance(0.0)
        self._picker.InitializePickList()
        self._picker.AddPickList(actor)
        self._picker.PickFromListOn()

    def at(self, x: float, y: float, renderer: Any) -> int:
        """Return the tag of the face at a pixel (from the lower left corner), 0 beside the part."""
        self._picker.Pick(x, y, 0.0, renderer)
        cell = self._picker.GetCellId()
        return int(self._faces[cell]) if cell >= 0 else 0

    @property
    def point(self) -> tuple[float, float, float]:
        """Where the last pick met the part."""
        return self._picker.GetPickPosition()
