"""A line above the messages: words that a message must hold, and how grave it must be at least."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QWidget

from trunnion.findings import Finding, Severity
from trunnion_gui.form import ChoiceField
from trunnion_gui.i18n import tr

GRAVEST_FIRST = (Severity.ERROR, Severity.WARNING, Severity.REMARK, Severity.INFO)


class MessageFilter(QWidget):
    """Which findings are shown: all of the words somewhere in text, place, remedy or code, and a severity or a graver one."""

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.words = QLineEdit()
        self.words.setObjectName("messageFilter")
        self.words.setPlaceholderText(tr("Filter by words, operation, feature or code"))
        self.words.setClearButtonEnabled(True)
        self.severity = ChoiceField()
        for label, least in (
            (tr("All messages"), Severity.INFO),
            (tr("Remarks and graver"), Severity.REMARK),
            (tr("Warnings and errors"), Severity.WARNING),
            (tr("Errors only"), Severity.ERROR),
        ):
            self.severity.addItem(label, least.value)
        self.count = QLabel()
        self.count.setObjectName("muted")
        line = QHBoxLayout(self)
        line.setContentsMargins(0, 4, 0, 4)
        line.addWidget(self.words, 1)
        line.addWidget(self.severity)
        line.addWidget(self.count)
        self.words.textChanged.connect(lambda _: self.changed.emit())
        self.severity.currentIndexChanged.connect(lambda _: self.changed.emit())

    def lets_through(self, finding: Finding) -> bool:
        """Return whether a finding is shown."""
        least = GRAVEST_FIRST.index(Severity(self.severity.currentData()))
        if GRAVEST_FIRST.index(finding.severity) > least:
            return False
        held = " ".join((finding.text, *finding.where, finding.remedy, finding.code)).lower()
        return all(word in held for word in self.words.text().lower().split())

    def show_count(self, shown: int, all: int) -> None:
        """Say how many of all messages are shown, where some are not."""
        self.count.setText(
            "" if shown == all else tr("{shown} of {all}").format(shown=shown, all=all)
        )
