"""Which of the part's area is finished: samples on the exact trimmed faces, each with the material that the program leaves on it.

A sample stands for an area. Material left is the smallest signed distance from the sample to the fluted cutter over every feed move; a
sample is finished when that is within tolerance and allowance. A face that lies in the blank's own surface has nothing to be finished.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.material import Machine
from trunnion.model.tool import PLAIN_FORMS, Tool
from trunnion.part.facets import Facets, facet_samples
from trunnion.part.surfaces import DX, DY, GUIDE, L_KIND, PROFILE, PW0, PW1, PZ0, PZ1, R_KIND, SIDE, U0, U1, Surfaces
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact import PartContact, guide_points
from trunnion.verify.finish.leaning import leaning_axes, touching_tips
from trunnion.verify.machine.kinematics import can_hold
from trunnion.verify.motion import poses_of

POSES = 2048
"""Poses tried between two looks at cancel."""
MOST_SAMPLES = 4_000_000
"""About a quarter of a GB, and some times as much while they are measured: a part of 4 x 4 m at the usual spacing."""
MOST_TRIED = 3000
"""Samples that every cutter is tried on, about half a minute where none reaches."""
MOST_LEANING = 200
"""The same for leaning cutters, which are tried in many more poses."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Samples:
    """Samples of trimmed faces: face (s,) rows, point and outward normal (s, 3) in the frame of the surfaces, area (s,) mm2."""

    face: Ints
    point: Floats
    normal: Floats
    area: Floats

    def __len__(self) -> int:
        return len(self.face)


def samples_of(surfaces: Surfaces, spacing: float, progress: Progress = QUIET, facets: Facets | None = None) -> Samples:
    """Return samples about `spacing` mm apart on every face, the same ones each time; no face is without one.

    Those of faces without closed form lie on their facets, which must be in the frame of the surfaces. Raises `OutOfMemory` beyond
    `MOST_SAMPLES`.
    """
    strips = np.vstack([surfaces.strip, surfaces.level])
    expected = sum(_expected(strip, spacing) for strip in strips)
    if expected > MOST_SAMPLES:
        raise OutOfMemory(f"measuring coverage needs about {expected / 1e6:.0f} million samples at {spacing:g} mm: set a larger "
                          "verify.spacing, or split the part")
    parts = [_strip_samples(strip, spacing) for strip in progress.over(strips, "Spreading samples")]
    face = np.repeat(np.concatenate([surfaces.strip_face, surfaces.level_face]), [len(p) for p in parts])
    rows = np.vstack([np.zeros((0, 7)), *parts])
    if facets is None or not len(surfaces.free):
        return Samples(face=face.astype(np.int64), point=rows[:, :3], normal=rows[:, 3:6], area=rows[:, 6])
    free, point, normal, area = facet_samples(facets, surfaces.free, spacing)
    return Samples(face=np.concatenate([face.astype(np.int64), free]), point=np.vstack([rows[:, :3], point]),
                   normal=np.vstack([rows[:, 3:6], normal]), area=np.concatenate([rows[:, 6], area]))


def _expected(strip: Floats, spacing: float) -> float:
    """Return about how many samples a strip gets, by its size at the middle of its profile."""
    u0, u1 = strip[U0], strip[U1]
    straight = strip[PROFILE] == 0.0
    length = np.hypot(strip[PW1] - strip[PW0], strip[PZ1] - strip[PZ0]) if straight else strip[PW1] * (u1 - u0)
    low, high = guide_ends(strip, 0.5 * (u0 + u1))
    wide = max(abs(strip[PW0]), abs(strip[PW1])) if strip[GUIDE] else 1.0
    return max(float(length * (high - low) * wide), 0.0) / spacing**2


def _strip_samples(strip: Floats, spacing: float) -> Floats:
    """Return points, normals and areas (k, 7) of one strip: rows across the profile, each as long as the trim is there."""
    u0, u1 = strip[U0], strip[U1]
    straight = strip[PROFILE] == 0.0
    length = np.hypot(strip[PW1] - strip[PW0], strip[PZ1] - strip[PZ0]) if straight else strip[PW1] * (u1 - u0)
    if u1 - u0 <= 0.0 or length < tolerance.PARAMETRIC:
        return np.zeros((0, 7))
    rows = max(1, int(np.ceil(length / spacing)))
    found = []
    for u in u0 + (np.arange(rows) + 0.5) / rows * (u1 - u0):
        ends = guide_ends(strip, u)
        if straight:
            share = (u - u0) / (u1 - u0)
            w, t = strip[PW0] + share * (strip[PW1] - strip[PW0]), np.array([strip[PW1] - strip[PW0], strip[PZ1] - strip[PZ0]]) / length
        else:
            w, t = strip[PW0] + strip[PW1] * np.cos(u), np.array([-np.sin(u), np.cos(u)])
        run = (ends[1] - ends[0]) * (abs(w) if strip[GUIDE] else 1.0)
        if run <= tolerance.PARAMETRIC:
            continue
        count = max(1, int(np.ceil(run / spacing)))
        shares = (np.arange(count) + 0.5) / count
        points = guide_points(strip, u, shares)
        across = _across(strip, ends[0] + shares * (ends[1] - ends[0]))
        normal = strip[SIDE] * np.column_stack([t[1] * across, np.full(count, -t[0])])
        found.append(np.column_stack([points, normal, np.full(count, run / count * length / rows)]))
    return np.vstack([np.zeros((0, 7)), *found])


def guide_ends(strip: Floats, u: float) -> tuple[float, float]:
    """Return where a strip's trim begins and ends along its guide at one profile parameter."""
    ends = []
    for column in (L_KIND, R_KIND):
        kind, a, b, c, sign = strip[column:column + 5]
        ends.append(float(a + b * (u - strip[U0]) if kind == 0.0 else a + sign * np.sqrt(max(b * b - (u - c) ** 2, 0.0))))
    return ends[0], ends[1]


def _across(strip: Floats, s: Floats) -> Floats:
    """Return the plan direction (k, 2) in which w grows."""
    if strip[GUIDE]:
        return np.column_stack([np.cos(s), np.sin(s)])
    return np.tile([-strip[DY], strip[DX]], (len(s), 1))


def on_blank(samples: Samples, low: Floats, high: Floats, n_faces: int) -> Bools:
    """Say for each face row whether all its samples lie in one of the blank's sides, given by corners in the samples' frame."""
    out = np.zeros(n_faces, bool)
    if not len(samples):
        return out
    near = np.abs(np.hstack([samples.point - low, samples.point - high])) < tolerance.SLIVER
    misses = np.zeros((n_faces, 6))
    np.add.at(misses, samples.face, ~near)
    out[np.unique(samples.face)] = True
    return out & (misses == 0).any(axis=1)


def depth_in_blank(points: Floats, low: Floats, high: Floats) -> Floats:
    """Return how far points (s, 3) are below the blank's surface (s,), 0 outside: the most material that can be left on them."""
    return np.clip(np.minimum(points - low, high - points).min(axis=1), 0.0, None)


class Reach:
    """Finds collision-free poses of catalogue cutters that touch a point of the part: upright ones from above, and leaning ones where the
    machine has rotary axes (contact then needs facets)."""

    def __init__(self, contact: PartContact, tools: Sequence[Tool], allowed: float, machine: Machine | None = None) -> None:
        self._contact, self._allowed, self._machine = contact, allowed, machine
        # Upright and from above, no other form goes where none of these fits. Slender cutters reach what any reach: the order is for speed.
        plain = [t for t in tools if t.form in PLAIN_FORMS]
        self._tools = sorted(reaching_furthest(plain), key=lambda t: (t.radius, -t.reach, t.number))

    def reached(self, samples: Samples, rows: Ints, progress: Progress = QUIET) -> Bools:
        """Say for each of the samples' rows whether some cutter reaches it.

        Of very many rows, evenly chosen ones of every face are tried, and the others share the answer of the nearest on their face.
        """
        machine = self._machine
        if machine is None or not machine.rotary:
            return _shared(self._try, samples, rows, MOST_TRIED, progress)
        found = _shared(self._try, samples, rows, MOST_TRIED, progress.part(0.0, 0.3))
        found[~found] = _shared(partial(self._try_leaning, machine), samples, rows[~found], MOST_LEANING, progress.part(0.3, 1.0))
        return found

    def _try(self, samples: Samples, rows: Ints, progress: Progress) -> Bools:
        found = np.zeros(len(rows), bool)
        for k, tool in enumerate(self._tools):
            for shape in range(_n_poses(tool)):
                open_rows = np.flatnonzero(~found)
                for first in range(0, len(open_rows), POSES):
                    progress.at(k / len(self._tools), "Looking for cutters that reach what is left")
                    some = open_rows[first:first + POSES]
                    tips, possible = _pose(tool, samples.point[rows[some]], samples.normal[rows[some]], shape)
                    if possible.any():
                        clear = self._contact.clear(poses_of(tool, tips[possible]), self._allowed)
                        found[some[possible]] |= clear
            if found.all():
                break
        return found

    def _try_leaning(self, machine: Machine, samples: Samples, rows: Ints, progress: Progress) -> Bools:
        found = np.zeros(len(rows), bool)
        axes = [(axis, can_hold(axis, machine)) for axis in leaning_axes(samples.normal[rows])]
        for k, tool in enumerate(self._tools):
            for axis, holds in axes:
                progress.at(k / len(self._tools), "Looking for leaning cutters that reach what is left")
                some = np.flatnonzero(~found & holds)
                tips, possible = touching_tips(tool, samples.point[rows[some]], samples.normal[rows[some]], axis[some])
                if possible.any():
                    found[some[possible]] = self._contact.clear(poses_of(tool, tips[possible], axis[some[possible]]), self._allowed)
            if found.all():
                break
        return found


def _shared(ask: Callable[[Samples, Ints, Progress], Bools], samples: Samples, rows: Ints, most: int, progress: Progress) -> Bools:
    """Return what is answered for rows, of very many only for evenly chosen ones: the others share the nearest answer on their face."""
    tried = _tried(samples.face[rows], most)
    answer = ask(samples, rows[tried], progress)
    if len(tried) == len(rows):
        return answer
    # Faces are told apart by a fourth coordinate longer than any part.
    place = np.column_stack([samples.point[rows], samples.face[rows] * 4.0 * np.ptp(samples.point)])
    return np.asarray(answer[cKDTree(place[tried]).query(place)[1]])


def reaching_furthest(tools: Sequence[Tool]) -> list[Tool]:
    """Return the tools without those that another one of the same form outreaches: as long flutes, as far to anything thicker, as far to
    the holder."""
    best: dict[tuple[float, float], list[Tool]] = {}
    for tool in tools:
        alike = best.setdefault((tool.radius, tool.corner_radius), [])
        if not any(_outreaches(other, tool) for other in alike):
            alike[:] = [other for other in alike if not _outreaches(tool, other)] + [tool]
    return [tool for alike in best.values() for tool in alike]


def _outreaches(one: Tool, other: Tool) -> bool:
    return one.flute_length >= other.flute_length and one.reach >= other.reach and one.stickout >= other.stickout


def _tried(face: Ints, most: int) -> Ints:
    """Return which rows are tried: all, or evenly chosen ones of every face when there are more than `most`."""
    step = -(-len(face) // most)
    order = np.argsort(face, kind="stable")
    first = np.flatnonzero(np.diff(face[order], prepend=-1))
    within = np.arange(len(face)) - np.repeat(first, np.diff(first, append=len(face)))
    return np.sort(order[within % step == 0]) if step > 1 else np.arange(len(face))


_AROUND = 8


def _n_poses(tool: Tool) -> int:
    return 3 + 2 * _AROUND


def _pose(tool: Tool, point: Floats, normal: Floats, shape: int) -> tuple[Floats, Bools]:
    """Return tips (k, 3) at which a cutter touches points from above, and which make sense.

    Shape 0 touches along the normal with the corner (or the flank, where the face is upright), 1 and 2 with the flank higher up, the others
    stand on a level face with the point anywhere under the cutter's flat end.
    """
    level = normal[:, 2] > np.cos(tolerance.ANGLE)
    plan = np.hypot(normal[:, 0], normal[:, 1])
    out = np.divide(normal[:, :2], plan[:, None], out=np.zeros_like(normal[:, :2]), where=plan[:, None] > 0.0)
    inner, corner = tool.radius - tool.corner_radius, tool.corner_radius
    if shape < 3:
        tips = point + corner * normal
        tips[:, :2] += np.where(level[:, None], 0.0, inner * out)
        tips[:, 2] -= corner
        upright = np.abs(normal[:, 2]) < np.sin(tolerance.ANGLE)
        tips[:, 2] -= shape * 0.5 * (tool.flute_length - corner) * upright
        usable = (normal[:, 2] > -np.sin(tolerance.ANGLE)) & (upright if shape else True)
        return tips, usable & np.ones(len(point), bool)
    ring, k = divmod(shape - 3, _AROUND)
    angle, share = 2 * np.pi * k / _AROUND, (1.0, 0.5)[ring]
    tips = point.copy()
    tips[:, :2] += share * inner * np.array([np.cos(angle), np.sin(angle)])
    return tips, level if inner > 0.0 else np.zeros(len(point), bool)
