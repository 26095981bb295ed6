"""Small blocks with a pocket and slopes outside of it, built by cadquery for tests: chamfers, sides that lean, a free-form side."""

from __future__ import annotations

from functools import cache
from typing import Any

import cadquery as cq

from leaning_pockets import BLOCK, block, upright_space

CORNER, FLOOR = 8.0, 8.0
"""mm: corners of the pocket, height of its floor."""


def with_pocket(solid: Any) -> Any:
    """Return a block with a pocket of upright walls in its middle."""
    return solid.cut(upright_space(CORNER).translate((0, 0, FLOOR)))


@cache
def chamfered_block(width: float = 1.5, height: float = 1.0) -> Any:
    """Return a block whose outline and whose pocket's rim have a chamfer above, and its outline one of 1 mm below."""
    solid = with_pocket(block().edges("|Z").fillet(6.0))
    solid = solid.faces(">Z").edges().chamfer(height, width)
    return solid.faces("<Z").edges().chamfer(1.0).val().wrapped


@cache
def drafted_block(lean: float = 6.0) -> Any:
    """Return a block whose four sides lean, inwards up where `lean` is above nothing."""
    middle = cq.Workplane("XY", origin=(BLOCK[0] / 2, BLOCK[1] / 2, 0))
    solid = middle.sketch().rect(*BLOCK[:2]).vertices().fillet(6.0).finalize()
    return with_pocket(solid.extrude(BLOCK[2], taper=lean)).val().wrapped


@cache
def fringed_block(across: float = 2.5, winds: float = 1.0) -> Any:
    """Return a block whose side of high x is free-form: it leans back by `across` mm up to its top and winds to either side."""
    length, width, height = BLOCK

    def section(z: float, shift: float, swing: float) -> cq.Wire:
        x = length - 5.0 - shift
        middle = [(x, -10), (x + swing, width / 3), (x - swing, 2 * width / 3), (x, width + 10)]
        sheet = cq.Workplane("XY", origin=(0, 0, z)).moveTo(*middle[0])
        sheet = sheet.spline(middle[1:], includeCurrent=True)
        return sheet.lineTo(length + 30, width + 10).lineTo(length + 30, -10).close().val()

    beyond = cq.Solid.makeLoft(
        [section(-1.0, 0.0, winds), section(height + 1.0, across, -winds)], True
    )
    return with_pocket(block().edges("|Z").fillet(6.0)).cut(cq.Workplane(obj=beyond)).val().wrapped
