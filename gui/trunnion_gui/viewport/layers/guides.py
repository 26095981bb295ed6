"""Guide lines, a colour for each kind, with a dot where one element of a wall's line meets the next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyvista as pv

from trunnion.model.guides import GuideCurve, GuideKind, LinkRelation
from trunnion_gui.look.colours import guide_colours

LINES, CORNERS = "guide lines", "guide corners"
_WIDTH, _WIDE, _DOT = 3.5, 7.0, 9.0
"""Pixels."""
_FORWARD = -5.0e4
"""How far lines are drawn before where they are: most of the way to the eye, in VTK's units of 1 / 65000 of the depth."""


def draw_guides(view: Any, lines: Sequence[GuideCurve]) -> None:
    """Show guide lines in the part's coordinates, or none."""
    colours = guide_colours()
    # Drawn over each other in this order: rims of areas are wide, walls' lines are seen on them.
    for kind in sorted(GuideKind, key=lambda k: k is not GuideKind.AREA):
        name = f"{LINES} {kind}"
        view.remove_actor(name, render=False)
        points = [line.points for line in lines if line.kind is kind]
        if points:
            is_area = kind is GuideKind.AREA
            _add(
                view,
                _polylines(points),
                name,
                colours[kind.value],
                line_width=_WIDE if is_area else _WIDTH,
            )
    for relation in LinkRelation:
        name = f"{CORNERS} {relation}"
        view.remove_actor(name, render=False)
        found = [
            line.corners[[k for k, other in enumerate(line.relations) if other is relation]]
            for line in lines
        ]
        places = np.concatenate([np.zeros((0, 3)), *found])
        if len(places):
            dots = pv.PolyData(places.astype(np.float32))
            _add(
                view,
                dots,
                name,
                colours[relation.value],
                point_size=_DOT,
                render_points_as_spheres=True,
            )


def _add(view: Any, shape: pv.PolyData, name: str, colour: str, **look: Any) -> None:
    actor = view.add_mesh(
        shape,
        color=colour,
        name=name,
        pickable=False,
        reset_camera=False,
        lighting=False,
        show_scalar_bar=False,
        **look,
    )
    # Seen through the part: at the foot of a wall a line lies inside of the fillet.
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, _FORWARD)
    actor.mapper.SetRelativeCoincidentTopologyPointOffsetParameter(_FORWARD)


def _polylines(lines: Sequence[np.ndarray]) -> pv.PolyData:
    """Return one mesh of lines (n, 3) each."""
    cells, first = [], 0
    for points in lines:
        cells += [np.array([len(points)]), np.arange(first, first + len(points))]
        first += len(points)
    return pv.PolyData(np.vstack(lines).astype(np.float32), lines=np.concatenate(cells))
