"""The metric of stepovers over a sheet: held past jumps of the curvature, whatever edges the sheet has."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.sheet.sheet import Sheet
from trunnion.toolpath.contact_passes.stepover.metric import metric_of, stepover_measure
from verify_tools import bull

TOOL = bull(6.0, 3.0)()


def rolled(n: int = 40, radius: float = 6.0, split: bool = False) -> Sheet:
    """Return a strip 4 mm wide that is level up to x = 0 and then rolls down; with `split` one of its points is there twice, an edge
    without length between both."""
    run = np.linspace(-6.0, 6.0, n + 1)
    turn = np.maximum(run, 0.0) / radius
    x = np.where(run > 0.0, radius * np.sin(turn), run)
    z = radius * (np.cos(turn) - 1.0)
    points = np.vstack([np.column_stack([x, np.full(n + 1, y), z]) for y in (0.0, 4.0)])
    up = np.tile(np.column_stack([np.sin(turn), 0.0 * turn, np.cos(turn)]), (2, 1))
    a = np.arange(n)
    triangles = np.vstack(
        [np.column_stack([a, a + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + n + 1])]
    )
    if split:
        points, up = np.vstack([points, points[3]]), np.vstack([up, up[3]])
        triangles = np.vstack([triangles, [3, len(points) - 1, n + 4]])
    return Sheet(
        points=points, normals=up, triangles=triangles, face=np.ones(len(triangles), np.int64)
    )


@pytest.mark.filterwarnings("error")
def test_an_edge_without_length_changes_nothing_of_the_others() -> None:
    measure = stepover_measure(TOOL, 0.01)
    plain, split = (metric_of(sheet, measure).lengths for sheet in (rolled(), rolled(split=True)))
    assert split[: len(plain)] == pytest.approx(plain)
