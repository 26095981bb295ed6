"""Colours as data: the same in window, report and pictures."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.model.feature import Feature
from trunnion_resources import folder

Colour = tuple[int, int, int]
GROUP = "group"
"""The kind of a group of equal patches."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviationColours:
    """Colours of the deviation map: finished, and two families from just outside the tolerance to the end of the range."""

    finished: Colour
    gouge: tuple[Colour, ...]
    left: tuple[Colour, ...]

    def at(self, value: Floats, low: float, high: float, limit: float) -> NDArray[np.uint8]:
        """Return the colour (v, 3) of deviations (v,) mm: gouge below `low`, left above `high`, both ending at `limit` from 0."""
        value = np.asarray(value, dtype=np.float64)
        found = np.tile(np.array(self.finished, np.float64), (len(value), 1))
        for colours, bad, share in (
            (self.gouge, value < low, (low - value) / (limit + low)),
            (self.left, value > high, (value - high) / (limit - high)),
        ):
            steps = np.linspace(0.0, 1.0, len(colours))
            for channel in range(3):
                found[bad, channel] = np.interp(share[bad], steps, [c[channel] for c in colours])
        return np.round(found).astype(np.uint8)


@dataclass(frozen=True, slots=True, kw_only=True)
class RadiusColours:
    """Colours of radii: `colours[k]` up to `limits[k]` mm, the last one above all of them."""

    limits: tuple[float, ...]
    colours: tuple[Colour, ...]

    def at(self, radius: float) -> Colour:
        """Return the colour of a radius in mm."""
        return self.colours[sum(radius > limit for limit in self.limits)]


@dataclass(frozen=True, kw_only=True)
class Palette:
    """Colours of feature kinds, of groups of equal patches by class, of radii, of motions and of deviations."""

    kinds: dict[str, Colour]
    remaining: tuple[Colour, ...]
    local: tuple[Colour, ...]
    radius: RadiusColours
    motions: dict[str, Colour]
    deviation: DeviationColours

    def kind(self, name: str) -> Colour:
        """Return the colour of a feature kind; kinds without one of their own share that of `other`."""
        return self.kinds.get(name, self.kinds["other"])

    def features(self, features: Iterable[Feature]) -> dict[str, Colour]:
        """Return the colour of each feature by id: its kind's, but groups of equal patches are told apart, local ones by warm colours."""
        found: dict[str, Colour] = {}
        met = {True: 0, False: 0}
        for f in features:
            if f.kind != GROUP:
                found[f.id] = self.kind(f.kind)
                continue
            is_local = bool(f.attributes.get("local"))
            wheel = self.local if is_local else self.remaining
            found[f.id] = wheel[met[is_local] % len(wheel)]
            met[is_local] += 1
        return found

    def motion(self, name: str) -> Colour:
        """Return the colour of a kind of motion."""
        return self.motions[name]


def load_palette() -> Palette:
    """Return the palette that is shipped; raise `BadInput` when a colour is not written as `#rrggbb`."""
    data = tomllib.loads((folder("palette") / "palette.toml").read_text(encoding="utf-8"))
    kinds, motions = (
        {k: _colour(k, v) for k, v in data[table].items()} for table in ("kinds", "motions")
    )
    remaining, local = (
        tuple(_colour(name, text) for text in data["groups"][name])
        for name in ("remaining", "local")
    )
    radius = RadiusColours(
        limits=tuple(data["radius"]["limits"]),
        colours=tuple(_colour("radius", c) for c in data["radius"]["colours"]),
    )
    return Palette(
        kinds=kinds,
        remaining=remaining,
        local=local,
        radius=radius,
        motions=motions,
        deviation=_deviation(data["deviation"]),
    )


def _deviation(data: dict[str, Any]) -> DeviationColours:
    gouge, left = (tuple(_colour(name, text) for text in data[name]) for name in ("gouge", "left"))
    return DeviationColours(finished=_colour("finished", data["finished"]), gouge=gouge, left=left)


def _colour(name: str, text: str) -> Colour:
    if len(text) != 7 or not text.startswith("#"):
        raise BadInput(f"palette: the colour of {name} must be written #rrggbb, not {text}")
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)
