"""Somebody who uses the real window by mouse and keys, and what that takes of him."""

from __future__ import annotations

import time

from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

LEFT = Qt.MouseButton.LeftButton
POINT_S, CLICK_S, KEY_S, HANDS_S, THINK_S = 1.10, 0.20, 0.28, 0.40, 1.35
"""s: to point at a target, to click, to press a key, to move a hand between keys and mouse, and to decide what next: the keystroke-level
model (Card, Moran and Newell 1980), of a person who types without error and knows what to do."""


def typed(field, words):
    """Type words into a line, as a person does, and leave it by the return key."""
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, words)
    QTest.keyClick(field, Qt.Key.Key_Return)
    QApplication.processEvents()


class Person:
    """Somebody who uses the window: counts his interactions, the seconds they take him (s, as the keystroke-level model has it), and how
    long the window's thread works at a stretch. A click, a line that is typed and a file that is chosen are one interaction each."""

    def __init__(self, window):
        self.window = window
        self.interactions = 0
        self.seconds = 0.0
        self.stretches = []
        self._beat = QTimer(window)
        self._beat.timeout.connect(self.looks)
        self._worked = time.thread_time()
        self._beat.start(5)

    def looks(self):
        now = time.thread_time()
        self.stretches.append(now - self._worked)
        self._worked = now

    def rests(self):
        """Stop looking at the window's thread."""
        self._beat.stop()

    def chooses(self, path):
        def choose():
            self._takes(POINT_S + CLICK_S)
            return str(path)

        return choose

    def clicks(self, widget, at=None):
        self._takes(POINT_S + CLICK_S)
        QTest.mouseClick(widget, LEFT, pos=at if at is not None else widget.rect().center())

    def types(self, field, words):
        """Type words into a field in place of what it shows, and leave it by the return key."""
        self._takes(POINT_S + CLICK_S + HANDS_S + (len(words) + 1) * KEY_S + HANDS_S)
        field.setFocus()
        field.selectAll()
        QTest.keyClicks(field, words)
        QTest.keyClick(field, Qt.Key.Key_Return)

    def _takes(self, seconds):
        self.interactions += 1
        self.seconds += THINK_S + seconds


def wait_for_job(window, seconds):
    end = time.monotonic() + seconds
    while window.document.is_busy and time.monotonic() < end:
        QTest.qWait(20)
    assert not window.document.is_busy
