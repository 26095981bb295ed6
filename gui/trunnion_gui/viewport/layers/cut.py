"""A cut that a person is about to make: the places that were clicked, and the line on the face that it will follow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyvista as pv

from trunnion_gui.look.colours import Theme


def draw_cut(
    view: Any, positions: Sequence[tuple[float, float, float]], line: np.ndarray, theme: Theme
) -> None:
    """Show places as points and a line of pieces (k, 2, 3), in front of the part; what is empty is not drawn."""
    for name in ("cut places", "cut line"):
        view.remove_actor(name, render=False)
    if len(line):
        ends = np.column_stack(
            [np.full(len(line), 2), np.arange(2 * len(line)).reshape(-1, 2)]
        ).ravel()
        _in_front(
            view.add_mesh(
                pv.PolyData(line.reshape(-1, 3).astype(np.float32), lines=ends),
                color=theme.bad,
                line_width=3.5,
                name="cut line",
                pickable=False,
                reset_camera=False,
                lighting=False,
                show_scalar_bar=False,
            )
        )
    if positions:
        _in_front(
            view.add_mesh(
                pv.PolyData(np.array(positions, np.float32)),
                color=theme.bad,
                point_size=10.0,
                style="points",
                render_points_as_spheres=True,
                name="cut places",
                pickable=False,
                reset_camera=False,
                lighting=False,
            )
        )


def _in_front(actor: Any) -> None:
    """Draw in front of the surface that it lies on."""
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -8.0)
    actor.mapper.SetRelativeCoincidentTopologyPointOffsetParameter(-8.0)
