"""Tools, paths and small plans of faces that the tests of the proof share."""

from __future__ import annotations

import numpy as np

from trunnion.model.program import ProgramSection
from trunnion.model.tool import Holder, Tool
from trunnion.model.toolpath import Motion, Toolpath

HOLDER = Holder(name="test holder", rows=((0.0, 12.0, 10.0, 20.0), (10.0, 20.0, 40.0, 20.0)))


def flat(diameter):
    """Return a maker of flat cutters of a diameter: `flat(10.0)(flute=25.0)`."""
    return bull(diameter, 0.0)


def bull(diameter, corner):
    """Return a maker of cutters of a diameter and a corner radius."""

    def make(flute=30.0, number=1):
        form = "flat" if corner == 0.0 else "ball" if corner == diameter / 2 else "bull"
        return Tool(number=number, name=f"{form} {diameter:g}", form=form, diameter=diameter, corner_radius=corner, flute_length=flute,
                    neck_diameter=diameter - 1.0, neck_length=flute + 1.0, shank_diameter=diameter, stickout=flute + 3.0,
                    gauge_length=flute + 60.0, teeth=3, centre_cutting=True, helix_angle=30.0, holder=HOLDER)

    return make


def program_section(tool, stops, operation="op", rapid_to=0):
    """Return a section whose blocks go to the stops: a point, (point, None), or (point, centre) for an anticlockwise arc.

    Blocks up to index `rapid_to` are rapids.
    """
    points, centres = [], []
    for stop in stops:
        point, centre = stop if len(stop) == 2 else (stop, None)
        points.append(point)
        centres.append([np.nan] * 3 if centre is None else [*centre[:2], 0.0])
    n = len(points)
    motion = [Motion.RAPID if k <= rapid_to else Motion.LINE if np.isnan(centres[k][0]) else Motion.ARC_CCW for k in range(n)]
    path = Toolpath(position=points, axis=[[0.0, 0.0, 1.0]] * n, motion=motion, centre=centres,
                    feed=[0.0 if m == Motion.RAPID else 1000.0 for m in motion], mark=[0] * n)
    return ProgramSection(operation=operation, tool=tool, spindle=10000.0, path=path)
