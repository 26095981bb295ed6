"""A brute-force milling of small parts for the tests of strategies: slow, plain, and sharing nothing with what it checks.

The stock is a field of columns; a cutter goes along each block in short steps. What it tells: how deep the finished shape was entered,
what stays, and which rapids went through material.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Blank, Box
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Holder, Tool
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive, WallGuide

SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=50.0, machine="Mill")
STEP = 0.2


def mill(
    diameter: float, corner_radius: float = 0.0, flute_length: float = 30.0, stickout: float = 70.0
) -> Tool:
    """Return an end mill in a slim holder."""
    return Tool(
        number=1,
        name=f"D{diameter:g} R{corner_radius:g}",
        form="bull" if corner_radius else "flat",
        diameter=diameter,
        corner_radius=corner_radius,
        flute_length=flute_length,
        neck_diameter=diameter - 0.5,
        neck_length=flute_length + 10.0,
        shank_diameter=diameter,
        stickout=stickout,
        gauge_length=stickout + 60.0,
        teeth=3,
        centre_cutting=True,
        helix_angle=40.0,
        holder=Holder(name="slim", rows=((0.0, 15.0, 40.0, 20.0),)),
    )


def cutting(depth: float, width: float, feed: float = 2400.0) -> CuttingData:
    """Return cutting data with a depth and a width of cut."""
    return CuttingData(
        speed=400.0,
        spindle=8000.0,
        feed_per_tooth=0.1,
        feed=feed,
        plunge_feed=0.4 * feed,
        depth=depth,
        width=width,
        removal_rate=0.0,
        power=1.0,
        power_limit=10.0,
        torque=1.0,
    )


def box_blank(low: tuple[float, float, float], high: tuple[float, float, float]) -> Blank:
    """Return a blank in the setup's own frame."""
    return Box(
        frame=WORLD, low=np.array(low), high=np.array(high), material="aluminium", density=2.7
    )


def rounded(x0: float, y0: float, x1: float, y1: float, radius: float) -> Region:
    """Return a rectangle with rounded corners."""
    return Region.rectangle(x0 + radius, y0 + radius, x1 - radius, y1 - radius).offset(radius)


def closed_pocket(plan: Region, depth: float, fillet: float = 0.0, **changed: object) -> PlaneDrive:
    """Return the drive of a pocket with vertical walls all round, its top at 0."""
    level = DriveLevel(top=0.0, bottom=-depth, wanted=plan, boundary=plan)
    walls = tuple(
        WallGuide(curve=c, top=0.0, bottom=-depth, fillet=fillet, faces=(2,)) for c in plan.curves()
    )
    floors = (Floor(z=-depth, region=plan, fillet=fillet, face=1),)
    words: dict[str, object] = {
        "feature": "pocket-01",
        "kind": "rough",
        "levels": (level,),
        "floors": floors,
        "walls": walls,
        "fillet": fillet,
        "stock_top": 0.0,
    }
    return PlaneDrive(**{**words, **changed})  # type: ignore[arg-type]


@dataclass
class Milled:
    """Columns of material over a rectangle: `x`, `y`, `height` (nx, ny); `crashes` are rapids through material (block, depth)."""

    low: tuple[float, float]
    high: tuple[float, float]
    top: float
    cell: float = 0.5
    crashes: list[tuple[int, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        x = np.arange(self.low[0], self.high[0] + 0.5 * self.cell, self.cell)
        y = np.arange(self.low[1], self.high[1] + 0.5 * self.cell, self.cell)
        self.x, self.y = np.meshgrid(x, y, indexing="ij")
        self.height = np.full(self.x.shape, self.top)

    @property
    def points(self) -> np.ndarray:
        """The columns' places (k, 2)."""
        return np.stack([self.x.ravel(), self.y.ravel()], axis=1)

    def cut(self, path: Toolpath, tool: Tool) -> Milled:
        """Follow a path; feed moves take material off, rapids must not meet any."""
        starts, sweeps = path.starts(), path.sweeps()
        for n in range(1, len(path)):
            for a, b in self._pieces(path, n, starts[n], float(sweeps[n])):
                self._sweep(a, b, tool, n if path.motion[n] == Motion.RAPID else None)
        return self

    def depth_below(self, target: np.ndarray, away_from: Region, margin: float = 0.01) -> float:
        """Return how deep the columns were cut below a target (nx, ny), those nearer than `margin` to a region's rim left out."""
        return float(np.where(self._off(away_from, margin), target - self.height, 0.0).max())

    def area_above(
        self, target: np.ndarray, away_from: Region, tolerance: float = 0.02, margin: float = 0.01
    ) -> float:
        """Return the area in mm2 where more than `tolerance` stays above a target (nx, ny)."""
        return (
            float((self._off(away_from, margin) & (self.height - target > tolerance)).sum())
            * self.cell**2
        )

    def pocket_target(self, plan: Region, depth: float, fillet: float = 0.0) -> np.ndarray:
        """Return the finished heights of a pocket with a fillet all round its floor, 0 outside."""
        inside = plan.signed_distance(self.points).reshape(self.x.shape)
        rise = fillet - np.sqrt(np.maximum(fillet**2 - np.maximum(fillet - inside, 0.0) ** 2, 0.0))
        return np.where(inside > 0.0, -depth + rise, 0.0)

    def _off(self, region: Region, margin: float) -> np.ndarray:
        return np.abs(region.signed_distance(self.points)).reshape(self.x.shape) > margin

    def _pieces(
        self, path: Toolpath, n: int, start: np.ndarray, sweep: float
    ) -> list[tuple[np.ndarray, np.ndarray]]:
        end = path.position[n]
        if sweep == 0.0:
            if abs(start[2] - end[2]) < 1e-9:
                return [(start, end)]
            places = start + np.linspace(
                0.0, 1.0, max(2, int(np.linalg.norm(end - start) / STEP) + 2)
            )[:, None] * (end - start)
            return [(p, p) for p in places]
        centre, ray = path.centre[n, :2], start[:2] - path.centre[n, :2]
        share = np.linspace(0.0, 1.0, max(9, int(abs(sweep) * math.hypot(*ray) / STEP) + 2))
        c, s = np.cos(share * sweep), np.sin(share * sweep)
        places = np.stack(
            [
                centre[0] + c * ray[0] - s * ray[1],
                centre[1] + s * ray[0] + c * ray[1],
                start[2] + share * (end[2] - start[2]),
            ],
            axis=1,
        )
        return list(itertools.pairwise(places))

    def _sweep(self, a: np.ndarray, b: np.ndarray, tool: Tool, rapid: int | None) -> None:
        radius, corner = tool.radius, tool.corner_radius
        first = np.maximum(
            np.floor((np.minimum(a, b)[:2] - radius - self.low) / self.cell).astype(int), 0
        )
        last = np.maximum(
            np.ceil((np.maximum(a, b)[:2] + radius - self.low) / self.cell).astype(int) + 1, 0
        )
        at = (slice(first[0], last[0]), slice(first[1], last[1]))
        x, y, height = self.x[at], self.y[at], self.height[at]
        if not x.size:
            return
        way = b[:2] - a[:2]
        square = float(way @ way)
        share = (
            np.clip(((x - a[0]) * way[0] + (y - a[1]) * way[1]) / square, 0.0, 1.0)
            if square
            else 0.0
        )
        far = np.hypot(x - a[0] - share * way[0], y - a[1] - share * way[1])
        inner = np.clip(far - (radius - corner), 0.0, corner)
        tip = max(a[2], b[2]) + corner - np.sqrt(corner**2 - inner**2)
        if rapid is None:
            self.height[at] = np.where(far <= radius, np.minimum(height, tip), height)
        else:
            deep = np.where(far < radius - 1e-3, height - tip, 0.0).max()
            if deep > 0.01:
                self.crashes.append((rapid, float(deep)))
