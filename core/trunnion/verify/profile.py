"""How high above its tip a cutter begins, as the height field needs it: row by row of a table, one row a tool."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.tool import PLAIN_FORMS, Tool
from trunnion.verify.cutter import Bodies, outline_of
from trunnion.verify.kernels import body as bodies_kernel

PROFILE_COLUMNS = 6


def profiles_of(tools: Sequence[Tool], bodies: Bodies) -> Floats:
    """Return rows (t, 6): RADIUS, CORNER, OPEN, PLAIN, FIRST, LAST, as `kernels/stock/zmap.py` names them.

    Up to the height OPEN above its tip a cutter does not get thinner; a column that it cuts below that has nothing left above the cut, so a
    field of heights says all. PLAIN 1 is an end of a radius and a corner radius; other forms are the bodies FIRST to LAST.
    """
    rows = []
    for k, tool in enumerate(tools):
        cutting = bodies.of(k)[:, bodies_kernel.KIND] == 0.0
        first = int(bodies.start[k])
        widest = float(bodies.of(k)[cutting, bodies_kernel.R_MAX].max())
        rows.append(
            (
                widest,
                tool.corner_radius,
                open_height(tool),
                float(tool.form in PLAIN_FORMS),
                first,
                first + int(cutting.sum()),
            )
        )
    return np.array(rows, dtype=np.float64).reshape(-1, PROFILE_COLUMNS)


def open_height(tool: Tool) -> float:
    """Return the height above the tip up to which a cutter gets no thinner: its flutes' top, a barrel's widest circle, a T-slot's rim."""
    height = 0.0
    for r0, z0, r1, z1, _, cz, radius in outline_of(tool):
        if radius == 0.0:
            thins, until = r1 < r0 - tolerance.PARAMETRIC, z0
        elif radius > 0.0:
            thins, until = z1 > cz + tolerance.PARAMETRIC, max(z0, cz)
        else:
            thins, until = z0 < cz - tolerance.PARAMETRIC, z0
        if thins:
            return until
        height = z1
    return height


def cones_of(tools: Sequence[Tool]) -> tuple[Floats, Ints]:
    """Return what is above the flutes of all tools as truncated cones (k, 5) and where each tool's begin (t + 1,).

    A row: radius low, radius high, z low, z high (from the tip), and 1 where the lower end is a free face.
    """
    rows: list[tuple[float, ...]] = []
    start = [0]
    for tool in tools:
        under = outline_of(tool)[-1][2]
        for z0, r0, z1, r1 in tool.profile():
            if z1 - z0 > tolerance.PARAMETRIC:
                rows.append((r0, r1, z0, z1, float(r0 > under + tolerance.PARAMETRIC)))
                under = r1
        start.append(len(rows))
    return np.array(rows, dtype=np.float64).reshape(-1, 5), np.array(start, dtype=np.int64)
