"""A foldout: a header with number, title, state and time, and a body below it that can be folded away."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme

STATES = {
    "empty": "empty",
    "stale": "stale",
    "running": "running",
    "done": "done",
    "problem": "problem",
}


class _Header(QFrame):
    clicked = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("foldoutHeader")
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self.rect().contains(
            event.position().toPoint()
        ):
            self.clicked.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Space, Qt.Key.Key_Return):
            self.clicked.emit()
        else:
            super().keyPressEvent(event)


class Foldout(QFrame):
    """A folded or open section. Its header never moves when a job ends: state and time have their own fixed places."""

    toggled = Signal(bool)
    makes: Callable[[], None] | None
    """Makes what stands in the body, once, when the body is opened first; None where all is there."""

    def __init__(
        self, title: str, number: int = 0, *, is_open: bool = False, is_group: bool = False
    ) -> None:
        super().__init__()
        self.setObjectName("settingsGroup" if is_group else "foldout")
        self._theme: Theme | None = None
        self.state = ""
        self._drawn: tuple[str, Theme | None] = ("", None)
        self.is_folded = not is_open
        self.makes = None
        self.header = _Header()
        self._arrow, self._state, self._words, self._time = QLabel(), QLabel(), QLabel(), QLabel()
        self.title = QLabel(title)
        self.body = QWidget()
        self.content = QVBoxLayout(self.body)
        self.content.setContentsMargins(
            2 if is_group else 12, 2, 2 if is_group else 12, 4 if is_group else 12
        )
        self.content.setSpacing(8)
        self._lay_header(number, is_group)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.header)
        column.addWidget(self.body)
        self.header.clicked.connect(lambda: self.fold(not self.is_folded))
        self.body.setVisible(is_open)

    def fold(self, folded: bool) -> None:
        """Fold the body away, or open it."""
        if not folded:
            self.make_body()
        self.is_folded = folded
        self.body.setVisible(not folded)
        self._draw_arrow()
        self.toggled.emit(not folded)

    def make_body(self) -> None:
        """Make what stands in the body where `makes` is left for that; done when the body is opened first."""
        makes, self.makes = self.makes, None
        if makes is not None:
            makes()

    def show_state(self, state: str, seconds: str) -> None:
        """Show a state (a key of `STATES`) and the time it took."""
        self._time.setText(seconds)
        is_news = (state, self._theme) != self._drawn
        self.state, self._drawn = state, (state, self._theme)
        if self._theme is not None and is_news:
            colours = {
                "empty": self._theme.muted,
                "stale": self._theme.warning,
                "running": self._theme.accent,
                "done": self._theme.good,
                "problem": self._theme.bad,
            }
            self._state.setPixmap(icons.pixmap(state, 14, colours[state]))
            self._words.setText(tr(STATES[state]))
            self._words.setStyleSheet(f"color: {colours[state]}; font-size: 12px")

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self._draw_arrow()
        if self.state:
            self.show_state(self.state, self._time.text())

    def _lay_header(self, number: int, is_group: bool) -> None:
        row = QHBoxLayout(self.header)
        row.setContentsMargins(
            2 if is_group else 10, 4 if is_group else 9, 2 if is_group else 12, 4 if is_group else 9
        )
        row.setSpacing(7)
        self._arrow.setFixedWidth(16)
        row.addWidget(self._arrow)
        if number:
            label = QLabel(str(number))
            label.setObjectName("number")
            row.addWidget(label)
        self.title.setObjectName("muted" if is_group else "")
        if not is_group:
            self.title.setStyleSheet("font-weight: 600")
        row.addWidget(self.title)
        row.addStretch(1)
        self._time.setObjectName("muted")
        self._time.setStyleSheet("font-size: 12px")
        for widget in (self._time, self._state, self._words):
            row.addWidget(widget)
        if is_group:
            for widget in (self._time, self._state, self._words):
                widget.hide()
        else:
            self._words.setFixedWidth(52)
            self._state.setFixedWidth(15)

    def _draw_arrow(self) -> None:
        self._arrow.setPixmap(
            icons.pixmap(
                "forward" if self.is_folded else "down",
                16,
                self._theme.muted if self._theme else "",
            )
        )
