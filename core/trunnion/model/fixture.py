"""Fixtures: what holds the part and must not be touched."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fixture:
    """A clamp, vice or plate as triangles in the part's coordinates. `setup` names the setup it is there in; empty: all of them."""

    name: str
    mesh: Mesh
    setup: str = ""
