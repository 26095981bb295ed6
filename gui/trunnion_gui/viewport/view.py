"""The widget that VTK draws in: pyvistaqt's where there is a screen, VTK's own EGL window painted into a widget where there is none.

Qt's `offscreen` platform has no OpenGL, so that tests and pictures need the second one. Both answer the same calls: the plotter's
methods, `renderer`, `render_window`, `render()`.
"""

from __future__ import annotations

import os
import sys
from typing import Any

import numpy as np
from PySide6.QtCore import QRect, QSize, Qt, QTimer
from PySide6.QtGui import (
    QGuiApplication,
    QImage,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget


def make_view(parent: QWidget | None = None) -> Any:
    """Return a new view for the platform that runs."""
    if QGuiApplication.platformName() == "offscreen":
        return PaintedView(parent)
    from trunnion_gui.viewport.screen import ScreenView

    return ScreenView(parent)


class PaintedView(QWidget):
    """A pyvista plotter in a plain widget: VTK draws off screen, the picture is painted, Qt's mouse goes to VTK's interactor."""

    _PRESSES = {
        Qt.MouseButton.LeftButton: "LeftButtonPressEvent",
        Qt.MouseButton.RightButton: "RightButtonPressEvent",
        Qt.MouseButton.MiddleButton: "MiddleButtonPressEvent",
    }

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        if sys.platform.startswith("linux"):
            os.environ.setdefault(
                "VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow"
            )  # else VTK tries X first, and warns
        import pyvista as pv
        from pyvista.plotting.render_window_interactor import RenderWindowInteractor
        from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor

        self._is_stale = True
        self._due = QTimer(self)
        self._due.setSingleShot(True)
        self._due.setInterval(0)
        self._due.timeout.connect(self.update)
        self._picture: QImage | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.WheelFocus)
        self._plotter = pv.Plotter(off_screen=True)
        self._plotter.render_window.SetMultiSamples(0)
        self._interactor = vtkGenericRenderWindowInteractor()
        self._interactor.SetRenderWindow(self._plotter.render_window)
        self._plotter.iren = RenderWindowInteractor(self._plotter, interactor=self._interactor)
        self._plotter.iren.initialize()
        self._plotter.enable_trackball_style()
        self._plotter.view_isometric()  # as pyvistaqt does; without it the camera jumps at the second click

    def __getattr__(self, name: str) -> Any:
        plotter = self.__dict__.get("_plotter")
        if plotter is None:
            raise AttributeError(name)
        return getattr(plotter, name)

    def sizeHint(self) -> QSize:
        return QSize(400, 400)

    def render(self, *_: Any) -> None:
        """Draw when the event loop is back, once however often it was called; hides `QWidget.render`, as pyvistaqt's view does."""
        self._is_stale = True
        self._due.start()

    def grab(self, rectangle: QRect | None = None) -> QPixmap:
        """Return the picture with all that was changed so far."""
        self._due.stop()
        return super().grab() if rectangle is None else super().grab(rectangle)

    def resizeEvent(self, event: QResizeEvent) -> None:
        width, height = self._pixels()
        self._plotter.render_window.SetSize(width, height)
        self._interactor.UpdateSize(width, height)
        self._is_stale = True

    def paintEvent(self, event: QPaintEvent) -> None:
        # A label above the picture that is painted anew does not draw the picture before its turn.
        if self._picture is None or (self._is_stale and not self._due.isActive()):
            self._is_stale, self._picture = False, self._drawn()
        painter = QPainter(self)
        painter.drawImage(self.rect(), self._picture)
        painter.end()

    def _drawn(self) -> QImage:
        """Return VTK's picture; drawn only when something in it changed, not when a label above it did."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

        window = self._plotter.render_window
        window.Render()
        width, height = window.GetSize()
        pixels = vtkUnsignedCharArray()
        window.GetPixelData(0, 0, width - 1, height - 1, 1, pixels, 0)
        image = np.ascontiguousarray(vtk_to_numpy(pixels).reshape(height, width, 3)[::-1])
        return QImage(image.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._report(event)
        if event.button() in self._PRESSES:
            getattr(self._interactor, self._PRESSES[event.button()])()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._report(event)
        if event.button() in self._PRESSES:
            getattr(self._interactor, self._PRESSES[event.button()].replace("Press", "Release"))()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self._report(event)
        if event.buttons() != Qt.MouseButton.NoButton:
            self._interactor.MouseMoveEvent()
            self.render()

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._report(event)
        (
            self._interactor.MouseWheelForwardEvent
            if event.angleDelta().y() > 0
            else self._interactor.MouseWheelBackwardEvent
        )()
        self.render()

    def close(self) -> bool:
        self._plotter.close()
        return super().close()

    def _pixels(self) -> tuple[int, int]:
        ratio = self.devicePixelRatioF()
        return max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))

    def _report(self, event: QMouseEvent | QWheelEvent) -> None:
        ratio, at, keys = self.devicePixelRatioF(), event.position(), event.modifiers()
        self._interactor.SetEventInformation(
            round(at.x() * ratio),
            round((self.height() - at.y() - 1) * ratio),
            bool(keys & Qt.KeyboardModifier.ControlModifier),
            bool(keys & Qt.KeyboardModifier.ShiftModifier),
            chr(0),
            0,
            None,
        )
