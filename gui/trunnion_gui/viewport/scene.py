"""The picture in the middle: arrays in, actors inside. Says which face was clicked; knows nothing of documents."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QMouseEvent, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Blank
from trunnion.model.guides import GuideCurve
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.playback import Moment
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.report.lines import MOTIONS
from trunnion_gui.look.colours import Theme, mixed, rgb
from trunnion_gui.pieces import PieceExecution
from trunnion_gui.viewport.layers.blank import draw_blank
from trunnion_gui.viewport.layers.cut import draw_cut
from trunnion_gui.viewport.layers.deviation import DeviationLayer
from trunnion_gui.viewport.layers.guides import draw_guides
from trunnion_gui.viewport.layers.label import draw_label, draw_names
from trunnion_gui.viewport.layers.part import PartLayer
from trunnion_gui.viewport.layers.paths import PathLayer
from trunnion_gui.viewport.layers.setups import draw_setups
from trunnion_gui.viewport.layers.stock import draw_stock
from trunnion_gui.viewport.layers.tool import draw_tool, draw_trail, move_tool_to
from trunnion_gui.viewport.pick import FacePicker
from trunnion_gui.viewport.view import make_view
from trunnion_gui.worker.drawing import DrawnMap, DrawnMesh

VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "isometric": ((-0.55, -0.75, 0.75), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "bottom": ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "back": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "left": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "right": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
}
"""Where the eye stands and what is up, in the frame of the recognition."""

_MARGIN = 1.12
"""How much more than the part a fitted picture shows."""
_LEAST_SPACE = 120.0
"""Pixels: a narrower or lower strip beside a legend is no place for a part."""
_DIRECTIONS = 24
_ASIDE = 0.45
"""How far from straight above a worst place the eye goes."""
_BUTTONS = (Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton)
_CLICK = 4
"""A press and a release this many pixels apart are a click; further apart they turn the part."""
_FADED = 0.8
"""How far the kinds' colours fade towards the part's own while toolpaths are to be seen on it."""


def best_fit(
    plan: np.ndarray, width: float, height: float, covered: QRectF
) -> tuple[float, tuple[float, float]]:
    """Return mm a pixel, and what should be in the middle of a picture, for points (v, 2) in mm (right, up) to fill it.

    When they would lie under the rectangle that is covered, they go beside or below it, whichever shows them larger.
    """
    low, high = plan.min(axis=0), plan.max(axis=0)

    def fitted(free: QRectF) -> tuple[float, tuple[float, float]]:
        scale = float(
            max((high[0] - low[0]) / free.width(), (high[1] - low[1]) / free.height(), 1e-9)
            * _MARGIN
        )
        away = free.center() - QPointF(width / 2, height / 2)
        middle = (low + high) / 2
        return scale, (float(middle[0] - away.x() * scale), float(middle[1] + away.y() * scale))

    whole = QRectF(0, 0, width, height)
    best = fitted(whole)
    x, y = (
        width / 2 + (plan[:, 0] - best[1][0]) / best[0],
        height / 2 - (plan[:, 1] - best[1][1]) / best[0],
    )
    if covered.isEmpty() or not outline(x, y).intersects(QPolygonF(covered)):
        return best
    right, below = (
        whole.adjusted(covered.right(), 0, 0, 0),
        whole.adjusted(0, covered.bottom(), 0, 0),
    )
    return min(
        (
            fitted(free)
            for free in (right, below)
            if free.width() > _LEAST_SPACE and free.height() > _LEAST_SPACE
        ),
        default=best,
    )


def outline(x: np.ndarray, y: np.ndarray) -> QPolygonF:
    """Return the points that are farthest in each of some directions, as a polygon around all."""
    angle = np.linspace(0.0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    rows = [int(np.argmax(x * c + y * s)) for c, s in zip(np.cos(angle), np.sin(angle))]
    return QPolygonF([QPointF(float(x[r]), float(y[r])) for r in rows])


@dataclass(frozen=True, slots=True)
class Click:
    """A click on the picture: the tag of the face there (0 beside the part), the place on it in the part's coordinates, and whether Ctrl
    was held down."""

    face: int
    position: tuple[float, float, float]
    with_ctrl: bool = False


class ViewportScene(QWidget):
    """The viewport with its layers."""

    clicked = Signal(object)
    """A `Click`."""
    menu_requested = Signal(object, QPoint)
    """A `Click` with the right button, and where on the screen: what can be done there?"""
    hovered = Signal(int)
    pointed = Signal(object, QPointF)
    """Face tag, deviation and place under the mouse while the map is shown (None beside the part), and where the mouse is."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setMinimumSize(240, 200)
        self.view: Any = make_view(self)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.view)
        self._theme = theme
        self._paths, self._path_pieces = PathLayer(self.view), PieceExecution(self)
        self._part: PartLayer | None = None
        self._drawing: DrawnMesh | None = None
        self._mesh: Mesh | None = None
        self._blank = np.zeros((0, 3))
        self._picker: FacePicker | None = None
        self._frame = WORLD
        self._colours: Mapping[int, str] = {}
        self._selected: tuple[int, ...] = ()
        self._is_filled = True
        self._hover: tuple[int, ...] = ()
        self._is_faded = False
        self._is_isolated = False
        self._pressed: QPointF | None = None
        self._section: float | None = None
        self._map: DeviationLayer | None = None
        self._is_playing = False
        self._covered = QRectF()
        self._fitted: tuple[float, ...] = ()
        self.view.enable_parallel_projection()
        self.use_theme(theme)
        self.view.installEventFilter(self)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.view.add_axes(line_width=2, color=theme.text)
        self.view.set_background(theme.view_bottom, top=theme.view_top)
        if self._drawing is not None:
            self.show_mesh(self._drawing, keep_camera=True)
        self.view.render()

    def show_mesh(self, drawing: DrawnMesh | None, keep_camera: bool = False) -> None:
        """Show a part, or nothing."""
        mesh = drawing.mesh if drawing is not None else None
        self._drawing, self._mesh = drawing, mesh
        for name in ("part", "edges", "chosen", "hover"):
            self.view.remove_actor(name, render=False)
        self._part = self._picker = None
        if drawing is not None and mesh is not None and len(mesh.triangles):
            self._part = PartLayer(self.view, drawing, self._theme)
            self._picker = FacePicker(self._part.actor, mesh.face)
            if not keep_camera:
                self._frame = WORLD
                self.look("isometric")
        self._repaint()

    def show_kinds(self, colours: Mapping[int, str], *, faded: bool = False) -> None:
        """Colour faces by tag (`#rrggbb`); the others have the part's own colour. Faded while toolpaths lie on them."""
        self._colours, self._is_faded = colours, faded
        self._repaint()

    def choose(self, faces: tuple[int, ...], *, filled: bool = True) -> None:
        """Mark faces as the selection: filled, or only by their border where toolpaths are to be seen on them."""
        self._selected, self._is_filled = faces, filled
        if self._part is not None:
            self._part.outline(
                "chosen",
                faces,
                self._theme.edge if filled else self._theme.selection,
                2.5 if filled else 4.0,
            )
        self._repaint()

    def isolate(self, on: bool) -> None:
        """Let everything but the selection fade into the background, or not."""
        self._is_isolated = on
        self._repaint()

    def show_blank(self, blank: Blank | None) -> None:
        """Show the blank, or none. A picture that nobody has turned since it was fitted is fitted anew."""
        draw_blank(self.view, blank, self._theme)
        self._blank = blank.corners(WORLD) if blank is not None else np.zeros((0, 3))
        self._fit_again()
        self.view.render()

    def show_setups(self, setups: Sequence[Setup]) -> None:
        """Show the zero of every setup."""
        draw_setups(self.view, setups, 0.07 * self._size())
        self.view.render()

    def show_paths(
        self, paths: Iterable[tuple[Toolpath, Frame]], motions: Iterable[str] = MOTIONS
    ) -> None:
        """Show toolpaths with the frames of their setups; many are drawn in pieces, after this has returned."""
        self._path_pieces.begin(self._path_work(tuple(paths), tuple(motions)))

    def _path_work(
        self, paths: Sequence[tuple[Toolpath, Frame]], motions: Sequence[str]
    ) -> Iterator[None]:
        yield from self._paths.draw(paths, motions, self._size())
        self.view.render()

    def show_guides(self, lines: Sequence[GuideCurve]) -> None:
        """Show guide lines in the part's coordinates, or none."""
        draw_guides(self.view, lines)
        self.view.render()

    def show_map(self, shown: DrawnMap | None) -> None:
        """Show a deviation map instead of the part's colours, or those again."""
        self.view.remove_actor("deviation", render=False)
        self._map = DeviationLayer(self.view, shown) if shown is not None else None
        self._apply_section()
        self._hide()
        self.view.render()

    def show_stock(self, moment: Moment | None) -> None:
        """Show the stock at a moment instead of the part, or the part again."""
        draw_stock(self.view, moment, self._theme)
        if self._is_playing != (moment is not None):
            self._is_playing = moment is not None
            self._hide()
        self._apply_section()
        self.view.render()

    def use_tool(self, tool: Tool | None) -> None:
        """Show a tool, or none."""
        draw_tool(self.view, tool, self._theme)
        self.view.render()

    def move_tool(self, tip: np.ndarray, axis: np.ndarray) -> None:
        """Stand the tool somewhere (the part's coordinates)."""
        move_tool_to(self.view, tip, axis)
        self.view.render()

    def show_trail(self, points: np.ndarray, rapid: np.ndarray) -> None:
        """Show the path of the tip: points (k + 1, 3), and whether each chord (k,) was a rapid."""
        draw_trail(self.view, points, rapid)

    def look_at(self, position: Sequence[float], face: int, half_height: float) -> None:
        """Bring a place on a face into the middle of the picture, from above its face, showing so many mm above and below it."""
        camera = self.view.camera
        normal = self._normal(face, np.asarray(position))
        away = normal + self._frame.z if normal @ self._frame.z > -0.5 else normal
        away = away + _ASIDE * self._frame.world_direction(np.array([-0.6, -0.8, 0.0]))
        away = (
            away
            / np.linalg.norm(away)
            * np.linalg.norm(np.subtract(camera.position, camera.focal_point))
        )
        camera.focal_point, camera.position, camera.up = (
            tuple(position),
            tuple(np.add(position, away)),
            tuple(self._frame.z),
        )
        camera.parallel_scale = half_height
        self.view.renderer.ResetCameraClippingRange()
        self.view.render()

    def _normal(self, face: int, position: np.ndarray) -> np.ndarray:
        """Return the direction that a face looks in at a place."""
        rows = (
            np.flatnonzero(self._mesh.face == face) if self._mesh is not None else np.zeros(0, int)
        )
        if self._mesh is None or not len(rows):
            return np.asarray(self._frame.z)
        nearest = np.argmin(
            np.linalg.norm(self._mesh.corners()[rows].mean(axis=1) - position, axis=1)
        )
        return self._mesh.normals()[rows[nearest]]

    def on_face(self, tag: int, points: np.ndarray) -> np.ndarray:
        """Return the positions (k, 3) on the drawn face that are nearest to points (k, 3)."""
        return self._part.on_face(tag, points) if self._part is not None else points

    def show_names(self, names: Sequence[tuple[str, tuple[float, float, float]]]) -> None:
        """Write words at positions of the part, or none."""
        draw_names(self.view, names, self._theme)
        self.view.render()

    def show_cut(self, positions: Sequence[tuple[float, float, float]], line: np.ndarray) -> None:
        """Show places that were clicked, and the line (k, 2, 3) that a cut will follow; both may be empty."""
        draw_cut(self.view, positions, line, self._theme)
        self.view.render()

    def show_label(self, text: str, at: tuple[float, ...] = (), to: tuple[float, ...] = ()) -> None:
        """Write a size at a point of the part; a distance is drawn from there to the point `to`."""
        draw_label(self.view, text if len(at) == 3 else "", at, self._theme, to)
        self.view.render()

    def use_frame(self, frame: Frame) -> None:
        """Let the standard views follow a frame."""
        self._frame = frame

    def look(self, name: str) -> None:
        """Take a standard view and fit."""
        eye, up = (self._frame.world_direction(np.array(v)) for v in VIEWS[name])
        self.view.view_vector(tuple(eye), viewup=tuple(up))
        self.fit()

    def fit(self) -> None:
        """Fit everything into the picture, beside or below what lies over it."""
        bounds = self._bounds()
        self.view.reset_camera(bounds=bounds)
        if bounds is not None:
            self._fit_tightly()
        self._fitted = self._camera()
        self.view.render()

    def set_covered(self, covered: QRectF) -> None:
        """Say which part of the picture something lies over; a picture that nobody has turned since it was fitted is fitted anew."""
        if covered != self._covered:
            self._covered = covered
            self._fit_again()

    def section(self, share: float | None) -> None:
        """Cut the part open across the frame's z at a share of its height; None shows it whole."""
        self._section = share
        self._apply_section()
        self.view.render()

    def face_at(self, at: QPointF) -> int:
        """Return the tag of the face at a point of the view widget, 0 beside the part."""
        if self._picker is None or self._is_playing:
            return 0
        ratio = self.view.devicePixelRatioF()
        return self._picker.at(
            at.x() * ratio, (self.view.height() - at.y() - 1) * ratio, self.view.renderer
        )

    def where(self, point: Sequence[float]) -> QPointF:
        """Return where a point of the part (x, y, z) is on the view widget."""
        renderer, ratio = self.view.renderer, self.view.devicePixelRatioF()
        renderer.SetWorldPoint(*point, 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        return QPointF(x / ratio, self.view.height() - 1 - y / ratio)

    def smooth(self) -> None:
        """Draw with smoothed edges from now on: for pictures to keep, slow without a graphics card."""
        self.view.enable_anti_aliasing("ssaa")
        self.view.render()

    def save_picture(self, path: str) -> bool:
        """Write what the viewport shows as PNG."""
        return self.view.grab().save(path)

    def end(self) -> None:
        """Let VTK go before Qt does."""
        self._path_pieces.stop()
        self.view.removeEventFilter(self)
        self.view.close()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QMouseEvent):
            kind = event.type()
            if kind == QEvent.Type.MouseButtonPress and event.button() in _BUTTONS:
                self._pressed = event.position()
            elif kind == QEvent.Type.MouseButtonRelease and self._pressed is not None:
                moved = event.position() - self._pressed
                self._pressed = None
                if event.button() in _BUTTONS and abs(moved.x()) + abs(moved.y()) <= _CLICK:
                    self._click(event)
            elif kind == QEvent.Type.MouseMove and event.buttons() == Qt.MouseButton.NoButton:
                self._point(event.position())
        elif event.type() == QEvent.Type.Leave and self._map is not None:
            self.pointed.emit(None, QPointF())
        return False

    def _click(self, event: QMouseEvent) -> None:
        face = self.face_at(event.position())
        position = self._picker.point if face and self._picker is not None else (0.0, 0.0, 0.0)
        click = Click(face, position, bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))
        if event.button() == Qt.MouseButton.LeftButton:
            self.clicked.emit(click)
        else:
            self.menu_requested.emit(click, event.globalPosition().toPoint())

    def _point(self, at: QPointF) -> None:
        if self._map is None or self._is_playing:
            self.hovered.emit(self.face_at(at))
            return
        ratio = self.view.devicePixelRatioF()
        self.pointed.emit(
            self._map.at(
                at.x() * ratio, (self.view.height() - at.y() - 1) * ratio, self.view.renderer
            ),
            at,
        )

    def _hide(self) -> None:
        """Hide the part's own look while the stock or the map is shown."""
        for name, is_shown in (
            ("part", not self._is_playing and self._map is None),
            ("edges", not self._is_playing),
            ("chosen", not self._is_playing),
            ("hover", not self._is_playing),
            ("deviation", not self._is_playing),
        ):
            actor = self.view.actors.get(name)
            if actor is not None:
                actor.visibility = is_shown

    def hover(self, faces: tuple[int, ...]) -> None:
        """Outline faces lightly, or none."""
        if faces != self._hover and self._part is not None:
            self._hover = faces
            self._part.outline("hover", faces, self._theme.edge, 2.0)
            self.view.render()

    def _repaint(self) -> None:
        if self._part is not None and self._mesh is not None:
            self._part.paint(self._palette(int(self._mesh.face.max())))
        self._apply_section()
        self._hide()
        self.view.render()

    def _palette(self, n_faces: int) -> np.ndarray:
        theme = self._theme
        colours = np.tile(np.array(rgb(theme.part), np.uint8), (n_faces + 1, 1))
        for tag, colour in self._colours.items():
            if tag <= n_faces:
                colours[tag] = rgb(mixed(colour, theme.part, _FADED) if self._is_faded else colour)
        if self._is_isolated and self._selected:
            others = np.setdiff1d(np.arange(n_faces + 1), self._selected)
            colours[others] = rgb(mixed(theme.part, theme.view_bottom, 0.7))
        for tag in self._selected:
            if tag <= n_faces:
                own = "#{:02x}{:02x}{:02x}".format(*colours[tag])
                colours[tag] = rgb(mixed(own, theme.selection, 0.85 if self._is_filled else 0.0))
        return colours

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_again()

    def _fit_again(self) -> None:
        if self._fitted and self._fitted == self._camera():
            self.fit()

    def _camera(self) -> tuple[float, ...]:
        camera = self.view.camera
        return (*camera.position, *camera.focal_point, *camera.up, camera.parallel_scale)

    def _fit_tightly(self) -> None:
        """Choose scale and middle of the picture so that all is as large as it can be without lying under what covers it."""
        camera = self.view.camera
        forward = np.subtract(camera.focal_point, camera.position)
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, camera.up)
        right = right / np.linalg.norm(right)
        up = np.cross(right, forward)
        plan = np.asarray(self._everything() - np.asarray(camera.focal_point)) @ np.column_stack(
            [right, up]
        )
        width, height = max(self.view.width(), 1), max(self.view.height(), 1)
        scale, (x, y) = best_fit(plan, width, height, self._covered)
        shift = x * right + y * up
        camera.focal_point = tuple(np.add(camera.focal_point, shift))
        camera.position = tuple(np.add(camera.position, shift))
        camera.parallel_scale = scale * height / 2
        self.view.renderer.ResetCameraClippingRange()

    def _size(self) -> float:
        """Return the part's longest side, mm."""
        return float(np.ptp(self._hull, axis=0).max()) if len(self._hull) else 1.0

    @property
    def _hull(self) -> np.ndarray:
        """The corners (k, 3) of the part's convex hull, mm; none without a part."""
        return self._drawing.hull if self._drawing is not None else np.zeros((0, 3))

    def _everything(self) -> np.ndarray:
        """Return points (k, 3), mm, that are as far apart in every direction as the part and the blank that is shown."""
        return np.vstack([self._hull, self._blank])

    def _bounds(self) -> tuple[float, ...] | None:
        points = self._everything()
        if not len(points):
            return None
        return tuple(float(v) for pair in zip(points.min(axis=0), points.max(axis=0)) for v in pair)

    def _apply_section(self) -> None:
        for name in ("part", "edges", "chosen", "deviation", "stock"):
            actor = self.view.actors.get(name)
            if actor is None:
                continue
            actor.mapper.RemoveAllClippingPlanes()
            if self._section is not None and self._mesh is not None:
                actor.mapper.AddClippingPlane(self._plane(self._section))

    def _plane(self, share: float) -> Any:
        from vtkmodules.vtkCommonDataModel import vtkPlane

        assert self._mesh is not None
        heights = self._frame.to_local(self._hull)[:, 2]
        height = heights.min() + share * np.ptp(heights)
        plane = vtkPlane()
        plane.SetOrigin(*self._frame.to_world(np.array([0.0, 0.0, height])))
        plane.SetNormal(*-np.asarray(self._frame.z))
        return plane
