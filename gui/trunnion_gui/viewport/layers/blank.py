"""The blank as a ghost around the part."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from trunnion.model.blank import Blank
from trunnion_gui.look.colours import Theme

_FACES = np.array(
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)


def draw_blank(view: Any, blank: Blank | None, theme: Theme) -> None:
    """Show a blank, or none."""
    for name in ("blank", "blank edges"):
        view.remove_actor(name, render=False)
    if blank is None:
        return
    box = pv.PolyData(corners(blank), np.hstack([np.full((6, 1), 4), _FACES]).ravel())
    view.add_mesh(
        box,
        color=theme.accent,
        opacity=0.10,
        name="blank",
        pickable=False,
        reset_camera=False,
        lighting=False,
    )
    edges = box.extract_feature_edges(boundary_edges=False, manifold_edges=False, feature_angle=30)
    view.add_mesh(
        edges,
        color=theme.accent,
        opacity=0.8,
        line_width=1.5,
        name="blank edges",
        pickable=False,
        reset_camera=False,
        lighting=False,
    )


def corners(blank: Blank) -> np.ndarray:
    """Return the eight corners of a box blank (8, 3) in the part's coordinates."""
    (x0, y0, z0), (x1, y1, z1) = blank.low, blank.high
    local = np.array(
        [[x, y, z] for z in (z0, z1) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    )
    return blank.frame.to_world(local)
