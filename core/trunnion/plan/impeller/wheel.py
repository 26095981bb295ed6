"""A bladed wheel as its features say: hub, shroud, blades in their order around the axis, and the period that repeats."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.channel.blade_channel import BladeChannel, Camber, camber_of, channels_of
from trunnion.plan.channel.meridian import MeridianSpline, WheelMeridian, cylindrical
from trunnion.progress import NO_PROGRESS, Progress

BLADE, SPLITTER, HUB, HOLE = "blade", "splitter", "hub", "hole"
WALLS, EDGES, TIP, ROOT = (
    ("pressure", "suction"),
    ("leading_edge",),
    ("shroud",),
    ("root_fillet",),
)
"""Roles of a blade's faces."""
SHORTEST = 1.0
"""mm along the hub that a channel has at least."""
EVEN = 1e-3
"""rad by which blades may be off their places for a period to repeat: 0.1 mm at a radius of 100."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Wheel:
    """A wheel in the rotor's frame. `blades` are the features in their order around the axis, a main blade first, splitters among them;
    `angles` (k,) rad where each stands; `period` of them repeat, `copies` (rad) are the turns that bring the first period to all."""

    meridian: WheelMeridian
    blades: tuple[Feature, ...]
    angles: Floats
    period: int
    copies: tuple[float, ...]

    def faces(self, roles: Sequence[str], kind: str, *, first: bool = False) -> tuple[int, ...]:
        """Return the faces of the blades of a kind that play one of some roles; with `first` those of the first period alone."""
        some = self.blades[: self.period] if first else self.blades
        return tuple(t for f in some if f.kind == kind for t in f.with_role(*roles))

    def channels(self, skin: Skin, progress: Progress = NO_PROGRESS) -> tuple[BladeChannel, ...]:
        """Return the channels of the first period, from a skin in the rotor's frame; raise `Refused` for walls that tell of none."""
        cambers: list[Camber] = []
        for f in self.blades[: self.period]:
            progress.check()
            feet = f.with_role(*ROOT) or f.tags
            camber = camber_of(skin, f.with_role(*WALLS), feet, self.meridian)
            if not np.isfinite(camber.angle.values).all():
                raise Refused(f"{f.id}: its walls are too small to tell the channel beside them")
            cambers.append(camber)
        step = 2.0 * math.pi / len(self.copies)
        closing = [*cambers, cambers[0].turned(step)]
        pairs = pairwise(closing)
        return tuple(g for pair in pairs for g in channels_of(pair, self.meridian)[:1])


def wheel_of(recognition: Recognition, skin: Skin) -> Wheel:
    """Return the wheel that features tell of, from a skin in the rotor's frame (`Recognition.frame`).

    Raises `Refused` where there are no blades, no hub, or no tips between which channels lie.
    """
    blades = recognition.of_kind(BLADE, SPLITTER)
    hub = tuple(t for f in recognition.of_kind(HUB) for t in f.tags)
    main = recognition.of_kind(BLADE)
    tips = tuple(t for f in main for t in f.with_role(*TIP))
    if len(main) < 2 or not hub or not tips:
        raise Refused(
            "no channels to plan: a wheel needs two blades, tip faces and a hub among its features"
        )
    angles = np.array([_angle(skin, f) for f in blades])
    order = np.argsort(angles)
    first = next(k for k, row in enumerate(order.tolist()) if blades[row].kind == BLADE)
    order = np.roll(order, -first)
    angles = np.mod(angles[order] - angles[order[0]], 2.0 * math.pi)
    ordered = tuple(blades[k] for k in order.tolist())
    period, count = _period(ordered, angles, len(main))
    meridian = _meridian(skin, hub, tips, ordered[0])
    if meridian.hub.run < SHORTEST:
        raise Refused("no channels to plan: the hub ends where the leading edges stand on it")
    return Wheel(
        meridian=meridian,
        blades=ordered,
        angles=angles,
        period=period,
        copies=tuple(2.0 * math.pi * k / count for k in range(count)),
    )


def _angle(skin: Skin, blade: Feature) -> float:
    """Return where a blade stands, rad: by its whole area, which is alike for equal blades."""
    rows = skin.of(blade.tags)
    corners = skin.points[skin.triangles[rows]].mean(axis=1)
    weight = skin.areas(rows)
    radius = np.hypot(corners[:, 0], corners[:, 1])
    x, y = ((weight * corners[:, k] / radius).sum() for k in (0, 1))
    return math.atan2(float(y), float(x))


def _period(blades: Sequence[Feature], angles: Floats, main: int) -> tuple[int, int]:
    """Return how many blades repeat, and how often: the smallest number that brings kinds and places round to themselves."""
    total = len(blades)
    for count in range(main, 0, -1):
        if main % count or total % count:
            continue
        period = total // count
        step = 2.0 * math.pi / count
        off = np.mod(np.roll(angles, -period) - angles - step + math.pi, 2.0 * math.pi) - math.pi
        kinds = [f.kind for f in blades]
        if np.abs(off).max() < EVEN and kinds[period:] + kinds[:period] == kinds:
            return period, count
    return total, 1


def _meridian(
    skin: Skin, hub: tuple[int, ...], tips: tuple[int, ...], blade: Feature
) -> WheelMeridian:
    def places(tags: tuple[int, ...]) -> Floats:
        return cylindrical(skin.points[np.unique(skin.triangles[skin.of(tags)])])[0]

    curve, shroud = MeridianSpline.through(places(hub)), MeridianSpline.through(places(tips))
    edge = blade.with_role(*EDGES) or blade.with_role(*WALLS)
    line = places(edge)
    # The leading edge's line goes on to the hub through the root fillet: straight from its middle over its innermost place.
    top = shroud.rows[0]
    foot = line[np.argmin(np.linalg.norm(curve.places(curve.nearest(line)) - line, axis=1))]
    reach = foot + (foot - top) / np.linalg.norm(foot - top) * np.linalg.norm(
        curve.places(curve.nearest(foot[None]))[0] - foot
    )
    start = float(curve.nearest(reach[None])[0])
    return WheelMeridian(hub=replace(curve, start=start), shroud=shroud)
