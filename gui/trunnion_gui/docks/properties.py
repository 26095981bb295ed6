"""What is selected, in numbers; an operation's own settings, what is demanded of holes and what features keep can
be changed here."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtWidgets import QLabel, QScrollArea, QTableWidget, QVBoxLayout, QWidget

from trunnion.model.feature import Feature
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.settings import Value
from trunnion_gui import edits
from trunnion_gui.docks.feature_allowance import FeatureAllowanceFields
from trunnion_gui.docks.hole_demand import HoleDemandFields
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import kind_label
from trunnion_gui.look.words import (
    amount,
    duration,
    kind_words,
    over_bound,
    sentence,
    size_unit,
)
from trunnion_gui.widgets import table as tables
from trunnion_gui.worker.requests import OPERATION

Rows = list[tuple[str, str]]
UPRIGHT = (0.0, 0.0, 1.0)
"""The direction of a tool that stands along its setup's z."""


def data_choices(operation: Operation) -> dict[str, Value]:
    """Return what may be changed of an operation's tool and data, by the full keys of its form (`plan.operation_change`)."""
    return {
        "operation.tool": operation.tool.name,
        "operation.spindle": round(operation.data.spindle, 1),
        "operation.feed": round(operation.data.feed, 1),
    }


def tool_rows(operation: Operation) -> Rows:
    """Return the sizes of an operation's tool: of a turning tool those of its nose."""
    diameter, corner = operation.tool.cutter_sizes
    rows = [
        (tr("Diameter"), f"{amount(diameter)} mm"),
        (tr("Corner radius"), f"{amount(corner)} mm"),
    ]
    if operation.tool.rotates:
        rows.append((tr("Stickout"), f"{amount(operation.cutter.stickout)} mm"))
    return rows


def speed_rows(operation: Operation) -> Rows:
    """Return spindle speed, or the table's under a locked spindle, and feed, for an operation without fields for them."""
    data = operation.data
    name = tr("Table speed") if operation.tool.locked else tr("Spindle speed")
    return [
        (name, f"{amount(data.spindle, 0)} 1/min"),
        (tr("Feed"), f"{amount(data.feed, 0)} mm/min"),
    ]


def mode_rows(data: CuttingData) -> Rows:
    """Return what a program gives of speed and feed, where that is more than 1/min and mm/min."""
    rows = []
    if data.spindle_mode is SpindleMode.SURFACE:
        rows.append((tr("Highest spindle speed"), f"{amount(data.highest_spindle, 0)} 1/min"))
    if data.feed_mode is FeedMode.REVOLUTION:
        rows.append((tr("Feed per revolution"), f"{amount(data.feed_per_revolution)} mm"))
    return rows


class PropertiesDock(QScrollArea):
    """Properties of the selected feature or operation."""

    def __init__(self, document: Document, views: Views) -> None:
        super().__init__()
        self._document = document
        self._operation = ""
        self.form: Form | None = None
        self.data_form: Form | None = None
        self._requested: tuple[str, str, Value] | None = None
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        inside = QWidget()
        self._column = QVBoxLayout(inside)
        self._column.setContentsMargins(12, 8, 12, 8)
        self.title = QLabel()
        self.title.setObjectName("title")
        self.title.setWordWrap(True)
        self.subtitle = QLabel()
        self.subtitle.setObjectName("muted")
        self.subtitle.setWordWrap(True)
        self.table: QTableWidget = tables.table(["", ""])
        self.table.horizontalHeader().hide()
        self.rules = QLabel()
        self.rules.setObjectName("muted")
        self.rules.setWordWrap(True)
        self._data, self._forms = QVBoxLayout(), QVBoxLayout()
        self._data.setContentsMargins(8, 4, 8, 4)
        self._column.addWidget(self.title)
        self._column.addWidget(self.subtitle)
        self._column.addLayout(self._data)
        self.demand = HoleDemandFields(document)
        self._column.addWidget(self.demand)
        self.allowance = FeatureAllowanceFields(document, views)
        self._column.addWidget(self.allowance)
        self._column.addWidget(self.table)
        self._column.addWidget(self.rules)
        self._column.addLayout(self._forms)
        self._column.addStretch(1)
        self.setWidget(inside)
        document.selection.changed.connect(lambda _: self.refresh())
        document.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the properties of the selection."""
        selected, document = self._document.selection.current, self._document
        feature, operation = document.feature(selected.id), document.operation(selected.id)
        if selected.kind == "feature" and feature:
            self._show(feature.id, sentence(tr(kind_label(feature.kind))), feature_rows(feature))
        elif selected.kind == "operation" and operation:
            self._show(
                operation.id,
                f"{sentence(tr(kind_words(operation.kind)))} · {operation.feature}",
                self._operation_rows(operation),
            )
        elif selected.kind == "faces":
            rows = self._owner_rows(selected.faces)
            self._show(
                selected.id,
                "" if rows or len(selected.faces) != 1 else tr("no feature has this face"),
                rows,
            )
        else:
            self._show("", tr("Click a feature or an operation, in the picture or in a table."), [])
        rules = (
            (*operation.rules, *operation.data.rules)
            if selected.kind == "operation" and operation
            else ()
        )
        self.rules.setText(tr("Why: {reasons}").format(reasons="; ".join(rules)))
        self.rules.setVisible(bool(rules))
        self._show_form(operation if selected.kind == "operation" else None)
        self.demand.show_for(self._selected_features())
        self.allowance.show_for(self._selected_features())

    def _show(self, title: str, subtitle: str, rows: Rows) -> None:
        self.title.setText(title)
        self.title.setVisible(bool(title))
        self.subtitle.setText(subtitle)
        self.table.setVisible(bool(rows))
        tables.fill(self.table, rows, right=(1,))
        self.table.setFixedHeight(26 * len(rows) + 4)

    def _selected_features(self) -> list[Feature]:
        """Return the features that are selected, one or several together; none where faces are selected beside them."""
        selected = self._document.selection.current
        if selected.kind not in ("feature", "faces"):
            return []
        found = [self._document.feature(id) for id in selected.id.split(", ")]
        return [] if None in found else [f for f in found if f is not None]

    def _owner_rows(self, tags: tuple[int, ...]) -> Rows:
        """Return what the selected faces belong to, feature by feature."""
        rows = []
        for f in self._document.shown.recognition or ():
            own = [t for t in tags if t in f.tags]
            if own:
                rows.append(
                    (
                        f.id,
                        ", ".join(map(str, own)) if len(own) <= 5 else f"{len(own)} {tr('faces')}",
                    )
                )
        return rows

    def _operation_rows(self, o: Operation) -> Rows:
        data, verdict = o.data, self._document.shown.verdict
        proof = (
            next((p for p in verdict.operations if p.operation == o.id), None) if verdict else None
        )
        rows = [
            (tr("Tool"), f"T{o.tool.number} {o.tool.name}"),
            *tool_rows(o),
            (tr("Holder"), o.tool.holder_name),
            (tr("Cutting speed"), f"{amount(data.speed, 0)} m/min"),
            *([] if self._is_changeable(o) else speed_rows(o)),
            *mode_rows(data),
            (tr("Feed per tooth"), f"{amount(data.feed_per_tooth)} mm"),
            (tr("Depth of cut"), f"{amount(data.depth)} mm"),
            (tr("Width of cut"), f"{amount(data.width)} mm"),
            (tr("Power"), f"{amount(data.power, 1)} / {amount(data.power_limit, 1)} kW"),
            (tr("Torque"), f"{amount(data.torque, 1)} Nm"),
            (tr("Highest power"), f"{amount(data.highest_power, 1)} kW"),
        ]
        if o.direction != UPRIGHT:
            rows.insert(
                4,
                (
                    tr("Tool comes from"),
                    "  ".join(
                        f"{axis} {amount(v)}" for axis, v in zip("xyz", o.direction, strict=True)
                    ),
                ),
            )
        if proof is not None:
            rows += [
                (tr("Verdict"), tr(proof.outcome.value)),
                (tr("Time"), duration(proof.time_s)),
                (tr("Time over its bound"), over_bound(proof.over_bound)),
                (tr("Deepest gouge"), f"{amount(proof.gouge)} mm"),
            ]
        return rows

    def _show_form(self, operation: Operation | None) -> None:
        strategy = operation.strategy if operation else ""
        if (
            self.form is None
            or self.form.property("strategy") != strategy
            or operation is None
            or operation.id != self._operation
        ):
            self._make_data_form(operation)
            self._make_form(operation)
        if self.form is not None and operation is not None:
            self.form.fill({**self._document.session.choices, **operation.choices})
        if self.data_form is not None and operation is not None:
            self._requested = None
            self.data_form.fill(data_choices(operation))

    def _make_data_form(self, operation: Operation | None) -> None:
        """Make the form of what any operation of a rotating tool may be given: tool, spindle speed, feed."""
        if self.data_form is not None:
            self._data.removeWidget(self.data_form)
            self.data_form.deleteLater()
            self.data_form = None
        if operation is None or not self._is_changeable(operation):
            return
        values, id = data_choices(operation), operation.id
        settings = self._document.groups[OPERATION][0].settings
        declared = [replace(s, default=values[s.key]) for s in settings]
        self.data_form = Form(declared)
        labels = {s.key: s.label for s in declared}
        self.data_form.changed.connect(
            lambda key, value, _: self._change_data(id, key, tr(labels[key]), value)
        )
        self._data.addWidget(self.data_form)

    def _is_changeable(self, operation: Operation) -> bool:
        """Return whether there are fields for an operation's tool, speed and feed: once the worker has said what may be chosen."""
        tool = operation.tool
        return tool.rotates and not tool.locked and OPERATION in self._document.groups

    def _change_data(self, id: str, key: str, label: str, value: Value) -> None:
        """Ask for a change once: a line that is left by the return key and then loses the focus signals twice."""
        operation = self._document.operation(id)
        is_new = operation is not None and data_choices(operation)[key] != value
        if is_new and self._requested != (id, key, value):
            self._requested = (id, key, value)
            self._document.change_operation(id, f"{id}: {label} {value}", key, value)

    def _make_form(self, operation: Operation | None) -> None:
        if self.form is not None:
            self._forms.removeWidget(self.form)
            self.form.deleteLater()
            self.form = None
        self._operation = operation.id if operation else ""
        group = next(
            (
                g
                for g in self._document.groups.get("toolpath", ())
                if operation and g.name == operation.strategy
            ),
            None,
        )
        if operation is None or group is None:
            return
        self.form = Form(group.settings)
        self.form.setProperty("strategy", operation.strategy)
        labels, id = {s.key: s.label for s in group.settings}, operation.id
        self.form.changed.connect(
            lambda key, value, gesture: self._document.edit(
                f"{id}: {tr(labels[key])} {value}",
                edits.with_operation_choice(id, key, value),
                gesture,
            )
        )
        self._forms.addWidget(self.form)


def feature_rows(feature: Feature) -> Rows:
    """Return a feature's sizes, attributes and faces by role as words."""
    rows = [
        (sentence(tr(kind_words(name))), f"{amount(value)} {size_unit(name, value)}".strip())
        for name, value in feature.sizes.items()
    ]
    rows += [
        (sentence(tr(kind_words(name))), amount(value))
        for name, value in feature.attributes.items()
    ]
    for role in dict.fromkeys(f.role for f in feature.faces):
        tags = feature.with_role(role)
        rows.append(
            (
                sentence(tr(kind_words(role))),
                ", ".join(map(str, tags)) if len(tags) <= 5 else f"{len(tags)} {tr('faces')}",
            )
        )
    return rows
