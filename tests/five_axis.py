"""A made-up five-axis finishing job of any size: a wavy block, and a ball or bull cutter with shank and holder that turns all along.

The surface is z = A sin(k x) cos(k y) over a square, so that every contact point, normal and curvature is known in closed form. Contexts of
contact and stock, and tests that need moves with a turning axis, take their work from here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Holder, Tool

SIDE, BASE, BLANK_TOP = 200.0, -30.0, 8.0
"""mm: side of the block, height of its bottom, and how high the blank it is cut from stands."""
AMPLITUDE, WAVE = 6.0, 2.0 * math.pi / 80.0
"""The surface's amplitude, mm, and wave number, 1/mm: it is nowhere more curved than a ball of 27 mm."""
PATCHES = 4
"""The top is cut into this many faces along each side."""
HOLDER = Holder(name="slim holder", rows=((0.0, 14.0, 40.0, 20.0), (40.0, 25.0, 80.0, 25.0)))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FiveAxisCase:
    """A closed mesh (points (v, 3), triangles (t, 3), face (t,) rows into tag (f,)), the section that finishes its top, and the blank's
    corners."""

    points: Floats
    triangles: Ints
    face: Ints
    tag: Ints
    section: ProgramSection
    blank_low: tuple[float, float, float] = (0.0, 0.0, BASE)
    blank_high: tuple[float, float, float] = (SIDE, SIDE, BLANK_TOP)


def five_axis_case(
    n_blocks: int, n_triangles: int, cutter: str = "ball", deeper: float = 0.0
) -> FiveAxisCase:
    """Return the job with about so many blocks and triangles; `deeper` pushes the cutter into the surface along its normal, mm."""
    tool = finisher(cutter)
    points, triangles, face = wavy_block(n_triangles)
    path = finishing(tool, n_blocks, deeper)
    return FiveAxisCase(
        points=points,
        triangles=triangles,
        face=face,
        tag=np.arange(1, PATCHES**2 + 6),
        section=ProgramSection(operation="five-axis", tool=tool, spindle=12000.0, path=path),
    )


def finisher(cutter: str) -> Tool:
    """Return a ball cutter of 12 mm or a bull cutter of 16 mm with corners of 3 mm, in a holder 60 mm above its tip."""
    diameter, corner = {"ball": (12.0, 6.0), "bull": (16.0, 3.0)}[cutter]
    return Tool(
        number=1,
        name=f"{cutter} {diameter:g}",
        form=cutter,
        diameter=diameter,
        corner_radius=corner,
        flute_length=20.0,
        neck_diameter=diameter - 1.0,
        neck_length=35.0,
        shank_diameter=diameter,
        stickout=60.0,
        gauge_length=140.0,
        teeth=2,
        centre_cutting=True,
        helix_angle=30.0,
        holder=HOLDER,
    )


def surface(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return points and upward unit normals (…, 3) of the wavy top at places (…) in plan."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
    sx, cx, sy, cy = np.sin(WAVE * x), np.cos(WAVE * x), np.sin(WAVE * y), np.cos(WAVE * y)
    normal = np.stack(
        [-AMPLITUDE * WAVE * cx * cy, AMPLITUDE * WAVE * sx * sy, np.ones_like(x)], axis=-1
    )
    return np.stack([x, y, AMPLITUDE * sx * cy], axis=-1), normal / np.linalg.norm(
        normal, axis=-1, keepdims=True
    )


def wavy_block(n_triangles: int) -> tuple[Floats, Ints, Ints]:
    """Return points (v, 3), triangles (t, 3) and faces (t,) of the closed block: the top's patches first, then sides and bottom."""
    n = max(PATCHES, round(math.sqrt(n_triangles / 2.0)))
    across = np.linspace(0.0, SIDE, n + 1)
    top = surface(across[:, None], across)[0].reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a = i * (n + 1) + j
    b, c, d = a + n + 1, a + n + 2, a + 1
    patch = (i * PATCHES // n) * PATCHES + j * PATCHES // n
    triangles, face = [np.column_stack([a, b, c]), np.column_stack([a, c, d])], [patch, patch]
    edge = np.arange(n)
    loop = np.concatenate([edge * (n + 1), n * (n + 1) + edge, (n - edge) * (n + 1) + n, n - edge])
    lower = len(top) + np.arange(len(loop))
    after = np.roll(np.arange(len(loop)), -1)
    middle = len(top) + len(loop)
    side = PATCHES**2 + np.repeat(np.arange(4), n)
    triangles += [
        np.column_stack([loop, lower, lower[after]]),
        np.column_stack([loop, lower[after], loop[after]]),
        np.column_stack([np.full(len(loop), middle), lower[after], lower]),
    ]
    face += [side, side, np.full(len(loop), PATCHES**2 + 4)]
    points = np.vstack(
        [
            top,
            np.column_stack([top[loop, :2], np.full(len(loop), BASE)]),
            [[SIDE / 2, SIDE / 2, BASE]],
        ]
    )
    return points, np.vstack(triangles), np.concatenate(face)


def finishing(tool: Tool, n_blocks: int, deeper: float = 0.0) -> Toolpath:
    """Return rows to and fro over the top, the cutter touching it while its axis leans to +x and to the side by angles that change."""
    step = SIDE / math.sqrt(n_blocks)
    per_row = max(2, round(SIDE / (1.25 * step)))
    rows = max(1, round(n_blocks / per_row))
    y = np.repeat((np.arange(rows) + 0.5) / rows * SIDE, per_row)
    share = np.tile(np.linspace(0.0, 1.0, per_row), rows)
    forward = np.repeat(np.arange(rows) % 2 == 0, per_row)
    x = np.where(forward, share, 1.0 - share) * SIDE
    touch, normal = surface(x, y)
    ahead = np.cross(np.array([0.0, 1.0, 0.0]), normal)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    lead, tilt = (
        np.radians(20.0 + 5.0 * np.sin(0.05 * x)),
        np.radians(6.0 * np.sin(0.04 * y + 0.07 * x)),
    )
    axis = _leaning(normal, ahead, lead, tilt)
    out = normal - (normal * axis).sum(axis=1, keepdims=True) * axis
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    corner = tool.corner_radius
    tips = touch + (corner - deeper) * normal + (tool.radius - corner) * out - corner * axis
    first, last = tips[0] + 60.0 * axis[0], tips[-1] + 60.0 * axis[-1]
    n = len(tips) + 2
    motion = np.full(n, int(Motion.LINE))
    motion[[0, -1]] = int(Motion.RAPID)
    return Toolpath(
        position=np.vstack([first, tips, last]),
        axis=np.vstack([axis[:1], axis, axis[-1:]]),
        motion=motion,
        centre=np.full((n, 3), np.nan),
        feed=np.where(motion == int(Motion.RAPID), 0.0, 3000.0),
        mark=np.zeros(n, int),
    )


def _leaning(normal: Floats, ahead: Floats, lead: Floats, tilt: Floats) -> Floats:
    beside = np.cross(normal, ahead)
    axis = normal + np.tan(lead)[:, None] * ahead + np.tan(tilt)[:, None] * beside
    return axis / np.linalg.norm(axis, axis=1, keepdims=True)
