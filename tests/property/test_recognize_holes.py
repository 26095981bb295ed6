"""Random holes in a plate that lies anywhere: all of them are found, with their sizes, and nothing else."""

from __future__ import annotations

from math import radians, tan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import samples
from drilled_parts import (
    box,
    counterbored,
    countersunk,
    cylinder,
    flat_hole,
    graph_of,
    pointed,
    through,
)
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.holes.sizes import hole_sizes

CELL, THICK = 40.0, 24.0
"""mm: a hole a cell, in a plate as thick."""
LARGEST = 30.0
Hole = tuple[Any, dict[str, Any]]


@st.composite
def holes(draw: st.DrawFn) -> Hole:
    """Return what is cut from the top of the plate, and the sizes of the hole."""
    diameter = round(draw(st.floats(2.0, 16.0)), 1)
    depth = round(draw(st.floats(3.0, 14.0)), 1)
    opens = draw(st.booleans())
    sizes: dict[str, Any] = {
        "diameter": diameter,
        "depth": THICK if opens else depth,
        "through": opens,
    }
    if opens:
        cutter = through(diameter, THICK)
    elif draw(st.booleans()):
        angle = draw(st.sampled_from((90.0, 118.0, 140.0)))
        cutter, sizes["point_angle"] = pointed(diameter, depth, angle), angle
    else:
        cutter = flat_hole(diameter, depth)
    mouth = draw(st.sampled_from(("plain", "counterbore", "countersink")))
    wide = round(diameter * draw(st.floats(1.2, 1.8)), 1)
    if mouth == "counterbore":
        deep = round(depth * draw(st.floats(0.2, 0.8)), 1)
        cutter = counterbored(cutter, wide, deep)
        sizes |= {"counterbore_diameter": wide, "counterbore_depth": deep}
    elif mouth == "countersink":
        angle = draw(st.sampled_from((82.0, 90.0, 100.0)))
        if 0.5 * (wide - diameter) / tan(radians(angle) / 2.0) < 0.9 * depth:
            cutter = countersunk(cutter, wide, diameter, angle)
            sizes |= {"countersink_diameter": wide, "countersink_angle": angle}
    return cutter, sizes


directions = st.tuples(*3 * [st.floats(-1.0, 1.0)]).filter(lambda v: np.linalg.norm(v) > 0.2)


@pytest.mark.examples(5)
@settings(deadline=None, max_examples=15)
@given(
    st.lists(holes(), min_size=1, max_size=4),
    directions,
    st.floats(0.0, 360.0),
    st.tuples(*3 * [st.floats(-5000.0, 5000.0)]),
)
def test_all_holes_of_a_plate_are_found(
    wanted: list[Hole],
    axis: tuple[float, float, float],
    angle: float,
    shift: tuple[float, float, float],
) -> None:
    plate = box((CELL * len(wanted), CELL, THICK))
    for n, (cutter, _) in enumerate(wanted):
        plate = plate.cut(cutter.translate((CELL * (n + 0.5), 0.5 * CELL, THICK)))
    # A round boss and a pocket with round corners are no holes.
    plate = plate.union(box((CELL, CELL, THICK), (-CELL, 0, 0))).cut(
        box((24, 24, 30), (-CELL + 8, 8, 10)).edges("|Z").fillet(5.0)
    )
    plate = plate.union(cylinder(12, 6, (-0.5 * CELL, 0.5 * CELL, 10)))
    shape = samples.moved(samples.turned(plate.val().wrapped, axis, angle), shift)
    up = np.array(samples.turned_direction((0, 0, 1), axis, angle))
    found = find_holes(graph_of(shape), LARGEST, up)
    assert sorted(sorted(_plain(hole_sizes(h)).items()) for h in found) == sorted(
        sorted(_plain(s).items()) for _, s in wanted
    )
    assert all(float(h.direction @ up) > 0.999 for h in found)


def _plain(sizes: dict[str, Any]) -> dict[str, Any]:
    return {k: round(float(v), 2) + 0.0 for k, v in sizes.items()}
