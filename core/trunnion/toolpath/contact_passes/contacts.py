"""Contact passes: where a cutter is to touch the faces one position after the other, before its axis there is known.

Between two contacts the face is not queried again: the path is the cubic whose ends lie on the face and run along it (across its normals),
which on a round face leaves it by less than the sixth power of the turn.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, floats
from trunnion.geometry.sphere import angle_between

_STILL = 1e-9
"""mm: contacts closer than this give no direction."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Contacts:
    """Contacts of one pass in their order: point (k, 3) on the faces, normal (k, 3) their outward unit normals there; at least two.

    `closed`: the last contact is the first one again.
    """

    point: Floats
    normal: Floats
    closed: bool = False
    _feed: list[Floats] = field(init=False, repr=False, default_factory=list)
    _travel: dict[float, Floats] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", floats(self.point, (None, 3), "contact points"))
        object.__setattr__(
            self, "normal", floats(self.normal, (len(self.point), 3), "contact normals")
        )

    def __len__(self) -> int:
        return len(self.point)

    @property
    def feed(self) -> Floats:
        """The unit direction of the path at each contact (k, 3), along the face; found once, as every run of a pass asks for it."""
        if not self._feed:
            self._feed.append(self._directions())
        return self._feed[0]

    def _directions(self) -> Floats:
        step = np.diff(self.point, axis=0)
        size = np.linalg.norm(step, axis=1, keepdims=True)
        direction = _scaled(step)
        if self.closed:
            before, after = (
                np.vstack([direction[-1:], direction]),
                np.vstack([direction, direction[:1]]),
            )
            length_before, length_after = np.vstack([size[-1:], size]), np.vstack([size, size[:1]])
        else:
            before, after = (
                np.vstack([direction[:1], direction]),
                np.vstack([direction, direction[-1:]]),
            )
            length_before, length_after = np.vstack([size[:1], size]), np.vstack([size, size[-1:]])
        # The circle through three contacts: the shorter chord says more of the direction at the middle one.
        return _along(length_after * before + length_before * after, self.normal)

    def travel(self, radius: float) -> Floats:
        """Return how far (k,) mm a point `radius` above the face has come at each contact: what a cutter of that radius travels."""
        if radius not in self._travel:
            offset = self.point + radius * self.normal
            run = np.cumsum(np.linalg.norm(np.diff(offset, axis=0), axis=1))
            self._travel[radius] = np.concatenate([[0.0], run])
        return self._travel[radius]

    def of(self, rows: Bools | slice) -> Contacts:
        """Return a part of the pass; it is not closed."""
        return Contacts(point=self.point[rows], normal=self.normal[rows])

    def reversed(self) -> Contacts:
        """Return the pass the other way round."""
        return Contacts(point=self.point[::-1], normal=self.normal[::-1], closed=self.closed)


def between(point: Floats, normal: Floats, feed: Floats, position: Floats) -> tuple[Floats, Floats]:
    """Return points and unit normals (k, 3) at positions (k,) along contacts (n, 3).

    Position 2.25 is a quarter of the distance from the third contact to the next; `feed` (n, 3) are the unit directions of the path.
    """
    row = np.clip(position.astype(np.int64), 0, len(point) - 2)
    return between_rows(point, normal, feed, row, position - row)


def between_rows(
    point: Floats, normal: Floats, feed: Floats, row: Ints, share: Floats
) -> tuple[Floats, Floats]:
    """Return points and unit normals (k, 3) at shares (k,) of the distances from the contacts of some rows (k,) to those after them."""
    u = share[:, None]
    a, b, start, end = point[row], point[row + 1], feed[row], feed[row + 1]
    # As long as the tangents of an arc's cubic: chord / cos^2(turn / 4).
    half = np.sqrt(0.5 * (1.0 + np.clip((start * end).sum(axis=1, keepdims=True), -1.0, 1.0)))
    length = np.linalg.norm(b - a, axis=1, keepdims=True) * 2.0 / (1.0 + half)
    found = (
        a * (1.0 + 2.0 * u) * (1.0 - u) ** 2
        + b * u * u * (3.0 - 2.0 * u)
        + length * (start * u * (1.0 - u) ** 2 - end * u * u * (1.0 - u))
    )
    return found, _scaled((1.0 - u) * normal[row] + u * normal[row + 1])


def axis_between(axis: Floats, position: Floats) -> Floats:
    """Return unit axes (k, 3) at positions (k,) along axes (n, 3), each turning evenly to the next."""
    row = np.clip(position.astype(np.int64), 0, len(axis) - 2)
    return slerp(axis[row], axis[row + 1], position - row)


def slerp(start: Floats, end: Floats, share: Floats) -> Floats:
    """Return the unit directions (k, 3) at shares (k,) of the even turn from start to end (k, 3)."""
    angle = angle_between(start, end)
    still = angle < 1e-7
    sine = np.where(still, 1.0, np.sin(angle))
    a = np.where(still, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    b = np.where(still, share, np.sin(share * angle) / sine)
    return _scaled(a[:, None] * start + b[:, None] * end)


def _along(direction: Floats, normal: Floats) -> Floats:
    """Return the unit directions (k, 3) of a path seen along faces with normals (k, 3)."""
    return _scaled(direction - (direction * normal).sum(axis=1, keepdims=True) * normal)


def _scaled(vectors: Floats) -> Floats:
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > _STILL)
