"""Features given other faces: what menus on faces and features offer for it, and the requests to the worker."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from trunnion.model.feature import Feature
from trunnion.recognize.contract import describable_kinds
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import kind_colour, kind_label
from trunnion_gui.look.words import faces_named, sentence
from trunnion_gui.widgets.table import colour_icon
from trunnion_gui.worker import face_requests
from trunnion_gui.worker.requests import Work


class FaceEdits(QObject):
    """Edits of features by their faces, of families that can describe features so; each is one entry of the history."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document

    def add_face_entries(self, menu: QMenu, tags: tuple[int, ...]) -> None:
        """Add what may be done with some faces to a menu: added to a feature, taken from theirs, made a new one."""
        features = self._describable()
        kinds = self._kinds()
        if not tags or not kinds:
            return
        owners = [f for f in features if set(f.tags) & set(tags)]
        others = [f for f in features if not set(tags) <= set(f.tags)]
        if others:
            into = menu.addMenu(
                icons.icon("move_faces"),
                tr("Add to") if len(tags) == 1 else tr("Add {n} faces to").format(n=len(tags)),
            )
            for f in others:
                into.addAction(
                    colour_icon(kind_colour(f.kind)), f.id, partial(self.add, f.id, tags)
                )
        for f in owners:
            gone = tuple(t for t in tags if t in f.tags)
            menu.addAction(tr("Take from {id}").format(id=f.id), partial(self.take, f.id, gone))
        make = menu.addMenu(icons.icon("kind"), tr("New feature"))
        for kind in kinds:
            make.addAction(
                colour_icon(kind_colour(kind)),
                sentence(tr(kind_label(kind))),
                partial(self.make, kind, tags),
            )

    def add_feature_entries(
        self, menu: QMenu, feature: Feature, selected_ids: Sequence[str]
    ) -> None:
        """Add what may be done with a feature's faces to its menu; `selected_ids` are the features of all selected rows."""
        ids = [f.id for f in self._describable()]
        selected = self._document.selection.current
        if feature.id not in ids:
            return
        if len(selected_ids) > 1 and feature.id in selected_ids and set(selected_ids) <= set(ids):
            others = [id for id in selected_ids if id != feature.id]
            menu.addAction(
                icons.icon("move_faces"),
                tr("Merge {ids} into {id}").format(ids=", ".join(others), id=feature.id),
                partial(self.merge, (feature.id, *others)),
            )
        elif selected.kind == "faces" and not set(selected.faces) <= set(feature.tags):
            menu.addAction(
                icons.icon("move_faces"),
                tr("Take the selected faces in"),
                partial(self.add, feature.id, selected.faces),
            )

    def add(self, id: str, tags: tuple[int, ...]) -> None:
        """Add faces to a feature."""
        label = tr("Add face {faces} to {id}").format(faces=faces_named(tags), id=id)
        self._change(face_requests.add, label, id, tags)

    def take(self, id: str, tags: tuple[int, ...]) -> None:
        """Take faces from a feature."""
        label = tr("Take face {faces} from {id}").format(faces=faces_named(tags), id=id)
        self._change(face_requests.take, label, id, tags)

    def merge(self, ids: tuple[str, ...]) -> None:
        """Make one feature of several, with the first one's name."""
        self._change(face_requests.merge, tr("Merge {ids}").format(ids=", ".join(ids)), ids)

    def make(self, kind: str, tags: tuple[int, ...]) -> None:
        """Make a new feature of faces."""
        label = tr("New {kind} of face {faces}").format(
            kind=tr(kind_label(kind)), faces=faces_named(tags)
        )
        self._change(face_requests.make, label, kind, tags)

    def _change(self, work: Work, label: str, *arguments: object) -> None:
        self._document.request(
            work, label, *arguments, finish=lambda state: self._document.keep(label, state)
        )

    def _kinds(self) -> tuple[str, ...]:
        found = self._document.shown.recognition
        return describable_kinds(found.family) if found is not None else ()

    def _describable(self) -> list[Feature]:
        kinds = self._kinds()
        return [f for f in self._document.shown.recognition or () if f.kind in kinds]
