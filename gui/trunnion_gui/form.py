"""Any declared settings to widgets and back: the only module that knows which widget suits which type."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from PySide6.QtCore import QEvent, QObject, QPoint, Qt, Signal
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QCompleter,
    QDoubleSpinBox,
    QFileDialog,
    QGridLayout,
    QLabel,
    QLineEdit,
    QMenu,
    QSpinBox,
    QWidget,
)

from trunnion.settings import Declared, Value
from trunnion.units import trimmed
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons

_WIDEST = 10**9
_FIELD_WIDTH = 138
_NAME_WIDTH = 190
_LONG = 60
"""A list of more words than this is searched, not opened."""


class NumberField(QDoubleSpinBox):
    """A number with its unit, without trailing zeros; the wheel turns it only while it has the focus."""

    def textFromValue(self, value: float) -> str:
        return trimmed(value, self.decimals())

    def wheelEvent(self, event: QWheelEvent) -> None:
        super().wheelEvent(event) if self.hasFocus() else event.ignore()


class CountField(QSpinBox):
    """A whole number; the wheel turns it only while it has the focus."""

    def wheelEvent(self, event: QWheelEvent) -> None:
        super().wheelEvent(event) if self.hasFocus() else event.ignore()


class ChoiceField(QComboBox):
    """One of several words; the wheel never turns it."""

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()


class Form(QWidget):
    """The settings of a group, one line each. A label in bold marks a value that is not the default; its menu takes it back."""

    changed = Signal(str, object, str)
    """Full key, new value, and the gesture: one visit to a field is one gesture."""
    reset = Signal(str)

    def __init__(self, settings: Sequence[Declared], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._settings = {s.key: s for s in settings}
        self._fields: dict[str, QWidget] = {}
        self._labels: dict[str, QLabel] = {}
        self._visit = 0
        self._is_filling = False
        lines = QGridLayout(self)
        lines.setContentsMargins(0, 0, 0, 0)
        lines.setHorizontalSpacing(10)
        lines.setVerticalSpacing(6)
        lines.setColumnStretch(0, 1)
        for row, setting in enumerate(settings):
            lines.addWidget(self._label(setting), row, 0)
            lines.addWidget(self._field(setting), row, 1, Qt.AlignmentFlag.AlignRight)
        self.fill({})

    def fill(self, choices: Mapping[str, Value]) -> None:
        """Show the values that `choices` gives by full key, the default of the others."""
        self._is_filling = True
        for key, setting in self._settings.items():
            value = choices.get(key, setting.default)
            show(self._fields[key], value)
            font = self._labels[key].font()
            font.setBold(value != setting.default)
            self._labels[key].setFont(font)
        self._is_filling = False

    def values(self) -> dict[str, Value]:
        """Return the values of all fields by full key."""
        return {key: read(field) for key, field in self._fields.items()}

    def field(self, key: str) -> QWidget:
        """Return the field of a setting."""
        return self._fields[key]

    def fields(self) -> tuple[QWidget, ...]:
        """Return all fields, from top to bottom."""
        return tuple(self._fields.values())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FocusIn:
            self._visit += 1
        return False

    def _label(self, setting: Declared) -> QLabel:
        label = QLabel(tr(setting.label))
        label.setWordWrap(True)
        label.setToolTip(tooltip(setting))
        label.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        label.customContextMenuRequested.connect(
            lambda at: self._offer_default(setting, label.mapToGlobal(at))
        )
        self._labels[setting.key] = label
        return label

    def _field(self, setting: Declared) -> QWidget:
        field = make_field(setting)
        field.setObjectName(setting.key)
        field.setToolTip(tooltip(setting))
        field.installEventFilter(self)
        on_change(field, lambda: self._report(setting.key))
        self._fields[setting.key] = field
        return field

    def _report(self, key: str) -> None:
        if not self._is_filling:
            self.changed.emit(key, read(self._fields[key]), f"{key} {id(self)} {self._visit}")

    def _offer_default(self, setting: Declared, at: QPoint) -> None:
        menu = QMenu(self)
        menu.addAction(
            tr("Back to the default ({value})").format(value=setting.default),
            lambda: self.reset.emit(setting.key),
        )
        menu.popup(at)


def tooltip(setting: Declared) -> str:
    """Return what a setting does, what it may be, and its key for the command line."""
    allowed = (
        setting.allowed()
        if len(setting.choices) <= _LONG
        else tr("one of {n} names").format(n=len(setting.choices))
    )
    return f"<p>{tr(setting.help)}</p><p>{allowed}<br><tt>{setting.key}</tt></p>"


def make_field(setting: Declared) -> QWidget:
    """Return the widget that suits a setting."""
    if setting.kind is bool:
        return QCheckBox()
    if len(setting.choices) > _LONG:
        return _searched(setting)
    if setting.choices:
        choice = ChoiceField()
        for word in setting.choices:
            choice.addItem(tr(word) if word else tr("automatic"), word)
        choice.setFixedWidth(_FIELD_WIDTH)
        return choice
    if setting.kind in (int, float):
        return _number(setting)
    if setting.files:
        return _file(setting)
    line = QLineEdit()
    line.setFixedWidth(_FIELD_WIDTH)
    return line


def _file(setting: Declared) -> QLineEdit:
    """Return a line for the name of a file, with a button that lets a person choose it."""
    line = QLineEdit()
    line.setFixedWidth(_FIELD_WIDTH)
    line.setClearButtonEnabled(True)
    patterns = " ".join(f"*{ending}" for ending in setting.files)

    def choose_path() -> None:
        title, kinds = tr(setting.label), f"{tr(setting.label)} ({patterns})"
        path, _ = QFileDialog.getOpenFileName(line.window(), title, line.text(), kinds)
        if path:
            line.setText(path)
            line.editingFinished.emit()

    action = line.addAction(icons.icon("open"), QLineEdit.ActionPosition.TrailingPosition)
    action.setToolTip(tr("Choose a file"))
    action.triggered.connect(choose_path)
    return line


def _searched(setting: Declared) -> QLineEdit:
    """Return a line that finds names of a long list by any of their letters."""
    line = QLineEdit()
    line.setFixedWidth(_NAME_WIDTH)
    line.setPlaceholderText(tr("automatic"))
    line.setClearButtonEnabled(True)
    finder = QCompleter([word for word in setting.choices if word], line)
    finder.setFilterMode(Qt.MatchFlag.MatchContains)
    finder.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
    line.setCompleter(finder)
    return line


def read(field: QWidget) -> Value:
    """Return the value that a field shows."""
    if isinstance(field, QCheckBox):
        return field.isChecked()
    if isinstance(field, QComboBox):
        return str(field.currentData())
    if isinstance(field, (QSpinBox, QDoubleSpinBox)):
        return field.value()
    assert isinstance(field, QLineEdit)
    return field.text()


def show(field: QWidget, value: Value) -> None:
    """Let a field show a value."""
    if isinstance(field, QCheckBox):
        field.setChecked(bool(value))
    elif isinstance(field, QComboBox):
        field.setCurrentIndex(max(field.findData(value), 0))
    elif isinstance(field, QSpinBox):
        field.setValue(int(value))
    elif isinstance(field, QDoubleSpinBox):
        field.setValue(float(value))
    elif isinstance(field, QLineEdit):
        field.setText(str(value))
        # A name that is longer than the line is read from its beginning.
        field.setCursorPosition(0)


def on_change(field: QWidget, slot: Callable[[], None]) -> None:
    """Call a slot when a person has changed a field (not at every key while he types)."""
    if isinstance(field, QCheckBox):
        field.toggled.connect(lambda _: slot())
    elif isinstance(field, QComboBox):
        field.currentIndexChanged.connect(lambda _: slot())
    elif isinstance(field, (QSpinBox, QDoubleSpinBox)):
        field.valueChanged.connect(lambda _: slot())
    elif isinstance(field, QLineEdit):
        field.editingFinished.connect(slot)


def _number(setting: Declared) -> QSpinBox | QDoubleSpinBox:
    field: QSpinBox | QDoubleSpinBox
    low = -_WIDEST if setting.low is None else setting.low
    high = _WIDEST if setting.high is None else setting.high
    if setting.kind is int:
        field = CountField()
        field.setRange(int(low), int(high))
    else:
        field = NumberField()
        field.setDecimals(4)
        field.setRange(float(low), float(high))
        field.setSingleStep(_step(float(setting.default)))
    if setting.unit:
        field.setSuffix(f" {tr(setting.unit)}")
    field.setKeyboardTracking(False)
    field.setAlignment(Qt.AlignmentFlag.AlignRight)
    field.setFixedWidth(_FIELD_WIDTH)
    return field


def _step(default: float) -> float:
    """Return a step that suits the size of a number: 1 for tens, 0.1 for ones, 0.01 for tenths."""
    size = abs(default) or 1.0
    step = 10.0
    while step > size / 5:
        step /= 10.0
    return step
