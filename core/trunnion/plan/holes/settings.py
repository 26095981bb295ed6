"""What a shop may choose about holes: how drills, reamers, taps and thread mills go down, which drill counts as a hole's own,
and what may be demanded of a hole."""

from __future__ import annotations

from trunnion.settings import setting, settings

MILL_ALLOWANCE = "hole.mill.allowance"
"""Key of an operation's choice that holds what a milled bore keeps on its side for the reamer, mm."""
WHERE_NO_TAP, ALWAYS = "no-tap", "always"
"""When threads are milled: where no tap of the catalogue serves, or always."""


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


@settings("hole.ream")
class ReamSettings:
    """How bores are reamed. Speed and feed come with the cutting data."""

    breakthrough: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Breakthrough",
        help="How far a reamer's full diameter goes on past the end of a through hole.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there: the retract plane of cycles.",
    )


@settings("hole.fine_bore")
class FineBoringSettings:
    """How holes are bored to size. Speed and feed come with the cutting data."""

    breakthrough: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Breakthrough",
        help="How far the edge goes on past the end of a through hole.",
    )
    dwell: float = setting(
        0.0,
        unit="s",
        low=0.0,
        high=10.0,
        label="Dwell",
        help="How long the edge waits at the end of the bore before it is fed out.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there: the retract plane of cycles.",
    )


@settings("hole.tap")
class TapSettings:
    """How threads are tapped. The speed comes with the cutting data; the feed is the pitch a revolution."""

    breakthrough: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Breakthrough",
        help="How far a tap's full threads go on past the end of a through hole.",
    )
    bottom_distance: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Distance to the bottom",
        help="How far a tap stays over the end of a blind bore's full diameter: space for chips, and for what the spindle runs on.",
    )
    start_pitches: float = setting(
        3.0,
        unit="pitches",
        low=0.0,
        high=20.0,
        label="Start above the hole",
        help="How high over the hole the tap is fed from, at least: until then the feed must have come up to the pitch a revolution.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there: the retract plane of cycles.",
    )


@settings("hole.thread_mill")
class ThreadMillSettings:
    """How threads are milled. Speed, feed and depth of a radial pass come with the cutting data."""

    bottom_distance: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Distance to the bottom",
        help="How far a thread mill stays over the end of a blind bore's full diameter: space for chips.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there.",
    )


@settings("hole.demand")
class HoleDemand:
    """What a person may demand of a hole; empty words demand nothing."""

    fit: str = setting(
        "",
        label="Bore fit",
        help="Tolerance of the bore: a class of ISO 286 such as H7, or limits in mm such as +0.021/0.",
    )
    thread: str = setting(
        "",
        label="Thread",
        help="Thread in the bore: M6, M8x1, 1/4-20 UNC. The model draws the bore at the thread's core.",
    )
    thread_depth: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=1000.0,
        label="Thread depth",
        help="How deep the thread is full, from where the bore begins; 0: all through, or as deep as the bore allows.",
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
    thread_milling: str = setting(
        WHERE_NO_TAP,
        choices=(WHERE_NO_TAP, ALWAYS),
        label="Mill threads",
        help="Whether threads are milled only where no tap of the catalogue serves, or always.",
    )


HOLE_SETTINGS: tuple[type, ...] = (
    HoleSettings,
    DrillSettings,
    ReamSettings,
    FineBoringSettings,
    TapSettings,
    ThreadMillSettings,
)
"""Groups of settings that planning of holes reads."""
