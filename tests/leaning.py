"""Programs of leaning and turning tools on the block of `verify_tools`, and how far a cutter stands out over a plane."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from trunnion.model.material import Axis
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.part.shape.facets import Facets
from trunnion.part.shape.surfaces import GUIDE, L_KIND, PROFILE, R_KIND, U0, U1
from trunnion.verify.contact import guide_points
from verify_tools import (
    FLOOR,
    FORMS,
    MACHINE,
    POCKET_HIGH,
    block_with_pocket,
    plain_depth,
    supports_of,
    tool_of,
)

RIGHT = POCKET_HIGH[0]
UP = (0.0, 0.0, 1.0)
CHORDS = 64
"""Chords over what bends: the pocket's corners of 4 mm are 0.3 um off."""
FIVE_AXES = replace(
    MACHINE,
    name="test five-axis mill",
    title="test five-axis mill",
    axes=(
        *(replace(a, high=900.0) for a in MACHINE.axes),
        Axis(
            name="C",
            kind="rotary",
            low=-720.0,
            high=720.0,
            rapid=14400.0,
            acceleration=1000.0,
            direction=(0.0, 0.0, 1.0),
            carries="tool",
        ),
        Axis(
            name="A",
            kind="rotary",
            low=-110.0,
            high=110.0,
            rapid=14400.0,
            acceleration=1000.0,
            direction=(1.0, 0.0, 0.0),
            carries="tool",
        ),
    ),
)


def block_facets():
    """Return the block's faces as triangles: many where something bends, few where nothing does."""
    surfaces = block_with_pocket()
    points, triangles, face, count = [], [], [], 0
    for strip, row in zip(
        np.vstack([surfaces.strip, surfaces.level]),
        [*surfaces.strip_face, *surfaces.level_face],
        strict=True,
    ):
        across = CHORDS if strip[PROFILE] or strip[L_KIND] or strip[R_KIND] else 1
        along = CHORDS if strip[GUIDE] else 1
        grid = [
            guide_points(strip, u, np.linspace(0.0, 1.0, along + 1))
            for u in np.linspace(strip[U0], strip[U1], across + 1)
        ]
        first = (np.arange(across)[:, None] * (along + 1) + np.arange(along)).ravel() + count
        up = first + along + 1
        triangles += [
            np.column_stack([first, first + 1, up + 1]),
            np.column_stack([first, up + 1, up]),
        ]
        points += grid
        face.append(np.full(2 * across * along, row))
        count += (along + 1) * (across + 1)
    return Facets.of_mesh(
        np.vstack(points), np.vstack(triangles), np.concatenate(face), surfaces.tag
    )


def lean(degrees, around=180.0):
    """Return the axis that leans from z towards a direction in plan, by default away from the right wall."""
    a, b = math.radians(degrees), math.radians(around)
    return math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)


def long_reaching(tool):
    """Return a tool with its holder far up, clear of the block however it leans."""
    return replace(
        tool,
        neck_diameter=min(tool.neck_diameter, tool.diameter),
        shank_diameter=min(tool.shank_diameter, tool.neck_diameter),
        neck_length=tool.flute_length + 40.0,
        stickout=tool.flute_length + 60.0,
        gauge_length=tool.flute_length + 120.0,
    )


SMALL = {
    "flat": tool_of("flat", diameter=6.0, flute_length=12.0),
    "bull": tool_of("bull", diameter=6.0, corner_radius=1.0, flute_length=12.0),
    "ball": tool_of("ball", diameter=6.0, corner_radius=3.0, flute_length=12.0),
    "taper": tool_of("taper", diameter=3.0, corner_radius=1.5, taper_angle=8.0, flute_length=12.0),
    "barrel": tool_of(
        "barrel",
        diameter=6.0,
        corner_radius=1.0,
        barrel_radius=10.0,
        flute_length=10.0,
        neck_diameter=5.0,
    ),
    "t-slot": tool_of(
        "t-slot",
        diameter=8.0,
        corner_radius=0.5,
        flute_length=3.0,
        neck_diameter=4.0,
        shank_diameter=4.0,
    ),
    "drill": tool_of("drill", diameter=6.0, point_angle=118.0, flute_length=20.0),
    "form": FORMS["form"],
}
"""A slender tool of every form."""
SMALL = {name: long_reaching(tool) for name, tool in SMALL.items()}


def outline_points(tool, steps=801):
    """Return the points (k, 2), radius and height, that a cutting part can touch a plane with."""
    ((rows, *_), *_) = supports_of(tool)
    parts = []
    for r, z, radius, first, last in rows:
        angle = np.linspace(first, last, steps if radius else 1)
        parts.append(np.column_stack([r + radius * np.cos(angle), z + radius * np.sin(angle)]))
    return np.vstack(parts)


def standing_out(tool, axis, normal):
    """Return how far a cutter at each axis (k, 3) stands out from its tip against a plane's normal."""
    points = outline_points(tool)
    down = -np.asarray(axis) @ np.asarray(normal)
    across = np.sqrt(np.maximum(1.0 - down**2, 0.0))
    return (across[:, None] * points[:, 0] + down[:, None] * points[:, 1]).max(axis=1)


def depth_in_plane(tool, axis, normal, out):
    """Return the deepest point of a plane in a cutter that stands out `out` beyond it: brute force on ever finer points of the plane."""
    axis, normal = np.asarray(axis), np.asarray(normal)
    side = np.cross(normal, axis)
    side = (
        side / np.linalg.norm(side)
        if np.linalg.norm(side) > 1e-9
        else np.cross(normal, [0.3, 0.5, 0.8])
    )
    side /= np.linalg.norm(side)
    forth = np.cross(side, normal)
    base = normal * (out - standing_out(tool, axis[None], normal)[0])
    (part, *_) = supports_of(tool)
    low, high, best = np.array([-9.0, -9.0]), np.array([9.0, 9.0]), -np.inf
    for _ in range(7):
        u, v = (np.linspace(low[k], high[k], 161) for k in (0, 1))
        at = base + u[:, None, None] * side + v[None, :, None] * forth
        height = at @ axis
        rho = np.linalg.norm(at - height[..., None] * axis, axis=2)
        depth = plain_depth(part, rho, height)
        i, j = np.unravel_index(np.argmax(depth), depth.shape)
        best = max(best, float(depth[i, j]))
        step = (high - low) / 16
        low, high = np.array([u[i], v[j]]) - step, np.array([u[i], v[j]]) + step
    return best


def poses_between(start, end, shares):
    """Return tips and axes (k, 3) along a move: the tip straight, the axis at an even rate on the great circle."""
    (p, a), (q, b) = ((np.array(tip, dtype=float), np.array(axis)) for tip, axis in (start, end))
    angle = math.acos(min(max(float(a @ b), -1.0), 1.0))
    shares = np.asarray(shares)[:, None]
    tips = p + shares * (q - p)
    if angle < 1e-9:
        return tips, np.tile(a, (len(shares), 1))
    return tips, (np.sin((1.0 - shares) * angle) * a + np.sin(shares * angle) * b) / math.sin(angle)


def section_through(tool, operation, poses):
    """Return a section that comes from above the pocket with the first pose's axis, goes through the poses (tip, axis), and up again."""
    first, last = poses[0][1], poses[-1][1]
    stops = [
        ((2.0, 0.0, 90.0), first),
        ((2.0, 0.0, FLOOR + 4.5), first),
        *poses,
        ((2.0, 0.0, FLOOR + 4.5), last),
        ((2.0, 0.0, 90.0), last),
    ]
    n = len(stops)
    path = Toolpath(
        position=[tip for tip, _ in stops],
        axis=[axis for _, axis in stops],
        motion=[Motion.RAPID] + [Motion.LINE] * (n - 1),
        centre=np.full((n, 3), np.nan),
        feed=[0.0] + [1000.0] * (n - 1),
        mark=[0] * n,
    )
    return ProgramSection(operation=operation, tool=tool, spindle=10000.0, path=path)
