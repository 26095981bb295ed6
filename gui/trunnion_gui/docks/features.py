"""The feature table: kinds with their colour and count, features below them, what a person may change by menu."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QMenu, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from trunnion.model.feature import Feature, Recognition
from trunnion_gui import commands, icons
from trunnion_gui.colours import kind_colour, kinds
from trunnion_gui.document import Document, Selection
from trunnion_gui.i18n import tr
from trunnion_gui.widgets.table import RIGHT, colour_icon, tree
from trunnion_gui.words import amount, kind_words, sentence

_ID = Qt.ItemDataRole.UserRole
_SHOWN_SIZES = ("depth", "thickness", "height", "diameter")


class FeatureDock(QWidget):
    """Features by kind; a row selects, the selection of others is followed."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._shown: Recognition | None = None
        self._items: dict[str, QTreeWidgetItem] = {}
        self.tree: QTreeWidget = tree([tr("Feature"), tr("Faces"), tr("Size")])
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.tree)
        self.tree.itemSelectionChanged.connect(self._choose)
        self.tree.customContextMenuRequested.connect(self._offer)
        document.changed.connect(self.refresh)
        document.selected.connect(self._follow)

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
        for kind, count in (found.counts() if found else {}).items():
            self._add_kind(kind, count, [f for f in found or () if f.kind == kind], kind in folded)
        if found is not None and found.unexplained:
            item = QTreeWidgetItem([tr("Unexplained"), str(len(found.unexplained)), ""])
            item.setIcon(0, colour_icon(kind_colour("unexplained")))
            item.setData(0, _ID, "?")
            item.setTextAlignment(1, RIGHT)
            self.tree.addTopLevelItem(item)
        self.tree.blockSignals(False)
        self._follow(self._document.selection)

    def item(self, id: str) -> QTreeWidgetItem:
        """Return the row of a feature."""
        return self._items[id]

    def menu(self, feature: Feature) -> QMenu:
        """Return what may be done with a feature."""
        menu = QMenu(self)
        change = menu.addMenu(icons.icon("kind"), tr("Change kind"))
        for kind in kinds():
            if kind not in ("unexplained", feature.kind):
                change.addAction(colour_icon(kind_colour(kind)), sentence(tr(kind_words(kind))), lambda k=kind: self._document.edit(
                    tr("{id} becomes {kind}").format(id=feature.id, kind=kind_words(k)), commands.with_kind(feature.id, k)))
        menu.addAction(icons.icon("delete"), tr("Delete {id}").format(id=feature.id), lambda: self._document.edit(
            tr("Delete {id}").format(id=feature.id), commands.without_feature(feature.id)))
        return menu

    def _add_kind(self, kind: str, count: int, features: list[Feature], folded: bool) -> None:
        top = QTreeWidgetItem([sentence(tr(kind_words(kind))), str(count), ""])
        top.setIcon(0, colour_icon(kind_colour(kind)))
        top.setData(0, _ID, kind)
        top.setFlags(top.flags() & ~Qt.ItemFlag.ItemIsSelectable)
        top.setTextAlignment(1, RIGHT)
        self.tree.addTopLevelItem(top)
        for f in features:
            item = QTreeWidgetItem([f.id, str(len(f.tags)), main_size(f)])
            item.setData(0, _ID, f.id)
            item.setTextAlignment(1, RIGHT)
            item.setTextAlignment(2, RIGHT)
            item.setToolTip(0, ", ".join(f"{role} {tag}" for role, tag in ((x.role, x.face) for x in f.faces)))
            if f.by_hand:
                item.setIcon(0, icons.icon("by_hand"))
            top.addChild(item)
            self._items[f.id] = item
        top.setExpanded(not folded)

    def _choose(self) -> None:
        chosen = self.tree.selectedItems()
        id = chosen[0].data(0, _ID) if chosen else ""
        if id == "?" and self._shown is not None:
            self._document.select(Selection("faces", tr("unexplained faces"), self._shown.unexplained))
        elif id in self._items:
            self._document.select_feature(id)

    def _follow(self, selection: Selection) -> None:
        self.tree.blockSignals(True)
        item = self._items.get(selection.id) if selection.kind == "feature" else None
        if item is None and selection.kind != "faces":
            self.tree.clearSelection()
        elif item is not None:
            self.tree.setCurrentItem(item)
            self.tree.scrollToItem(item)
        self.tree.blockSignals(False)

    def _offer(self, at: QPoint) -> None:
        item = self.tree.itemAt(at)
        feature = self._document.feature(item.data(0, _ID)) if item is not None else None
        if feature is not None:
            self.menu(feature).popup(self.tree.viewport().mapToGlobal(at))


def main_size(feature: Feature) -> str:
    """Return the one size that tells most about a feature."""
    for name in _SHOWN_SIZES:
        if name in feature.sizes:
            return f"{amount(feature.sizes[name], 2)} mm"
    return ""
