"""Fields for what the selected features are to keep on purpose: material on walls, and on floors or tops."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QVBoxLayout, QWidget

from trunnion.model.feature import Feature
from trunnion.settings import Value
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.worker.requests import ALLOWANCE


class FeatureAllowanceFields(QWidget):
    """The allowance of one feature, or of several that are selected together; what is typed goes to all of them as one entry of the
    history."""

    def __init__(self, document: Document, views: Views) -> None:
        super().__init__()
        self._document, self._views = document, views
        self._ids: tuple[str, ...] = ()
        self._requested: tuple[tuple[str, ...], str, Value] | None = None
        self.form: Form | None = None
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)

    def show_for(self, features: Sequence[Feature]) -> None:
        """Show what some features keep, nothing where one of them can't keep anything; of several features that of the first."""
        found = self._document.shown.recognition
        kinds = self._views.allowance_kinds(found.family) if found is not None else ()
        keep = bool(features) and all(f.kind in kinds for f in features)
        known = ALLOWANCE in self._document.groups
        self.setVisible(keep and known)
        if not keep or not known:
            self._ids = ()
            return
        if self.form is None:
            self.form = Form(self._document.groups[ALLOWANCE][0].settings)
            self.form.changed.connect(lambda key, value, _: self._change(key, value))
            self.form.reset.connect(lambda key: self._change(key, 0.0))
            self._column.addWidget(self.form)
        self._ids = tuple(f.id for f in features)
        self._requested = None
        self.form.fill(self._kept(features[0]))

    def _change(self, key: str, value: Value) -> None:
        """Ask for an amount once: a line that is left by the return key and then loses the focus signals twice."""
        features = [f for f in map(self._document.feature, self._ids) if f is not None]
        is_new = any(self._kept(f)[key] != value for f in features)
        if not is_new or self._requested == (self._ids, key, value):
            return
        self._requested = (self._ids, key, value)
        label = tr("{ids}: keep {amount} mm").format(ids=", ".join(self._ids), amount=value)
        self._document.change_allowance(self._ids, label, {_field(key): value})

    def _kept(self, feature: Feature) -> dict[str, Value]:
        """Return what a feature keeps, by the full keys of the fields."""
        keys = (d.key for d in self._document.groups[ALLOWANCE][0].settings)
        return {key: _number(feature.attributes.get(_field(key), 0.0)) for key in keys}


def _field(key: str) -> str:
    """Return the attribute of a feature behind the full key of a field."""
    return key.rpartition(".")[2]


def _number(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0
