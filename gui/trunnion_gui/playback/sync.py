"""G-code and process tree stand where the tool is in the playback, and the tool goes to the line that is clicked."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from trunnion_gui.docks.code import CodeDock
from trunnion_gui.docks.process import ProcessDock
from trunnion_gui.playback.player import Player

_FOLLOW_MS = 66
"""They follow the tool this often at most."""


class PlaybackSync(QObject):
    """Ties a player, the G-code and the process tree to each other."""

    def __init__(
        self, player: Player, code: CodeDock, process: ProcessDock, parent: QObject
    ) -> None:
        super().__init__(parent)
        self._player, self._code, self._process = player, code, process
        self.soon = QTimer(self)
        self.soon.setSingleShot(True)
        self.soon.setInterval(_FOLLOW_MS)
        self.soon.timeout.connect(self._follow)
        player.moved.connect(lambda _: self.soon.isActive() or self.soon.start())
        player.opened.connect(self._follow)
        code.line_picked.connect(self._go_to_line)

    def _follow(self) -> None:
        line, position = self._player.timeline, self._player.position
        if line is None:
            self._process.mark("")
            self._code.show_line("", 0)
            return
        passage = line.passage(position)
        self._process.mark(passage.operation)
        self._code.show_line(passage.file, int(line.line[line.block(position)]))

    def _go_to_line(self, file: str, number: int) -> None:
        line = self._player.timeline
        position = line.position_of(file, number) if line is not None else None
        if position is not None:
            self._player.pause()
            self._player.go(position)
