"""What the six panels share: a foldout with forms of the step's settings, one main button, and a line of result."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QWidget

from trunnion_gui.actions import Registry
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import duration
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.widgets.step_settings import StepSettings
from trunnion_gui.worker.steps import STEPS, PanelStage, joined_state


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
        self._main: list[QPushButton] = []
        self._settings_shown: Mapping | None = None
        self.settings = StepSettings(document, views, folds_first=self.folds_settings)
        self.result = QLabel()
        self.result.setWordWrap(True)
        self.result.setObjectName("muted")
        self.build()
        document.changed.connect(self.refresh)
        document.jobs.changed.connect(self.refresh)

    def build(self) -> None:
        """Lay the panel out: settings, main button, result."""
        self.content.addLayout(self.settings)
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
        if not self.is_folded:
            self.make_body()
        self.settings.fill(document.session.choices)
        self.settings.show_own(document.shown.recognition)
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
        self.settings.use_theme(theme)
        self.fill()

    @property
    def forms(self) -> tuple[Form, ...]:
        """The forms of all settings of the step, also of those that nobody has unfolded yet."""
        self.make_body()
        return self.settings.forms

    def make_body(self) -> None:
        """Add the settings once the worker has sent them: when the panel is opened first, or at once while it stands open."""
        super().make_body()
        groups = self.document.groups
        if groups is self._settings_shown:
            return
        self._settings_shown = groups
        own = [g for step in self.stage.steps for g in groups.get(step, ()) if g.settings]
        self.settings.show_groups(own, before=self._main[0])


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
