"""The playback's controls: the slider over all blocks with the operations below it, step, skip, play, speed, and where the tool is."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from trunnion.model.playback import Moment
from trunnion_gui.actions import Registry
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme, tool_cycle
from trunnion_gui.look.words import amount, clock, grouped
from trunnion_gui.playback.player import SPEEDS, Player
from trunnion_gui.widgets.timeline_slider import TimelineSlider

BUTTONS = (
    "play.begin",
    "play.previous",
    "play.back",
    "play.run",
    "play.forward",
    "play.next",
    "play.end",
)
_WORDS_MS = 66
"""Words follow the tool this often at most: nobody reads faster."""


class PlaybackBar(QWidget):
    """What a person steers the player with."""

    def __init__(self, player: Player, registry: Registry, theme: Theme) -> None:
        super().__init__()
        self._player = player
        self._registry = registry
        self._removed = 0.0
        self._load = np.zeros(0)
        self.track = TimelineSlider(theme)
        self.speed, self.mode = QComboBox(), QComboBox()
        self.position_label, self.clock, self.amount = QLabel(), QLabel(), QLabel()
        self._fill_choices()
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 2, 12, 4)
        column.setSpacing(0)
        column.addLayout(self._words())
        column.addWidget(self.track)
        column.addLayout(self._controls())
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(_WORDS_MS)
        self._soon.timeout.connect(self._show_position)
        self.track.wanted.connect(player.go)
        self.track.stepped.connect(player.step)
        player.opened.connect(self._open)
        player.moved.connect(self._move)
        player.cut.connect(self._cut)
        player.changed.connect(self.refresh)
        self.refresh()
        self._open()
        self.hide()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._soon.start()

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.track.use_theme(theme)
        self.refresh()

    def refresh(self) -> None:
        """Show speed, mode and whether it plays."""
        run = self._registry.action("play.run")
        run.setIcon(icons.icon("pause" if self._player.is_playing else "play"))
        run.setText(tr("Pause") if self._player.is_playing else tr("Play"))
        self.speed.setCurrentIndex(SPEEDS.index(self._player.speed))
        self.mode.setCurrentIndex(int(self._player.by_block))

    def _fill_choices(self) -> None:
        for speed in SPEEDS:
            self.speed.addItem(f"×{speed}", speed)
        self.speed.setToolTip(
            tr("How many times faster than the machine; block by block: blocks a second")
        )
        for words in (tr("machine time"), tr("block by block")):
            self.mode.addItem(words)
        self.speed.activated.connect(lambda row: self._player.set_speed(SPEEDS[row]))
        self.mode.activated.connect(lambda row: self._player.set_by_block(row == 1))
        for choice in (self.speed, self.mode):
            choice.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def _controls(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(1)
        self.buttons: dict[str, QToolButton] = {}
        for id in BUTTONS:
            button = QToolButton()
            button.setDefaultAction(self._registry.action(id))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
            button.setIconSize(QSize(18, 18))
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            if id == "play.run":
                button.setObjectName("run")
            self.buttons[id] = button
            row.addWidget(button)
        row.addSpacing(12)
        row.addWidget(self.speed)
        row.addSpacing(6)
        row.addWidget(self.mode)
        row.addStretch(1)
        return row

    def _words(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(8, 0, 6, 0)
        self.position_label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        row.addWidget(self.position_label, 1)
        for label in (self.amount, self.clock):
            label.setObjectName("muted")
            label.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            row.addSpacing(14)
            row.addWidget(label)
        return row

    def _open(self) -> None:
        line = self._player.timeline
        if line is None:
            self.track.show_marks(0.0, (), (), ())
            self._load = np.zeros(0)
            self.track.show_load(self._load, np.zeros(0, bool))
            self.position_label.setText("")
            self.amount.setText("")
            self.clock.setText("")
            return
        words = [f"{p.operation} · T{p.tool.number} {p.tool.name}" for p in line.passages]
        colours = tool_cycle([p.tool.number for p in line.passages])
        self.track.show_marks(self._player.end, [float(f) for f in line.first[:-1]], words, colours)
        self._load, bad = self._player.load()
        self.track.show_load(self._load, bad)
        self.clock.setFixedWidth(
            self.clock.fontMetrics().horizontalAdvance(
                f"{clock(line.seconds)} / {clock(line.seconds)}"
            )
            + 8
        )
        self._show_position()

    def _move(self, position: float) -> None:
        self.track.show_value(position)
        if not self._soon.isActive():
            self._soon.start()

    def _cut(self, moment: Moment) -> None:
        self._removed = moment.removed
        self.track.show_stock(moment.position)
        if not self._soon.isActive():
            self._soon.start()

    def _show_position(self) -> None:
        line, position = self._player.timeline, self._player.position
        if line is None:
            return
        passage, block = line.passage(position), line.block(position)
        number = tr("block {n} of {all}").format(
            n=grouped(block + 1 if position > 0 else 0), all=grouped(len(line))
        )
        text = tr("line {n}").format(n=grouped(int(line.line[block]))) if line.line[block] else ""
        rate = (
            f"{amount(self._load[block], 0)} cm³/min"
            if len(self._load) and self._load[block] > 0.5
            else ""
        )
        words = " · ".join(w for w in (number, text, passage.operation, rate) if w)
        self.position_label.setText(
            self.position_label.fontMetrics().elidedText(
                words, Qt.TextElideMode.ElideRight, self.position_label.width()
            )
        )
        self.position_label.setToolTip(
            f"{passage.operation} · {passage.setup} · T{passage.tool.number} {passage.tool.name}"
        )
        self.amount.setText(tr("{n} cm³ removed").format(n=grouped(round(self._removed / 1000.0))))
        self.clock.setText(f"{clock(line.seconds_at(position))} / {clock(line.seconds)}")
