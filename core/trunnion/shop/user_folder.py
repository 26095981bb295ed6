"""The user's own folder for data of this program: catalogues, tool cribs, the plan library."""

from __future__ import annotations

import os
import sys
from pathlib import Path

FOLDER = "TRUNNION_USER_FOLDER"
"""The environment's name for the user's folder, where no option names it."""


def user_folder() -> Path:
    """Return the user's own folder: named by the environment, else where the system keeps such data. It need not be there."""
    named = os.environ.get(FOLDER, "")
    if named:
        return Path(named)
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA") or Path.home()) / "Trunnion"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "Trunnion"
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "trunnion"


def shop_folder(named: Path | None) -> Path:
    """Return the folder of a shop's own data: the named one, else the user's own."""
    return user_folder() if named is None else named
