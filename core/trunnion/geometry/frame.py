"""Frames: where a setup's origin is and how it lies in the part's coordinates as read."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from trunnion.geometry.arrays import Floats, floats, unit


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A right-handed frame given in the part's coordinates.

    `origin` (3,) mm; `x` and `z` (3,) unit and perpendicular (x is made so from what is given).
    """

    origin: Floats
    x: Floats
    z: Floats
    _axes: list[Floats] = field(init=False, repr=False, default_factory=list)

    def __post_init__(self) -> None:
        z = unit(floats(self.z, (3,), "frame z"), "frame z")
        x = floats(self.x, (3,), "frame x")
        x = unit(x - (x @ z) * z, "frame x across z")
        object.__setattr__(self, "origin", floats(self.origin, (3,), "frame origin"))
        object.__setattr__(self, "x", floats(x, (3,), "frame x"))
        object.__setattr__(self, "z", floats(z, (3,), "frame z"))

    @property
    def y(self) -> Floats:
        """The second axis (3,)."""
        return self.axes[1]

    @property
    def axes(self) -> Floats:
        """The three axes as rows (3, 3): local = axes @ (world - origin)."""
        if not self._axes:
            self._axes.append(
                floats(np.stack([self.x, np.cross(self.z, self.x), self.z]), (3, 3), "frame axes")
            )
        return self._axes[0]

    def to_local(self, points: Floats) -> Floats:
        """Return points (…, 3) of the part's coordinates in this frame."""
        return (np.asarray(points) - self.origin) @ self.axes.T

    def to_world(self, points: Floats) -> Floats:
        """Return points (…, 3) of this frame in the part's coordinates."""
        return np.asarray(points) @ self.axes + self.origin

    def local_direction(self, directions: Floats) -> Floats:
        """Return directions (…, 3) of the part's coordinates in this frame."""
        return np.asarray(directions) @ self.axes.T

    def world_direction(self, directions: Floats) -> Floats:
        """Return directions (…, 3) of this frame in the part's coordinates."""
        return np.asarray(directions) @ self.axes

    def moved(self, local_origin: Floats) -> Frame:
        """Return the frame with its origin at a point given in this frame."""
        return Frame(self.to_world(np.asarray(local_origin, dtype=np.float64)), self.x, self.z)

    def as_dict(self) -> dict[str, list[float]]:
        """Return the frame as the JSON that other programs rely on."""
        return {
            name: [float(v) + 0.0 for v in getattr(self, name)] for name in ("origin", "x", "z")
        }


WORLD = Frame(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
"""The part's coordinates as read."""
