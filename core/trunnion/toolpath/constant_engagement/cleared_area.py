"""What a cutter has cleared of an area so far, on a grid: where it may be, how far it is engaged there, and what is left.

Two fields over the axis region and a radius about it: how deep in the axis region a node is, and how far from all that was cleared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import ndimage

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels import constant_engagement as kernels
from trunnion.geometry.plane.region import Region
from trunnion.plan.cutting.milling import FILM

CELLS_A_RADIUS = 16
"""Cells of the grid along the cutter's radius: a bilinear circle is then nowhere farther from the true one than 0.0005 radii."""

MOST_NODES = 4_000_000
"""Most nodes of a grid: of a larger area its cells are larger."""

FAN = 48
"""Directions in which half a rim is looked at."""

THIN = 0.006
"""Radii: a layer of material no thicker than this isn't worth a pass: 0.06 mm under a cutter of 20 mm."""

MOST_LOOKED_AT = 400
"""Positions among which the deepest is looked for."""

BLOCK = 8
"""Nodes along the side of a block that is looked at as a whole first."""

AROUND = np.ones((3, 3), dtype=np.bool_)
"""The eight nodes around a node, and itself."""

UNKNOWN = 1e3
"""mm: where nothing was cleared near by."""


@dataclass(frozen=True, slots=True, eq=False)
class Remaining:
    """A place of material that a cutter still reaches: the `area` of the `positions` (k, 2) that it would cut it from, mm2; the positions
    beside free ones, `fronts` (m, 2), and the nearest `material` (m, 2) to each."""

    area: float
    positions: Floats
    fronts: Floats
    material: Floats


@dataclass(frozen=True, slots=True, eq=False)
class ClearedArea:
    """`depth` (nx, ny) in the axis region, negative outside, and `uncut` (nx, ny), the distance from what was cleared, mm; node (i, j) is
    at `corner` + (i, j) `cell`. `wanted` (nx, ny): where material is to go. `uncut` changes as passes are marched."""

    axis_region: Region
    radius: float
    corner: Floats
    cell: float
    depth: Floats
    uncut: Floats
    wanted: Bools

    @staticmethod
    def of(
        axis_region: Region, wanted: Region, radius: float, is_material: Callable[[Floats], Bools]
    ) -> ClearedArea:
        """Return the area that a cutter of a radius reaches from an axis region; `is_material` says of points (k, 2) whether material is
        there.
        Only what is `wanted` is looked for, the rest is known to load the cutter."""
        low, high = axis_region.box()
        cell = radius / CELLS_A_RADIUS
        around = radius + 4.0 * cell
        size = high - low + 2.0 * around
        cell = max(cell, math.sqrt(float(np.prod(size)) / MOST_NODES))
        corner = low - around
        shape = tuple(int(n) for n in np.ceil(size / cell) + 1)
        nodes = corner + cell * np.stack(
            np.meshgrid(*(np.arange(n) for n in shape), indexing="ij"), axis=-1
        )
        material = is_material(nodes.reshape(-1, 2)).reshape(shape)
        return ClearedArea(
            axis_region,
            radius,
            corner,
            cell,
            _depths(axis_region, nodes, cell),
            _distances(material, cell),
            _depths(wanted, nodes, cell) >= 0.0,
        )

    @property
    def fan(self) -> Floats:
        """Cosine and sine (n, 2) of the directions in which half a rim is looked at."""
        angle = np.linspace(0.0, math.pi, FAN)
        return np.column_stack([np.cos(angle), np.sin(angle)])

    @property
    def thin(self) -> float:
        """The thickness in mm of what isn't worth a pass."""
        return THIN * self.radius

    def clear(self, points: Floats) -> None:
        """Clear what the cutter sweeps along straight lines through points (k, 2), k at least 1."""
        for a, b in pairwise([points[0], *points]):
            kernels.sweep_disc(
                self.uncut, *self.corner, self.cell, a[0], a[1], b[0], b[1], self.radius
            )

    def line_is_free(self, start: Floats, end: Floats) -> bool:
        """Return whether the cutter goes straight from one position (2,) to another through what was cleared."""
        return bool(
            kernels.line_is_free(
                self.uncut,
                self.depth,
                *self.corner,
                self.cell,
                start[0],
                start[1],
                end[0],
                end[1],
                self.radius,
                self.fan,
                FILM * self.radius,
            )
        )

    def march(
        self,
        start: Floats,
        angle: float,
        *,
        step: float,
        turn: float,
        idle_before: float,
        idle_after: float,
        longest: float,
        least: float,
        wider: float = 0.0,
        side: float = 1.0,
        cuts: bool = True,
    ) -> tuple[Floats, int]:
        """Return what `march_engaged` does: positions (k, 4) and why it ended. A cutter that is `wider` than the true one doesn't cut."""
        path = np.empty((max(int(longest / step), 2), 4))
        count, why = kernels.march_engaged(
            self.uncut,
            self.depth,
            *self.corner,
            self.cell,
            start,
            self.radius + wider,
            self.fan,
            self.thin,
            side,
            cuts and wider == 0.0,
            angle,
            least,
            step,
            turn,
            idle_before,
            idle_after,
            path,
        )
        return path[:count].copy(), int(why)

    def remaining(self) -> Iterator[Remaining]:
        """Yield the places of wanted material that the cutter still reaches, the largest first."""
        material = self.uncut > self.thin
        wanted = material & self.wanted
        if not wanted.any():
            return
        inside = self.depth >= 0.0
        near = self.radius - self.cell
        cuts = inside & (ndimage.distance_transform_edt(~wanted, sampling=self.cell) < near)
        if not cuts.any():
            return
        away, nearest = ndimage.distance_transform_edt(
            ~material, sampling=self.cell, return_indices=True
        )
        meets = inside & (away < near)
        at_free = ndimage.binary_dilation(inside & ~meets, structure=AROUND)
        places, count = ndimage.label(meets, structure=AROUND)
        sizes = ndimage.sum_labels(cuts, places, np.arange(1, count + 1))
        boxes = ndimage.find_objects(places)
        for n in np.argsort(-sizes, kind="stable"):
            if not sizes[n]:
                return
            box = boxes[n]
            here = places[box] == n + 1
            first = np.array([s.start for s in box])
            nodes = first + np.argwhere(here & cuts[box])
            fronts = first + np.argwhere(here & at_free[box])
            yield Remaining(
                area=float(sizes[n]) * self.cell**2,
                positions=self.corner + self.cell * nodes,
                fronts=self.corner + self.cell * fronts,
                material=self.corner + self.cell * nearest[:, fronts[:, 0], fronts[:, 1]].T,
            )

    def is_free(self, position: Floats) -> bool:
        """Return whether the cutter is free at a position (2,) of the axis region: in what was cleared with all its rim."""
        return bool(
            kernels.disc_is_free(
                self.uncut,
                self.depth,
                *self.corner,
                self.cell,
                position[0],
                position[1],
                self.radius,
                self.fan,
                self.thin,
            )
        )

    def held(self, points: Floats) -> Floats:
        """Return points (k, 2), those outside the axis region moved to its rim: at sharp corners of the part the grid blurs it."""
        outside = np.flatnonzero(self.axis_region.signed_distance(points) < 0.0)
        held = points.copy()
        for row in outside:
            curves = self.axis_region.curves()
            rim = min(curves, key=lambda c: float(c.distance(points[row])[0]))
            held[row] = rim.at(rim.nearest(points[row]))[0]
        return held

    def deepest(self, positions: Floats) -> tuple[Floats, float]:
        """Return the one of positions (k, 2), of every so many of them, that is deepest in the axis region, and how deep it is: exactly,
        which the grid isn't far from the rim."""
        some = positions[:: max(1, len(positions) // MOST_LOOKED_AT)]
        depths = self.axis_region.signed_distance(some)
        row = int(np.argmax(depths))
        return some[row], float(depths[row])


def _depths(region: Region, nodes: Floats, cell: float) -> Floats:
    """Return the signed distances (nx, ny) of nodes (nx, ny, 2) from a region's rim, exact near it; farther inside or outside those of the
    middles of blocks, which are as far off as a block is wide at most."""
    nx, ny = nodes.shape[:2]
    middles_x, middles_y = (
        np.minimum(np.arange(0, n, BLOCK) + BLOCK // 2, n - 1) for n in (nx, ny)
    )
    middles = nodes[np.ix_(middles_x, middles_y)]
    coarse = region.signed_distance(middles.reshape(-1, 2)).reshape(middles.shape[:2])
    depths = np.repeat(np.repeat(coarse, BLOCK, axis=0), BLOCK, axis=1)[:nx, :ny].copy()
    near = np.abs(depths) < (BLOCK + 2.0 * kernels.BAND) * cell
    depths[near] = region.signed_distance(nodes[near])
    return depths


def _distances(material: Bools, cell: float) -> Floats:
    """Return the distances (nx, ny) of nodes with material from those without, negative the other way round."""
    if material.all():
        return np.full(material.shape, UNKNOWN)
    if not material.any():
        return np.full(material.shape, -UNKNOWN)
    outside = ndimage.distance_transform_edt(material, sampling=cell)
    inside = ndimage.distance_transform_edt(~material, sampling=cell)
    # Half a cell is between the last node of one kind and the edge.
    return np.asarray(np.where(material, outside - 0.5 * cell, 0.5 * cell - inside))
