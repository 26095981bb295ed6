"""Colours for the features of a class: as many as there are, apart from each other and most of all from neighbours on the part.

One after the other, each is the candidate that lies farthest from those given before, in OKLab, by the sight (`colour_space.SIGHTS`) that
parts them least. The distance to a neighbour on the part counts as half of what it is, so that neighbours end up about twice as far apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.report.colour_space import (
    SIGHTS,
    contrast,
    distances,
    light,
    light_of,
    oklab,
    on_screen,
    seen,
    written,
)
from trunnion.units import radians

Colour = tuple[int, int, int]
CONTRAST = 1.3
"""Least contrast of a feature with what it is drawn on: edges are drawn around it as well."""
LIGHTNESS, CHROMA = np.linspace(0.38, 0.86, 17), np.linspace(0.05, 0.21, 7)
"""Of the candidates, in OKLab."""
HALF_SECTOR = radians(50.0)
"""Hues of a class lie within so much of the mean of those that it declares, rad: cold ones stay cold."""
HUES = 23
"""Steps of hue among the candidates."""
NEIGHBOUR = 0.5
"""What counts of a distance to a neighbour on the part."""


def distinct_colours(
    classes: Sequence[tuple[Colour, ...]],
    neighbours: Iterable[tuple[int, int]],
    backgrounds: tuple[Colour, ...],
    others: Sequence[Colour] = (),
) -> tuple[Colour, ...]:
    """Return a colour for each of some features, by the declared colours of its class and by the pairs of rows that are neighbours.

    A class with one colour gives it to all its features; the first feature of any other class has the first of the declared ones. `others`
    are colours that no feature of such a class comes near to.
    """
    earlier = _earlier(neighbours, len(classes))
    distance = {
        declared: _free_distance(declared, backgrounds, others) for declared in set(classes)
    }
    views = np.zeros((len(SIGHTS), len(classes), 3))
    found: list[Colour] = []
    for row, declared in enumerate(classes):
        colours, looks = candidates(declared, backgrounds)
        near = distances(looks, views[:, earlier[row]]).min(axis=1, initial=np.inf)
        is_first = declared not in classes[:row]
        best = 0 if is_first else int(np.argmax(np.minimum(distance[declared], NEIGHBOUR * near)))
        found.append(colours[best])
        views[:, row] = looks[:, best]
        for other, free in distance.items():
            looks = candidates(other, backgrounds)[1]
            np.minimum(free, distances(looks, views[:, [row]])[:, 0], out=free)
    return tuple(found)


def _earlier(neighbours: Iterable[tuple[int, int]], count: int) -> list[list[int]]:
    """Return the neighbours of each row that come before it."""
    found: list[list[int]] = [[] for _ in range(count)]
    for a, b in neighbours:
        found[max(a, b)].append(min(a, b))
    return found


def _free_distance(
    declared: tuple[Colour, ...], backgrounds: tuple[Colour, ...], others: Sequence[Colour]
) -> Floats:
    """Return how far each candidate of a class (k,) is from the nearest of some colours."""
    looks = candidates(declared, backgrounds)[1]
    given = seen(np.array(others, dtype=float).reshape(-1, 3))
    return np.asarray(distances(looks, given).min(axis=1, initial=np.inf))


@cache
def candidates(
    declared: tuple[Colour, ...], backgrounds: tuple[Colour, ...]
) -> tuple[tuple[Colour, ...], Floats]:
    """Return the colours that features of a class may have, the declared ones first, and how they are seen (sights, k, 3)."""
    own = np.array(declared, dtype=float)
    found = np.vstack([own, *([_grid(own, backgrounds)] if len(declared) > 1 else [])])
    colours = tuple((int(r), int(g), int(b)) for r, g, b in found)
    return colours, seen(found)


def _grid(declared: Floats, backgrounds: tuple[Colour, ...]) -> Floats:
    """Return colours (k, 3) in whole steps of the hues around those of declared ones that a screen shows and that stand off backgrounds."""
    lab = oklab(light(declared))
    mean = np.arctan2(lab[:, 2].sum(), lab[:, 1].sum())
    hue = mean + np.linspace(-HALF_SECTOR, HALF_SECTOR, HUES)
    lightness, chroma, angle = (g.ravel() for g in np.meshgrid(LIGHTNESS, CHROMA, hue))
    colours = written(
        light_of(np.stack([lightness, chroma * np.cos(angle), chroma * np.sin(angle)], axis=1))
    )
    suits = on_screen(colours)
    for background in backgrounds:
        suits &= contrast(colours, np.array(background, dtype=float)) >= CONTRAST
    return np.asarray(np.round(colours[suits]))


def pairs_of(owners: Sequence[Sequence[int]], faces: Ints) -> tuple[tuple[int, int], ...]:
    """Return which features are neighbours, as pairs of rows: by the faces of each, and the pairs of faces (k, 2) with a common edge."""
    of_face: dict[int, list[int]] = {}
    for row, tags in enumerate(owners):
        for tag in tags:
            of_face.setdefault(tag, []).append(row)
    found = {
        (min(i, j), max(i, j))
        for a, b in faces.tolist()
        for i in of_face.get(a, ())
        for j in of_face.get(b, ())
        if i != j
    }
    return tuple(sorted(found))
