"""Compiled: the material of a bundle's rays as sorted disjoint intervals, each ray with a place of its own in flat arrays. mm."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED

SHRINK = 1e-6
"""mm that bodies are made smaller by: a surface that was just cut to is not cut again by what only touches it."""
NOISE = 1e-7
"""mm: depths less apart are the same."""
THIN = 1e-6
"""mm: material thinner than this is nothing."""


FIRST, COUNT, CAPACITY = 0, 1, 2
"""Columns of what is known of a ray: the row of its first interval, how many it has, and how many it may have there."""


class Rays(NamedTuple):
    """Where material is on rays: ends (m, 2) mm, where intervals begin and end, each ray's in a row and upwards.

    ray (c, 3): a row a ray, with the columns above. free (2,) of a tile: the first row of `ends` that no ray of it has, and the one after
    its last. A ray that is full moves there, to twice the capacity.
    """

    ray: Ints
    ends: Floats
    free: Ints


@njit(**BORROWED)
def ray_misses(ray: Ints, ends: Floats, cell: int, bottom: float, top: float) -> bool:
    """Return whether a ray has no material between two positions, or no more than what SHRINK leaves of a
    cut; `ray` and `ends` as `Rays` has them."""
    first = ray[cell, FIRST]
    for m in range(first, first + ray[cell, COUNT]):
        if ends[m, 1] > bottom + 2.0 * SHRINK:
            return ends[m, 0] >= top - 2.0 * SHRINK
    return True


@njit(**BORROWED)
def has_capacity(rays: Rays, cell: int) -> bool:
    """Return whether a ray has capacity for one more interval; one that is full is moved to what is free."""
    table, ends, free_rows = rays.ray, rays.ends, rays.free
    first, count, capacity, free = (
        table[cell, FIRST],
        table[cell, COUNT],
        table[cell, CAPACITY],
        free_rows[0],
    )
    if count < capacity:
        return True
    if free + 2 * capacity > free_rows[1]:
        return False
    for k in range(count):
        ends[free + k, 0], ends[free + k, 1] = (
            ends[first + k, 0],
            ends[first + k, 1],
        )
    table[cell, FIRST], table[cell, CAPACITY], free_rows[0] = (
        free,
        2 * capacity,
        free + 2 * capacity,
    )
    return True


@njit(**BORROWED)
def subtract_interval(rays: Rays, cell: int, k: int, a: float, b: float) -> float:
    """Subtract [a, b] from a ray's interval k (a < b, both within it); return the length (mm) that is
    gone.

    Remainders thinner than THIN go too. The ray needs capacity for one more interval. Intervals stay
    sorted and disjoint.
    """
    table, ends = rays.ray, rays.ends
    m = table[cell, FIRST] + k
    end = table[cell, FIRST] + table[cell, COUNT]
    left, right = a - ends[m, 0] > THIN, ends[m, 1] - b > THIN
    # The middle goes: two intervals remain.
    if left and right:
        for n in range(end, m + 1, -1):
            ends[n, 0], ends[n, 1] = ends[n - 1, 0], ends[n - 1, 1]
        ends[m + 1, 0], ends[m + 1, 1] = b, ends[m, 1]
        ends[m, 1] = a
        table[cell, COUNT] += 1
        return b - a
    if left:
        gone = ends[m, 1] - a
        ends[m, 1] = a
        return gone
    if right:
        gone = b - ends[m, 0]
        ends[m, 0] = b
        return gone
    gone = ends[m, 1] - ends[m, 0]
    for n in range(m, end - 1):
        ends[n, 0], ends[n, 1] = ends[n + 1, 0], ends[n + 1, 1]
    table[cell, COUNT] -= 1
    return gone


@njit(**BORROWED)
def subtract_from_ray(rays: Rays, cell: int, a: float, b: float) -> tuple[float, bool]:
    """Subtract [a, b] from all intervals of a ray; return the length (mm) that is gone, and whether
    the ray had capacity for all that is left.

    Overlaps thinner than NOISE are left.
    """
    table, ends = rays.ray, rays.ends
    gone, k = 0.0, 0
    while k < table[cell, COUNT]:
        m, before = table[cell, FIRST] + k, table[cell, COUNT]
        c, d = max(a, ends[m, 0]), min(b, ends[m, 1])
        if d - c > NOISE:
            if not has_capacity(rays, cell):
                return gone, False
            gone += subtract_interval(rays, cell, k, c, d)
        k += 1 + table[cell, COUNT] - before
    return gone, True
