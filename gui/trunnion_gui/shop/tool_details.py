"""One tool: its picture, what the crib of the machine has of it, and its fields."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QSpinBox,
    QSplitter,
    QTableWidget,
    QVBoxLayout,
    QWidget,
)

from trunnion.shop.crib import HIGHEST_NUMBER, LARGEST_WEAR, CribTool
from trunnion_gui.document.shop import ShopCatalogue
from trunnion_gui.form import CountField, NumberField
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import kind_words, sentence
from trunnion_gui.shop.tool_picture import ToolPicture
from trunnion_gui.widgets import table as tables
from trunnion_gui.worker.shop_requests import Fields, ToolRow

_DECIMALS = 4


class ToolDetails(QSplitter):
    """Fields write to the crib when a person leaves them; a refusal brings back what was there."""

    def __init__(self, shop: ShopCatalogue) -> None:
        super().__init__(Qt.Orientation.Vertical)
        self._shop = shop
        self._row: ToolRow | None = None
        self._is_filling = False
        self.title, self.subtitle = QLabel(), QLabel()
        self.title.setObjectName("title")
        self.subtitle.setObjectName("muted")
        self.subtitle.setWordWrap(True)
        self.picture = ToolPicture()
        self.loaded = QCheckBox(tr("In the machine"))
        self.loaded.setObjectName("inMachine")
        self.number, self.pocket = _count("toolNumber", 1), _count("toolPocket", 0)
        self.pocket.setSpecialValueText(tr("not known"))
        self.gauge = _length("gaugeLength", 0.0, 10_000.0)
        self.length = _length("wearLength", -LARGEST_WEAR, LARGEST_WEAR)
        self.radius = _length("wearRadius", -LARGEST_WEAR, LARGEST_WEAR)
        self.fields = field_table()
        self._arrange()
        self.loaded.clicked.connect(self._tick)
        for field in (self.number, self.pocket):
            field.editingFinished.connect(self._put)
        self.gauge.editingFinished.connect(self._measure)
        for wear in (self.length, self.radius):
            wear.editingFinished.connect(self._wear)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.picture.use_theme(theme)

    def show_tool(self, row: ToolRow | None) -> None:
        """Show a tool of the catalogue with what the crib has of it, or none."""
        is_other = row is not self._row
        self._row = row
        loaded = self._shop.loaded(row.name) if row is not None else None
        self.title.setText(row.name if row is not None else tr("No tool is selected"))
        self.subtitle.setText(row.title if row is not None else "")
        self.picture.show_tool(row, loaded.wear_length if loaded is not None else 0.0)
        self._show_crib(row, loaded)
        if is_other:
            fill_fields(self.fields, row.fields if row is not None else ())

    def _show_crib(self, row: ToolRow | None, loaded: CribTool | None) -> None:
        self._is_filling = True
        self.loaded.setEnabled(row is not None and bool(self._shop.machine))
        self.loaded.setChecked(loaded is not None)
        shown = loaded or CribTool(name="", number=self._shop.crib.free_number())
        self.number.setValue(shown.number)
        self.pocket.setValue(shown.pocket)
        self.length.setValue(shown.wear_length)
        self.radius.setValue(shown.wear_radius)
        self.gauge.setValue((row.gauge_length if row is not None else 0.0) + shown.wear_length)
        for field in (self.number, self.pocket, self.gauge, self.length, self.radius):
            field.setEnabled(loaded is not None)
        self._is_filling = False

    def _tick(self, on: bool) -> None:
        if self._row is None:
            return
        if on:
            self._shop.put(self._row.name)
        else:
            self._shop.take(self._row.name)

    def _put(self) -> None:
        loaded = self._loaded()
        wanted = self.number.value(), self.pocket.value()
        if loaded is not None and wanted != (loaded.number, loaded.pocket):
            self._shop.put(loaded.name, *wanted)

    def _measure(self) -> None:
        """Take the measured gauge length as wear of the length."""
        loaded = self._loaded()
        if loaded is None or self._row is None:
            return
        worn = round(self.gauge.value() - self._row.gauge_length, _DECIMALS)
        if worn != round(loaded.wear_length, _DECIMALS):
            self._shop.set_wear(loaded.name, worn, loaded.wear_radius)

    def _wear(self) -> None:
        loaded = self._loaded()
        wanted = round(self.length.value(), _DECIMALS), round(self.radius.value(), _DECIMALS)
        if loaded is not None and wanted != (loaded.wear_length, loaded.wear_radius):
            self._shop.set_wear(loaded.name, *wanted)

    def _loaded(self) -> CribTool | None:
        if self._is_filling or self._row is None:
            return None
        return self._shop.loaded(self._row.name)

    def _arrange(self) -> None:
        grid = QGridLayout()
        grid.setVerticalSpacing(4)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)
        rows: tuple[tuple[tuple[str, QWidget], ...], ...] = (
            ((tr("T number"), self.number), (tr("Pocket"), self.pocket)),
            ((tr("Wear, length"), self.length), (tr("Wear, radius"), self.radius)),
            ((tr("Gauge length, measured"), self.gauge),),
        )
        for line, pairs in enumerate(rows):
            for column, (words, field) in enumerate(pairs):
                label = QLabel(words)
                label.setBuddy(field)
                wide = len(pairs) == 1
                grid.addWidget(label, line, 2 * column, 1, 2 if wide else 1)
                grid.addWidget(field, line, 2 * column + (2 if wide else 1), 1, 2 if wide else 1)
        self.gauge.setToolTip(
            tr(
                "What the shop measures; its difference from the catalogue is the wear of the length"
            )
        )
        above, below = QWidget(), QWidget()
        top, bottom = QVBoxLayout(above), QVBoxLayout(below)
        top.setContentsMargins(8, 0, 0, 4)
        bottom.setContentsMargins(8, 4, 0, 0)
        top.addWidget(self.title)
        top.addWidget(self.subtitle)
        top.addWidget(self.picture, 1)
        top.addWidget(self.loaded)
        top.addLayout(grid)
        bottom.addWidget(self.fields)
        self.addWidget(above)
        self.addWidget(below)
        self.setStretchFactor(0, 3)
        self.setStretchFactor(1, 1)
        self.setChildrenCollapsible(False)


def field_table() -> QTableWidget:
    """Return an empty table of an entry's fields."""
    made = tables.table([tr("Field"), tr("Value")], stretched=(1,))
    made.horizontalHeader().hide()
    made.setMinimumHeight(80)
    return made


def fill_fields(made: QTableWidget, fields: Fields) -> None:
    """Show the fields of an entry of the catalogue."""
    tables.fill(made, [(tr(sentence(kind_words(name))), value) for name, value in fields])


def _count(name: str, least: int) -> QSpinBox:
    field = CountField()
    field.setObjectName(name)
    field.setRange(least, HIGHEST_NUMBER)
    return field


def _length(name: str, low: float, high: float) -> QDoubleSpinBox:
    field = NumberField()
    field.setObjectName(name)
    field.setRange(low, high)
    field.setDecimals(_DECIMALS)
    field.setSingleStep(0.001)
    field.setSuffix(" mm")
    return field
