"""Colours as data: the same in window, report and pictures."""

from __future__ import annotations

import json
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.feature import Feature
from trunnion.recognize.contract import FeatureKind, feature_kinds
from trunnion.report.colour_choice import Colour as Colour
from trunnion.report.colour_choice import distinct_colours, pairs_of
from trunnion_resources import folder

PAPER: Colour = (255, 255, 255)
"""The report's ground."""
OTHER, UNEXPLAINED = "other", "unexplained"
"""What has a colour of its own beside the kinds that families declare: features of any other kind, and faces in no feature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviationColours:
    """Colours of the deviation map: finished, and two families from just outside the tolerance to the end of the range."""

    finished: Colour
    gouge: tuple[Colour, ...]
    residual: tuple[Colour, ...]

    def at(self, value: Floats, low: float, high: float, limit: float) -> NDArray[np.uint8]:
        """Return the colour (v, 3) of deviations (v,) mm: gouge below `low`, left above `high`, both ending at `limit` from 0."""
        value = np.asarray(value, dtype=np.float64)
        found = np.tile(np.array(self.finished, np.float64), (len(value), 1))
        for colours, bad, share in (
            (self.gouge, value < low, (low - value) / (limit + low)),
            (self.residual, value > high, (value - high) / (limit - high)),
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


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassColours:
    """A class of features in legends: what several are called, and its colours: one for all, or some whose hues say where each
    has one of its own."""

    label: str
    colours: tuple[Colour, ...]


@dataclass(frozen=True, kw_only=True)
class Palette:
    """Colours of features by the kinds that families declare, of radii, motions, parts of machining time and deviations.

    `other` is that of features whose kind no registered family declares, `unexplained` that of faces in no feature; `backgrounds` are
    what features are drawn on, `selections` what is selected is drawn in.
    """

    kinds: Mapping[str, FeatureKind]
    other: Colour
    unexplained: Colour
    radius: RadiusColours
    motions: dict[str, Colour]
    machine_time: dict[str, Colour]
    deviation: DeviationColours
    backgrounds: tuple[Colour, ...] = ()
    selections: tuple[Colour, ...] = ()

    def kind(self, name: str) -> Colour:
        """Return the colour of a feature kind; kinds without one of their own share that of `other`."""
        if name == UNEXPLAINED:
            return self.unexplained
        return rgb(name, self.kinds[name].colour) if name in self.kinds else self.other

    def class_of(self, feature: Feature) -> ClassColours:
        """Return the class that a feature stands in."""
        if feature.kind not in self.kinds:
            return ClassColours(label=feature.kind.replace("_", " "), colours=(self.other,))
        found = self.kinds[feature.kind].class_of(feature)
        return ClassColours(
            label=found.label, colours=tuple(rgb(feature.kind, c) for c in found.colours)
        )

    def classes(self, features: Iterable[Feature]) -> dict[ClassColours, int]:
        """Return the classes of features with the number of each, in the order in which they are declared within a kind."""
        met = Counter(self.class_of(f) for f in features)
        labels = [c.label for kind in self.kinds.values() for c in kind.classes]
        rank = {label: n for n, label in enumerate(labels)}
        return dict(sorted(met.items(), key=lambda item: rank.get(item[0].label, -1)))

    def features(
        self, features: Iterable[Feature], neighbours: Ints | None = None
    ) -> dict[str, Colour]:
        """Return the colour of each feature by id: its kind's, or one of its own among those of its class.

        `neighbours` are the pairs of faces (k, 2) with a common edge, where they are known: features that meet are farthest apart.
        """
        given = tuple(features)
        pairs = () if neighbours is None else pairs_of([f.tags for f in given], neighbours)
        colours = distinct_colours(
            [self.class_of(f).colours for f in given],
            pairs,
            self.backgrounds,
            (self.other, self.unexplained, *self.selections),
        )
        return {f.id: colour for f, colour in zip(given, colours, strict=True)}

    def motion(self, name: str) -> Colour:
        """Return the colour of a kind of motion."""
        return self.motions[name]


def load_palette() -> Palette:
    """Return the shipped colours with those that families declare; raise `BadInput` when a colour is not written as `#rrggbb`."""
    data = tomllib.loads((folder("palette") / "palette.toml").read_text(encoding="utf-8"))
    motions, features, machine_time = (
        {name: rgb(name, text) for name, text in data[table].items()}
        for table in ("motions", "features", "machine_time")
    )
    radius = RadiusColours(
        limits=tuple(data["radius"]["limits"]),
        colours=tuple(rgb("radius", c) for c in data["radius"]["colours"]),
    )
    return Palette(
        kinds=feature_kinds(),
        other=features[OTHER],
        unexplained=features[UNEXPLAINED],
        radius=radius,
        motions=motions,
        machine_time=machine_time,
        deviation=_deviation(data["deviation"]),
        backgrounds=(PAPER, *_of_themes("view_top", "view_bottom")),
        selections=_of_themes("selection"),
    )


def _of_themes(*names: str) -> tuple[Colour, ...]:
    """Return some colours of every theme of the window, each once."""
    themes = json.loads((folder("palette") / "themes.json").read_text(encoding="utf-8"))
    return tuple(dict.fromkeys(rgb(name, t[name]) for t in themes.values() for name in names))


def _deviation(data: dict[str, Any]) -> DeviationColours:
    gouge, residual = (tuple(rgb(name, text) for text in data[name]) for name in ("gouge", "left"))
    return DeviationColours(
        finished=rgb("finished", data["finished"]), gouge=gouge, residual=residual
    )


def rgb(name: str, text: str) -> Colour:
    """Return red, green and blue (0 to 255) of what is written `#rrggbb`; raise `BadInput` that names it otherwise."""
    if not re.fullmatch("#[0-9a-fA-F]{6}", text):
        raise BadInput(f"palette: the colour of {name} must be written #rrggbb, not {text}")
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)
