"""What a shop may choose about the plan library."""

from __future__ import annotations

from trunnion.settings import setting, settings

AUTOMATIC, OFF = "auto", "off"
"""Values of `use` beside the names of plans."""


@settings("route.library")
class LibrarySettings:
    """Whether a route follows a plan of the library, and from what similarity on."""

    use: str = setting(
        AUTOMATIC,
        label="Plan library",
        help="auto: the route follows the most similar plan of the library that another part has taught, where one is similar "
        "enough and no typical plan is named; off: none; else the name of the plan to follow, however similar.",
    )
    similarity: float = setting(
        0.8,
        unit="of 1",
        low=0.0,
        high=1.0,
        label="Similar enough",
        help="Least similarity of a plan's part for auto to follow it; 1: the same features, sizes, material and kind of machine.",
    )
