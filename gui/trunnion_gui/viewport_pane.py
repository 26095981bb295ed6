"""The middle of the window: the picture with what lies above it, kept in step with the document."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSlider, QVBoxLayout, QWidget

from trunnion.model.guides import GuideCurve
from trunnion.model.playback import Moment
from trunnion.model.session import Session, SizeEntry
from trunnion.report.deviation import WorstPoint
from trunnion.report.lines import leans
from trunnion.report.palette import load_palette
from trunnion_gui.actions import Registry
from trunnion_gui.deviation import DeviationSource
from trunnion_gui.document import Document, Selection
from trunnion_gui.families.contract import Colouring, LegendRow
from trunnion_gui.families.views import Views
from trunnion_gui.guides import GuideSource
from trunnion_gui.i18n import tr
from trunnion_gui.look import legend
from trunnion_gui.look.colours import Theme, motions
from trunnion_gui.look.words import amount, fine_amount, kind_words
from trunnion_gui.playback.player import Player
from trunnion_gui.viewport.scene import Click, ViewportScene
from trunnion_gui.widgets.colour_bar import ColourBar
from trunnion_gui.widgets.legend import Legend
from trunnion_gui.widgets.notice import Notice
from trunnion_gui.widgets.welcome import Welcome
from trunnion_gui.worker.drawing import DrawnMap, point_on

_EDGE = 14
_TIP_AWAY = 16
_LONGEST_TRAIL = 20_000
"""Chords of the path behind the tool that are shown: a surface's path has hundreds of thousands, and each frame sends them anew."""
_MOST_IDS = 200
"""IDs that are written on the part at most."""
_CLOSE_LOOK = 30.0
"""mm above and below a worst place that a click on it shows."""


class PictureTool(Protocol):
    """Something a person does in the picture with clicks on the part, from beginning to end."""

    @property
    def is_on(self) -> bool: ...
    def take(self, click: Click) -> None: ...
    def end(self) -> None: ...
    def use_theme(self) -> None: ...


class ViewportPane(QWidget):
    """Notice on top, picture, section slider; legend and welcome card above the picture."""

    hinted = Signal(str)
    """Words for the status line about what is under the mouse."""

    def __init__(
        self,
        document: Document,
        registry: Registry,
        theme: Theme,
        player: Player,
        deviation: DeviationSource,
        guides: GuideSource,
        views: Views,
    ) -> None:
        super().__init__()
        self._document = document
        self._player, self._deviation, self._views = player, deviation, views
        self._guides = guides
        self._theme = theme
        self._tool: object = None
        self._run: tuple[int, np.ndarray, np.ndarray] = (-1, np.zeros((0, 3)), np.zeros(0))
        self._drawn: dict[str, object] = {}
        self.shows = {"colours": True, "blank": True, "paths": True, "isolate": False, "ids": False}
        self._colouring: Colouring | None = None
        self._takes_click: Callable[[int], bool] | None = None
        self.motions: tuple[str, ...] = tuple(motions())
        self.notice = Notice()
        self.scene = ViewportScene(theme)
        self.legend = Legend(self.scene)
        self.scale = ColourBar(self.scene, theme, load_palette().deviation)
        self.tip = self._make_tip()
        self.welcome = Welcome(document, registry, self.scene)
        self.section_bar, self.section_slider = self._make_section_bar()
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._column.addWidget(self.notice)
        self._column.addWidget(self.scene, 1)
        self._column.addWidget(self.section_bar)
        self._tools: list[PictureTool] = []
        self.scene.clicked.connect(self._click)
        self.scene.menu_requested.connect(self._open_menu)
        self.scene.hovered.connect(self._hover)
        document.mesh_changed.connect(self._show_mesh)
        document.redrawn.connect(self._redraw_mesh)
        document.changed.connect(self.refresh)
        document.selection.changed.connect(self._choose)
        self.scene.pointed.connect(self._point)
        player.opened.connect(self._open_playback)
        player.moved.connect(self._move_tool)
        player.cut.connect(self._show_stock)
        deviation.arrived.connect(self._show_map)
        guides.arrived.connect(lambda _: self.refresh())

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.scene.use_theme(theme)
        self.scale.use_theme(theme)
        for tool in self._tools:
            tool.use_theme()
        self._drawn = {}
        self._show_map(self._deviation.shown if self._deviation.is_on else None)
        self.refresh()
        self._choose(self._document.selection.current)

    def add_bar(self, bar: QWidget) -> None:
        """Put a bar below the picture."""
        self._column.addWidget(bar)

    def add_tool(self, tool: PictureTool) -> None:
        """Give clicks on the part to a tool while it is on."""
        self._tools.append(tool)

    def end_tool(self) -> bool:
        """Put the tool away that is on; return whether there was one."""
        tool = self._tool_on()
        if tool is not None:
            tool.end()
        return tool is not None

    def _tool_on(self) -> PictureTool | None:
        return next((tool for tool in self._tools if tool.is_on), None)

    def show_layer(self, name: str, on: bool) -> None:
        """Show or hide colours, blank or paths; fade what is not selected (`isolate`)."""
        self.shows[name] = on
        self.scene.isolate(self.shows["isolate"])
        self.refresh()

    def colour_by(self, colouring: Colouring | None) -> None:
        """Colour the part otherwise than by its features; None: by these again."""
        self._colouring = colouring
        self.refresh()

    def give_clicks_to(self, takes_click: Callable[[int], bool] | None) -> None:
        """Offer the face of every click to a function first, which returns whether it took it; None: to nobody."""
        self._takes_click = takes_click

    def show_motions(self, kinds: tuple[str, ...]) -> None:
        """Show these kinds of motion only."""
        self.motions = kinds
        self.refresh()

    def show_section(self, on: bool) -> None:
        """Cut the part open, or close it."""
        self.section_bar.setVisible(on)
        self.scene.section(
            self.section_slider.value() / self.section_slider.maximum() if on else None
        )

    def show_size(self, entry: SizeEntry) -> None:
        """Show where a size is: its faces and its number."""
        self._document.selection.select(
            Selection("faces", f"{kind_words(entry.name)} {entry.feature}", entry.faces)
        )
        self.scene.show_label(
            f"{kind_words(entry.name)} {amount(entry.value)} {entry.unit}", entry.at, entry.to
        )

    def refresh(self) -> None:
        """Draw what changed in the shown session."""
        session = self._document.shown
        self._once("frame", (session.recognition,), lambda: self._use_frame(session))
        self._once(
            "kinds",
            (
                session.recognition,
                self.shows["colours"],
                self._colouring,
                self._shows_paths(session),
            ),
            lambda: self._paint(session),
        )
        self._once(
            "ids",
            (
                session.recognition,
                self._document.mesh,
                self._document.selection.current,
                self.shows["ids"],
            ),
            lambda: self._write_ids(session),
        )
        shows_blank = (
            self.shows["blank"]
            and not self._shows_paths(session)
            and not self._plays
            and not self._shows_map
        )
        self._once(
            "blank",
            (session.blank, shows_blank),
            lambda: self.scene.show_blank(session.blank if shows_blank else None),
        )
        self._once(
            "setups",
            (session.setups, self._document.mesh),
            lambda: self.scene.show_setups(session.setups),
        )
        self._once(
            "paths",
            (
                session.paths,
                session.process,
                self._shows_paths(session),
                self.motions,
                self._operation(),
            ),
            lambda: self._draw_paths(session),
        )
        self._once(
            "guides",
            (self._guide_lines, self._document.mesh),
            lambda: self.scene.show_guides(self._guide_lines),
        )
        self.legend.show_rows(self._legend(session))
        self._arrange()
        self.welcome.setVisible(not self._document.has_part and not self._document.is_busy)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._arrange()

    def _once(self, name: str, inputs: tuple, draw: Callable[[], None]) -> None:
        """Draw a layer only when what it is drawn from is another thing than last time."""
        before = self._drawn.get(name)
        if (
            isinstance(before, tuple)
            and len(before) == len(inputs)
            and all(a is b or _equal(a, b) for a, b in zip(before, inputs))
        ):
            return
        self._drawn[name] = inputs
        draw()

    def _arrange(self) -> None:
        self.legend.move(_EDGE, _EDGE)
        self.scale.move(_EDGE, _EDGE)
        card = next((c for c in (self.scale, self.legend) if c.isVisible()), None)
        self.scene.set_covered(
            QRectF(card.geometry()).adjusted(-_EDGE, -_EDGE, _EDGE, _EDGE)
            if card is not None
            else QRectF()
        )
        self.welcome.move(
            (self.scene.width() - self.welcome.width()) // 2,
            max((self.scene.height() - self.welcome.height()) // 2 - 20, 8),
        )

    def _show_mesh(self) -> None:
        self._drawn = {}
        self.scene.show_label("")
        self.scene.show_mesh(self._document.drawing)

    def _redraw_mesh(self) -> None:
        self._drawn = {}
        self.scene.show_mesh(self._document.drawing, keep_camera=True)

    def _click(self, click: Click) -> None:
        tool = self._tool_on()
        if tool is not None:
            tool.take(click)
        elif self._takes_click is not None and self._takes_click(click.face):
            return
        elif click.with_ctrl:
            self._document.selection.toggle_face(click.face)
        else:
            self._document.selection.select_face(click.face)

    def _open_menu(self, click: Click, at: QPoint) -> None:
        """Offer what can be done with the face that was clicked, or with all selected ones when it is among them."""
        selected, operation = self._document.selection.current, self._operation()
        if not click.face or self._tool_on() is not None:
            return
        if not (selected.kind == "faces" and click.face in selected.faces):
            self._document.selection.select_face_alone(click.face)
        menu = self._views.face_menu(self, self._document.selection.current.faces, operation)
        menu.aboutToHide.connect(menu.deleteLater)
        if menu.actions():
            menu.popup(at)

    def _write_ids(self, session: Session) -> None:
        """Write the ID of every feature on the part; of the faces of the selection, when there is one."""
        mesh, found, selected = (
            self._document.mesh,
            session.recognition,
            self._document.selection.current,
        )
        if not self.shows["ids"] or mesh is None:
            self.scene.show_names(())
        elif selected.faces:
            self.scene.show_names(
                [(str(tag), point_on(mesh, (tag,))) for tag in selected.faces[:_MOST_IDS]]
            )
        else:
            self.scene.show_names(
                [(f.id, point_on(mesh, f.tags)) for f in (found or ()) if f.tags][:_MOST_IDS]
            )

    def _use_frame(self, session: Session) -> None:
        if session.recognition is not None:
            self.scene.use_frame(session.recognition.frame)

    def _operation(self) -> str:
        selected = self._document.selection.current
        return selected.id if selected.kind == "operation" else ""

    def _shows_paths(self, session: Session) -> bool:
        return (
            self.shows["paths"] and bool(session.paths) and not self._plays and not self._shows_map
        )

    @property
    def _plays(self) -> bool:
        return self._player.is_on and self._player.timeline is not None

    @property
    def _guide_lines(self) -> tuple[GuideCurve, ...]:
        return () if self._plays or self._shows_map else self._guides.shown.lines

    @property
    def _shows_map(self) -> bool:
        return self._deviation.is_on and self._deviation.shown is not None

    def _paint(self, session: Session) -> None:
        found = session.recognition
        colours: dict[int, str] = {}
        if found is not None:
            colours = (
                self._colouring.by_face(found)
                if self._colouring
                else legend.features_by_face(found)
                if self.shows["colours"]
                else {}
            )
        self.scene.show_kinds(colours, faded=self._shows_paths(session))

    def _draw_paths(self, session: Session) -> None:
        process, only = session.process, self._operation()
        if process is None or not self._shows_paths(session):
            self.scene.show_paths(())
            return
        frames = {
            o.id: process.setup(o.setup).frame
            for o in process.operations
            if not o.suppressed and only in ("", o.id)
        }
        self.scene.show_paths(
            [(p.path, frames[p.operation]) for p in session.paths if p.operation in frames],
            self.motions,
        )

    def _legend(self, session: Session) -> list[LegendRow]:
        if self._plays:
            return legend.playing(self._theme)
        if self._shows_map:
            return []
        found, rows = session.recognition, []
        if found is not None and self._colouring is not None:
            rows = list(self._colouring.legend())
        elif found is not None and self.shows["colours"]:
            rows = legend.features(found, self._views)
        if self._shows_paths(session):
            rows = [
                *rows,
                legend.GAP,
                *legend.paths(self.motions, any(leans(p.path) for p in session.paths)),
            ]
        if self._guide_lines:
            rows = [*rows, legend.GAP, *legend.guides(self._guide_lines)]
        return rows

    def _choose(self, selection: Selection) -> None:
        self.scene.show_label("")
        self.scene.choose(
            selection.faces,
            filled=selection.kind != "operation" or not self._shows_paths(self._document.shown),
        )
        self.refresh()

    def _hover(self, tag: int) -> None:
        found = self._document.shown.recognition
        owners = [f for f in found or () if tag in f.tags]
        feature = min(owners, key=lambda f: len(f.tags)) if owners else None
        self.scene.hover(feature.tags if feature else (tag,) if tag else ())
        words = f"{feature.id} · face {tag}" if feature else f"face {tag}" if tag else ""
        self.scene.view.setToolTip(words)

    # playback

    def _open_playback(self) -> None:
        line = self._player.timeline
        self._tool, self._run = None, (-1, np.zeros((0, 3)), np.zeros(0))
        if line is None:
            self.scene.use_tool(None)
            self.scene.show_trail(np.zeros((0, 3)), np.zeros(0, bool))
            self.scene.show_stock(None)
        self.refresh()

    def _move_tool(self, position: float) -> None:
        line = self._player.timeline
        if line is None:
            return
        row = line.row(position)
        if line.passages[row].tool is not self._tool:
            self._tool = line.passages[row].tool
            self.scene.use_tool(line.passages[row].tool)
        if row != self._run[0]:
            self._run = (row, *line.run(row))
        tip, axis = line.pose(position)
        _, points, reached = self._run
        done = int(np.searchsorted(reached, position, side="right"))
        first = max(done - _LONGEST_TRAIL, 0)
        blocks = np.append(np.ceil(reached[first + 1 : done]) - 1, line.block(position)).astype(int)
        self.scene.show_trail(np.vstack([points[first:done], tip]), line.rapid[blocks])
        self.scene.move_tool(tip, axis)

    def _show_stock(self, moment: Moment) -> None:
        if self._plays:
            self.scene.show_stock(moment)

    # deviation map

    def _show_map(self, shown: DrawnMap | None) -> None:
        self.scene.show_map(shown)
        self.scale.show_map(shown.map if shown is not None else None)
        self._point(None, QPointF())
        self.refresh()

    def look_at_worst_point(self, worst: WorstPoint) -> None:
        """Go to a worst place of the map."""
        self.scene.look_at(worst.point, worst.face, _CLOSE_LOOK)
        self.scene.show_label(fine_amount(worst.deviation), worst.point)

    def _point(
        self, found: tuple[int, float, tuple[float, float, float]] | None, at: QPointF
    ) -> None:
        """Say what the map shows under the mouse: in the status line, in a small tip and on the scale."""
        self.scale.point(found[1] if found else None)
        self.tip.setVisible(found is not None)
        if found is None:
            self.hinted.emit("")
            return
        face, value, position = found
        owners = [f for f in self._document.shown.recognition or () if face in f.tags]
        owner = min(owners, key=lambda f: len(f.tags)).id if owners else ""
        where = "x {:.2f}  y {:.2f}  z {:.2f}".format(*position)
        self.hinted.emit(
            " · ".join(w for w in (fine_amount(value), f"{tr('face')} {face}", owner, where) if w)
        )
        self.tip.setText(fine_amount(value))
        self.tip.adjustSize()
        x = min(int(at.x()) + _TIP_AWAY, self.scene.width() - self.tip.width() - 4)
        self.tip.move(x, min(int(at.y()) + _TIP_AWAY, self.scene.height() - self.tip.height() - 4))

    def _make_tip(self) -> QLabel:
        tip = QLabel(self.scene)
        tip.setObjectName("tip")
        tip.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        tip.hide()
        return tip

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
