"""The bevel of a rim: one round of a conical cutter whose flank leans as the bevel does."""

from __future__ import annotations

import math
from dataclasses import dataclass

from trunnion.findings import error
from trunnion.model.motion.toolpath import Mark
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder

SAME_ANGLE = 0.01
"""Degrees by which flank and bevel may differ: 2 um on a bevel of 10 mm."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BevelDrive:
    """A cone about the z axis through `centre` (x, y) of the setup frame: from `radius` at `foot` up to `top`, mm, `angle` degrees to z."""

    centre: tuple[float, float]
    radius: float
    foot: float
    top: float
    angle: float

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to cut."""
        return self.top <= self.foot


@settings("disc.bevel")
class BevelSettings:
    """How a bevel is cut."""

    below: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Below the bevel",
        help="How far the tip reaches below its foot.",
    )
    lead: float = setting(
        5.0,
        unit="mm",
        low=0.5,
        high=50.0,
        label="Lead",
        help="Way from outside onto the bevel and off it.",
    )


@strategy(settings=BevelSettings, drive=BevelDrive)
def bevel(drive, tool, data, stock, setup, settings, progress):
    """Return one climbing round about the bevel, or the finding that the cutter doesn't fit it."""
    progress.at(0.0, "bevel")
    if tool.form != "taper" or abs(tool.taper_angle - drive.angle) > SAME_ANGLE:
        wrong = error(
            "disc.angle",
            f"{tool.name} leans by {tool.taper_angle:g} degrees, the bevel by {drive.angle:g}: it stays",
            remedy="choose a cutter with the bevel's angle",
        )
        return Planned(findings=(wrong,))
    tip = drive.foot - settings.below
    if tip + tool.flute_length < drive.top:
        short = error(
            "disc.flutes",
            f"{tool.name} is too short for the bevel: it stays",
            remedy="choose a longer one",
        )
        return Planned(findings=(short,))
    slope = math.tan(math.radians(drive.angle))
    radius = drive.radius + tool.radius + settings.below * slope
    (x, y), builder = drive.centre, PathBuilder(tool, data, stock, setup, 0.0)
    start, outside = (x + radius, y, tip), (x + radius + settings.lead, y, tip)
    builder.rapid((*outside[:2], setup.clearance))
    builder.line(outside, data.plunge_feed, Mark.ENTRY)
    builder.line(start, data.feed, Mark.LEAD)
    for half in ((x - radius, y, tip), start):
        builder.arc(half, (x, y), -math.pi, data.feed)
    builder.line(outside, data.feed, Mark.LEAD)
    progress.at(1.0, "bevel")
    return Planned(path=builder.finished())
