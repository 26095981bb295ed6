"""The process tree: setups and their operations, reordered by drag; suppressed, copied and deleted by menu."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QBrush, QColor, QDropEvent, QFont, QIcon
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QMenu,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from trunnion.model.operation import Operation
from trunnion.model.verdict import OperationProof, Outcome
from trunnion.plan.manual.operation_copy import copy_targets
from trunnion_gui import edits
from trunnion_gui.document import Document, Selection
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import amount, clock, kind_words, sentence
from trunnion_gui.widgets.table import RIGHT, select_row, tree

_ID = Qt.ItemDataRole.UserRole
_FEATURE, _DIAMETER, _TIME, _OVER = 1, 3, 4, 5


class _Tree(QTreeWidget):
    """A tree that signals a drop instead of moving rows by itself: the session is what moves."""

    dropped = Signal(str, object)
    """The id of the dragged operation, and the id it was dropped in front of (None: at the end)."""

    def dropEvent(self, event: QDropEvent) -> None:
        dragged = self.currentItem()
        if dragged is not None:
            self.dropped.emit(dragged.data(0, _ID), self._target(event.position().toPoint()))
        event.setDropAction(Qt.DropAction.IgnoreAction)
        event.accept()

    def _target(self, at: QPoint) -> str | None:
        item = self.itemAt(at)
        if item is None:
            return None
        below = at.y() > self.visualItemRect(item).center().y()
        after = self.itemBelow(item) if below else item
        return after.data(0, _ID) if after is not None and after.parent() is not None else None


class ProcessDock(QWidget):
    """Operations in the order they are cut."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._theme: Theme | None = None
        self._shown: tuple = ()
        self._items: dict[str, QTreeWidgetItem] = {}
        self._marked = ""
        titles = [tr("Operation"), tr("Feature"), tr("Tool"), "⌀ mm", tr("Time"), "×"]
        self.tree = tree(titles, kind=_Tree)
        self.tree.header().setSectionResizeMode(_FEATURE, QHeaderView.ResizeMode.Stretch)
        self.tree.headerItem().setToolTip(
            _OVER, tr("Time over the least that spindle, cutter and material allow")
        )
        for number in (_TIME, _OVER):
            self.tree.headerItem().setTextAlignment(number, RIGHT)
        self.tree.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.tree)
        self.tree.itemSelectionChanged.connect(self._choose)
        self.tree.customContextMenuRequested.connect(self._offer)
        self.tree.dropped.connect(self.reorder)
        document.changed.connect(self.refresh)
        document.selection.changed.connect(self._follow)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self._shown = ()
        self.refresh()

    def refresh(self) -> None:
        """Show the process of the shown session."""
        session = self._document.shown
        if (session.process, session.verdict) == self._shown:
            return
        self._shown = (session.process, session.verdict)
        self.tree.blockSignals(True)
        self.tree.clear()
        self._items = {}
        proofs = {p.operation: p for p in session.verdict.operations} if session.verdict else {}
        self.tree.setColumnHidden(_DIAMETER, bool(proofs))
        for column in (_TIME, _OVER):
            self.tree.setColumnHidden(column, not proofs)
        for setup in session.process.setups if session.process else ():
            top = QTreeWidgetItem([f"{setup.name}  {setup.work_offset}", setup.machine])
            top.setIcon(0, icons.icon("setup"))
            top.setFlags(
                top.flags() & ~(Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsDragEnabled)
            )
            self.tree.addTopLevelItem(top)
            for o in session.process.operations if session.process else ():
                if o.setup == setup.name:
                    self._add(top, o, proofs.get(o.id))
            top.setExpanded(True)
        self.tree.blockSignals(False)
        marked, self._marked = self._marked, ""
        self.mark(marked)
        self._follow(self._document.selection.current)

    def mark(self, id: str) -> None:
        """Show which operation is being played; none for an empty id."""
        if id == self._marked:
            return
        for name, is_played in ((self._marked, False), (id, True)):
            item = self._items.get(name)
            if item is not None:
                self._stress(item, is_played)
                if is_played:
                    self.tree.scrollToItem(item)
        self._marked = id

    def _stress(self, item: QTreeWidgetItem, is_played: bool) -> None:
        font = QFont(item.font(0))
        font.setBold(is_played)
        colour = (
            QBrush(QColor(self._theme.accent))
            if is_played and self._theme is not None
            else QBrush()
        )
        for column in range(self.tree.columnCount()):
            item.setFont(column, font)
            item.setForeground(column, colour)

    def item(self, id: str) -> QTreeWidgetItem:
        """Return the row of an operation."""
        return self._items[id]

    def reorder(self, id: str, before: str | None) -> None:
        """Move an operation in front of another one."""
        self._document.edit(tr("Move {id}").format(id=id), edits.with_operation_before(id, before))

    def menu(self, operation: Operation) -> QMenu:
        """Return what may be done with an operation."""
        menu, id, edit = QMenu(self), operation.id, self._document.edit
        words = tr("Cut {id} again") if operation.suppressed else tr("Suppress {id}")
        menu.addAction(
            icons.icon("resume" if operation.suppressed else "suppress"),
            words.format(id=id),
            lambda: edit(words.format(id=id), edits.with_suppressed(id, not operation.suppressed)),
        )
        menu.addAction(
            icons.icon("copy"),
            tr("Copy {id}").format(id=id),
            lambda: self._document.copy_operation(id),
        )
        self._add_copies_on(menu, operation)
        menu.addAction(
            icons.icon("delete"),
            tr("Delete {id}").format(id=id),
            lambda: edit(tr("Delete {id}").format(id=id), edits.without_operation(id)),
        )
        return menu

    def _add_copies_on(self, menu: QMenu, operation: Operation) -> None:
        """Add the features that an operation can be copied to, where there are any."""
        found = self._document.shown.recognition
        features = copy_targets(operation, found) if found is not None else ()
        if features:
            onto = menu.addMenu(tr("Copy {id} to").format(id=operation.id))
            for id in features:
                onto.addAction(id, partial(self._document.copy_operation, operation.id, id))

    def _add(self, top: QTreeWidgetItem, o: Operation, proof: OperationProof | None) -> None:
        item = QTreeWidgetItem(
            [
                label(o),
                o.feature,
                f"T{o.tool.number}",
                amount(o.tool.cutter_sizes[0], 2),
                clock(proof.time_s) if proof is not None else "",
                f"{proof.over_bound:.1f}" if proof is not None and proof.bound_s else "",
            ]
        )
        item.setData(0, _ID, o.id)
        for column in (_DIAMETER, _TIME, _OVER):
            item.setTextAlignment(column, RIGHT)
        item.setToolTip(0, "<br>".join((f"<b>{o.id}</b>", *o.rules)))
        item.setToolTip(2, o.tool.description or o.tool.name)
        item.setIcon(0, self._icon(o, proof))
        if o.suppressed and self._theme is not None:
            for column in range(self.tree.columnCount()):
                item.setForeground(column, QColor(self._theme.muted))
        top.addChild(item)
        self._items[o.id] = item

    def _icon(self, o: Operation, proof: OperationProof | None) -> QIcon:
        if o.suppressed:
            return icons.icon("suppress")
        if proof is None or self._theme is None:
            return icons.icon("by_hand" if o.is_manual else "empty")
        colours = {
            Outcome.PASSED: self._theme.good,
            Outcome.REMARKS: self._theme.warning,
            Outcome.FAILED: self._theme.bad,
        }
        return icons.icon(
            "problem" if proof.outcome is Outcome.FAILED else "done", colours[proof.outcome]
        )

    def _choose(self) -> None:
        items = self.tree.selectedItems()
        if items and items[0].data(0, _ID):
            self._document.selection.select_operation(items[0].data(0, _ID))

    def _follow(self, selection: Selection) -> None:
        item = self._items.get(selection.id) if selection.kind == "operation" else None
        select_row(self.tree, item)

    def _offer(self, at: QPoint) -> None:
        item = self.tree.itemAt(at)
        operation = self._document.operation(item.data(0, _ID) or "") if item is not None else None
        if operation is not None:
            self.menu(operation).popup(self.tree.viewport().mapToGlobal(at))


def label(o: Operation) -> str:
    """Return what distinguishes an operation from others of its feature: its kind, with what else its id says."""
    rest = (
        o.id.replace(f"-{o.feature}", "")
        .removeprefix(o.kind.replace("_", "-"))
        .removeprefix(o.kind)
        .strip("-")
    )
    kind = sentence(tr(kind_words(o.kind)))
    return f"{kind} {rest}" if rest else kind
