"""Work offsets: three short arrows at each setup's zero."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyvista as pv

from trunnion.model.setup import Setup

_COLOURS = ("#cc3311", "#228833", "#1f6feb")
_MOST = 6


def draw_setups(view: Any, setups: Sequence[Setup], length: float) -> None:
    """Show the zero of every setup; `length` of an arrow in mm."""
    for row in range(_MOST):
        for axis in "xyz":
            view.remove_actor(f"setup {row} {axis}", render=False)
    for row, setup in enumerate(setups[:_MOST]):
        for axis, direction, colour in zip("xyz", setup.frame.axes, _COLOURS):
            arrow = pv.Arrow(
                start=setup.frame.origin,
                direction=np.asarray(direction),
                scale=length,
                shaft_radius=0.025,
                tip_radius=0.07,
                tip_length=0.25,
            )
            view.add_mesh(
                arrow,
                color=colour,
                name=f"setup {row} {axis}",
                pickable=False,
                reset_camera=False,
                ambient=0.4,
            )
