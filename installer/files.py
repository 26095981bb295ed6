"""Files of an installer: filled templates, desktop files, one time for all."""

from __future__ import annotations

import gzip
import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path

from installer.project import ROOT, stop

HERE = ROOT / "installer"
ICON = ROOT / "resources" / "trunnion_resources" / "icons" / "trunnion.svg"
DESKTOP = {
    "trunnion.desktop": "applications/trunnion.desktop",
    "trunnion.xml": "mime/packages/trunnion.xml",
}
"""Desktop files below `installer/desktop`, and where they lie below `share`."""
ICON_PLACE = "icons/hicolor/scalable/apps/trunnion.svg"
PROGRAM, DATA = 0o755, 0o644


def filled(template: Path, values: Mapping[str, str]) -> str:
    """Return a template with its `@WORDS@` replaced; stops where one has no value."""

    def value(found: re.Match[str]) -> str:
        if found[1] not in values:
            stop(f"{template} wants {found[0]}, which the build does not give")
        return values[found[1]]

    return re.sub(r"@([A-Z_]+)@", value, template.read_text(encoding="utf-8"))


def write(path: Path, text: str, mode: int = DATA) -> None:
    """Write a text file, with the folders that it lies in."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(mode)


def write_gzip(path: Path, text: str) -> None:
    """Write a compressed text file that holds neither its name nor the time."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
    path.chmod(DATA)


def add_desktop_files(share: Path) -> None:
    """Put the menu entry, the type of project files and the icon below a folder `share`."""
    for name, place in DESKTOP.items():
        write(share / place, (HERE / "desktop" / name).read_text(encoding="utf-8"))
    write(share / ICON_PLACE, ICON.read_text(encoding="utf-8"))


def with_one_time(folder: Path, seconds: int) -> None:
    """Give every file and folder below a folder, and itself, one time and the modes that files of a package have."""
    for parent, folders, names in os.walk(folder):
        for name in (*folders, *names):
            path = Path(parent) / name
            if not path.is_symlink():
                path.chmod(PROGRAM if path.is_dir() or path.stat().st_mode & 0o100 else DATA)
            os.utime(path, (seconds, seconds), follow_symlinks=False)
    folder.chmod(PROGRAM)
    os.utime(folder, (seconds, seconds))


def size_kib(folder: Path) -> int:
    """Return what the files below a folder take, each rounded up to 1 KiB (Debian policy 5.6.20)."""
    files = (p for p in folder.rglob("*") if p.is_file() or p.is_symlink())
    return sum(-(-p.lstat().st_size // 1024) for p in files)


def empty_folder(path: Path) -> Path:
    """Return a folder that holds nothing, whatever it held before."""
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path
