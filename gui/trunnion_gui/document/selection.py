"""What is selected, the same in every view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

if TYPE_CHECKING:
    from trunnion_gui.document.document import Document


@dataclass(frozen=True, slots=True)
class Selection:
    """What is selected: `kind` is feature, operation, faces, or empty; `id` the feature's or operation's; `faces` their tags."""

    kind: str = ""
    id: str = ""
    faces: tuple[int, ...] = ()


NOTHING = Selection()


class SelectionModel(QObject):
    """The selection of a document, by features, operations, faces, and the words of findings."""

    changed = Signal(object)
    """Another `Selection`."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.current = NOTHING

    def clear(self) -> None:
        """Select nothing of another part, and notify every view."""
        self.current = NOTHING
        self.changed.emit(NOTHING)

    def select(self, selection: Selection) -> None:
        """Make something the selection of every view."""
        if selection != self.current:
            self.current = selection
            self.changed.emit(selection)

    def select_feature(self, id: str) -> None:
        """Select a feature with its faces."""
        found = self._document.feature(id)
        self.select(Selection("feature", id, found.tags) if found else NOTHING)

    def select_operation(self, id: str) -> None:
        """Select an operation with the faces of its feature."""
        found = self._document.operation(id)
        feature = self._document.feature(found.feature) if found else None
        faces = found.faces or (feature.tags if feature else ()) if found else ()
        self.select(Selection("operation", id, faces) if found else NOTHING)

    def select_face(self, tag: int) -> None:
        """Select the feature a face belongs to, the smallest when there are several; the face itself when there is none."""
        owners = [f for f in (self._document.shown.recognition or ()) if tag in f.tags]
        if owners:
            self.select_feature(min(owners, key=lambda f: len(f.tags)).id)
        else:
            self.select(Selection("faces", f"face {tag}", (tag,)) if tag else NOTHING)

    def select_ids(self, words: Sequence[str]) -> bool:
        """Select features and faces by their ids (`group-05`, `face 12`, `12`), all together; return whether there was any."""
        features = [f for f in (self._document.shown.recognition or ()) if f.id in words]
        known = (
            set(np.unique(self._document.mesh.face).tolist())
            if self._document.mesh is not None
            else set()
        )
        given = [w.removeprefix("face").strip() for w in words]
        faces = [int(w) for w in given if w.isdigit() and int(w) in known]
        if len(features) == 1 and not faces:
            self.select_feature(features[0].id)
        elif features or faces:
            names = [f.id for f in features] + [f"face {t}" for t in faces]
            tags = dict.fromkeys([t for f in features for t in f.tags] + faces)
            self.select(Selection("faces", ", ".join(names), tuple(tags)))
        return bool(features or faces)

    def select_face_alone(self, tag: int) -> None:
        """Select one face, whatever it belongs to."""
        self.select(Selection("faces", f"face {tag}", (tag,)) if tag else NOTHING)

    def toggle_face(self, tag: int) -> None:
        """Take one more face into the selection, or out of it again."""
        if tag:
            selected = self.current.faces if self.current.kind in ("faces", "feature") else ()
            faces = tuple(t for t in selected if t != tag) if tag in selected else (*selected, tag)
            self.select(
                Selection("faces", ", ".join(f"face {t}" for t in faces), faces)
                if faces
                else NOTHING
            )

    def select_where(self, words: tuple[str, ...]) -> None:
        """Select what the words of a finding name."""
        for word in words:
            if self._document.feature(word):
                self.select_feature(word)
                return
            if self._document.operation(word):
                self.select_operation(word)
                return
        tags = tuple(int(w[5:]) for w in words if w.startswith("face ") and w[5:].isdigit())
        if tags:
            self.select(Selection("faces", ", ".join(f"face {t}" for t in tags), tags))

    def follow(self) -> None:
        """Drop a selection whose feature or operation is gone, follow one whose faces changed."""
        selected = self.current
        if selected.kind == "feature":
            found = self._document.feature(selected.id)
            self.select(replace(selected, faces=found.tags) if found else NOTHING)
        elif selected.kind == "operation" and self._document.operation(selected.id) is None:
            self.select(NOTHING)
