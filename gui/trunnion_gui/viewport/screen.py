"""The view on a real screen: pyvistaqt's widget, drawn once for all that changed in one turn of the event loop."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor


class ScreenView(QtInteractor):
    """A pyvistaqt view whose `render()` draws soon, as a widget's `update()` does.

    A step changes several layers at once. A software renderer takes 50 to 200 ms a frame, so drawing after each change would hold the
    window for as many frames as there are changes.
    """

    _due: QTimer | None = None

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent, auto_update=False)
        self._due = QTimer(self)
        self._due.setSingleShot(True)
        self._due.setInterval(0)
        self._due.timeout.connect(self._draw)
        if "llvmpipe" in str(self.render_window.ReportCapabilities()):
            # Multisampling makes a software renderer five times slower.
            self.render_window.SetMultiSamples(0)

    def render(self) -> None:
        """Draw when the event loop is back, once however often it was called."""
        if self._due is not None:
            self._due.start()

    def close(self) -> None:
        """Let VTK go, and pyvistaqt's wrapper of Qt's surface with it.

        Qt deletes the surface with the widget. PySide isn't told, as a surface is no QObject, and takes the next object at its address for
        it as long as the wrapper lives: an action without `triggered`, or a crash.
        """
        super().close()
        self._forget_context()

    def paintEvent(self, event: QPaintEvent) -> None:
        # What lies above the view and is painted anew does not draw it before its turn.
        if self._due is None or not self._due.isActive():
            super().paintEvent(event)

    def _draw(self) -> None:
        super().render()
