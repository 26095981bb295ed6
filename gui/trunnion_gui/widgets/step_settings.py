"""The settings of a step in its panel: a form for each group, made when it is first unfolded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QVBoxLayout, QWidget

from trunnion.model.feature import Recognition
from trunnion.settings import Value
from trunnion_gui import edits
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.form import Form
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.worker.requests import SettingsGroup

_FEW = 4
"""The first group of a step is shown open when it has at most so many settings; everything else is folded."""
_MANY = 3
"""More groups than this are folded once more, all together."""


class StepSettings(QVBoxLayout):
    """The groups of a step one under the other.

    All forms of the program together take some tenths of a second to make, and most of them are never looked at: `show_groups` makes those
    that stand open, every other one is made when its group is unfolded.
    """

    def __init__(self, document: Document, views: Views, *, folds_first: bool = False) -> None:
        super().__init__()
        self.setSpacing(6)
        self._document, self._views = document, views
        self._folds_first = folds_first
        self._theme: Theme | None = None
        self._forms: dict[int, Form] = {}
        self._foldouts: list[Foldout] = []
        self._by_name: dict[str, QWidget] = {}

    @property
    def forms(self) -> tuple[Form, ...]:
        """The forms of all groups, in their order; those that nobody has unfolded yet are made."""
        # The foldout of all groups appends theirs while the loop runs.
        for foldout in self._foldouts:
            foldout.make_body()
        return tuple(self._forms[number] for number in sorted(self._forms))

    def group(self, name: str) -> QWidget:
        """Return what shows a group of settings: its foldout, or its form where that stands open."""
        return self._by_name[name]

    def show_groups(self, groups: Sequence[SettingsGroup], before: QWidget) -> None:
        """Show groups, all of them folded but a short first one. In the order of the tab key they come before a widget of the panel."""
        numbered, after = list(enumerate(groups)), preceding_by_tab(before)
        if groups and len(groups[0].settings) <= _FEW and not self._folds_first:
            form = self._form(*numbered.pop(0))
            self.addWidget(form)
            self._by_name[groups[0].name] = form
            after = follow_by_tab(after, form.fields())
        if self._views.most_offered([g.name for g in groups]) > _MANY:
            whole = self._foldout(tr("Settings"))
            whole.makes = partial(self._add_groups, whole.content, numbered, whole.header)
            self.addWidget(whole)
            follow_by_tab(after, (whole.header,))
        else:
            self._add_groups(self, numbered, after)

    def fill(self, choices: Mapping[str, Value]) -> None:
        """Show the values of settings by full key in the forms that are made."""
        for form in self._forms.values():
            form.fill(choices)

    def show_own(self, found: Recognition | None) -> None:
        """Hide the settings of families that the part has nothing of."""
        for name, widget in self._by_name.items():
            widget.setVisible(self._views.offers(name, found))

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        for foldout in self._foldouts:
            foldout.use_theme(theme)

    def _add_groups(
        self, rows: QVBoxLayout, numbered: Sequence[tuple[int, SettingsGroup]], after: QWidget
    ) -> None:
        """Add the foldouts of groups, which are given with their number in the step."""
        for number, group in numbered:
            foldout = self._foldout(tr("{group} settings").format(group=tr(group.title)))
            foldout.makes = partial(self._add_form, foldout, number, group)
            rows.addWidget(foldout)
            self._by_name[group.name] = foldout
            after = follow_by_tab(after, (foldout.header,))
        self.show_own(self._document.shown.recognition)

    def _add_form(self, foldout: Foldout, number: int, group: SettingsGroup) -> None:
        form = self._form(number, group)
        foldout.content.addWidget(form)
        follow_by_tab(foldout.header, form.fields())

    def _foldout(self, title: str) -> Foldout:
        foldout = Foldout(title, is_group=True)
        if self._theme is not None:
            foldout.use_theme(self._theme)
        self._foldouts.append(foldout)
        return foldout

    def _form(self, number: int, group: SettingsGroup) -> Form:
        form = Form(group.settings)
        form.fill(self._document.session.choices)
        labels = {s.key: s.label for s in group.settings}
        form.changed.connect(
            lambda key, value, gesture: self._document.choose(
                key, f"{tr(labels[key])}: {value}", value, gesture
            )
        )
        form.reset.connect(
            lambda key: self._document.edit(
                f"{tr(labels[key])}: default", edits.without_choices(key)
            )
        )
        self._forms[number] = form
        return form


def preceding_by_tab(widget: QWidget) -> QWidget:
    """Return the widget that the tab key reaches before another one."""
    found = widget
    while (before := found.previousInFocusChain()) is not None and before is not widget:
        found = before
        if found.focusPolicy() & Qt.FocusPolicy.TabFocus:
            break
    return found


def follow_by_tab(after: QWidget, widgets: Sequence[QWidget]) -> QWidget:
    """Let widgets follow another one when a person presses the tab key, and return the last one that the key reaches."""
    for widget in widgets:
        if widget.focusPolicy() & Qt.FocusPolicy.TabFocus:
            QWidget.setTabOrder(after, widget)
            after = widget
    return after
