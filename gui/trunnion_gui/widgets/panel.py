"""What the six panels share: a foldout with forms of the step's settings, one main button, and a line of result."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from trunnion_gui import edits
from trunnion_gui.actions import Registry
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import duration
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.worker.requests import SettingsGroup
from trunnion_gui.worker.steps import STEPS, PanelStage, joined_state

_FEW = 4
"""The first group of a step is shown open when it has at most so many settings; everything else is folded."""


_MANY = 3
"""More groups than this are folded once more, all together."""


class Panel(Foldout):
    """One step of the work. A subclass gives `command` (the main button), `fill` (results) and may add to `content`."""

    command = ""
    folds_settings = False

    def __init__(
        self, stage: PanelStage, number: int, document: Document, registry: Registry, views: Views
    ) -> None:
        super().__init__(tr(stage.title), number, is_open=number == 1)
        self.setProperty("stage", stage.name)
        self.stage = stage
        self.document = document
        self.registry = registry
        self.views = views
        self.theme: Theme | None = None
        self.forms: list[Form] = []
        self._groups: list[Foldout] = []
        self._by_name: dict[str, QWidget] = {}
        self._main: list[QPushButton] = []
        self._settings_shown: Mapping | None = None
        self._settings = QVBoxLayout()
        self._settings.setSpacing(6)
        self.result = QLabel()
        self.result.setWordWrap(True)
        self.result.setObjectName("muted")
        self.build()
        document.changed.connect(self.refresh)
        document.jobs.changed.connect(self.refresh)

    def build(self) -> None:
        """Lay the panel out: settings, main button, result."""
        self.content.addLayout(self._settings)
        self.content.addWidget(self.button(self.command, primary=True))
        self.content.addWidget(self.result)

    def fill(self) -> None:
        """Show the results of the shown session."""

    def button(self, command: str, primary: bool = False) -> QPushButton:
        """Return a button for a command of the registry."""
        action = self.registry.action(command)
        button = QPushButton(action.text())
        if primary:
            self._main.append(button)
        button.setProperty("command", command)
        button.setToolTip(action.toolTip())
        button.setEnabled(action.isEnabled())
        button.clicked.connect(action.trigger)
        action.enabledChanged.connect(button.setEnabled)
        return button

    def buttons(self, *commands: str, primary: str = "") -> QWidget:
        """Return a row of buttons."""
        row = QWidget()
        line = QHBoxLayout(row)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(6)
        for command in commands:
            line.addWidget(self.button(command, primary=command == primary))
        return row

    def refresh(self) -> None:
        """Show state, time, settings and results anew."""
        document = self.document
        records = document.shown.records
        state = (
            "running"
            if document.running_step in self.stage.steps
            else joined_state(document.states, self.stage.steps)
        )
        taken = sum(records[s].seconds for s in self.stage.steps if s in records)
        self.show_state(
            state, duration(taken) if any(s in records for s in self.stage.steps) else ""
        )
        if document.groups is not self._settings_shown:
            self._make_forms()
        for form in self.forms:
            form.fill(document.session.choices)
        self._show_own_groups()
        self._stress(state)
        self.fill()
        self.result.setVisible(bool(self.result.text()))

    def _stress(self, state: str) -> None:
        """Give the main button the accent while its step is the next one to do."""
        earlier = STEPS[: STEPS.index(self.stage.steps[0])]
        states = self.document.states
        is_next = (
            state in ("empty", "stale")
            and self.document.has_part
            and all(states.get(s) in ("done", "problem") for s in earlier)
        )
        for button in self._main:
            name = "primary" if is_next else ""
            if button.objectName() != name:
                button.setObjectName(name)
                button.style().unpolish(button)
                button.style().polish(button)

    def use_theme(self, theme: Theme) -> None:
        self.theme = theme
        super().use_theme(theme)
        for group in self._groups:
            group.use_theme(theme)
        self.fill()

    def _make_forms(self) -> None:
        self._settings_shown = self.document.groups
        groups = [
            g for step in self.stage.steps for g in self.document.groups.get(step, ()) if g.settings
        ]
        inside = self._settings
        if self.views.most_offered([g.name for g in groups]) > _MANY:
            whole = self._folded(tr("Settings"))
            self._settings.addWidget(whole)
            inside = whole.content
        for n, group in enumerate(groups):
            form = self._form(group)
            if n == 0 and len(group.settings) <= _FEW and not self.folds_settings:
                self._settings.addWidget(form)
                self._by_name[group.name] = form
                continue
            foldout = self._folded(tr("{group} settings").format(group=tr(group.title)))
            foldout.content.addWidget(form)
            inside.addWidget(foldout)
            self._by_name[group.name] = foldout

    def _show_own_groups(self) -> None:
        """Hide the settings of families that the part has nothing of."""
        found = self.document.shown.recognition
        for name, widget in self._by_name.items():
            widget.setVisible(self.views.offers(name, found))

    def _folded(self, title: str) -> Foldout:
        foldout = Foldout(title, is_group=True)
        if self.theme is not None:
            foldout.use_theme(self.theme)
        self._groups.append(foldout)
        return foldout

    def _form(self, group: SettingsGroup) -> Form:
        form = Form(group.settings)
        labels = {s.key: s.label for s in group.settings}
        form.changed.connect(
            lambda key, value, gesture: self.document.choose(
                key, f"{tr(labels[key])}: {value}", value, gesture
            )
        )
        form.reset.connect(
            lambda key: self.document.edit(
                f"{tr(labels[key])}: default", edits.without_choices(key)
            )
        )
        self.forms.append(form)
        return form


def rule() -> QFrame:
    """Return a thin line between two things."""
    line = QFrame()
    line.setObjectName("rule")
    return line


def swatch(colour: str, size: int = 11) -> QLabel:
    """Return a small square in a colour."""
    label = QLabel()
    label.setFixedSize(size, size)
    label.setStyleSheet(f"background: {colour}; border-radius: 2px")
    return label
