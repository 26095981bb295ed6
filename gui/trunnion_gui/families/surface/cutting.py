"""The bar below the picture while a face is being cut: by a plane across x, y or z, by one through three places, or along a drawn line."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from trunnion.findings import BadInput
from trunnion.geometry.cut import Cut, curve_cut, plane_cut
from trunnion_gui.document import Document
from trunnion_gui.families.surface.jobs import PatchJobs
from trunnion_gui.form import NumberField
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.viewport.scene import Click, ViewportScene
from trunnion_gui.worker.drawing import box_of, plane_line, sampled

AXES = ("x", "y", "z")
THREE, DRAWN = "three", "drawn"
_CLOSING = 9.0
"""Pixels: a click this near to the first place of a drawn line closes it."""
_FINE = 24
"""Pieces of the line that is shown between two places."""
Position = tuple[float, float, float]


class CutBar(QWidget):
    """Collects what a cut needs, shows where it will run, and hands it over."""

    ended = Signal()

    def __init__(self, document: Document, jobs: PatchJobs, scene: ViewportScene) -> None:
        super().__init__()
        self._document, self._jobs, self._scene = document, jobs, scene
        self.face = 0
        self.positions: list[Position] = []
        self._make_widgets()
        row = QHBoxLayout(self)
        row.setContentsMargins(14, 2, 14, 6)
        row.setSpacing(8)
        for widget in (self.method, self.value):
            row.addWidget(widget)
        row.addWidget(self.words, 1)
        for button in (self.back, self.apply, self.close_button):
            row.addWidget(button)
        document.jobs.changed.connect(self.refresh)
        document.redrawn.connect(self.end)
        document.mesh_changed.connect(self.end)
        self.hide()

    @property
    def is_on(self) -> bool:
        """Whether a cut is being made, so that clicks on the part are its points."""
        return not self.isHidden()

    def begin(self, face: int, by_plane: bool) -> None:
        """Begin a cut of a face (0: of the one that is clicked next)."""
        self.positions = []
        self.face = 0
        self._take_method(AXES[0] if by_plane else DRAWN)
        self.show()
        self._choose(face)

    def end(self) -> None:
        """Put the bar away."""
        if self.is_on:
            self.hide()
            self.face, self.positions = 0, []
            self._scene.show_cut((), np.zeros((0, 2, 3)))
            self.ended.emit()

    def take(self, click: Click) -> None:
        """Take a click on the part as the next place."""
        if not click.face:
            return
        if not self.face:
            self._choose(click.face)
        kind = self._kind()
        if kind in AXES:
            self.value.setValue(click.position[AXES.index(kind)])
        elif kind == THREE:
            self.positions = (
                [*self.positions, click.position] if len(self.positions) < 3 else [click.position]
            )
        elif not self._is_closed():
            self.positions.append(self._closed(click.position))
        self.refresh()

    def take_back(self) -> None:
        """Forget the last place."""
        if self.positions:
            self.positions.pop()
            self.refresh()

    def cut(self) -> Cut | None:
        """Return the cut as it is now, None while something is missing."""
        kind = self._kind()
        if not self.face:
            return None
        try:
            if kind in AXES:
                normal = tuple(float(a == kind) for a in AXES)
                return plane_cut(self.face, tuple(self.value.value() * v for v in normal), normal)  # type: ignore[arg-type]
            if kind == THREE:
                return (
                    plane_cut(self.face, self.positions[0], self._normal())
                    if len(self.positions) == 3
                    else None
                )
            return curve_cut(self.face, tuple(self.positions)) if len(self.positions) > 1 else None
        except BadInput:
            return None

    def refresh(self) -> None:
        """Show what is there and what is still wanted."""
        if not self.is_on:
            return
        kind, cut = self._kind(), self.cut()
        self.value.setVisible(kind in AXES)
        self.back.setVisible(kind not in AXES)
        self.back.setEnabled(bool(self.positions))
        self.apply.setEnabled(cut is not None and not self._document.is_busy)
        self.words.setText(self._wanted(kind))
        self._scene.show_cut(self.positions, self._line(cut))

    # inside

    def _make_widgets(self) -> None:
        self.method = QComboBox()
        self.method.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.method.setMinimumContentsLength(12)
        for words, kind in (
            (tr("plane across x"), "x"),
            (tr("plane across y"), "y"),
            (tr("plane across z"), "z"),
            (tr("plane through three places"), THREE),
            (tr("along a drawn line"), DRAWN),
        ):
            self.method.addItem(words, kind)
        self.method.currentIndexChanged.connect(self._change)
        self.value = NumberField()
        self.value.setDecimals(4)
        self.value.setSuffix(" mm")
        self.value.setKeyboardTracking(False)
        self.value.setFixedWidth(130)
        self.value.valueChanged.connect(lambda _: self.refresh())
        self.words = QLabel()
        self.words.setObjectName("muted")
        self.words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.words.setWordWrap(True)
        self.back = self._button(QToolButton(), tr("Last place away"), self.take_back)
        self.apply = self._button(QPushButton(), tr("Cut"), self._cut)
        self.apply.setObjectName("primary")
        self.close_button = self._button(QPushButton(), tr("Leave it"), self.end)
        self.close_button.setToolTip(tr("Put the cut away without making it (Escape)"))

    @staticmethod
    def _button(
        made: QPushButton | QToolButton, words: str, slot: Callable[[], None]
    ) -> QPushButton | QToolButton:
        made.setText(words)
        made.clicked.connect(lambda _=False: slot())
        return made

    def _take_method(self, kind: str) -> None:
        self.method.blockSignals(True)
        self.method.setCurrentIndex(self.method.findData(kind))
        self.method.blockSignals(False)

    def _kind(self) -> str:
        return str(self.method.currentData())

    def _change(self) -> None:
        self.positions = []
        self._reach()
        self.refresh()

    def _choose(self, face: int) -> None:
        self.face = face
        mesh = self._document.mesh
        if face and mesh is not None:
            self._document.selection.select_face_alone(face)
            if self._kind() in AXES:
                longest = int(np.argmax(np.subtract(*reversed(box_of(mesh, face)))))
                self._take_method(AXES[longest])
        self._reach()
        self.refresh()

    def _reach(self) -> None:
        """Let the plane's place reach over the face, and stand in its middle at first."""
        mesh, kind = self._document.mesh, self._kind()
        if mesh is None or not self.face or kind not in AXES:
            return
        low, high = (float(corner[AXES.index(kind)]) for corner in box_of(mesh, self.face))
        self.value.blockSignals(True)
        self.value.setRange(low, high)
        self.value.setSingleStep(max((high - low) / 50.0, 1e-4))
        self.value.setValue(0.5 * (low + high))
        self.value.blockSignals(False)

    def _closed(self, position: Position) -> Position:
        """Return a place, or the very first one when it is clicked again."""
        if len(self.positions) > 2:
            away = self._scene.where(position) - self._scene.where(self.positions[0])
            if abs(away.x()) + abs(away.y()) < _CLOSING:
                return self.positions[0]
        return position

    def _is_closed(self) -> bool:
        return len(self.positions) > 3 and self.positions[-1] == self.positions[0]

    def _normal(self) -> Position:
        a, b, c = (np.array(p) for p in self.positions)
        x, y, z = np.cross(b - a, c - a)
        return float(x), float(y), float(z)

    def _line(self, cut: Cut | None) -> np.ndarray:
        """Return the pieces (k, 2, 3) of the line on the face that the cut will follow."""
        mesh = self._document.mesh
        if cut is None or mesh is None:
            return np.zeros((0, 2, 3))
        if cut.is_plane:
            return plane_line(mesh, cut.face, cut.places[0], cut.normal)
        points = self._scene.on_face(cut.face, sampled(cut.places, _FINE))
        return np.stack([points[:-1], points[1:]], axis=1)

    def _wanted(self, kind: str) -> str:
        if not self.face:
            return tr("Click the face that shall be cut.")
        where = f"{tr('face')} {self.face}"
        if kind in AXES:
            return tr("{face}: type where, or click a place of the plane.").format(face=where)
        if kind == THREE:
            return tr("{face}: click three places, {n} are there.").format(
                face=where, n=len(self.positions)
            )
        if self._is_closed():
            return tr("{face}: the line is closed.").format(face=where)
        return tr(
            "{face}: click places of the line, {n} are there; it is led on to the edge, or closed by a click on the first."
        ).format(face=where, n=len(self.positions))

    def _cut(self) -> None:
        cut = self.cut()
        if cut is not None:
            self._jobs.cut(cut)

    def use_theme(self) -> None:
        """Draw in the colours of the theme that is used now."""
        self.back.setIcon(icons.icon("undo"))
        self.refresh()
