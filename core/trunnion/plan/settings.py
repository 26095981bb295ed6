"""What a shop may choose about every route, whatever the family."""

from __future__ import annotations

from trunnion.plan.cutting.engaged import BY_TIME, CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL
from trunnion.settings import setting, settings

HALVES = "route.sides.halves"
"""Key of an operation's choices: true where it cuts the half of its feature that lies nearer to the tool, another setup the other one."""

KEPT_KEYS = "feature."
"""How keys of an operation's choices begin that say what its features keep: the route gives them, and each change of operations anew."""


@settings("route")
class RouteSettings:
    """What a shop may choose when operations and cutters are planned."""

    plan: str = setting(
        "",
        label="Typical plan",
        help="Name of the typical plan that the route follows; empty: the family's first one, a "
        "shop's own before the program's.",
        catalogue="plans",
    )
    only_in_machine: bool = setting(
        False,
        label="Only tools in the machine",
        help="Cutters are chosen from the tool crib of the machine alone, not from the whole catalogue.",
    )
    wall_allowance: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Wall allowance",
        help="What roughing leaves on walls.",
    )
    floor_allowance: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Floor allowance",
        help="What roughing leaves on floors.",
    )
    reach_clearance: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Reach clearance",
        help="Least height of the shank over the surroundings when the tip is deepest.",
    )
    corner_share: float = setting(
        0.9,
        unit="of the corner's radius",
        low=0.1,
        high=1.0,
        label="Cutter in corners",
        help="Largest radius of a finishing cutter over the radius of the corner it goes through.",
    )
    missable: float = setting(
        0.12,
        unit="of the area",
        low=0.0,
        high=0.9,
        label="Left to rest roughing",
        help="Share of a pocket's area that the roughing cutter may leave to smaller ones.",
    )
    falling: float = setting(
        2.5,
        unit="times",
        low=1.1,
        high=20.0,
        label="Falling sizes",
        help="Largest diameter over the next smaller one in corners.",
    )
    slender: float = setting(
        6.0,
        unit="diameters",
        low=1.0,
        high=20.0,
        label="Slender walls",
        help="Stickout over diameter from which walls get a larger cutter and only the corners the slender one.",
    )
    roughing: str = setting(
        BY_TIME,
        choices=(BY_TIME, CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL),
        label="Roughing",
        help="How pockets are cleared: at a constant angle of contact, deep and narrow; by passes parallel to the walls; or as is quicker.",
    )
    largest: float = setting(
        20.0,
        unit="mm",
        low=1.0,
        high=200.0,
        label="Largest end mill",
        help="Larger ones are not chosen: what they leave in corners has to be cut once more.",
    )
