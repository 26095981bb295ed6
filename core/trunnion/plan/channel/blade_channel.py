"""Channels between neighbouring blades: coordinates u along the stream, v from one camber surface to the next, w from hub to shroud."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.interpolate import LinearNDInterpolator, RegularGridInterpolator

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.plan.channel.meridian import WheelMeridian, cylindrical, in_space

U_NODES, W_NODES = 61, 9
"""Nodes of the net that carries a camber surface: bilinear between them it is a few hundredths of a mm off, and no path lies on it."""
U_BEYOND = 0.25
"""How far the net goes on before the leading edge and behind the outlet."""
TAIL_U, TAIL_W = 6, 3
"""Nodes at an end of a row along u, or across along w, that say how it goes on beyond."""
PLACES = 3000
"""Places of a side that its net is laid through: more of them say no more."""
ON_HUB = 0.003
"""mm off the hub's curve up to which a place of a blade's foot lies on it: a fillet of 1.5 mm is a tenth of a mm wide there."""
NO_TOE: Floats = np.zeros((0, 2))
LEVEL = math.cos(math.radians(85.0))
"""Least part of a normal round the axis by which a place of a blade belongs to one of its sides."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Camber:
    """The middle surface of a blade: its angle about the rotor's axis by u and w, rad, without a leap; straight on beyond its ends.

    `sides`: the angles of its walls, at smaller angles first. `toes`: rows (k, 2) of u and angle, along which each side's foot, or its root
    fillet, meets the hub.
    """

    angle: RegularGridInterpolator
    sides: tuple[RegularGridInterpolator, RegularGridInterpolator]
    toes: tuple[Floats, Floats]
    begins: Floats = field(default_factory=lambda: np.zeros((0, 2)))

    def begin(self, w: Floats) -> Floats:
        """Return the u (k,) at which the walls begin at coordinates w (k,): behind 0 on splitters."""
        rows = self.begins
        return np.interp(w, rows[:, 0], rows[:, 1]) if len(rows) else np.zeros_like(w)

    def at(self, u: Floats, w: Floats) -> Floats:
        """Return the angle (k,) rad at coordinates u and w (k,)."""
        return _read(self.angle, u, w)

    def side(self, number: int, u: Floats, w: Floats) -> Floats:
        """Return the angle (k,) rad of a wall, 0 or 1, at coordinates u and w (k,)."""
        return _read(self.sides[number], u, w)

    def toe(self, number: int, u: Floats) -> Floats:
        """Return the angle (k,) rad where a side's foot meets the hub at coordinates u (k,); before its first place it is the camber's."""
        rows = self.toes[number]
        camber = self.at(u, np.zeros_like(u))
        if not len(rows):
            return camber
        found = np.interp(u, rows[:, 0], rows[:, 1] - self.at(rows[:, 0], np.zeros(len(rows))))
        return np.where(u < rows[0, 0], camber, camber + found)

    @property
    def mean(self) -> float:
        """The angle in the middle, rad."""
        return float(self.at(np.array([0.7]), np.array([0.5]))[0])

    def turned(self, angle: float) -> Camber:
        """Return the camber of the blade turned about the axis by an angle, rad."""
        some = [
            RegularGridInterpolator(net.grid, net.values + angle)
            for net in (self.angle, *self.sides)
        ]
        toes = [rows + np.array([0.0, angle]) for rows in self.toes]
        return Camber(
            angle=some[0], sides=(some[1], some[2]), toes=(toes[0], toes[1]), begins=self.begins
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BladeChannel:
    """The space between two neighbouring blades, `lower` at the smaller angle, in the rotor's frame; splitters count as blades."""

    meridian: WheelMeridian
    lower: Camber
    upper: Camber

    def angle(self, u: Floats, v: Floats, w: Floats) -> Floats:
        """Return the angle (k,) rad about the axis at coordinates (k,)."""
        low, high = self.lower.at(u, w), self.upper.at(u, w)
        return low + v * (high - low)

    def at(self, u: Floats, v: Floats, w: Floats) -> Floats:
        """Return points (k, 3) at coordinates (k,)."""
        return in_space(self.meridian.at(u, w), self.angle(u, v, w))

    def hub(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return points (k, 3) on the hub and its outward unit normals (k, 3) there."""
        zero = np.zeros_like(u)
        angle = self.angle(u, v, zero)
        rz, along = self.meridian.hub.at(u)
        # The shroud lies to the left of the stream: radius outwards, height upwards, seen with the radius to the right.
        across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
        normal = np.stack(
            [across[..., 0] * np.cos(angle), across[..., 0] * np.sin(angle), across[..., 1]],
            axis=-1,
        )
        return in_space(rz, angle), normal

    def rulings(self, u: Floats, v: Floats) -> Floats:
        """Return unit directions (k, 3) from the hub to the shroud along lines of equal u and v: between the walls' own rulings."""
        line = self.at(u, v, np.ones_like(u)) - self.at(u, v, np.zeros_like(u))
        return np.asarray(line / np.linalg.norm(line, axis=-1, keepdims=True))


def _read(net: RegularGridInterpolator, u: Floats, w: Floats) -> Floats:
    u = np.clip(u, -U_BEYOND, 1.0 + U_BEYOND)
    return np.asarray(net(np.stack([u, np.clip(w, 0.0, 1.0)], axis=-1)))


def camber_of(
    skin: Skin, tags: Sequence[int], feet: Sequence[int], meridian: WheelMeridian
) -> Camber:
    """Return the camber of a blade by the faces that are its walls, from a skin in the rotor's frame: the mean of its two sides. `feet` are
    the faces of it that meet the hub."""
    rows = np.unique(skin.triangles[skin.of(tuple(tags))])
    rz, angle = cylindrical(skin.points[rows])
    middle = math.atan2(float(np.sin(angle).mean()), float(np.cos(angle).mean()))
    angle = middle + np.mod(angle - middle + math.pi, 2.0 * math.pi) - math.pi
    around = np.column_stack([-np.sin(angle), np.cos(angle)])
    lean = (skin.normals[rows][:, :2] * around).sum(axis=1)
    uw = meridian.coordinates(rz)
    u = np.linspace(-U_BEYOND, 1.0 + U_BEYOND, U_NODES)
    w = np.linspace(0.0, 1.0, W_NODES)
    # The wall at smaller angles looks towards them.
    seen = [_seen(uw[s], angle[s], u, w) for s in (lean < -LEVEL, lean > LEVEL)]
    sides = [_net(places, u, w) for places in seen]
    nets = [RegularGridInterpolator((u, w), v) for v in (0.5 * (sides[0] + sides[1]), *sides)]
    bare = Camber(
        angle=nets[0],
        sides=(nets[1], nets[2]),
        toes=(NO_TOE, NO_TOE),
        begins=begins_of(seen, u, w),
    )
    return replace(bare, toes=_toes(skin, feet, meridian, bare))


def _toes(
    skin: Skin, feet: Sequence[int], meridian: WheelMeridian, camber: Camber
) -> tuple[Floats, Floats]:
    """Return where the faces that meet the hub do so: rows (k, 2) of u and angle, in the order of u, on either side of the camber."""
    rows = np.unique(skin.triangles[skin.of(tuple(feet))])
    rz, angle = cylindrical(skin.points[rows])
    along = meridian.hub.nearest(rz)
    on = np.linalg.norm(meridian.hub.places(along) - rz, axis=1) < ON_HUB
    u = (along[on] - meridian.hub.start) / meridian.hub.run
    middle = camber.at(u, np.zeros_like(u))
    off = np.mod(angle[on] - middle + math.pi, 2.0 * math.pi) - math.pi
    found = []
    for sign in (-1.0, 1.0):
        some = np.flatnonzero(sign * off > 0.0)
        some = some[np.argsort(u[some], kind="stable")]
        found.append(np.column_stack([u[some], (middle + off)[some]]))
    return found[0], found[1]


def _seen(uw: Floats, angle: Floats, u: Floats, w: Floats) -> Floats:
    """Return the angle at the nodes (nu, nw) of a net from scattered places (k, 2); no number where there is no wall."""
    rows = np.arange(0, len(uw), max(1, len(uw) // PLACES))
    nodes = np.stack(np.meshgrid(u, w, indexing="ij"), axis=-1).reshape(-1, 2)
    seen = LinearNDInterpolator(uw[rows], angle[rows])(nodes)
    return np.asarray(seen).reshape(len(u), len(w))


def _net(seen: Floats, u: Floats, w: Floats) -> Floats:
    """Return the angle at all nodes (nu, nw) of a net: straight on across the stream where walls end in fillets, then along it where there
    is no blade."""
    across = np.stack([_carried_on(w, row, TAIL_W) for row in seen])
    return np.column_stack([_carried_on(u, row, TAIL_U) for row in across.T])


def begins_of(seen: Sequence[Floats], u: Floats, w: Floats) -> Floats:
    """Return rows (k, 2) of w and the node before the first u at which a wall is seen there, by the nets of both sides."""
    known: Bools = np.asarray(np.isfinite(np.stack(seen)).any(axis=0))
    some: Bools = np.asarray(known.any(axis=0))
    first = np.maximum(known[:, some].argmax(axis=0) - 1, 0)
    return np.column_stack([w[some], u[first]])


def _carried_on(at: Floats, row: Floats, tail: int) -> Floats:
    """Return a row (k,) of a net without channels: straight between what is known, and on beyond by the line through the last of it."""
    known: Bools = np.isfinite(row)
    if known.sum() < tail:
        return np.full(len(row), np.nan)
    known_at, value = at[known], row[known]
    out = np.interp(at, known_at, value)
    for beyond, some, end in (
        (at < known_at[0], slice(0, tail), 0),
        (at > known_at[-1], slice(-tail, None), -1),
    ):
        slope = np.polyfit(known_at[some], value[some], 1)[0]
        out[beyond] = value[end] + slope * (at[beyond] - known_at[end])
    return out


def channels_of(cambers: Sequence[Camber], meridian: WheelMeridian) -> tuple[BladeChannel, ...]:
    """Return the channels between blades, each from one to the next around the axis, in the order of the cambers, which go once around."""
    found = []
    for lower, upper in zip(cambers, [*cambers[1:], cambers[0]], strict=True):
        turns = math.ceil((lower.mean - upper.mean) / (2.0 * math.pi) - 1e-9)
        found.append(
            BladeChannel(
                meridian=meridian, lower=lower, upper=upper.turned(2.0 * math.pi * max(turns, 0))
            )
        )
    return tuple(found)
