"""Sorting and grouping of patches by size, largest first (quick segmentation, figure 10 of the paper)."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.recognize.surface.size import PatchSizes


def grouped(rows: Ints, size: Floats, tolerance: float, *, relative: bool = False) -> list[Ints]:
    """Return the rows in groups, largest first: a patch within the tolerance of the one before it joins its group.

    rows (k,) into size (n,); `tolerance` in the size's unit, or a share of it.
    """
    order = rows[np.lexsort((rows, -size[rows]))]
    if not len(order):
        return []
    sorted_size = size[order]
    allowed = tolerance * sorted_size[:-1] if relative else tolerance
    return [
        np.asarray(g)
        for g in np.split(order, np.flatnonzero(sorted_size[:-1] - sorted_size[1:] > allowed) + 1)
    ]


def divided(
    groups: list[Ints], size: Floats, tolerance: float, *, relative: bool = False
) -> list[Ints]:
    """Return every group divided by one more size."""
    return [part for g in groups for part in grouped(g, size, tolerance, relative=relative)]


def aligned_groups(
    sizes: PatchSizes, rows: Ints, tolerance: float, *, relative: bool, subdivide: bool
) -> list[Ints]:
    """Group by the diagonal of the box along the axes; where chosen, divide by its sides, the longest first."""
    groups = grouped(rows, sizes.diagonal, tolerance, relative=relative)
    if subdivide:
        sides = np.sort(sizes.sides, axis=1)[:, ::-1]
        for k in range(3):
            groups = divided(groups, sides[:, k], tolerance, relative=relative)
    return groups


def invariant_groups(
    sizes: PatchSizes, rows: Ints, tolerance: float, *, relative: bool
) -> list[Ints]:
    """Group by what does not turn with the part: diameter, then area (the tolerance in mm2), then boundary length."""
    groups = grouped(rows, sizes.diameter, tolerance, relative=relative)
    for size in (sizes.area, sizes.length):
        groups = divided(groups, size, tolerance, relative=relative)
    return groups
