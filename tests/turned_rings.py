"""Rings to turn, their blanks, tools and cutting data, that the tests of turning share."""

from __future__ import annotations

import numpy as np
import shapely

from own_shop import own_shop
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Revolved
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.settings import TurningSettings
from trunnion.progress import NO_PROGRESS

SHOP = own_shop()
RING = np.array(
    [(94, 0), (120, 0), (120, 10), (100, 10), (100, 90), (120, 90), (120, 100), (94, 100)], float
)
"""A ring of radius 94 to 100 between flanges of radius 120: r and z in mm, z from its lower end."""
BLANK = np.array([(92, 0), (125, 0), (125, 102), (92, 102)], float)
HELD = 8.0
"""mm: what holds the ring reaches so high."""
STRONG, SLENDER = "DCLNR2525M12 CNMG120412", "DDJNR2525M15 DNMG150608"
BACK, BAR = "DDJNL2525M15 DNMG150608", "S25T-PCLNR12 CNMG120412"
WORK = (
    ("face", STRONG, 100.0),
    ("outside", SLENDER, HELD),
    ("outside", BACK, HELD),
    ("inside", BAR, HELD),
)
"""What turns the ring: side, tool, and the lowest height of its point."""
SETUP = Setup(
    name="S1", frame=WORLD, work_offset="G54", clearance=130.0, machine="Vertical lathe 600"
)


def turned_over(height: float = 100.0) -> Frame:
    """Return the frame of the ring turned over: its z points down along the work's, from a height of it."""
    return Frame(
        np.array([0.0, 0.0, height]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    )


def blank_of(outline: np.ndarray = BLANK) -> Revolved:
    """Return the blank of revolution of an outline."""
    return Revolved(frame=WORLD, outline=outline, material="EN AW-7075", density=2.8)


def ring_area(outline: np.ndarray = RING) -> shapely.Polygon:
    """Return an outline as a meridian."""
    return shapely.Polygon(outline)


def turning_tool(name: str, number: int = 1) -> TurningTool:
    """Return a tool of the catalogue with a number."""
    from dataclasses import replace

    return replace(SHOP.turning_tool(name), number=number)


def data_of(depth: float = 3.0, feed: float = 0.3) -> CuttingData:
    """Return data of turning at 350 m/min, at most 1000 1/min."""
    return CuttingData(
        speed=350.0,
        spindle=450.0,
        feed_per_tooth=feed,
        feed=450.0 * feed,
        plunge_feed=50.0,
        depth=depth,
        width=feed,
        removal_rate=350.0 * feed * depth,
        power=5.0,
        power_limit=37.0,
        torque=1.0,
        spindle_mode=SpindleMode.SURFACE,
        highest_spindle=1000.0,
        feed_mode=FeedMode.REVOLUTION,
    )


def laid(
    strategy,
    side: str,
    tool: TurningTool,
    lowest: float,
    stock: Revolved,
    depth: float = 3.0,
    **choices,
):
    """Return the path of a strategy on the ring, for a depth of cut."""
    settings = TurningSettings(side=side, lowest=lowest, floor=min(lowest, HELD), **choices)
    drive = RevolvedDrive(part=RING, to_cut=1.0)
    return strategy(drive, tool, data_of(depth), stock, SETUP, settings, NO_PROGRESS).path
