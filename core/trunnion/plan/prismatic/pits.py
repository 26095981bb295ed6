"""Pits: recesses in the wall of a pocket, under material, and where the axis of a T-slot cutter may be that cuts them.

The disc comes down in the pocket, where nothing is over it, and goes under the material from the side, as far as its neck stays off what
is over the pit. All heights and regions are in the frame of a setup.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.lean import POCKETS
from trunnion.plan.prismatic.regions import NEAR, SetupSpace, number, parent_of, touching
from trunnion.recognize.grow import bend_radius
from trunnion.settings import setting, settings

PIT = "pit"
"""Kind of feature, and of the operation that cuts it."""


@settings("plane.pit")
class PitSettings:
    """How pits in walls are cut. Width and depth of cut come with the cutting data."""

    clearance: float = setting(
        0.2,
        unit="mm",
        low=0.05,
        high=10.0,
        label="Clearance",
        help="What neck, shank and holder keep off the part, and the disc off the walls where it comes down.",
    )
    slot_feed: float = setting(
        0.5,
        unit="of feed",
        low=0.1,
        high=1.0,
        label="Feed into the material",
        help="Share of the feed on the way from the pocket into the material, square to the wall.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.1,
        high=50.0,
        label="Safety distance",
        help="Distance above the material where feed begins.",
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PitSpace:
    """A pit between its `floor` and its `roof` (mm): `wanted` is what of its plan area lies under material, `beside` where nothing of the
    part is at its heights, `over` where nothing is above it, as far as the part's `top`; `fillet` the radius (mm) between its walls and
    floor and roof, 0: sharp."""

    floor: float
    roof: float
    top: float
    wanted: Region
    beside: Region
    over: Region
    fillet: float

    @property
    def height(self) -> float:
        """From floor to roof, mm."""
        return self.roof - self.floor


def pit_space(feature: Feature, space: SetupSpace) -> PitSpace:
    """Return a pit as a setup sees it; raise `Refused` where a T-slot cutter can't cut it whatever its size."""
    owner = parent_of(feature, space.recognition)
    if owner is None or owner.kind not in POCKETS:
        raise Refused(
            f"{feature.id}: it is not in the wall of a pocket, where a T-slot cutter could come down beside it"
        )
    floor, roof = sorted(space.height_in(feature, number(feature, name)) for name in ("z0", "z1"))
    if not _is_level(feature, floor, space) or not _is_level(feature, roof, space):
        raise Refused(f"{feature.id}: its floor or its roof is not level")
    own = space.plan_box(feature)
    if not own:
        raise Refused(f"{feature.id}: it has no plan area; correct the feature")
    low, high = own.box()
    window = Region.rectangle(*(low - NEAR), *(high + NEAR))
    margin = tolerance.OFF_PLANE
    over = space.free_near(roof + margin, own)
    # Fillets at its floor and its roof are suppressed; beside the pit, what stands at any of its heights counts.
    ends = space.section(floor + margin).union(space.section(roof - margin))
    near = own.offset(margin)
    material = space.section(0.5 * (floor + roof)).union(ends.minus(near))
    beside = touching(window.minus(material), own)
    wanted = touching(beside.minus(over).intersect(near), own)
    if not wanted:
        raise Refused(f"{feature.id}: no free space is found in it; correct the feature")
    return PitSpace(
        floor=floor,
        roof=roof,
        top=space.top,
        wanted=wanted,
        beside=beside,
        over=over,
        fillet=_fillet(feature, space),
    )


def _is_level(feature: Feature, z: float, space: SetupSpace) -> bool:
    """Return whether a level face of a feature lies at a height."""
    graph, frame = space.part.graph(), space.setup.frame
    rows = [tag - 1 for tag in feature.tags if graph.surface[tag - 1] == "plane"]
    up = np.abs(frame.local_direction(graph.normal[rows])[:, 2]) > math.cos(tolerance.ANGLE)
    heights = frame.to_local(graph.centre[rows])[:, 2]
    return bool((up & (np.abs(heights - z) < tolerance.SEW)).any())


def _fillet(feature: Feature, space: SetupSpace) -> float:
    """Return the largest radius along the floor and the roof of a pit, 0 where its edges there are sharp: of hollow faces about level
    axes."""
    graph, frame = space.part.graph(), space.setup.frame
    found = [0.0]
    for tag in feature.tags:
        row = tag - 1
        if graph.bend[row] < 0.0 and graph.surface[row] in ("cylinder", "torus"):
            level = abs(float(frame.local_direction(graph.axis[row])[2])) < math.sin(
                tolerance.ANGLE
            )
            # The tube of a torus about an upright axis is a fillet round a corner.
            if level or graph.surface[row] == "torus":
                found.append(bend_radius(graph, row))
    return max(r for r in found if math.isfinite(r))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PitReach:
    """Where the axis of a T-slot cutter may be in a pit: `axis`, and of that `outside` where nothing is over the disc, so that it may come
    down there; `covered` is what of the pit's area the disc gets to."""

    axis: Region
    outside: Region
    covered: Region

    @staticmethod
    def of(
        wanted: Region,
        beside: Region,
        over: Region,
        deep: float,
        tool: Tool,
        clearance: float,
    ) -> PitReach:
        """Return it for a cutter whose tip is at most `deep` mm under the top of what stands around, with a clearance in mm for all
        that follows its disc; the regions as `PitSpace` has them."""
        body = body_radius(tool, deep)
        axis = beside.offset(-tool.radius).intersect(over.offset(-(body + clearance)))
        axis = touching(axis, wanted.offset(tool.radius)) if axis else axis
        outside = axis.intersect(over.offset(-(tool.radius + clearance))) if axis else axis
        # Only from where it comes down does it get anywhere.
        axis = touching(axis, outside) if outside else outside
        covered = wanted.intersect(axis.offset(tool.radius + tolerance.SEW)) if axis else axis
        return PitReach(axis=axis, outside=outside, covered=covered)


def body_radius(tool: Tool, deep: float) -> float:
    """Return the largest radius in mm of what follows the disc of a T-slot cutter up to a height over its tip (mm)."""
    return max((max(r0, r1) for z0, r0, _, r1 in tool.profile() if z0 < deep), default=tool.radius)


def pit_heights(floor: float, roof: float, tool: Tool) -> tuple[float, ...]:
    """Return the heights of the tip in which a disc cuts from the roof down to the floor, the highest first.

    Discs with corner radii overlap by these: on the back stays no cusp. A disc that is thinner than the pit by nothing cuts once.
    """
    rest = roof - floor - tool.flute_length
    step = tool.flute_length - 2.0 * tool.corner_radius
    if rest <= tolerance.COINCIDENT:
        return (floor,)
    if step <= tolerance.COINCIDENT:
        step = 0.5 * tool.flute_length
    count = math.ceil(rest / step - tolerance.COINCIDENT) + 1
    return tuple(float(z) for z in np.linspace(roof - tool.flute_length, floor, count))
