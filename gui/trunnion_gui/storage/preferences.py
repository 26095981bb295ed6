"""What the window remembers between two starts: look, arrangement, recent files; and where autosaves lie."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from PySide6.QtCore import QByteArray, QSettings, QStandardPaths

_MOST_RECENT = 8


def settings() -> QSettings:
    """Return the store; `TRUNNION_SETTINGS` moves it (tests, portable installations)."""
    folder = os.environ.get("TRUNNION_SETTINGS")
    if folder:
        return QSettings(str(Path(folder) / "window.ini"), QSettings.Format.IniFormat)
    return QSettings("Trunnion", "Trunnion")


def theme_name() -> str:
    """Return the name of the look last used."""
    return str(settings().value("theme", "light"))


def language() -> str:
    """Return the language last used."""
    return str(settings().value("language", "en"))


def word(name: str) -> str:
    """Return a word that is remembered, empty where none is."""
    return str(settings().value(name, ""))


def remember(name: str, value: str | QByteArray) -> None:
    """Remember a word or an arrangement."""
    settings().setValue(name, value)


def arrangement(name: str) -> QByteArray | None:
    """Return an arrangement of the window, if one is remembered."""
    value = settings().value(name)
    return value if isinstance(value, QByteArray) else None


def recent() -> list[str]:
    """Return the files opened last, newest first, those that are still there."""
    stored = settings().value("recent") or []
    paths = [stored] if isinstance(stored, str) else list(stored)
    return [p for p in paths if Path(p).exists()]


def add_recent(path: str) -> None:
    """Put a file on top of the recent ones."""
    settings().setValue("recent", [path, *(p for p in recent() if p != path)][:_MOST_RECENT])


def autosave_file() -> Path:
    """Return the file that work in progress is kept in."""
    folder = os.environ.get("TRUNNION_SETTINGS") or QStandardPaths.writableLocation(
        QStandardPaths.StandardLocation.AppLocalDataLocation
    )
    Path(folder).mkdir(parents=True, exist_ok=True)
    return Path(folder) / f"autosave-{os.getpid()}.trunnion"


def leftover_file() -> Path | None:
    """Return the newest autosave of a program that no longer runs, if there is one."""
    own = autosave_file()
    found = [p for p in own.parent.glob("autosave-*.trunnion") if p != own and not _runs(p)]
    return max(found, key=lambda p: p.stat().st_mtime, default=None)


def _runs(path: Path) -> bool:
    """Whether the program that an autosave belongs to still runs: its number may have been given to another one since."""
    try:
        number = int(path.stem.removeprefix("autosave-"))
        os.kill(number, 0)
    except (ValueError, OverflowError, ProcessLookupError):
        return False
    except OSError:
        return True  # it runs, for another user
    with contextlib.suppress(OSError):
        started = Path(f"/proc/{number}").stat().st_mtime
        return started <= path.stat().st_mtime
    return True
