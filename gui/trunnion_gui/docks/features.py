"""The feature table: kinds with their colour and count, features below them, what a person may change by menu.

Groups of equal patches stand in two classes, the remaining area and local features, with their radii; a click on the mark changes the
class.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QAbstractItemView, QLineEdit, QMenu, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from trunnion.model.feature import Feature, Recognition
from trunnion.report.palette import GROUP
from trunnion_gui import edits, icons
from trunnion_gui.colours import class_colours, feature_colours, kind_colour, kinds
from trunnion_gui.document import Document, Selection
from trunnion_gui.i18n import tr
from trunnion_gui.patches import PatchTools
from trunnion_gui.widgets.table import RIGHT, colour_icon, tree
from trunnion_gui.words import amount, kind_words, sentence

_ID = Qt.ItemDataRole.UserRole
_SHOWN_SIZES = ("depth", "thickness", "height", "diameter", "feature_size")
RADII = ("concave_radius", "convex_radius")
_LOCAL = 5
"""The column of the marks for local features."""
_COLUMNS = 6
_UNEXPLAINED = "?"
_LARGE = 100.0
"""mm: of larger radii nobody wants to know the decimals."""


class FeatureDock(QWidget):
    """Features by kind; a row selects, the selection of others is followed."""

    def __init__(self, document: Document, tools: PatchTools) -> None:
        super().__init__()
        self._document, self._tools = document, tools
        self._shown: Recognition | None = None
        self._items: dict[str, QTreeWidgetItem] = {}
        self.tree: QTreeWidget = tree([""] * _COLUMNS)
        self.tree.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        tips = (tr("Faces"), tr("Size in mm"), tr("Smallest concave radius in mm; no larger ball reaches"),
                tr("Smallest convex radius in mm"), tr("A local feature gets a cutter of its own; click to change"))
        for place, words in enumerate(tips, 1):
            self.tree.headerItem().setToolTip(place, words)
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
        document.selected.connect(self._follow)
        self._show_columns(False)

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
        self._show_columns(found is not None and bool(found.of_kind(GROUP)))
        colours = feature_colours(found) if found is not None else {}
        for name, words, colour, features in (_classes(found) if found is not None else ()):
            self._add_class(name, words, colour, features, colours, name in folded)
        if found is not None and found.unexplained:
            item = QTreeWidgetItem([tr("Unexplained"), str(len(found.unexplained)), ""])
            item.setIcon(0, colour_icon(kind_colour("unexplained")))
            item.setData(0, _ID, _UNEXPLAINED)
            item.setTextAlignment(1, RIGHT)
            self.tree.addTopLevelItem(item)
        self.tree.blockSignals(False)
        self._follow(self._document.selection)

    def item(self, id: str) -> QTreeWidgetItem:
        """Return the row of a feature."""
        return self._items[id]

    def menu(self, feature: Feature) -> QMenu:
        """Return what may be done with a feature."""
        menu = self._tools.menu(self, feature.tags) if feature.kind == GROUP else QMenu(self)
        chosen = self._document.selection
        if feature.kind == GROUP and chosen.kind == "faces" and not set(chosen.faces) <= set(feature.tags):
            menu.addAction(icons.icon("move_faces"), tr("Take the selected faces in"),
                           lambda: self._document.move(chosen.faces, feature.id))
        change = QMenu(tr("Change kind"), menu)
        change.setIcon(icons.icon("kind"))
        for kind in kinds():
            if kind not in ("unexplained", feature.kind):
                change.addAction(colour_icon(kind_colour(kind)), sentence(tr(kind_words(kind))), lambda k=kind: self._document.edit(
                    tr("{id} becomes {kind}").format(id=feature.id, kind=kind_words(k)), edits.with_kind(feature.id, k)))
        menu.addMenu(change)
        menu.addAction(icons.icon("delete"), tr("Delete {id}").format(id=feature.id), lambda: self._document.edit(
            tr("Delete {id}").format(id=feature.id), edits.without_feature(feature.id)))
        return menu

    def _show_columns(self, has_groups: bool) -> None:
        first, faces = (tr("Group"), tr("n")) if has_groups else (tr("Feature"), tr("Faces"))
        self.tree.setHeaderLabels([first, faces, tr("Size"), tr("r in"), tr("r out"), tr("Local")])
        for column in (3, 4, _LOCAL):
            self.tree.setColumnHidden(column, not has_groups)

    def _add_class(self, name: str, words: str, colour: str, features: list[Feature], colours: dict[str, str], folded: bool) -> None:
        top = QTreeWidgetItem([words, str(len(features)), ""])
        top.setIcon(0, colour_icon(colour))
        top.setData(0, _ID, name)
        top.setFlags(top.flags() & ~Qt.ItemFlag.ItemIsSelectable)
        top.setTextAlignment(1, RIGHT)
        self.tree.addTopLevelItem(top)
        if any(f.kind == GROUP for f in features):
            top.setText(0, f"{words} · {len(features)}")
            top.setFirstColumnSpanned(True)  # the columns beside it are narrow, and say nothing of a class
        for f in features:
            item = QTreeWidgetItem([f.id, str(len(f.tags)), main_size(f), *(radius_words(f, r) for r in RADII)])
            item.setData(0, _ID, f.id)
            for column in (1, 2, 3, 4):
                item.setTextAlignment(column, RIGHT)
            item.setToolTip(0, ", ".join(f"{role} {tag}" for role, tag in ((x.role, x.face) for x in f.faces)))
            if f.kind == GROUP:
                item.setIcon(0, colour_icon(colours[f.id]))
                for place, name, title in ((3, "fillet_radius", tr("fillet")), (4, "rounding_radius", tr("rounded edge"))):
                    if radius_words(f, name):
                        item.setToolTip(place, f"{title} R {radius_words(f, name)} mm")
                item.setCheckState(_LOCAL, Qt.CheckState.Checked if f.attributes.get("local") else Qt.CheckState.Unchecked)
                item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsUserCheckable)  # a click is an edit of the session, not of the row
            if f.by_hand:
                item.setIcon(1 if f.kind == GROUP else 0, icons.icon("by_hand"))
            top.addChild(item)
            self._items[f.id] = item
        top.setExpanded(not folded)

    def _find(self) -> None:
        words = [w for w in re.split(r"\s*[,;]\s*|(?<=\d)\s+", self.line.text().strip()) if w]
        if not self._document.select_ids(words):
            self._document.notice(tr("{words}: no feature and no face has this ID").format(words=self.line.text()),
                                  tr("write IDs as in the table, with commas between them"))

    def _click(self, item: QTreeWidgetItem, column: int) -> None:
        feature = self._document.feature(item.data(0, _ID))
        if column == _LOCAL and feature is not None and feature.kind == GROUP:
            self._tools.set_local([feature.id], not feature.attributes.get("local"))

    def _choose(self) -> None:
        ids = [item.data(0, _ID) for item in self.tree.selectedItems()]
        if ids == [_UNEXPLAINED] and self._shown is not None:
            self._document.select(Selection("faces", tr("unexplained faces"), self._shown.unexplained))
        elif ids:
            self._document.select_ids([id for id in ids if id in self._items])

    def _follow(self, selection: Selection) -> None:
        self.tree.blockSignals(True)
        item = self._items.get(selection.id) if selection.kind == "feature" else None
        if selection.kind == "faces":
            named = selection.id.split(", ")
            for id, row in self._items.items():
                row.setSelected(id in named)
        elif item is None:
            self.tree.clearSelection()
        else:
            self.tree.setCurrentItem(item)
            self.tree.scrollToItem(item)
        self.tree.blockSignals(False)

    def _offer(self, at: QPoint) -> None:
        item = self.tree.itemAt(at)
        feature = self._document.feature(item.data(0, _ID)) if item is not None else None
        if feature is not None:
            self.menu(feature).popup(self.tree.viewport().mapToGlobal(at))


def _classes(found: Recognition) -> Iterator[tuple[str, str, str, list[Feature]]]:
    """Give what stands together in the table: its name, words and colour, and the features of it, none of them empty."""
    for kind in found.counts():
        own = list(found.of_kind(kind))
        if kind != GROUP:
            yield kind, sentence(tr(kind_words(kind))), kind_colour(kind), own
            continue
        titles = (tr("Remaining area"), tr("Local features"))
        for is_local, name, words, colour in zip((False, True), (kind, "local"), titles, class_colours(), strict=True):
            members = [f for f in own if bool(f.attributes.get("local")) == is_local]
            if members:
                yield name, words, colour, members


def main_size(feature: Feature) -> str:
    """Return the one size that tells most about a feature."""
    for name in _SHOWN_SIZES:
        if name in feature.sizes:
            return f"{amount(feature.sizes[name], 2)} mm" if feature.kind != GROUP else amount(feature.sizes[name], 2)
    return ""


def radius_words(feature: Feature, name: str) -> str:
    """Return a radius of a group without its unit, nothing where there is none."""
    value = feature.sizes.get(name)
    if not isinstance(value, (int, float)) or not 0.0 < value < float("inf"):
        return ""
    return amount(value, 2 if value < _LARGE else 0)
