"""Arrays that plain data holds: checked once, at construction, and read-only from then on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def floats(
    values: ArrayLike, shape: Sequence[int | None], name: str, *, may_be_nan: bool = False
) -> Floats:
    """Return a read-only float64 array of a shape (`None`: any length); raise `ValueError` naming the array otherwise."""
    array = _fixed(np.array(values, dtype=np.float64), shape, name)
    if not may_be_nan and not np.isfinite(array).all():
        raise ValueError(f"{name}: every number must be finite")
    return array


def ints(values: ArrayLike, shape: Sequence[int | None], name: str) -> Ints:
    """Return a read-only int64 array of a shape."""
    return _fixed(np.array(values, dtype=np.int64), shape, name)


def _fixed(array: NDArray, shape: Sequence[int | None], name: str) -> NDArray:
    if array.size == 0 and len(shape) != array.ndim:
        array = array.reshape([0 if n is None else n for n in shape])
    if array.ndim != len(shape) or any(
        want is not None and want != got for want, got in zip(shape, array.shape, strict=True)
    ):
        wanted = ", ".join("n" if n is None else str(n) for n in shape)
        raise ValueError(f"{name}: expected shape ({wanted}), got {array.shape}")
    array.setflags(write=False)
    return array


def items_of(count: Ints) -> tuple[Ints, Ints]:
    """Return for `count` (k,) items of each of k things, one thing after the other, which thing (p,) each is of, and its number (p,)
    there, from 0 on."""
    of = np.repeat(np.arange(len(count)), count)
    return of, np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)


def unit(vector: ArrayLike, name: str = "direction") -> Floats:
    """Return a vector (…, 3) scaled to length one; raise `ValueError` when it has no direction."""
    array = np.asarray(vector, dtype=np.float64)
    length = np.linalg.norm(array, axis=-1, keepdims=True)
    if not (length > 0.0).all():
        raise ValueError(f"{name}: a zero vector has no direction")
    return array / length
