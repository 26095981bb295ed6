"""The program's own catalogues, read once a session: that takes a tenth of a second, for every engine and every module of tests."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from trunnion.registry import resource_folders
from trunnion.shop import Shop, load_shop


def own_shop() -> Shop:
    """Return the shop of the catalogues of the program, and of those packages that are registered now."""
    return _read(tuple(map(str, resource_folders("tools"))))


def shop_of(user_folder: Path | None) -> Shop:
    """Return what `load_shop` does; where no user's folder is there, the shop that was read before."""
    return (
        load_shop(user_folder) if user_folder is not None and user_folder.exists() else own_shop()
    )


@cache
def _read(_: tuple[str, ...]) -> Shop:
    return load_shop()
