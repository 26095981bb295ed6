"""Where the docks stand round the picture: at first, as a person left them, and put back."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from PySide6.QtCore import QByteArray, Qt
from PySide6.QtWidgets import (
    QDockWidget,
    QMainWindow,
    QScrollArea,
    QTabBar,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from trunnion_gui.storage import preferences

LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
BELOW = Qt.DockWidgetArea.BottomDockWidgetArea
_LEFT_WIDTH = 344
_RIGHT_WIDTH = 380
_HEIGHTS = {"features": 420, "properties": 300}
_BELOW_HEIGHT = 170
_LEAST_WIDTHS = {LEFT: _LEFT_WIDTH, RIGHT: 260, BELOW: 200}
"""A dock is never narrower: names in the tables right stay readable. It is also all that a dock insists on, whatever stands in it: a long
line in one dock would else take its width from the others."""
_LEAST_CENTRE = 490
"""The bars below the picture fit into this; a window of 1280 pixels has it beside both columns."""


class Arrangement:
    """The docks of a window by name: `steps` left, `features` and `properties` right, `messages` below, others as tabs of these."""

    def __init__(self, window: QMainWindow) -> None:
        self._window = window
        self._docks: dict[str, QDockWidget] = {}
        self._first = QByteArray()
        for corner, side in (
            (Qt.Corner.BottomLeftCorner, LEFT),
            (Qt.Corner.BottomRightCorner, RIGHT),
        ):
            window.setCorner(corner, side)
        window.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, QTabWidget.TabPosition.North)

    def add(self, name: str, title: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        """Put a widget into a dock of its own."""
        dock = QDockWidget(title, self._window)
        dock.setObjectName(name)
        widget.setMinimumWidth(_LEAST_WIDTHS[area])
        dock.setWidget(widget)
        self._window.addDockWidget(area, dock)
        self._docks[name] = dock
        return dock

    def add_tabs(self, area: Qt.DockWidgetArea, *tabs: tuple[str, str, QWidget]) -> None:
        """Put widgets (name, title, widget) into docks behind each other, the first one in front."""
        docks = [self.add(name, title, widget, area) for name, title, widget in tabs]
        for before, dock in pairwise(docks):
            self._window.tabifyDockWidget(before, dock)
        for dock in docks:
            dock.setTitleBarWidget(QWidget())  # the tab is title enough, and can be dragged
        docks[0].raise_()

    def names(self) -> tuple[str, ...]:
        """Return the names of all docks."""
        return tuple(self._docks)

    def dock(self, name: str) -> QDockWidget:
        """Return a dock by its name."""
        return self._docks[name]

    def show(self, name: str) -> None:
        """Bring a dock to the front."""
        self._docks[name].show()
        self._docks[name].raise_()

    def begin(self) -> None:
        """Remember this as the first arrangement, then take up the one a person left."""
        middle = self._window.centralWidget()
        if middle is not None:
            middle.setMinimumWidth(_LEAST_CENTRE)
        self._size()
        self._first = self._window.saveState()
        geometry, state = preferences.arrangement("geometry"), preferences.arrangement("state")
        if geometry is not None:
            self._window.restoreGeometry(geometry)
        if state is not None:
            self._window.restoreState(state)

    def settle(self) -> None:
        """Put the docks right once the window is there: Qt forgets some sizes that were set before."""
        self._hide_old_tabs()
        if preferences.arrangement("state") is None:
            self._size()

    def keep(self) -> None:
        """Remember the arrangement for the next start."""
        preferences.remember("geometry", self._window.saveGeometry())
        preferences.remember("state", self._window.saveState())

    def forget(self) -> None:
        """Put docks back where they were at first."""
        self._window.restoreState(self._first)
        self._hide_old_tabs()

    def _size(self) -> None:
        def resize(sizes: dict[str, int], orientation: Qt.Orientation) -> None:
            self._window.resizeDocks(
                [self._docks[name] for name in sizes], list(sizes.values()), orientation
            )

        resize({"steps": _LEFT_WIDTH, "features": _RIGHT_WIDTH}, Qt.Orientation.Horizontal)
        resize(_HEIGHTS, Qt.Orientation.Vertical)
        resize({"messages": _BELOW_HEIGHT}, Qt.Orientation.Vertical)

    def _hide_old_tabs(self) -> None:
        """Hide the tab bars that Qt made while docks were put together and has no use for: they would show where docks move away."""
        bars = self._window.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly)
        titles = [{bar.tabText(n) for n in range(bar.count())} for bar in bars]
        for n, bar in enumerate(bars):
            if any(titles[n] <= later for later in titles[n + 1 :]):
                bar.hide()


def column(panels: Sequence[QWidget]) -> QScrollArea:
    """Return foldout panels one under the other, as far as they don't fit to be scrolled."""
    inside = QWidget()
    inside.setObjectName("steps")
    rows = QVBoxLayout(inside)
    rows.setContentsMargins(8, 2, 6, 8)
    rows.setSpacing(7)
    for panel in panels:
        rows.addWidget(panel)
    rows.addStretch(1)
    scroll = QScrollArea()
    scroll.setObjectName("stepsArea")
    scroll.setWidgetResizable(True)
    scroll.setFrameShape(QScrollArea.Shape.NoFrame)
    scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    scroll.setWidget(inside)
    return scroll
