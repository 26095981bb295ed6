"""Icons by the window's own names (`resources/icons`), in the colours of the theme."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files

from PySide6.QtGui import QIcon, QPixmap

from trunnion_gui.look.colours import Theme, theme

_theme = theme("light")
_DRAWN = 48
"""Pixels an icon is drawn with once; smaller ones are made from it."""


@cache
def names() -> dict[str, str]:
    """Return the icon font's name of every icon."""
    return json.loads((files("trunnion_resources") / "icons" / "icons.json").read_text("utf-8"))


def use_theme(new_theme: Theme) -> None:
    """Draw icons from now on in the colours of a theme."""
    global _theme
    _theme = new_theme


def icon(name: str, colour: str = "") -> QIcon:
    """Return an icon; raises `KeyError` for a name that resources do not have."""
    return _icon(names()[name], colour or _theme.text, _theme.line)


def pixmap(name: str, size: int, colour: str = "") -> QPixmap:
    """Return an icon as a picture."""
    return _pixmap(names()[name], size, colour or _theme.text, _theme.line)


# Drawing a letter of the icon font takes milliseconds, and a tree has a hundred rows.
@cache
def _icon(font_name: str, colour: str, disabled: str) -> QIcon:
    import qtawesome

    drawn = qtawesome.icon(font_name, color=colour, color_disabled=disabled)
    kept = QIcon(drawn.pixmap(_DRAWN, _DRAWN))
    kept.addPixmap(drawn.pixmap(_DRAWN, _DRAWN, QIcon.Mode.Disabled), QIcon.Mode.Disabled)
    return kept


@cache
def _pixmap(font_name: str, size: int, colour: str, disabled: str) -> QPixmap:
    import qtawesome

    return qtawesome.icon(font_name, color=colour, color_disabled=disabled).pixmap(size, size)


def window_icon() -> QIcon:
    """Return the program's own sign."""
    picture = QPixmap()
    picture.loadFromData(
        (files("trunnion_resources") / "icons" / "trunnion.svg").read_bytes(), "SVG"
    )
    return QIcon(picture)
