"""Plates with holes of which nothing is a file, beside a wall or in the open: what stands around their holes, and their routes."""

from __future__ import annotations

from flat_parts import MILL, FlatPart, Prism, blank_of
from holed import HIGH
from own_shop import own_shop
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.plan.holes.hole import hole_in
from trunnion.plan.holes.tools import HoleSpace
from trunnion.plan.panel.route import RouteSettings, make_route
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose

SHOP = own_shop()


def walled(*holes, wall: float = 0.0, at: float = 40.0):
    """Return a plate 100 x 60 x 20 with holes, its ground beside a wall from x = `at` on lower by `wall` mm, and its recognition."""
    cuts = [
        Prism(
            area=Region.circle((h["x"], h["y"]), h["diameter"] / 2),
            low=h["top_z"] - h["depth"] - (1.0 if h["through"] else 0.0),
            high=HIGH + 1.0,
            face=2 * n + 2,
            side=2 * n + 3,
            at=(h["x"], h["y"]),
        )
        for n, h in enumerate(holes)
    ]
    if wall:
        n = 2 * len(holes) + 2
        ground = Region.rectangle(-10, -10, at, 70)
        cuts.append(
            Prism(area=ground, low=HIGH - wall, high=HIGH + 1, face=n, side=n + 1, at=(5, 5))
        )
    part = FlatPart(outline=Region.rectangle(0, 0, 100, 60), height=HIGH, cuts=tuple(cuts))
    features = tuple(
        Feature(
            id=f"hole-{n + 1:02}",
            kind="hole",
            faces=(FaceRole(role="side", face=2 * n + 3),),
            sizes=h,
        )
        for n, h in enumerate(holes)
    )
    return part, Recognition(family="panel", frame=WORLD, features=features)


def around(made, clearance=1.0):
    """Return what stands around the holes of a plate and its recognition, and the bore of the first hole."""
    part, recognition = made
    blank = blank_of(part)
    setup = make_setups(recognition, blank, choose(SetupSettings, MILL))[0]
    space = SetupSpace.of(part, recognition, blank, setup)
    first = hole_in(recognition.features[0], WORLD, setup.frame).bore
    return HoleSpace(space=space, clearance=clearance), first


def route(made, **choices):
    """Return the process of a plate and its recognition; `choices` by full key."""
    part, recognition = made
    blank = blank_of(part)
    setups = make_setups(recognition, blank, choose(SetupSettings, MILL))
    return make_route(
        recognition,
        (),
        blank,
        setups,
        SHOP,
        part,
        choose(RouteSettings, {}),
        NO_PROGRESS,
        choices=choices,
    )
