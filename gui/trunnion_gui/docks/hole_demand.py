"""Fields for what is demanded of the selected holes beyond their shape: a fit, or a thread with its depth."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QVBoxLayout, QWidget

from trunnion.model.feature import Feature
from trunnion.plan.holes.settings import HoleDemand
from trunnion.recognize.holes.features import HOLE
from trunnion.settings import Value, declared
from trunnion_gui.document import Document
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.worker.requests import DEMAND

FIT, THREAD, DEPTH = (d.key for d in declared(HoleDemand))
"""Full keys of the fields."""


class HoleDemandFields(QWidget):
    """The demand of one hole, or of several that are selected together; what is typed goes to all of them as one entry of the history."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._ids: tuple[str, ...] = ()
        self._requested: tuple[tuple[str, ...], dict[str, Value]] | None = None
        self.form: Form | None = None
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)

    def show_for(self, features: Sequence[Feature]) -> None:
        """Show the demand of some features, nothing where one of them is no hole; of several holes that of the first."""
        are_holes = bool(features) and all(f.kind == HOLE for f in features)
        known = DEMAND in self._document.groups
        self.setVisible(are_holes and known)
        if not are_holes or not known:
            self._ids = ()
            return
        if self.form is None:
            self.form = Form(self._document.groups[DEMAND][0].settings)
            self.form.changed.connect(lambda key, value, _: self._change(key, value))
            self.form.reset.connect(lambda key: self._change(key, 0.0 if key == DEPTH else ""))
            self._column.addWidget(self.form)
        self._ids = tuple(f.id for f in features)
        self._requested = None
        self.form.fill(demand_values(features[0]))

    def _change(self, key: str, value: Value) -> None:
        """Ask for a demand once: a line that is left by the return key and then loses the focus signals twice."""
        if self.form is None or not self._ids:
            return
        values = self.form.values() | {key: value}
        # A bore has one of both: what is typed last takes the place of the other.
        if key == FIT and value:
            values |= {THREAD: "", DEPTH: 0.0}
        if key == THREAD:
            values |= {FIT: ""} if value else {DEPTH: 0.0}
        features = [f for f in map(self._document.feature, self._ids) if f is not None]
        is_new = any(demand_values(f) != values for f in features)
        if not is_new or self._requested == (self._ids, values):
            return
        self._requested = (self._ids, values)
        words = str(values[FIT] or values[THREAD]) or tr("no fit and no thread")
        label = f"{', '.join(self._ids)}: {words}"
        self._document.change_demand(self._ids, label, values)


def demand_values(feature: Feature) -> dict[str, Value]:
    """Return what is demanded of a hole, by the full keys of the fields."""
    depth = feature.sizes.get("thread_depth", 0.0)
    return {
        FIT: str(feature.attributes.get("fit", "")),
        THREAD: str(feature.attributes.get("thread", "")),
        DEPTH: float(depth) if isinstance(depth, (int, float)) else 0.0,
    }
