"""What a shop may choose about holes: how a drill goes down, which drill counts as a hole's own."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("hole.drill")
class DrillSettings:
    """How drills go down. Speed and feed come with the cutting data."""

    breakthrough: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Breakthrough",
        help="How far a drill's full diameter goes on past the end of a through hole.",
    )
    chip_break_from: float = setting(
        3.0,
        unit="diameters",
        low=0.5,
        high=100.0,
        label="Chip breaking from",
        help="Depth over diameter from which a drill stops to break its chips.",
    )
    peck_from: float = setting(
        6.0,
        unit="diameters",
        low=0.5,
        high=100.0,
        label="Pecking from",
        help="Depth over diameter from which a drill comes out of the hole to bring its chips out.",
    )
    peck: float = setting(
        1.0,
        unit="diameters",
        low=0.1,
        high=20.0,
        label="Peck",
        help="Depth of one stroke where chips are broken or brought out.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there: the retract plane of cycles.",
    )


@settings("holes")
class HoleSettings:
    """How holes are planned."""

    diameter_tolerance: float = setting(
        0.02,
        unit="mm",
        low=0.0,
        high=1.0,
        label="Drill's diameter",
        help="Largest difference of a drill's diameter and the hole's; a hole without such a drill is milled.",
    )
    spot: bool = setting(
        False,
        label="Spot holes",
        help="Whether holes are spotted before they are drilled. Short solid carbide drills need none.",
    )
