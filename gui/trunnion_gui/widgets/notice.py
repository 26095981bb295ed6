"""A message above the picture that says what happened and what to do. Never modal."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout

from trunnion.findings import Finding, Severity
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.words import message_sentence
from trunnion_gui.widgets.layout import empty

_SIDES = {Severity.ERROR: "error", Severity.WARNING: "warning"}


class Notice(QFrame):
    """One message at a time, with at most two things to do about it."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("notice")
        self._text, self._remedy = QLabel(), QLabel()
        self._text.setWordWrap(True)
        self._text.setStyleSheet("font-weight: 600")
        self._remedy.setWordWrap(True)
        self._remedy.setObjectName("muted")
        words = QVBoxLayout()
        words.setSpacing(2)
        words.addWidget(self._text)
        words.addWidget(self._remedy)
        self._actions = QHBoxLayout()
        self.close_button = QToolButton()
        self.close_button.setToolTip(tr("Close this message"))
        self.close_button.clicked.connect(self.hide)
        row = QHBoxLayout(self)
        row.setContentsMargins(14, 9, 8, 9)
        row.addLayout(words, 1)
        row.addLayout(self._actions)
        row.addWidget(self.close_button)
        self.hide()

    @property
    def text(self) -> str:
        """What the message says."""
        return self._text.text()

    @property
    def remedy(self) -> str:
        """What it says to do, or what became of the work."""
        return self._remedy.text()

    def show_finding(
        self, finding: Finding, actions: dict[str, Callable[[], None]] | None = None
    ) -> None:
        """Show a finding with buttons for what can be done."""
        self.setProperty("severity", _SIDES.get(finding.severity, "info"))
        self.style().unpolish(self)
        self.style().polish(self)
        self.close_button.setIcon(icons.icon("close"))
        self._text.setText(message_sentence(finding.text))
        self._remedy.setText(message_sentence(finding.remedy))
        self._remedy.setVisible(bool(finding.remedy))
        empty(self._actions)
        for words, action in (actions or {}).items():
            button = QPushButton(words)
            button.clicked.connect(self.hide)
            button.clicked.connect(lambda _=False, act=action: act())
            self._actions.addWidget(button)
        self.show()
