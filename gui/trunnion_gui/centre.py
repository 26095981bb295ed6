"""The middle of the window: the picture with what lies above it, kept in step with the document."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSlider, QVBoxLayout, QWidget

from trunnion.model.session import Session, SizeEntry
from trunnion_gui.actions import Registry
from trunnion_gui.colours import Theme, kind_colour, motions
from trunnion_gui.document import Document, Selection
from trunnion_gui.i18n import tr
from trunnion_gui.viewport.scene import Scene
from trunnion_gui.widgets.legend import Legend
from trunnion_gui.widgets.notice import Notice
from trunnion_gui.widgets.welcome import Welcome
from trunnion_gui.words import amount, kind_words, sentence

_EDGE = 14


class Centre(QWidget):
    """Notice on top, picture, section slider; legend and welcome card above the picture."""

    def __init__(self, document: Document, registry: Registry, theme: Theme) -> None:
        super().__init__()
        self._document = document
        self._drawn: dict[str, object] = {}
        self.shows = {"colours": True, "blank": True, "paths": True, "isolate": False}
        self.motions: tuple[str, ...] = tuple(motions())
        self.notice = Notice()
        self.scene = Scene(theme)
        self.legend = Legend(self.scene)
        self.welcome = Welcome(document, registry, self.scene)
        self.section_bar, self.section_slider = self._make_section_bar()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(self.notice)
        column.addWidget(self.scene, 1)
        column.addWidget(self.section_bar)
        self.scene.clicked.connect(document.select_face)
        self.scene.hovered.connect(self._hover)
        document.mesh_changed.connect(self._show_mesh)
        document.changed.connect(self.refresh)
        document.selected.connect(self._choose)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.scene.use_theme(theme)
        self._drawn = {}
        self.refresh()
        self._choose(self._document.selection)

    def show_layer(self, name: str, on: bool) -> None:
        """Show or hide colours, blank or paths; fade what is not selected (`isolate`)."""
        self.shows[name] = on
        self.scene.isolate(self.shows["isolate"])
        self.refresh()

    def show_motions(self, kinds: tuple[str, ...]) -> None:
        """Show these kinds of motion only."""
        self.motions = kinds
        self.refresh()

    def show_section(self, on: bool) -> None:
        """Cut the part open, or close it."""
        self.section_bar.setVisible(on)
        self.scene.section(self.section_slider.value() / self.section_slider.maximum() if on else None)

    def show_size(self, entry: SizeEntry) -> None:
        """Show where a size is: its faces and its number."""
        self._document.select(Selection("faces", f"{kind_words(entry.name)} {entry.feature}", entry.faces))
        self.scene.show_label(f"{kind_words(entry.name)} {amount(entry.value)} {entry.unit}", entry.at)

    def refresh(self) -> None:
        """Draw what changed in the shown session."""
        session = self._document.shown
        self._once("frame", (session.recognition,), lambda: self._use_frame(session))
        self._once("kinds", (session.recognition, self.shows["colours"], self._shows_paths(session)), lambda: self._paint(session))
        self._once("blank", (session.blank, self.shows["blank"], self._shows_paths(session)), lambda: self.scene.show_blank(
            session.blank if self.shows["blank"] and not self._shows_paths(session) else None))
        self._once("setups", (session.setups, self._document.mesh), lambda: self.scene.show_setups(session.setups))
        self._once("paths", (session.paths, session.process, self.shows["paths"], self.motions, self._operation()),
                   lambda: self._draw_paths(session))
        self.legend.show_rows(self._legend(session))
        self._place()
        self.welcome.setVisible(not self._document.has_part and not self._document.is_busy)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place()

    def _once(self, name: str, inputs: tuple, draw: Callable[[], None]) -> None:
        """Draw a layer only when what it is drawn from is another thing than last time."""
        before = self._drawn.get(name)
        if isinstance(before, tuple) and len(before) == len(inputs) and all(a is b or _equal(a, b) for a, b in zip(before, inputs)):
            return
        self._drawn[name] = inputs
        draw()

    def _place(self) -> None:
        self.legend.move(_EDGE, _EDGE)
        self.welcome.move((self.scene.width() - self.welcome.width()) // 2, max((self.scene.height() - self.welcome.height()) // 2 - 20, 8))

    def _show_mesh(self) -> None:
        self._drawn = {}
        self.scene.show_label("")
        self.scene.show_mesh(self._document.mesh)

    def _use_frame(self, session: Session) -> None:
        if session.recognition is not None:
            self.scene.use_frame(session.recognition.frame)

    def _operation(self) -> str:
        chosen = self._document.selection
        return chosen.id if chosen.kind == "operation" else ""

    def _shows_paths(self, session: Session) -> bool:
        return self.shows["paths"] and bool(session.paths)

    def _paint(self, session: Session) -> None:
        colours: dict[int, str] = {}
        found = session.recognition
        if found is not None and self.shows["colours"]:
            colours.update(dict.fromkeys(found.unexplained, kind_colour("unexplained")))
            # The smaller feature wins a face that two features have, as it wins the click.
            for feature in sorted(found, key=lambda f: -len(f.tags)):
                colours.update(dict.fromkeys(feature.tags, kind_colour(feature.kind)))
        self.scene.show_kinds(colours, faded=self._shows_paths(session))

    def _draw_paths(self, session: Session) -> None:
        process, only = session.process, self._operation()
        if process is None or not self._shows_paths(session):
            self.scene.show_paths(())
            return
        frames = {o.id: process.setup(o.setup).frame for o in process.operations if not o.suppressed and only in ("", o.id)}
        self.scene.show_paths([(p.path, frames[p.operation]) for p in session.paths if p.operation in frames], self.motions)

    def _legend(self, session: Session) -> list[tuple[str, str, str]]:
        rows: list[tuple[str, str, str]] = []
        found = session.recognition
        if found is not None and self.shows["colours"]:
            rows += [(kind_colour(kind), sentence(tr(kind_words(kind))), str(n)) for kind, n in found.counts().items()]
            if found.unexplained:
                rows.append((kind_colour("unexplained"), tr("Unexplained"), str(len(found.unexplained))))
        if self._shows_paths(session):
            rows += [("", "", ""), *((motions()[m], sentence(tr(m)), "") for m in self.motions)]
        return rows

    def _choose(self, selection: Selection) -> None:
        self.scene.show_label("")
        self.scene.choose(selection.faces, filled=selection.kind != "operation" or not self._shows_paths(self._document.shown))
        self.refresh()

    def _hover(self, tag: int) -> None:
        found = self._document.shown.recognition
        owners = [f for f in found or () if tag in f.tags]
        feature = min(owners, key=lambda f: len(f.tags)) if owners else None
        self.scene.hover(feature.tags if feature else (tag,) if tag else ())
        words = f"{feature.id} · face {tag}" if feature else f"face {tag}" if tag else ""
        self.scene.view.setToolTip(words)

    def _make_section_bar(self) -> tuple[QWidget, QSlider]:
        bar, slider = QWidget(), QSlider(Qt.Orientation.Horizontal)
        slider.setRange(0, 200)
        slider.setValue(120)
        slider.valueChanged.connect(lambda _: self.show_section(True))
        row = QHBoxLayout(bar)
        row.setContentsMargins(14, 2, 14, 6)
        row.addWidget(QLabel(tr("Section")))
        row.addWidget(slider, 1)
        bar.hide()
        return bar, slider


def _equal(a: object, b: object) -> bool:
    """Compare words, tuples of words and switches by value; everything else by identity, which is how the session's parts change."""
    if isinstance(a, tuple):
        return isinstance(b, tuple) and all(isinstance(x, str) for x in a + b) and a == b
    return isinstance(a, (str, bool)) and a == b
