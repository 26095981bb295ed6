"""Shapes that the program makes itself: the box of a blank."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from trunnion.findings import BadInput
from trunnion.geometry.frame import Frame
from trunnion.part.topology.identity import Shape


def box_blank(frame: Frame, low: ArrayLike, high: ArrayLike) -> Shape:
    """Return the solid box between two corners (3,) given in a frame, placed in the part's coordinates.

    Raises `BadInput` when the box has no thickness.
    """
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    low, size = (
        np.asarray(low, dtype=np.float64),
        np.asarray(high, dtype=np.float64) - np.asarray(low, dtype=np.float64),
    )
    if not (size > 0.0).all():
        raise BadInput(
            "a blank needs length, width and height: "
            + " x ".join(f"{s:g}" for s in size)
            + " mm is not a box"
        )
    corner = gp_Ax2(
        gp_Pnt(*frame.to_world(low).tolist()), gp_Dir(*frame.z.tolist()), gp_Dir(*frame.x.tolist())
    )
    return BRepPrimAPI_MakeBox(corner, *size.tolist()).Solid()
