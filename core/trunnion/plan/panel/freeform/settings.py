"""What a person may choose about leaning walls and curved floors of pockets."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("leaning")
class LeaningSettings:
    """How pockets with leaning walls or curved floors are roughed, and how fine they are finished."""

    scallop: float = setting(
        0.01,
        unit="mm",
        low=0.0002,
        high=1.0,
        label="Scallop height",
        help="Height of the ridges between passes on leaning walls, their fillets and curved floors.",
    )
    share: float = setting(
        0.97,
        unit="of the area",
        low=0.5,
        high=1.0,
        label="Reach",
        help="Share of the walls that their cutter must reach of what any cutter does; a smaller one finishes the rest.",
    )
    step: float = setting(
        0.5,
        unit="mm",
        low=0.05,
        high=10.0,
        label="Steps of roughing",
        help="How far the layers of roughing stand out from one another on the wall that leans most.",
    )
    layer: float = setting(
        1.5,
        unit="mm",
        low=0.05,
        high=50.0,
        label="Layer over curved floors",
        help="Largest height of the layers that rough a pocket with a curved floor: the steps it leaves are as high.",
    )
    semi_allowance: float = setting(
        0.1,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Semi-finishing allowance",
        help="What semi-finishing leaves on curved floors for the last cut; 0: they are finished at once.",
    )
    semi_scallop: float = setting(
        0.05,
        unit="mm",
        low=0.001,
        high=2.0,
        label="Semi-finishing scallop",
        help="Height of the ridges that semi-finishing leaves on its allowance.",
    )
    swarf: bool = setting(
        True,
        label="Walls by the flank",
        help="Where the machine has rotary axes leaning walls are swarf milled; else they are finished level by level.",
    )
    steep: float = setting(
        60.0,
        unit="deg",
        low=10.0,
        high=84.0,
        label="Steep from",
        help="Over curved floors, what leans from level by more is cut level by level.",
    )
    cell: float = setting(
        0.25,
        unit="mm",
        low=0.05,
        high=5.0,
        label="Map cell",
        help="Distance of the places at which roughing measures how high the part stands in a pocket.",
    )
