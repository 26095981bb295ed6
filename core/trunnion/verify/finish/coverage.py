"""Which of the part's area is finished: samples on the exact trimmed faces, each with the material that the program leaves on it.

A sample represents an area. Material left is the smallest signed distance from the sample to the fluted cutter over every feed move; a
sample is finished when that is within tolerance and allowance. A face that lies in the blank's own surface has nothing to be finished.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.part.shape.facets import Facets, facet_samples, represented
from trunnion.part.shape.surfaces import (
    DX,
    DY,
    GUIDE,
    L_KIND,
    PROFILE,
    PW0,
    PW1,
    PZ0,
    PZ1,
    R_KIND,
    SIDE,
    U0,
    U1,
    Surfaces,
)
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact import guide_points

THIN, FEW, DENSE = 0.5, 8, 4.0
"""Strips thinner than this share of the spacing are thin. Where a face has more than a few of them, and a row of samples along each would
be so many times what their area asks for, they are dense: the wall of a casing comes in thousands, cut by the fillets of its bosses."""
GOLDEN = 0.5 * (5.0**0.5 - 1.0)
MOST_SAMPLES = 4_000_000
"""About a quarter of a GB, and some times as much while they are measured: a part of 4 x 4 m at the usual spacing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Samples:
    """Samples of trimmed faces: face (s,) rows, point and outward normal (s, 3) in the frame of the surfaces, area (s,) mm2."""

    face: Ints
    point: Floats
    normal: Floats
    area: Floats

    def __len__(self) -> int:
        return len(self.face)


def samples_of(
    surfaces: Surfaces,
    spacing: float,
    progress: Progress = NO_PROGRESS,
    facets: Facets | None = None,
) -> Samples:
    """Return samples about `spacing` mm apart on every face, the same ones each time; no face is without one.

    Those of faces without closed form lie on their facets, which must be in the frame of the surfaces. Raises `OutOfMemory` beyond
    `MOST_SAMPLES`.
    """
    strips = np.vstack([surfaces.strip, surfaces.level])
    strip_face = np.concatenate([surfaces.strip_face, surfaces.level_face])
    progress.at(0.0, "Spreading samples")
    size = np.array([_size(strip) for strip in progress.each(strips)]).reshape(-1, 2)
    expected = float(size.prod(axis=1).sum()) / spacing**2
    if expected > MOST_SAMPLES:
        raise OutOfMemory(
            f"measuring coverage needs about {expected / 1e6:.0f} million samples at {spacing:g} mm: set a larger "
            "verify.spacing, or split the part"
        )
    dense = _dense(size, strip_face, spacing)
    parts = [
        _strip_samples(strip, spacing, progress, n if dense[n] else None)
        for n, strip in enumerate(progress.over(strips, "Spreading samples"))
    ]
    owner = np.repeat(np.arange(len(strips)), [len(p) for p in parts])
    rows = np.vstack([np.zeros((0, 7)), *parts])
    kept = progress.aside(
        lambda _: _represented(rows, np.where(dense, strip_face, -1)[owner], spacing),
        "Spreading samples",
    )
    face, rows = strip_face[owner[kept]], rows[kept]
    if facets is None or not len(surfaces.free):
        return Samples(
            face=face.astype(np.int64), point=rows[:, :3], normal=rows[:, 3:6], area=rows[:, 6]
        )
    triangles = facets
    free, point, normal, area = progress.aside(
        lambda own: facet_samples(triangles, surfaces.free, spacing, own),
        "Spreading samples over free-form faces",
    )
    return Samples(
        face=np.concatenate([face.astype(np.int64), free]),
        point=np.vstack([rows[:, :3], point]),
        normal=np.vstack([rows[:, 3:6], normal]),
        area=np.concatenate([rows[:, 6], area]),
    )


def _size(strip: Floats) -> tuple[float, float]:
    """Return the length of a strip's profile and of its guide at the profile's middle, mm."""
    low, high = guide_ends(strip, 0.5 * (strip[U0] + strip[U1]))
    wide = max(abs(strip[PW0]), abs(strip[PW1])) if strip[GUIDE] else 1.0
    return _length(strip), max(float((high - low) * wide), 0.0)


def _length(strip: Floats) -> float:
    """Return the length of a strip's profile, mm."""
    if strip[PROFILE] == 0.0:
        return float(np.hypot(strip[PW1] - strip[PW0], strip[PZ1] - strip[PZ0]))
    return float(strip[PW1] * (strip[U1] - strip[U0]))


def _dense(size: Floats, strip_face: Ints, spacing: float) -> Bools:
    """Return which strips (n,) of sizes (n, 2) are so thin, and so many on their face, that a row of samples along each would be far too
    many."""
    thin = size[:, 0] < THIN * spacing
    dense = np.zeros(len(size), bool)
    faces, counts = np.unique(strip_face[thin], return_counts=True)
    for face in faces[counts > FEW]:
        mine = thin & (strip_face == face)
        dense |= mine & bool(size[mine, 1].sum() * spacing > DENSE * size[mine].prod(axis=1).sum())
    return dense


def _represented(rows: Floats, dense_face: Ints, spacing: float) -> Ints:
    """Return the rows (k,) of samples (s, 7) that stay: of those on dense strips of a face, by `dense_face` (s,), -1 for others, one in
    each cell of a grid. It is given the area of all that it represents."""
    stays = dense_face < 0
    for face in np.unique(dense_face[~stays]):
        mine = np.flatnonzero(dense_face == face)
        first, area = represented(rows[mine, :3], rows[mine, 6], spacing)
        stays[mine[first]], rows[mine[first], 6] = True, area
    return np.flatnonzero(stays)


def _strip_samples(strip: Floats, spacing: float, progress: Progress, number: int | None) -> Floats:
    """Return points, normals and areas (k, 7) of one strip: rows across the profile, each as long as the trim is there.

    Of a dense strip, which is given its `number`, they are as many as its area asks for several times over, shifted from strip to strip by
    the golden ratio: so they are spread evenly however thin strips are.
    """
    u0, u1 = strip[U0], strip[U1]
    straight, length = strip[PROFILE] == 0.0, _length(strip)
    if u1 - u0 <= 0.0 or length < tolerance.PARAMETRIC:
        return np.zeros((0, 7))
    rows = max(1, int(np.ceil(length / spacing)))
    found = []
    for u in progress.each(u0 + (np.arange(rows) + 0.5) / rows * (u1 - u0)):
        ends = guide_ends(strip, u)
        if straight:
            share = (u - u0) / (u1 - u0)
            w, t = (
                strip[PW0] + share * (strip[PW1] - strip[PW0]),
                np.array([strip[PW1] - strip[PW0], strip[PZ1] - strip[PZ0]]) / length,
            )
        else:
            w, t = strip[PW0] + strip[PW1] * np.cos(u), np.array([-np.sin(u), np.cos(u)])
        run = (ends[1] - ends[0]) * (abs(w) if strip[GUIDE] else 1.0)
        if run <= tolerance.PARAMETRIC:
            continue
        apart = spacing if number is None else spacing**2 * rows / (DENSE * length)
        count = max(1, int(np.ceil(run / max(apart, spacing))))
        shares = (np.arange(count) + (0.5 + GOLDEN * (number or 0)) % 1.0) / count
        points = guide_points(strip, u, shares)
        across = _across(strip, ends[0] + shares * (ends[1] - ends[0]))
        normal = strip[SIDE] * np.column_stack([t[1] * across, np.full(count, -t[0])])
        found.append(np.column_stack([points, normal, np.full(count, run / count * length / rows)]))
    return np.vstack([np.zeros((0, 7)), *found])


def guide_ends(strip: Floats, u: float) -> tuple[float, float]:
    """Return where a strip's trim begins and ends along its guide at one profile parameter."""
    ends = []
    for column in (L_KIND, R_KIND):
        kind, a, b, c, sign = strip[column : column + 5]
        ends.append(
            float(
                a + b * (u - strip[U0])
                if kind == 0.0
                else a + sign * np.sqrt(max(b * b - (u - c) ** 2, 0.0))
            )
        )
    return ends[0], ends[1]


def _across(strip: Floats, s: Floats) -> Floats:
    """Return the plan direction (k, 2) in which w grows."""
    if strip[GUIDE]:
        return np.column_stack([np.cos(s), np.sin(s)])
    return np.tile([-strip[DY], strip[DX]], (len(s), 1))


def on_blank(samples: Samples, blank: Blank, frame: Frame, n_faces: int) -> Bools:
    """Return for each face row whether all its samples lie in one of the blank's sides; `frame` is the samples'."""
    out = np.zeros(n_faces, bool)
    if not len(samples):
        return out
    near = blank.sides(blank.own(samples.point, frame), tolerance.SLIVER)
    misses = [np.bincount(samples.face[~side], minlength=n_faces) for side in near.T]
    out[np.unique(samples.face)] = True
    return out & (np.array(misses) == 0).any(axis=0)
