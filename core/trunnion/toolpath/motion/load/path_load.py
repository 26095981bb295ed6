"""The load that a path as it was laid puts on cutter and spindle, piece by piece, from what it takes off the stock.

Sections and widths of cut are means over a diameter's way: a corner that loads a cutter for less is not a peak. Power is Kienzle's, as in
the cutting data, at the feeds that the path has.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.material import Material
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.power import drill_chip, specific_force
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.motion.load.pieces import PIECE, cut_width, in_pieces
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT

CELL = 0.25
"""mm: side of the cells that loads are taken from. Layers along a wall are a few tenths thick."""
TURN = math.atan((math.sqrt(5.0) - 1.0) / 2.0)
"""rad: turn of the cells against the setup. The golden ratio is worst told by fractions: along any wall the cells come evenly, and a layer
thinner than a cell is seen as thick as it is on the mean."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PathLoad:
    """The load of pieces n of a path: rate (n,) cm3/min, chip (n,) mm the thickest, power (n,) kW."""

    rate: Floats
    chip: Floats
    power: Floats


class LoadStock:
    """The stock of one setup that loads are taken from, as operation after operation cuts it; only upright tools do."""

    def __init__(self, blank: Blank, frame: Frame) -> None:
        c, s = math.cos(TURN), math.sin(TURN)
        self.frame = Frame(origin=frame.origin, x=c * frame.x + s * frame.y, z=frame.z)
        self._blank = blank
        self._stock: PlanningStock | None = None

    def cut(
        self,
        path: Toolpath,
        tool: Tool,
        data: CuttingData,
        material: Material,
        progress: Progress = NO_PROGRESS,
    ) -> PathLoad:
        """Take a path of an upright tool, in this stock's own frame, off it and return its load."""
        if self._stock is None:
            # A setup whose tools all lean needs none, and of a large turned blank it takes seconds.
            self._stock = PlanningStock.centred_in(self._blank, self.frame, CELL)
        cuts = path.motion != Motion.RAPID
        pieces, block = in_pieces(path, PIECE * tool.radius, cuts)
        taken = self._stock.taken(pieces, tool, progress)
        return load_of(pieces, block, tool, data, material, *taken)


def load_of(
    pieces: Toolpath,
    block: Ints,
    tool: Tool,
    data: CuttingData,
    material: Material,
    volume: Floats,
    squares: Floats,
) -> PathLoad:
    """Return the load of pieces of blocks (n,) that take off volumes (n,) mm3, the squares of their heights summed up to `squares` (n,)
    mm4."""
    cuts = (volume > 0.0) & (pieces.motion != Motion.RAPID)
    # Each piece's volume goes at its own feed: a neighbour that is eased doesn't count at the feed of this one.
    section, square, flow = (
        np.where(cuts, _by_length(pieces, block, taken, tool.core_diameter), 0.0)
        for taken in (volume, squares, volume * np.where(cuts, pieces.feed, 0.0))
    )
    width = cut_width(section, square, tool)
    feed = np.divide(flow, section, out=np.zeros(len(pieces)), where=section > 0.0)
    tooth = feed / (tool.teeth * data.spindle)
    if tool.edge_angle > 0.0:
        share = drill_chip(tool, 1.0)
        mean, thickest = tooth * share, np.full(len(pieces), share)
    else:
        mean = tooth * mean_share(width, tool.core_diameter)
        thickest = _thickest_share(pieces, tool, volume, squares, cuts)
    rate = flow / MM_PER_METRE
    power = rate * specific_force(material, mean) / (SECONDS_PER_MINUTE * WATTS_PER_KILOWATT)
    tooth = np.where(cuts, pieces.feed, 0.0) / (tool.teeth * data.spindle)
    return PathLoad(rate=rate, chip=tooth * thickest, power=np.where(cuts, power, 0.0))


def _thickest_share(
    pieces: Toolpath, tool: Tool, volume: Floats, squares: Floats, cuts: Bools
) -> Floats:
    """Return the thickest chip of each piece (n,) over the feed per tooth: thick where a cutter is engaged far round, for however short a
    way."""
    length = np.maximum(pieces.lengths(), tolerance.COINCIDENT)
    here = cut_width(
        np.where(cuts, volume / length, 0.0), np.where(cuts, squares / length, 0.0), tool
    )
    return np.asarray(np.sin(np.minimum(contact_arc(here, tool.core_diameter), 0.5 * math.pi)))


def contact_arc(width: Floats, diameter: float) -> Floats:
    """Return the angle (n,) rad over which a cutter is engaged from its side in widths (n,) mm."""
    return np.arccos(np.clip(1.0 - 2.0 * width / diameter, -1.0, 1.0))


def mean_share(width: Floats, diameter: float) -> Floats:
    """Return the mean chip thickness over the arc of contact, over the feed per tooth, in widths (n,) mm."""
    arc = contact_arc(width, diameter)
    return np.divide(2.0 * width / diameter, arc, out=np.zeros(len(arc)), where=arc > 0.0)


def _by_length(pieces: Toolpath, block: Ints, taken: Floats, window: float) -> Floats:
    """Return what pieces take (n,) over their way (n,), on a stretch of at least a window (mm) about each, or about its block where that is
    shorter; a rapid ends a stretch."""
    length, rapid = pieces.lengths(), pieces.motion == Motion.RAPID
    # Rapids are as long as no window is, and along them neither way nor what is taken grows.
    at, way, total = (
        np.concatenate([[0.0], np.cumsum(steps)])
        for steps in (np.where(rapid, window, length), np.where(rapid, 0.0, length), taken)
    )
    first = np.flatnonzero(np.diff(block, prepend=-1))
    last = np.append(first[1:], len(block))
    whole = np.bincount(block, length)[block]
    short = whole < window
    low = np.where(short, at[first[block]], at[:-1])
    high = np.where(short, at[last[block]], at[1:])
    spare = 0.5 * np.maximum(window - np.where(short, whole, length), 0.0)
    low, high = low - spare, high + spare
    between = np.interp(high, at, way) - np.interp(low, at, way)
    cut = np.interp(high, at, total) - np.interp(low, at, total)
    return np.divide(cut, between, out=np.zeros(len(pieces)), where=~rapid & (between > 0.0))
