"""Parts without CAD for tests of planning: prisms cut out of a prism, which answer as a part does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Blank, Box
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.tool import Tool
from trunnion.settings import Value

MILL = {"machine": "Mill 1200"}
"""Settings of setups: the machine that the tests of planning stand on."""


def rounded(x0: float, y0: float, x1: float, y1: float, radius: float) -> Region:
    """Return a rectangle with rounded corners."""
    return Region.rectangle(x0, y0, x1, y1).offset(-radius).offset(radius)


@dataclass(frozen=True, slots=True, kw_only=True)
class Prism:
    """A plan area from `low` to `high`; the face at its one end has tag `face`, those of its side tag `side`."""

    area: Region
    low: float
    high: float
    face: int
    side: int
    at: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class FlatPart:
    """A plate from z 0 up, with prisms taken out of it and islands put back."""

    outline: Region
    height: float
    cuts: tuple[Prism, ...]
    islands: tuple[Prism, ...] = ()
    touching: tuple[tuple[int, int], ...] = ()
    top_face: int = 1
    asked: list[float] = field(default_factory=list)

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material at a height of a frame."""
        at = float(frame.to_world(np.array([0.0, 0.0, z]))[2])
        self.asked.append(round(at, 6))
        if not 0.0 <= at <= self.height:
            return Region()
        material = self.outline
        for cut in self.cuts:
            if cut.low < at < cut.high:
                material = material.minus(cut.area)
        for island in self.islands:
            if island.low < at < island.high:
                material = material.union(island.area)
        return _seen(material, frame)

    def face_outline(self, frame: Frame, tag: int) -> Region:
        """Return the plan area of a floor, a rib's top or an island's top."""
        for prism in (*self.cuts, *self.islands):
            if prism.face == tag:
                return _seen(prism.area, frame)
        return _seen(self.section(WORLD, self.height), frame)

    def graph(self) -> FaceGraph:
        """Return a graph that knows where faces are and which touch."""
        prisms = (*self.cuts, *self.islands)
        n = max([self.top_face, *(p.face for p in prisms), *(p.side for p in prisms)])
        centre = np.zeros((n, 3))
        centre[self.top_face - 1] = (*self.outline.box()[0], self.height)
        for p in prisms:
            through = p in self.islands or p.high < self.height
            centre[p.face - 1] = (*p.at, p.high if through else p.low)
            centre[p.side - 1] = (*p.at, 0.5 * (p.low + p.high))
        (x0, y0), (x1, y1) = self.outline.box()
        box = np.array([[x0, y0, 0.0], [x1, y1, self.height]])
        pairs = [(p.face - 1, p.side - 1) for p in prisms] + [
            (a - 1, b - 1) for a, b in self.touching
        ]
        m, nan3 = len(pairs), np.full((n, 3), np.nan)
        edge = np.tile(box[:1], (m, 1))
        return FaceGraph(
            surface=("plane",) * n,
            area=np.ones(n),
            centre=centre,
            normal=np.tile([0.0, 0.0, 1.0], (n, 1)),
            axis_point=nan3,
            axis=nan3,
            radius=np.full(n, np.nan),
            minor=np.full(n, np.nan),
            bend=np.zeros(n),
            box_low=centre,
            box_high=centre,
            sample_face=np.zeros(2),
            sample_point=box,
            sample_normal=np.tile([0.0, 0.0, 1.0], (2, 1)),
            edge_face=np.array(pairs),
            convexity=-np.ones(m),
            dihedral=np.ones(m),
            length=np.ones(m),
            edge_loop=np.zeros((m, 2)),
            curve=("line",) * m,
            start=edge,
            middle=edge,
            end=edge,
            curve_centre=np.full((m, 3), np.nan),
            curve_axis=np.full((m, 3), np.nan),
            curve_radius=np.full(m, np.nan),
        )


def _seen(region: Region, frame: Frame) -> Region:
    """Return a plan area of the world in a frame that is only moved, or turned about its x axis as well."""
    x, y = -frame.origin[:2]
    moved = region.moved(float(x), float(y))
    return moved if frame.z[2] > 0.0 else moved.mirrored(1)


def panel() -> tuple[FlatPart, Recognition]:
    """Return a panel 200 x 100 x 30: two pockets with a rib of height 22 between them and an island of height 15 in the second.

    Pocket 1: x 10 to 95, floor 5; pocket 2: x 99 to 190, floor 8; both y 10 to 90 with corners of 8 and a floor fillet of 3.
    """
    first, second = rounded(10, 10, 95, 90, 8), rounded(99, 10, 190, 90, 8)
    rib = Region.rectangle(87, 10, 107, 90).minus(first).minus(second)
    part = FlatPart(
        outline=rounded(0, 0, 200, 100, 10),
        height=30.0,
        cuts=(
            Prism(area=first, low=5, high=31, face=2, side=3, at=(50, 50)),
            Prism(area=second, low=8, high=31, face=4, side=5, at=(170, 50)),
            Prism(area=rib, low=22, high=31, face=6, side=7, at=(97, 50)),
        ),
        islands=(
            Prism(area=rounded(130, 40, 150, 60, 8), low=8, high=15, face=8, side=9, at=(140, 50)),
        ),
        touching=((6, 3), (6, 5)),
    )
    features = (
        _pocket("pocket-01", 2, 3, floor_z=5.0),
        _pocket("pocket-02", 4, 5, floor_z=8.0),
        Feature(
            id="rib-01",
            kind="rib",
            faces=(FaceRole(role="top", face=6),),
            sizes={"top_z": 22.0, "thickness": 4.0, "height": 17.0},
        ),
        Feature(
            id="island-01",
            kind="island",
            faces=(FaceRole(role="top", face=8), FaceRole(role="wall", face=9)),
            sizes={"top_z": 15.0, "in": "pocket-02"},
        ),
        Feature(
            id="profile-01",
            kind="profile",
            faces=(FaceRole(role="wall", face=7),),
            sizes={"height": 30.0, "corner_radius": 10.0},
        ),
        Feature(
            id="datum-01",
            kind="datum",
            faces=(FaceRole(role="top", face=1),),
            sizes={"top_z": 30.0, "bottom_z": 0.0},
        ),
    )
    return part, Recognition(family="panel", frame=WORLD, features=features)


def open_panel() -> tuple[FlatPart, Recognition]:
    """Return a panel 100 x 60 x 20 with one pocket, floor 10, that is open towards +x: x 20 to 100, y 10 to 50, corners of 8."""
    area = rounded(20, 10, 140, 50, 8).intersect(Region.rectangle(0, 0, 100, 60))
    part = FlatPart(
        outline=Region.rectangle(0, 0, 100, 60),
        height=20.0,
        cuts=(Prism(area=area, low=10, high=21, face=2, side=3, at=(60, 30)),),
    )
    pocket = Feature(
        id="open_pocket-01",
        kind="open_pocket",
        faces=(FaceRole(role="floor", face=2), FaceRole(role="wall", face=3)),
        sizes={
            "floor_z": 10.0,
            "top_z": 20.0,
            "corner_radius": 8.0,
            "floor_fillet": 0.0,
            "leans": (0.0,),
        },
    )
    return part, Recognition(family="panel", frame=WORLD, features=(pocket,))


def open_panel_with_island() -> tuple[FlatPart, Recognition]:
    """Return the open panel with an island of height 15 in its pocket: x 70 to 90, y 20 to 40, corners of 8."""
    part, recognition = open_panel()
    island = Feature(
        id="island-01",
        kind="island",
        faces=(FaceRole(role="top", face=4), FaceRole(role="wall", face=5)),
        sizes={"top_z": 15.0, "in": "open_pocket-01"},
    )
    standing = Prism(area=rounded(70, 20, 90, 40, 8), low=10, high=15, face=4, side=5, at=(80, 30))
    return replace(part, islands=(standing,)), replace(
        recognition, features=(*recognition.features, island)
    )


def narrow_panel() -> tuple[FlatPart, Recognition]:
    """Return a panel 200 x 100 x 25 with one pocket, x 10 to 190, y 10 to 90, floor 5, and an island 12 away from its wall."""
    part = FlatPart(
        outline=Region.rectangle(0, 0, 200, 100),
        height=25.0,
        cuts=(
            Prism(area=rounded(10, 10, 190, 90, 8), low=5, high=26, face=2, side=3, at=(30, 80)),
        ),
        islands=(
            Prism(area=rounded(90, 22, 110, 42, 9), low=5, high=15, face=4, side=5, at=(100, 32)),
        ),
    )
    island = Feature(
        id="island-01",
        kind="island",
        faces=(FaceRole(role="top", face=4), FaceRole(role="wall", face=5)),
        sizes={"top_z": 15.0, "in": "pocket-01"},
    )
    return part, Recognition(
        family="panel", frame=WORLD, features=(_pocket("pocket-01", 2, 3, floor_z=5.0), island)
    )


def stepped_panel() -> tuple[FlatPart, Recognition]:
    """Return a panel 100 x 60 x 30 with a stepped pocket: x 10 to 90, y 10 to 50, floor 15, from x 50 on floor 5, all corners of 8."""
    whole, deep = rounded(10, 10, 90, 50, 8), rounded(50, 10, 90, 50, 8)
    part = FlatPart(
        outline=Region.rectangle(0, 0, 100, 60),
        height=30.0,
        cuts=(
            Prism(area=whole.minus(deep), low=15, high=31, face=2, side=3, at=(30, 30)),
            Prism(area=deep, low=5, high=31, face=4, side=5, at=(70, 30)),
        ),
    )
    roles = (("floor", 2), ("wall", 3), ("floor", 4), ("wall", 5))
    pocket = Feature(
        id="pocket-01",
        kind="pocket",
        faces=tuple(FaceRole(role=r, face=t) for r, t in roles),
        sizes={
            "floor_z": 15.0,
            "floors_z": (15.0, 5.0),
            "top_z": 30.0,
            "corner_radius": 8.0,
            "floor_fillet": 0.0,
            "leans": (0.0,),
        },
    )
    return part, Recognition(family="panel", frame=WORLD, features=(pocket,))


def blank_of(part: FlatPart) -> Blank:
    """Return a blank with 5 mm on each side and 2 mm on top."""
    (x0, y0), (x1, y1) = part.outline.box()
    return Box(
        frame=WORLD,
        low=np.array([x0 - 5, y0 - 5, 0.0]),
        high=np.array([x1 + 5, y1 + 5, part.height + 2.0]),
        material="EN AW-7075",
        density=2.81,
    )


def operation(
    kind: str, feature: str, tool: Tool, choices: Mapping[str, Value] | None = None
) -> Operation:
    """Return an operation for tests of its drive."""
    data = CuttingData(
        speed=100,
        spindle=1000,
        feed_per_tooth=0.1,
        feed=300,
        plunge_feed=100,
        depth=1,
        width=1,
        removal_rate=1,
        power=1,
        power_limit=10,
        torque=1,
    )
    return Operation(
        id=f"{kind}-{feature}",
        kind=kind,
        strategy="plane.rough",
        feature=feature,
        setup="S1",
        tool=tool,
        data=data,
        choices=choices or {},
    )


def _pocket(id: str, floor: int, wall: int, floor_z: float) -> Feature:
    return Feature(
        id=id,
        kind="pocket",
        faces=(FaceRole(role="floor", face=floor), FaceRole(role="wall", face=wall)),
        sizes={
            "floor_z": floor_z,
            "top_z": 30.0,
            "depth": 30.0 - floor_z,
            "corner_radius": 8.0,
            "floor_fillet": 3.0,
            "leans": (0.0,),
            "lowest_rim_z": 22.0,
        },
    )
