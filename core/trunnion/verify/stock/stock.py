"""The stock of a piece of work, in the blank's frame: the same object goes from setup to setup."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadInput, OutOfMemory
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.stock.bundles import AXES, RAY_BYTES, Bundle
from trunnion.verify.stock.field import Field, Part, cells_along

MOST_BYTES = 2_000_000_000
"""Most memory that the stock may take."""


HEIGHTS = "heights"
"""The height field's name in a snapshot."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """A stock at a moment: copies of the tiles of each bundle, shared with the snapshot before where nothing has changed since."""

    parts: dict[str, tuple[Part, ...]]
    cut_by: tuple[tuple[Sweep, Frame], ...]

    @property
    def nbytes(self) -> int:
        """Bytes that it takes, with what it shares."""
        return sum(a.nbytes for tiles in self.parts.values() for tile in tiles for a in tile)


@dataclass(slots=True, eq=False)
class Stock:
    """What is left of a blank: rays `pitch` apart through it along some of its axes (`bundles`), and where material is on them.

    While every cut came from above, the z bundle is a height field (`field`), else one of intervals (`rays["z"]`), as the others always
    are. `low`, `high` (3,): the box in the blank's frame that it is of, the blank's own but for a patch. `cut_by`: the sweeps that went
    through it, with their setups' frames.
    """

    blank: Blank
    low: Floats
    high: Floats
    pitch: float
    bundles: tuple[str, ...]
    field: Field | None
    rays: dict[str, Bundle]
    cut_by: list[tuple[Sweep, Frame]] = dataclasses.field(default_factory=list)
    _last: Snapshot | None = None

    @staticmethod
    def of(
        blank: Blank,
        pitch: float,
        bundles: Sequence[str] = ("z",),
        box: tuple[Floats, Floats] | None = None,
    ) -> Stock:
        """Return a whole blank, or what is of it in a box (low, high) of its frame.

        Raises `OutOfMemory` when rays so close would need too much memory.
        """
        if not bundles or any(name not in AXES for name in bundles):
            raise BadInput(
                f"stock: its bundles are some of {', '.join(AXES)}, not {', '.join(bundles) or 'none'}"
            )
        low, high = box or (blank.low, blank.high)
        _refuse(Stock.need(blank, pitch, bundles, (low, high)), pitch)
        field = Field.of(blank, pitch, (low, high)) if "z" in bundles else None
        rays = {
            name: Bundle.of(blank, pitch, AXES.index(name), (low, high))
            for name in bundles
            if name != "z" or field is None
        }
        return Stock(blank, low, high, pitch, tuple(bundles), field, rays)

    @staticmethod
    def need(
        blank: Blank,
        pitch: float,
        bundles: Sequence[str] = ("z",),
        box: tuple[Floats, Floats] | None = None,
    ) -> int:
        """Return the bytes that a stock takes at its beginning; ragged ones grow, up to `MOST_BYTES`."""
        low, high = box or (blank.low, blank.high)
        x, y, z = cells_along(high - low, pitch)
        rays = {"x": y * z, "y": z * x, "z": x * y}
        return sum(rays[name] * (8 if tuple(bundles) == ("z",) else RAY_BYTES) for name in bundles)

    @property
    def frame(self) -> Frame:
        """The blank's frame, in which all of it is."""
        return self.blank.frame

    @property
    def volume(self) -> float:
        """Volume in mm3: the mean of what the bundles say."""
        volumes = [b.volume for b in self.rays.values()] + (
            [self.field.volume] if self.field is not None else []
        )
        return float(np.mean(volumes))

    def contains(self, points: Floats) -> Bools:
        """Return for points (k, 3) in the blank's frame whether they are in material: what most of the nearest rays say."""
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        votes = [b.contains(points) for b in self.rays.values()] + (
            [self.field.contains(points)] if self.field is not None else []
        )
        inside = ((points >= self.low) & (points <= self.high)).all(axis=1)
        return np.asarray(inside & (2 * np.sum(votes, axis=0) > len(votes)))

    def was_solid(self, points: Floats) -> Bools:
        """Return for points (k, 3) in the blank's frame whether they were inside before anything was cut."""
        inside = ((points > self.low) & (points < self.high)).all(axis=1)
        return np.asarray(inside & (self.blank.depth(points, self.frame) > 0.0))

    def patch(self, low: Floats, high: Floats, pitch: float) -> Stock:
        """Return a box of the blank, whole, with finer rays: cut it by the moves that touch it to see this position closely."""
        low, high = np.maximum(low, self.low), np.minimum(high, self.high)
        if not (high > low).all():
            raise BadInput("stock: a patch must have its box in the blank")
        return Stock.of(self.blank, pitch, self.bundles, (low, high))

    def open_field(self) -> None:
        """Turn the height field into intervals: from now on anything may be cut."""
        if self.field is not None:
            _refuse(
                RAY_BYTES * self.field.top.size + sum(b.nbytes for b in self.rays.values()),
                self.pitch,
            )
            self.rays["z"], self.field = Bundle.of_field(self.field), None

    def snapshot(self) -> Snapshot:
        """Return what `restore` goes back to. Tiles that have not changed since the last one are not copied again."""
        parts = {name: b.parts() for name, b in self.rays.items()}
        if self.field is not None:
            parts[HEIGHTS] = self.field.parts()
        before = self._last.parts if self._last is not None else {}
        self._last = Snapshot(
            {name: _shared(before.get(name, ()), own) for name, own in parts.items()},
            tuple(self.cut_by),
        )
        return self._last

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot of this stock."""
        if HEIGHTS in snapshot.parts:
            self.rays.pop("z", None)
            self.field = self.field or Field.of(self.blank, self.pitch, (self.low, self.high))
            assert self.field is not None  # it was one when the snapshot was taken
            self.field.put(snapshot.parts[HEIGHTS])
        else:
            self.open_field()
        for name, bundle in self.rays.items():
            bundle.put(snapshot.parts[name])
        self.cut_by, self._last = list(snapshot.cut_by), snapshot


def _shared(before: Sequence[Part], now: Sequence[Part]) -> tuple[Part, ...]:
    """Return the tiles as they are now, those that are as before by the older copy."""
    if len(before) != len(now):
        return tuple(now)
    return tuple(
        old if all(map(np.array_equal, old, new)) else new
        for old, new in zip(before, now, strict=True)
    )


def _refuse(need: int, pitch: float) -> None:
    if need > MOST_BYTES:
        least = math.ceil(100.0 * pitch * math.sqrt(need / MOST_BYTES)) / 100.0
        raise OutOfMemory(
            f"stock at cells of {pitch:g} mm would need {need / 1e6:.0f} MB: choose verify.cell of at least {least:.2f} mm"
        )
