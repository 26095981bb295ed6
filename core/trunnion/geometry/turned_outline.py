"""What triangles sweep when they turn about an axis: how far out and how far in they reach at every height."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints


def outer_meridian(points: Floats, triangles: Ints, bands: int) -> tuple[Floats, Floats, float]:
    """Return heights along z (bands + 1,) from the lowest point to the highest, the radius (bands + 1,) about z that lines between them
    keep outside of all triangles (t, 3) of points (v, 3), and the least distance of any triangle from z.

    The distance from the axis is convex along a straight line, so in a band of heights it is largest where an edge enters or leaves the
    band; at each height the larger of the two bands counts.
    """
    edges = np.unique(
        np.sort(
            np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1
        ),
        axis=0,
    )
    used = points[np.unique(triangles)]
    level = np.linspace(used[:, 2].min(), used[:, 2].max(), bands + 1)
    band = np.zeros(bands)
    row = np.clip(np.searchsorted(level, used[:, 2], side="right") - 1, 0, bands - 1)
    np.maximum.at(band, row, np.linalg.norm(used[:, :2], axis=1))
    on_level = np.isclose(used[:, 2], level[row], rtol=0.0, atol=1e-9) & (row > 0)
    np.maximum.at(band, row[on_level] - 1, np.linalg.norm(used[on_level, :2], axis=1))
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    for k in range(1, bands):
        low, high = a[:, 2] - level[k], b[:, 2] - level[k]
        cut = low * high < 0.0
        share = low[cut] / (low[cut] - high[cut])
        at = a[cut, :2] + share[:, None] * (b[cut, :2] - a[cut, :2])
        far = float(np.linalg.norm(at, axis=1).max(initial=0.0))
        band[k - 1 : k + 1] = np.maximum(band[k - 1 : k + 1], far)
    radius = np.maximum(np.concatenate([band[:1], band]), np.concatenate([band, band[-1:]]))
    return level, radius, _nearest_to_axis(points, triangles, edges)


def _nearest_to_axis(points: Floats, triangles: Ints, edges: Ints) -> float:
    """Return the least distance of triangles from z, 0 where it passes one."""
    corner = points[triangles][..., :2]
    around = [
        corner[:, k, 0] * corner[:, (k + 1) % 3, 1] - corner[:, k, 1] * corner[:, (k + 1) % 3, 0]
        for k in range(3)
    ]
    sense = np.sign(np.stack(around))
    if (np.abs(sense.sum(axis=0)) == 3.0).any():
        return 0.0
    a, b = points[edges[:, 0], :2], points[edges[:, 1], :2]
    step = b - a
    square = np.maximum((step * step).sum(axis=1), 1e-30)
    share = np.clip(-(a * step).sum(axis=1) / square, 0.0, 1.0)
    return float(np.linalg.norm(a + share[:, None] * step, axis=1).min())
