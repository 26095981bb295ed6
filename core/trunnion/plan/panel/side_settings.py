"""What a shop may choose when panels are cut from both sides."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("route.sides")
class SidesSettings:
    """How panels are cut from two sides."""

    thin_web: float = setting(
        3.0,
        unit="mm",
        low=0.0,
        high=100.0,
        label="Thin web",
        help="A floor with a pocket behind it that is thinner than this is told of: it has no support when it is cut. "
        "3 mm is shop practice, no standard's figure.",
    )
    halves: bool = setting(
        True,
        label="Half from each side",
        help="Whether holes and outlines that are too deep for every tool are cut half from each side.",
    )
