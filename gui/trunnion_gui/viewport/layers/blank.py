"""The blank as a ghost around the part."""

from __future__ import annotations

from typing import Any

import pyvista as pv

from trunnion.model.blank import Blank
from trunnion_gui.look.colours import Theme


def draw_blank(view: Any, blank: Blank | None, theme: Theme) -> None:
    """Show a blank, or none."""
    for name in ("blank", "blank edges"):
        view.remove_actor(name, render=False)
    if blank is None:
        return
    points, triangles = blank.shell()
    solid = pv.PolyData.from_regular_faces(blank.frame.to_world(points), triangles)
    view.add_mesh(
        solid,
        color=theme.accent,
        opacity=0.10,
        name="blank",
        pickable=False,
        reset_camera=False,
        lighting=False,
    )
    edges = solid.extract_feature_edges(
        boundary_edges=False, manifold_edges=False, feature_angle=30
    )
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
