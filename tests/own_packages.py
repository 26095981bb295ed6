"""Packages of one's own, registered as pip would: folders of `tests` on the path, their entry points beside ours."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import trunnion.pipeline  # noqa: F401 - choices of settings are ours alone: they are declared before other packages are there
from trunnion import registry
from trunnion.post.contract import Dialect

FOLDER = Path(__file__).resolve().parent / "dialects"
FOLDERS = (FOLDER, FOLDER.parent / "families")
"""Folders that hold packages, each with its dist-info."""
REMEMBERED = (
    ("trunnion_gui.look.colours", "palette"),
    ("trunnion_gui.i18n", "_words"),
)
"""Functions of the window that keep what they were told of packages."""


@contextmanager
def with_own_packages() -> Iterator[None]:
    """Let the registry find the packages of `FOLDERS` too, for as long as the context lasts."""
    sys.path[:0] = map(str, FOLDERS)
    forget()
    try:
        yield
    finally:
        for folder in FOLDERS:
            sys.path.remove(str(folder))
        forget()


def forget() -> None:
    """Let the registry, and the window's words and colours, look for packages again."""
    registry._points.cache_clear()
    registry.get.cache_clear()
    for module, function in REMEMBERED:
        if module in sys.modules:
            getattr(sys.modules[module], function).cache_clear()


def environment() -> dict[str, str]:
    """Return the environment of a process that finds the packages."""
    path = [*map(str, FOLDERS), *filter(None, [os.environ.get("PYTHONPATH")])]
    return os.environ | {"PYTHONPATH": os.pathsep.join(path)}


def names(kind: str) -> tuple[str, ...]:
    """Return the registered names of a kind, those of the packages among them."""
    with with_own_packages():
        return registry.names(kind)


def all_dialects() -> dict[str, type[Dialect]]:
    """Return every registered dialect by its name, ours and those of the packages."""
    with with_own_packages():
        return {name: registry.get("dialects", name) for name in registry.names("dialects")}
