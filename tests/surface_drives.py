"""Small surfaces in closed form and the drives over them that tests of surface strategies share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion.geometry.frame import WORLD
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Box
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.toolpath.stock.heightfield import PlanningStock
from verify_tools import bull

DATA = CuttingData(
    speed=200.0,
    spindle=10000.0,
    feed_per_tooth=0.1,
    feed=2000.0,
    plunge_feed=500.0,
    depth=1.0,
    width=1.0,
    removal_rate=1.0,
    power=1.0,
    power_limit=10.0,
    torque=1.0,
)


def grid(height, n=60, low=(0.0, 0.0), high=(30.0, 30.0), tag=1):
    """Return the skin z = height(x, y) over a rectangle: one face of n by n squares, normals upwards as its triangles have them."""
    x, y = np.meshgrid(
        np.linspace(low[0], high[0], n + 1), np.linspace(low[1], high[1], n + 1), indexing="ij"
    )
    a = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    triangles = np.vstack(
        [np.column_stack([a, a + n + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + 1])]
    )
    step = 1e-5
    slope = [
        (height(x + dx, y + dy) - height(x - dx, y - dy)).ravel() / (2 * step)
        for dx, dy in ((step, 0.0), (0.0, step))
    ]
    normals = np.column_stack([-slope[0], -slope[1], np.ones(x.size)])
    return Skin(
        points=np.column_stack([x.ravel(), y.ravel(), height(x, y).ravel()]),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        triangles=triangles,
        face=np.full(len(triangles), tag),
        bound=0.0,
    )


def joined(*skins):
    """Return one skin of several."""
    start = np.cumsum([0, *(len(s.points) for s in skins)])
    return Skin(
        points=np.vstack([s.points for s in skins]),
        normals=np.vstack([s.normals for s in skins]),
        triangles=np.vstack([s.triangles + a for s, a in zip(skins, start[:-1], strict=True)]),
        face=np.concatenate([s.face for s in skins]),
        bound=max(s.bound for s in skins),
    )


def driven(skin, faces=(1,), exact=(), allowance=0.0, height=0.004, top=20.0, earlier=None):
    """Return the drive over faces of a skin in the part's coordinates, its setup, and the stock before: a blank 1 mm larger all round."""
    low, high = skin.box()
    low, high = low - 1.0, np.append(high[:2] + 1.0, max(float(high[2]) + 1.0, top))
    setup = Setup(
        name="S1",
        frame=WORLD,
        work_offset="G54",
        clearance=float(high[2]) + 5.0,
        machine="Trunnion 650",
    )
    drive = SurfaceDrive(
        feature="group-01",
        kind="finish",
        faces=faces,
        exact=exact,
        skin=skin,
        frame=WORLD,
        low=low,
        high=high,
        clearance=setup.clearance,
        allowance=allowance,
        height=height,
        digest="test",
        earlier=earlier,
    )
    return (
        drive,
        setup,
        PlanningStock.of(
            Box(frame=WORLD, low=low, high=high, material="7050-T7451", density=2.83), setup
        ),
    )


def roughed(stock, skin, left=0.5):
    """Return the stock after roughing that came everywhere and left some mm over a skin."""
    rows = np.argwhere(np.ones(stock.heights.shape, dtype=bool))
    centres = stock.corner + (rows + 0.5) * stock.cell
    fine = lower_side(bull(2.0, 1.0)())
    heights = skin.drop.drop(centres, fine, float(skin.points[:, 2].min())) + left
    heights = np.minimum(stock.heights, heights.reshape(stock.heights.shape))
    return replace(stock, field=heights, digest="roughed")
