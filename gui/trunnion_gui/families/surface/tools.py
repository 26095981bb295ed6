"""What a person does with the groups of equal patches of a curved part: calls them local features, moves faces between them, cuts faces."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QMenu

from trunnion.geometry.cut import Cut
from trunnion.model.feature import Feature
from trunnion_gui.document import Document
from trunnion_gui.families.surface.groups import GROUP, is_local, with_local
from trunnion_gui.families.surface.jobs import PatchJobs
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import feature_colours
from trunnion_gui.widgets.table import colour_icon


class PatchTools(QObject):
    """Edits of groups and faces by tag, and the menu that offers them."""

    cut_wanted = Signal(int, bool)
    """A face (0: the next one that is clicked) shall be cut: by a plane, or else by a way that is drawn."""

    def __init__(self, document: Document, jobs: PatchJobs) -> None:
        super().__init__(document)
        self._document, self._jobs = document, jobs

    @property
    def has_groups(self) -> bool:
        """Whether the shown part was segmented into groups."""
        found = self._document.shown.recognition
        return found is not None and any(f.kind == GROUP for f in found.features)

    def groups_of(self, tags: Iterable[int]) -> list[Feature]:
        """Return the groups that some faces belong to, in their order."""
        wanted = set(tags)
        return [
            f
            for f in self._document.shown.recognition or ()
            if f.kind == GROUP and wanted & set(f.tags)
        ]

    def toggle_face(self, face: int) -> bool:
        """Change the class of a face's group; return whether there is one."""
        groups = self.groups_of((face,))
        self.toggle_local((face,))
        return bool(groups)

    def toggle_local(self, tags: Iterable[int]) -> None:
        """Call the groups of some faces local features; when they all are, call them so no longer."""
        groups = self.groups_of(tags)
        if groups:
            self.set_local([f.id for f in groups], not all(map(is_local, groups)))

    def set_local(self, ids: list[str], value: bool) -> None:
        """Call groups local features, or not."""
        words = tr("{id} is a local feature") if value else tr("{id} is no local feature")
        self._document.edit(words.format(id=", ".join(ids)), with_local(ids, value))

    def add_entries(self, menu: QMenu, tags: tuple[int, ...]) -> None:
        """Add what may be done with some faces to a menu."""
        groups, document = self.groups_of(tags), self._document
        if groups:
            are_local = all(map(is_local, groups))
            local = menu.addAction(
                tr("Local feature"), lambda: self.set_local([f.id for f in groups], not are_local)
            )
            local.setCheckable(True)
            local.setChecked(are_local)
        if self.has_groups and tags:
            self._add_groups(menu, tags, groups)
        if len(tags) == 1:
            menu.addAction(
                icons.icon("cut_plane"),
                tr("Cut face {n} by a plane…").format(n=tags[0]),
                lambda: self.cut_wanted.emit(tags[0], True),
            )
            menu.addAction(
                icons.icon("cut_way"),
                tr("Cut face {n} along a drawn line…").format(n=tags[0]),
                lambda: self.cut_wanted.emit(tags[0], False),
            )
        cuts = document.session.cuts
        if cuts:
            back = menu.addMenu(icons.icon("undo"), tr("Take back a cut"))
            for number, cut in enumerate(cuts):
                back.addAction(cut_words(number, cut), partial(self._jobs.take_back, number))

    def _add_groups(self, menu: QMenu, tags: tuple[int, ...], own: list[Feature]) -> None:
        found = self._document.shown.recognition
        assert found is not None
        colours = feature_colours(found)
        into = menu.addMenu(
            icons.icon("move_faces"),
            tr("Move to") if len(tags) == 1 else tr("Move {n} faces to").format(n=len(tags)),
        )
        for group in found.of_kind(GROUP):
            if [group] != own:
                into.addAction(
                    colour_icon(colours[group.id]),
                    group.id,
                    partial(self._jobs.move, tags, group.id),
                )
        into.addSeparator()
        into.addAction(tr("a new group"), lambda: self._jobs.move(tags))


def cut_words(number: int, cut: Cut) -> str:
    """Return which cut one is, counted from 1: the face that was cut, and by what."""
    by = tr("by a plane") if cut.is_plane else tr("along a drawn line")
    return f"{number + 1}: {tr('face')} {cut.face} {by}"
