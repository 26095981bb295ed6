"""A cylinder's ground with a flange at its end and a block on it, under a turned ring, laid flat: what layers and gaps go round."""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Revolved
from trunnion.plan.development.ground import DevelopedGround, GroundBounds, ground_of
from trunnion.progress import NO_PROGRESS

RADIUS, LENGTH, WIDE, HIGH = 100.0, 60.0, 20.0, 8.0
BOSS = 7


def ground(
    ends: tuple[float, float] = (0.0, LENGTH), limited: GroundBounds | None = None
) -> DevelopedGround:
    """Return a cylinder with a flange over its lower end and a square block that stands on it at x, under a turned ring."""
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    rows = [(RADIUS, 0.0), (RADIUS + 12.0, 0.0)]
    flange = np.array(
        [[(r * math.cos(t), r * math.sin(t), z) for t in turn] for r, z in rows]
    ).reshape(-1, 3)
    n = np.arange(360)
    triangles = np.vstack(
        [np.column_stack([n, n + 1, n + 361]), np.column_stack([n + 1, n + 362, n + 361])]
    )
    half, low, high = 0.5 * WIDE, 30.0 - 0.5 * WIDE, 30.0 + 0.5 * WIDE
    top = RADIUS + HIGH
    block = np.array(
        [[r, y, z] for r in (RADIUS - 5.0, top) for y in (-half, half) for z in (low, high)]
    )
    sides = [[0, 1, 5], [0, 5, 4], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 3, 7], [1, 7, 5]]
    faces = np.array([*sides, [4, 5, 7], [4, 7, 6]]) + len(flange)
    mesh = Mesh(
        points=np.vstack([flange, block]),
        triangles=np.vstack([triangles, faces]).astype(np.int64),
        face=np.concatenate([np.full(len(triangles), 1), np.full(len(faces), BOSS)]),
    )
    blank = Revolved(
        frame=WORLD,
        outline=np.array(
            [
                [90.0, 0.0],
                [100.0, 0.0],
                [100.0, 18.0],
                [109.0, 18.0],
                [109.0, 42.0],
                [100.0, 42.0],
                [100.0, 60.0],
                [90.0, 60.0],
            ]
        ),
        material="EN AW-7075",
        density=2.8,
    )
    development = Development(frame=WORLD, radius=RADIUS, height=0.0, slope=0.0, middle=0.0)
    return ground_of(development, ends, mesh, [((BOSS,), True)], (1,), blank, NO_PROGRESS, limited)
