"""The feature table: kinds with their colour and count, features below them, what a person may change by menu.

Families add columns of their own, with words or marks, and say which classes their features stand in.
"""

from __future__ import annotations

import re

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QLineEdit,
    QMenu,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from trunnion.model.feature import Feature, Recognition
from trunnion_gui import edits
from trunnion_gui.document import Document, Selection
from trunnion_gui.families.contract import Column, FeatureClass
from trunnion_gui.families.views import Views
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import feature_colours, kind_colour, kind_label, kinds
from trunnion_gui.look.words import sentence
from trunnion_gui.widgets.table import RIGHT, colour_icon, select_row, tree

_ID = Qt.ItemDataRole.UserRole
_FIRST_OWN = 3
"""The columns before this are those of every family: id, number of faces, size."""
_UNEXPLAINED = "?"


class FeatureDock(QWidget):
    """Features by kind; a row selects, the selection of others is followed."""

    def __init__(self, document: Document, views: Views) -> None:
        super().__init__()
        self._document, self._views = document, views
        self._columns = [(view, column) for view in views for column in view.columns()]
        self._shown: Recognition | None = None
        self._items: dict[str, QTreeWidgetItem] = {}
        self.tree: QTreeWidget = tree([""] * (_FIRST_OWN + len(self._columns)))
        self.tree.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        tips = (tr("Faces"), tr("Size in mm"), *(column.tip for _, column in self._columns))
        for number, words in enumerate(tips, 1):
            self.tree.headerItem().setToolTip(number, words)
        self.line = QLineEdit()
        self.line.setPlaceholderText(tr("Select by ID: group-05, face 12"))
        self.line.setClearButtonEnabled(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(2)
        column.addWidget(self.line)
        column.addWidget(self.tree)
        self.line.returnPressed.connect(self._find)
        self.tree.itemSelectionChanged.connect(self._choose)
        self.tree.itemClicked.connect(self._click)
        self.tree.customContextMenuRequested.connect(self._offer)
        document.changed.connect(self.refresh)
        document.selection.changed.connect(self._follow)
        self._show_columns(None)

    def refresh(self) -> None:
        """Show the features of the shown session."""
        found = self._document.shown.recognition
        if found is self._shown:
            return
        tops = (self.tree.topLevelItem(n) for n in range(self.tree.topLevelItemCount()))
        folded = {top.data(0, _ID) for top in tops if top is not None and not top.isExpanded()}
        self._shown = found
        self.tree.blockSignals(True)
        self.tree.clear()
        self._items = {}
        self._show_columns(found)
        colours = feature_colours(found) if found is not None else {}
        for shown in self._views.classes(found) if found is not None else ():
            self._add_class(shown, colours, shown.name in folded)
        if found is not None and found.unexplained:
            item = QTreeWidgetItem([tr("Unexplained"), str(len(found.unexplained)), ""])
            item.setIcon(0, colour_icon(kind_colour("unexplained")))
            item.setData(0, _ID, _UNEXPLAINED)
            item.setTextAlignment(1, RIGHT)
            self.tree.addTopLevelItem(item)
        self.tree.blockSignals(False)
        self._follow(self._document.selection.current)

    def item(self, id: str) -> QTreeWidgetItem:
        """Return the row of a feature."""
        return self._items[id]

    def menu(self, feature: Feature) -> QMenu:
        """Return what may be done with a feature."""
        menu = QMenu(self)
        selected_ids = [id for id, row in self._items.items() if row.isSelected()]
        self._views.face_edits.add_feature_entries(menu, feature, selected_ids)
        self._views.of(feature).add_feature_entries(menu, feature)
        change = QMenu(tr("Change kind"), menu)
        change.setIcon(icons.icon("kind"))
        for kind in kinds():
            if kind != feature.kind:
                change.addAction(
                    colour_icon(kind_colour(kind)),
                    sentence(tr(kind_label(kind))),
                    lambda k=kind: self._document.edit(
                        tr("{id} becomes {kind}").format(id=feature.id, kind=tr(kind_label(k))),
                        edits.with_kind(feature.id, k),
                    ),
                )
        menu.addMenu(change)
        menu.addAction(
            icons.icon("delete"),
            tr("Delete {id}").format(id=feature.id),
            lambda: self._document.edit(
                tr("Delete {id}").format(id=feature.id), edits.without_feature(feature.id)
            ),
        )
        return menu

    def _show_columns(self, found: Recognition | None) -> None:
        present = self._views.present(found)
        self.tree.setHeaderLabels(
            [
                *self._views.headings(found),
                tr("Size"),
                *(column.title for _, column in self._columns),
            ]
        )
        for number, (view, _) in enumerate(self._columns, _FIRST_OWN):
            self.tree.setColumnHidden(number, view not in present)

    def _add_class(self, shown: FeatureClass, colours: dict[str, str], folded: bool) -> None:
        top = QTreeWidgetItem([shown.words, str(len(shown.features)), ""])
        top.setIcon(0, colour_icon(shown.colour))
        top.setData(0, _ID, shown.name)
        top.setFlags(top.flags() & ~Qt.ItemFlag.ItemIsSelectable)
        top.setTextAlignment(1, RIGHT)
        self.tree.addTopLevelItem(top)
        if self._views.of(shown.features[0]).columns():
            top.setText(0, f"{shown.words} · {len(shown.features)}")
            top.setFirstColumnSpanned(
                True
            )  # the columns beside it are narrow, and say nothing of a class
        for f in shown.features:
            self._items[f.id] = item = self._row(f, colours)
            top.addChild(item)
        top.setExpanded(not folded)

    def _row(self, f: Feature, colours: dict[str, str]) -> QTreeWidgetItem:
        view = self._views.of(f)
        item = QTreeWidgetItem([f.id, str(len(f.tags)), view.size(f)])
        item.setData(0, _ID, f.id)
        item.setToolTip(
            0, ", ".join(f"{role} {tag}" for role, tag in ((x.role, x.face) for x in f.faces))
        )
        for number in range(1, _FIRST_OWN):
            item.setTextAlignment(number, RIGHT)
        for number, (owner, column) in enumerate(self._columns, _FIRST_OWN):
            if owner is view:
                _fill_cell(item, number, column, f)
        if view.has_own_colours:
            item.setIcon(0, colour_icon(colours[f.id]))
        if f.by_hand:
            item.setIcon(1 if view.has_own_colours else 0, icons.icon("by_hand"))
        return item

    def _find(self) -> None:
        words = [w for w in re.split(r"\s*[,;]\s*|(?<=\d)\s+", self.line.text().strip()) if w]
        if not self._document.selection.select_ids(words):
            self._document.notice(
                tr("{words}: no feature and no face has this ID").format(words=self.line.text()),
                tr("write IDs as in the table, with commas between them"),
            )

    def _click(self, item: QTreeWidgetItem, number: int) -> None:
        feature = self._document.feature(item.data(0, _ID))
        if feature is not None and number >= _FIRST_OWN:
            owner, column = self._columns[number - _FIRST_OWN]
            if column.click is not None and self._views.of(feature) is owner:
                column.click(feature)

    def _choose(self) -> None:
        ids = [item.data(0, _ID) for item in self.tree.selectedItems()]
        if ids == [_UNEXPLAINED] and self._shown is not None:
            self._document.selection.select(
                Selection("faces", tr("unexplained faces"), self._shown.unexplained)
            )
        elif ids:
            self._document.selection.select_ids([id for id in ids if id in self._items])

    def _follow(self, selection: Selection) -> None:
        if selection.kind != "faces":
            item = self._items.get(selection.id) if selection.kind == "feature" else None
            select_row(self.tree, item)
            return
        self.tree.blockSignals(True)
        named = selection.id.split(", ")
        for id, row in self._items.items():
            row.setSelected(id in named)
        self.tree.blockSignals(False)

    def _offer(self, at: QPoint) -> None:
        item = self.tree.itemAt(at)
        feature = self._document.feature(item.data(0, _ID)) if item is not None else None
        if feature is not None:
            self.menu(feature).popup(self.tree.viewport().mapToGlobal(at))


def _fill_cell(item: QTreeWidgetItem, number: int, column: Column, feature: Feature) -> None:
    """Write what a family's own column says of a feature into its row."""
    if column.is_ticked is not None:
        item.setCheckState(
            number, Qt.CheckState.Checked if column.is_ticked(feature) else Qt.CheckState.Unchecked
        )
        item.setFlags(
            item.flags() & ~Qt.ItemFlag.ItemIsUserCheckable
        )  # a click is an edit of the session, not of the row
        return
    item.setText(number, column.words(feature))
    item.setTextAlignment(number, RIGHT)
    item.setToolTip(number, column.cell_tip(feature))
