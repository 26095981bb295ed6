"""Interrupted turning made by hand: a round insert, ground of revolution and passes with gaps, for tests of paths, texts and proof."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import samples
from programs import HOLDER
from seeded.casings import short_ring
from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD
from trunnion.model.operation import CuttingData
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.pipeline import Engine
from trunnion.plan.turning.gap_drive import GapDrive, GapPass
from trunnion.toolpath.turning.interrupted import GapSettings

RING = {"setup.machine": "Mill-turn 1250", "casing.regions.surface_speed": 8.0}
"""Choices for a ring of 24 mm: only at a low speed is there time to get out of its gaps."""


@cache
def ring_with_gaps(until: str = "toolpath") -> tuple[Engine, Session]:
    """Return an engine and the session of a short ring with two bosses, the gaps between them turned, after a step."""
    engine = Engine()
    session = engine.open(samples.written(short_ring(), name="ring"))
    session = engine.with_choices(session, {**RING, "recognize.family": "casing"})
    return engine, engine.run(session, until=until)


BUTTON_12 = Tool(
    number=9,
    name="button 12",
    form="button",
    diameter=12.0,
    corner_radius=6.0,
    flute_length=6.0,
    neck_diameter=11.0,
    neck_length=28.0,
    shank_diameter=30.0,
    stickout=60.0,
    gauge_length=135.0,
    teeth=1,
    centre_cutting=True,
    helix_angle=0.0,
    holder=HOLDER,
)
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=200.0, machine="Mill-turn 1250")
SETTINGS = GapSettings(
    retract_speed=20.0, acceleration=3000.0, margin=4.0, shortest=30.0, threshold=0.0, chord=0.004
)


def gap_data(speed: float = 30.0, feed: float = 0.5, depth: float = 0.3) -> CuttingData:
    """Return data at a speed (m/min), a feed (mm a revolution) and a depth (mm)."""
    return CuttingData(
        speed=speed,
        spindle=30.0,
        feed_per_tooth=feed,
        feed=1000.0 * speed,
        plunge_feed=1000.0 * speed,
        depth=depth,
        width=feed,
        removal_rate=speed * feed * depth,
        power=0.1,
        power_limit=30.0,
        torque=10.0,
    )


def ground(radius: float = 200.0, slope: float = 0.0) -> Development:
    """Return ground about z."""
    return Development(frame=WORLD, radius=radius, height=0.0, slope=slope, middle=0.3)


def drive(*passes: GapPass, on: Development | None = None) -> GapDrive:
    """Return the drive of passes."""
    return GapDrive(development=on or ground(), passes=passes, clearance=60.0)


def two_gaps(along: float, lift: float = 15.0) -> GapPass:
    """Return a pass with two gaps, one of them over the end of the plane."""
    return GapPass(along=along, lift=lift, gaps=((-1.0, 0.9), (1.6, 4.2)))


def slower(settings: GapSettings, speed: float, acceleration: float) -> GapSettings:
    """Return settings with another speed (m/min) and acceleration (mm/s2) of retracting."""
    return replace(settings, retract_speed=speed, acceleration=acceleration)
