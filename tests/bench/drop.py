"""Dropping cutters, one thread, beside opencamlib in the same run, and beside our own plain form: how quick, and how far apart."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.cutter_contact.drop_cutter import drop_cutter as plain_drop
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.plan.freeform.cutters.cutter import lower_side
from verify_tools import bull

LOWEST = -100.0
SIZE = 200.0
FORMS = {
    "flat 16": (16.0, 0.0),
    "ball 16": (16.0, 8.0),
    "bull 16 r3": (16.0, 3.0),
    "ball 6": (6.0, 3.0),
    "ball 2": (2.0, 1.0),
}
"""Diameters and corner radii."""
TIMES_FASTER, POINTS_A_SECOND = 100.0, 60_000.0
ROUNDS = 5


def wavy(n: int) -> tuple[Floats, Ints]:
    """Return points and the 2 n n triangles of a wavy sheet of 200 x 200 mm."""
    x, y = np.meshgrid(np.linspace(0.0, SIZE, n + 1), np.linspace(0.0, SIZE, n + 1), indexing="ij")
    z = 10.0 * np.sin(x / 15.0) * np.cos(y / 20.0) - 12.0 + 0.04 * x
    a = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    return (
        np.column_stack([x.ravel(), y.ravel(), z.ravel()]),
        np.vstack(
            [np.column_stack([a, a + n + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + 1])]
        ),
    )


def grid(n: int) -> Floats:
    """Return n n plan points over the whole sheet, its rims too."""
    along = np.linspace(0.0, SIZE, n)
    return np.stack(np.meshgrid(along, along, indexing="ij"), axis=-1).reshape(-1, 2)


class Peer:
    """The same sheet and cutter in opencamlib; whatever it is given is kept, as it keeps bare references."""

    def __init__(self, points: Floats, triangles: Ints, form: tuple[float, float]) -> None:
        import opencamlib as ocl

        diameter, corner = form
        self.cutter = (
            ocl.CylCutter(diameter, 60.0)
            if corner == 0.0
            else ocl.BallCutter(diameter, 60.0)
            if 2.0 * corner == diameter
            else ocl.BullCutter(diameter, corner, 60.0)
        )
        self.corners = [ocl.Point(*map(float, p)) for p in points]
        self.triangles = [ocl.Triangle(*(self.corners[int(k)] for k in t)) for t in triangles]
        self.surface = ocl.STLSurf()
        for triangle in self.triangles:
            self.surface.addTriangle(triangle)
        self.library = ocl

    def drop(self, at: Floats) -> tuple[Floats, float]:
        """Return heights over plan points, and the CPU seconds of the dropping alone, on one thread."""
        batch = self.library.BatchDropCutter()
        batch.setSTL(self.surface)
        batch.setCutter(self.cutter)
        batch.setThreads(1)
        for x, y in at.tolist():
            batch.appendPoint(self.library.CLPoint(x, y, LOWEST))
        began = time.process_time()
        batch.run()
        return np.array([p.z for p in batch.getCLPoints()]), time.process_time() - began


def drop(quick: bool) -> Iterator[dict[str, Any]]:
    """Points a second at 20,000 and 51,000 triangles beside opencamlib's, and how far heights are from its and from the plain form's."""
    few = 20 if quick else 40
    points, triangles = wavy(100)
    surface = DropSurface.of(points, triangles)
    for name in ("flat 16", "ball 16", "bull 16 r3", "ball 2"):
        peer = Peer(points, triangles, FORMS[name])
        yield from _beside(name, surface, points[triangles], _pieces(name), few, peer)
    points, triangles = wavy(160)
    yield _rate("ball 6", DropSurface.of(points, triangles), len(triangles))


def _pieces(name: str) -> Floats:
    diameter, corner = FORMS[name]
    return lower_side(bull(diameter, corner)())


def _beside(
    name: str, surface: DropSurface, corners: Floats, pieces: Floats, few: int, peer: Peer
) -> Iterator[dict[str, Any]]:
    theirs, their_seconds = peer.drop(grid(few))
    many = grid(6 * few)
    seconds = _cpu(lambda: surface.drop(many, pieces, LOWEST))
    ours = surface.drop(grid(few), pieces, LOWEST)
    faster = their_seconds / few**2 / (seconds / len(many))
    on = "20000 triangles"
    yield {
        "name": f"drop, {name}",
        "part": on,
        "seconds": seconds,
        "ratio_to": f"opencamlib's points a second ({few**2 / their_seconds:.0f}); ours {len(many) / seconds:.0f}",
        "ratio": faster,
        "goal": f">= {TIMES_FASTER:g}",
    }
    apart = np.abs(ours - theirs)
    yield {
        "name": f"drop, {name}, apart",
        "part": on,
        "seconds": 0.0,
        "ratio_to": "mm from opencamlib at most; "
        f"{int((apart > 1e-4).sum())} of {len(apart)} points beyond the goal",
        "ratio": float(apart.max()),
        "goal": "<= 0.0001",
    }
    some = grid(few)[::11]
    yield {
        "name": f"drop, {name}, plain",
        "part": on,
        "seconds": 0.0,
        "ratio_to": f"mm from every triangle for {len(some)} points",
        "ratio": float(
            np.abs(
                surface.drop(some, pieces, LOWEST) - plain_drop(some, corners, pieces, LOWEST)
            ).max()
        ),
        "goal": "<= 1e-09",
    }


def _rate(name: str, surface: DropSurface, count: int) -> dict[str, Any]:
    many = grid(240)
    seconds = _cpu(lambda: surface.drop(many, _pieces(name), LOWEST))
    return {
        "name": f"drop, {name}",
        "part": f"{count} triangles",
        "seconds": seconds,
        "ratio_to": "points a second",
        "ratio": len(many) / seconds,
        "goal": f">= {POINTS_A_SECOND:g}",
    }


def _cpu(work: Callable[[], Any]) -> float:
    """Return the median CPU seconds of some runs after one that is not counted."""
    work()
    taken = []
    for _ in range(ROUNDS):
        began = time.process_time()
        work()
        taken.append(time.process_time() - began)
    return float(np.median(taken))
