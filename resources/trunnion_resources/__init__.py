"""Data only: tools, holders, materials, machines, typical plans, schemas, palette, icons, translations, sample parts.

Read through `importlib.resources`; every folder is open to a user's own folder of the same shape.
"""

from __future__ import annotations

from importlib.resources import files
from importlib.resources.abc import Traversable


def folder(name: str) -> Traversable:
    """Return one of the resource folders by name."""
    return files(__name__) / name


def sample(name: str) -> Traversable:
    """Return a sample part (`B1`) as shipped, gzipped STEP."""
    return folder("samples") / f"{name}.stpz"
