"""Thin webs: floors that have no support when they are cut, for the pocket behind them is open already."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.units import trimmed


def thin_webs(
    space: SetupSpace, features: Sequence[Feature], before: Sequence[Feature], thickness: float
) -> list[Finding]:
    """Return a warning for each pocket of a setup whose floor, thinner than a thickness (mm), is the floor of one that was cut before.

    The web between them is pressed down where nothing carries it: it gives way, and springs back thinner or thicker than it should be.
    """
    opened = [(f, _floors(space, f)) for f in before]
    found = []
    for feature in features:
        thin = [
            (z - z_behind, other, (tag, tag_behind))
            for tag, z, area in _floors(space, feature)
            for other, floors in opened
            for tag_behind, z_behind, behind in floors
            if tolerance.SEW < z - z_behind < thickness
            and area.intersect(behind).area > tolerance.AREA
        ]
        if not thin:
            continue
        least = min(web for web, _, _ in thin)
        others = dict.fromkeys(other.id for _, other, _ in thin)
        found.append(
            warning(
                "route.thin-web",
                f"{feature.id}: its floor is a web of {trimmed(least, 3)} mm, open underneath in {space.setup.name}: "
                f"{', '.join(others)} {'is' if len(others) == 1 else 'are'} cut already",
                feature.id,
                *face_tags(dict.fromkeys(tag for _, _, tags in thin for tag in tags)),
                remedy="support the web from below: a vacuum fixture, a support plate that fits the pocket, or filler poured into it",
            )
        )
    return found


def _floors(space: SetupSpace, feature: Feature) -> list[tuple[int, float, Region]]:
    """Return tag, height and plan area of a pocket's level floors, in the setup's frame."""
    graph, frame = space.part.graph(), space.setup.frame
    return [
        (tag, z, space.part.face_outline(frame, tag))
        for tag, z in space.floors_of(feature).items()
        if graph.surface[tag - 1] == "plane"
        and abs(float(frame.local_direction(graph.normal[tag - 1])[2])) > 1.0 - tolerance.PARAMETRIC
    ]
