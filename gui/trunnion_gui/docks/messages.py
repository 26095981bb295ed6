"""What a person should know: findings of the steps, and what happened to the program itself. A click goes to what a line names."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QGuiApplication, QKeySequence, QResizeEvent, QShortcut, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QMenu,
    QTableWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from trunnion.findings import Finding, Fix, Severity
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.message_filter import GRAVEST_FIRST, MessageFilter

_MOST_NOTICES = 20
_MOST_WRAPPED = 100
"""More messages than this have a line each: to lay out so many rows would hold the window."""
_WHERE, _REMEDY, _CODE, _FIX = 2, 3, 4, 5
_MOST_SHARES = {_WHERE: 0.16, _REMEDY: 0.3, _CODE: 0.13}
"""How much of the width these columns take at most; what they don't need is the message's."""


class MessagesDock(QWidget):
    """Findings, the gravest first: filtered, wrapped, copied; a click goes to what one names."""

    counted = Signal(int)

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._theme: Theme | None = None
        self._notices: list[Finding] = []
        self.findings: tuple[Finding, ...] = ()
        self.table: QTableWidget = tables.table(
            ["", tr("Message"), tr("Where"), tr("What to do"), tr("Code"), ""], stretched=(1,)
        )
        for shared in _MOST_SHARES:
            self.table.horizontalHeader().setSectionResizeMode(
                shared, QHeaderView.ResizeMode.Interactive
            )
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        self.filter = MessageFilter()
        column.addWidget(self.filter)
        column.addWidget(self.table)
        self.table.setColumnHidden(_FIX, True)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.table.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.table.customContextMenuRequested.connect(self._offer)
        copy = QShortcut(QKeySequence(QKeySequence.StandardKey.Copy), self.table)
        copy.setContext(Qt.ShortcutContext.WidgetShortcut)
        copy.activated.connect(self.copy_selected)
        self.filter.changed.connect(self._apply_filter)
        self.table.cellClicked.connect(
            lambda row, _: document.selection.select_where(self.findings[row].where)
        )
        document.changed.connect(self.refresh)
        document.noticed.connect(self._note)
        document.files.opened.connect(lambda _: self._notices.clear())

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.findings = ()
        self.refresh()

    def refresh(self) -> None:
        """Show the findings of the shown session."""
        session = self._document.shown
        verdict = session.verdict.findings if session.verdict else ()
        paths = tuple(f for p in session.paths for f in p.findings)
        own = dict.fromkeys(session.findings() + paths + verdict)
        listed = tuple(self._notices) + tuple(
            sorted(own, key=lambda f: GRAVEST_FIRST.index(f.severity))
        )
        if listed == self.findings:
            return
        self.findings = listed
        tables.fill(
            self.table,
            [("", f.text, f.location, f.remedy, f.code, "") for f in listed],
            icons=[icons.icon(f.severity.value, self._colour(f.severity)) for f in listed],
        )
        for row, finding in enumerate(listed):
            if finding.fix is not None:
                self.table.setCellWidget(row, _FIX, self._button(finding.fix))
            else:
                self.table.removeCellWidget(row, _FIX)
        buttons = [self.table.cellWidget(row, _FIX) for row in range(len(listed))]
        widths = [button.sizeHint().width() for button in buttons if button is not None]
        self.table.setColumnHidden(_FIX, not widths)
        self.table.horizontalHeader().setSectionResizeMode(_FIX, QHeaderView.ResizeMode.Fixed)
        self.table.setColumnWidth(_FIX, max(widths, default=0))
        self._set_widths()
        self._apply_filter()
        self.counted.emit(len(listed))

    def copy_selected(self) -> None:
        """Copy the selected messages as lines of text, their columns parted by tabs."""
        self._copy(sorted({i.row() for i in self.table.selectedIndexes()}))

    def copy_all(self) -> None:
        """Copy all messages that the filter lets through."""
        self._copy([r for r in range(len(self.findings)) if not self.table.isRowHidden(r)])

    def _copy(self, rows: list[int]) -> None:
        lines = (
            "\t".join((f.severity.value, f.text, f.location, f.remedy, f.code))
            for f in (self.findings[r] for r in rows)
        )
        if rows:
            QGuiApplication.clipboard().setText("\n".join(lines))

    def menu(self) -> QMenu:
        """Return what may be done with messages."""
        menu = QMenu(self)
        menu.addAction(tr("Copy"), self.copy_selected).setEnabled(
            bool(self.table.selectedIndexes())
        )
        menu.addAction(tr("Copy all shown"), self.copy_all)
        return menu

    def _offer(self, at: QPoint) -> None:
        self.menu().popup(self.table.viewport().mapToGlobal(at))

    def _apply_filter(self) -> None:
        """Hide what the filter does not let through; the rows stay those of `findings`."""
        shown = [self.filter.lets_through(f) for f in self.findings]
        for row, is_shown in enumerate(shown):
            self.table.setRowHidden(row, not is_shown)
        self.filter.show_count(sum(shown), len(shown))
        self._fit_rows()

    def _fit_rows(self) -> None:
        """Let messages wrap: each row is as high as its words need in the width there is."""
        wraps = len(self.findings) <= _MOST_WRAPPED
        self.table.setWordWrap(wraps)
        # Laid out when it is shown: behind another dock nobody reads it.
        if wraps and self.table.isVisible():
            self.table.resizeRowsToContents()

    def _button(self, fix: Fix) -> QToolButton:
        """Return the button that lets the planner take up a finding's fix."""
        button = QToolButton()
        button.setObjectName("inTable")
        button.setText(tr("Apply"))
        button.setToolTip(tr("Change the plan as the remedy says; run and prove it again after it"))
        button.clicked.connect(lambda: self._document.apply_fix(fix))
        return button

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._share_width()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._share_width()

    def _share_width(self) -> None:
        self._set_widths()
        self._fit_rows()

    def _set_widths(self) -> None:
        """Give the columns beside the message what they need, up to their share."""
        header, width = self.table.horizontalHeader(), self.table.viewport().width()
        for column, most in _MOST_SHARES.items():
            needed = max(self.table.sizeHintForColumn(column), header.sectionSizeHint(column))
            header.resizeSection(column, min(needed, int(most * width)))

    def _note(self, finding: Finding) -> None:
        self._notices = [finding, *self._notices][:_MOST_NOTICES]
        self.refresh()

    def _colour(self, severity: Severity) -> str:
        if self._theme is None:
            return ""
        return {Severity.ERROR: self._theme.bad, Severity.WARNING: self._theme.warning}.get(
            severity, self._theme.muted
        )
