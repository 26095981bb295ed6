"""A hole as a setup sees it, read from a feature's sizes: its mouth, the end of its full diameter, and the cone or floor below it.

The sizes are those of `docs/words.md` (hole): `x`, `y`, `top_z` of the mouth in the recognition's frame, `diameter`, `depth` from the mouth
to the end of the full diameter, `through`, and where it has them `point_angle`, `counterbore_diameter` and `counterbore_depth`,
`countersink_diameter` and `countersink_angle`; further those of stepped holes (`diameters`, `step_depths`), of conical shoulders
(`shoulder_angle`), ball-shaped bottoms (`bottom_radius`) and tapers (`taper_angle`), and of a thread that is demanded. `direction` is the
way out of the hole where that is not the frame's z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.feature import Feature
from trunnion.model.tool.drill import point_height
from trunnion.units import trimmed

FLAT = 180.0
"""Point angle of a flat bottom, degrees."""
FLAT_WITHIN = 0.05
"""Degrees: as far as directions are held to be parallel (`tolerance.ANGLE`)."""
THREAD_SIZES = ("thread_diameter", "thread_pitch", "thread_depth")
"""Sizes of the thread that is demanded in a hole (`plan.holes.demand`)."""
BACK = "back_"
"""Stands before the names of sizes of a through hole's far end."""
NEEDED = ("x", "y", "top_z", "diameter", "depth")
"""Sizes without which nothing is known of a hole."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedHole:
    """A round recess along z of a setup: a whole hole's bore, or its counterbore.

    `x`, `y` of the axis, `top` where it begins, `bottom` where its full diameter ends, all mm in the setup's frame; below a blind one comes
    a cone of `point_angle` (degrees over both sides, 180: a flat floor). `core` is the diameter that is free around the axis when a wider
    part is cut, 0 where nothing is. `faces` are the tags that finishing it makes.
    """

    feature: str
    x: float
    y: float
    top: float
    bottom: float
    diameter: float
    through: bool
    point_angle: float = FLAT
    core: float = 0.0
    faces: tuple[int, ...] = ()

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return 0.5 * self.diameter

    @property
    def depth(self) -> float:
        """From where it begins to where its full diameter ends, mm."""
        return self.top - self.bottom

    @property
    def position(self) -> Floats:
        """Where its axis is in plan (2,)."""
        return np.array([self.x, self.y])

    @property
    def is_flat(self) -> bool:
        """Whether it is blind and ends in a flat floor."""
        return not self.through and self.point_angle >= FLAT - FLAT_WITHIN

    @property
    def point_length(self) -> float:
        """How far it goes on below its full diameter: the height of its cone; without end where it goes through."""
        if self.through:
            return math.inf
        return 0.0 if self.is_flat else point_height(self.diameter, self.point_angle)


@dataclass(frozen=True, slots=True, kw_only=True)
class Countersink:
    """The cone at a hole's mouth: its largest `diameter` mm at the mouth, and its `angle` in degrees over both sides."""

    diameter: float
    angle: float


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleThread:
    """The thread in a bore: nominal `diameter` and `pitch` mm, full down to `depth` mm below the bore's beginning, 0: as deep as may be."""

    diameter: float
    pitch: float
    depth: float


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleShape:
    """A hole's parts: the bore, and where it has them its counterbores, the narrowest and deepest first, the countersink, and the thread
    that is demanded in its bore."""

    bore: PlannedHole
    counterbores: tuple[PlannedHole, ...] = ()
    countersink: Countersink | None = None
    thread: HoleThread | None = None

    @property
    def narrow(self) -> PlannedHole:
        """The bore from where it begins to be as narrow as it is: from the floor of the deepest counterbore."""
        if not self.counterbores:
            return self.bore
        return replace(self.bore, top=self.counterbores[0].bottom)


def hole_in(feature: Feature, frame: Frame, setup: Frame) -> HoleShape:
    """Return a hole in a setup's frame; `frame` is the recognition's.

    Raises `Refused` where sizes are missing, or where the tool's axis does not run along the hole's. A plain hole that goes through is
    reached from both of its ends, one that is wider at its far end from there with what is wider there.
    """
    missing = [name for name in NEEDED if not isinstance(_word(feature, name), (int, float))]
    if missing:
        raise Refused(f"{feature.id}: nothing says its {', '.join(missing)}; correct the feature")
    x, y, top, diameter, depth = (hole_size(feature, name) for name in NEEDED)
    if diameter <= 0.0 or depth <= 0.0:
        raise Refused(f"{feature.id}: a hole's diameter and depth are above 0; correct the feature")
    if hole_size(feature, "taper_angle") > 0.0:
        raise Refused(
            f"{feature.id}: its side is tapered, which neither a drill nor an end mill makes"
        )
    out = hole_direction(feature)
    mouth = np.array([x, y, top])
    ends = setup.to_local(frame.to_world(np.stack([mouth, mouth - depth * out])))
    up = float(setup.local_direction(frame.world_direction(out))[2])
    through, wide_ends = bool(_word(feature, "through")), is_wider_behind(feature)
    if 1.0 - abs(up) > 1.0 - math.cos(tolerance.ANGLE):
        lean = math.degrees(math.acos(min(abs(up), 1.0)))
        raise Refused(
            f"{feature.id}: its axis leans by {trimmed(lean, 2)} degrees from the tool's; it needs a setup or a tool that comes along it"
        )
    if up < 0.0:
        if not through or (_is_stepped(feature) and not wide_ends):
            raise Refused(f"{feature.id}: it opens away from the tool; it needs a setup from there")
        ends = ends[::-1]
    (x, y, top), bottom = ends[0].tolist(), float(ends[1, 2])
    bore = PlannedHole(
        feature=feature.id,
        x=x,
        y=y,
        top=top,
        bottom=bottom,
        diameter=diameter,
        through=through,
        point_angle=_point_angle(feature, 0.5 * diameter),
        faces=feature.with_role("side", "bottom"),
    )
    end = BACK if up < 0.0 else ""
    return HoleShape(
        bore=bore,
        counterbores=_counterbores(feature, bore, end),
        countersink=_countersink(feature, end),
        thread=thread_of(feature),
    )


def thread_of(feature: Feature) -> HoleThread | None:
    """Return the thread that is demanded in a hole, None where there is none."""
    diameter, pitch, depth = (hole_size(feature, name) for name in THREAD_SIZES)
    if pitch <= 0.0 or diameter <= 0.0:
        return None
    return HoleThread(diameter=diameter, pitch=pitch, depth=depth)


def bore_start(feature: Feature) -> float:
    """Return how deep below a hole's mouth its narrowest bore begins, mm."""
    steps = _steps(feature, hole_size(feature, "diameter"), hole_size(feature, "depth"), "")
    return steps[0][1] if steps else 0.0


def nearer_half(shape: HoleShape) -> HoleShape:
    """Return the half of a plain through hole that lies nearer to the tool; drills go on past its end as past that of a whole one."""
    bore = shape.bore
    return HoleShape(
        bore=replace(bore, bottom=0.5 * (bore.top + bore.bottom)), counterbores=(), countersink=None
    )


def is_plain_through(feature: Feature) -> bool:
    """Return whether a hole goes through and is as wide at both ends, its thread too: it may be made from either of them."""
    return (
        bool(_word(feature, "through"))
        and hole_size(feature, "thread_depth") == 0.0
        and not _is_stepped(feature)
        and not is_wider_behind(feature)
    )


def _counterbores(feature: Feature, bore: PlannedHole, end: str) -> tuple[PlannedHole, ...]:
    return tuple(
        PlannedHole(
            feature=feature.id,
            x=bore.x,
            y=bore.y,
            top=bore.top,
            bottom=bore.top - depth,
            diameter=diameter,
            through=False,
            point_angle=hole_size(feature, f"{end}shoulder_angle", FLAT),
            core=bore.diameter,
            faces=feature.with_role("counterbore_side", "counterbore_floor"),
        )
        for diameter, depth in _steps(feature, bore.diameter, bore.depth, end)
    )


def _steps(feature: Feature, bore: float, deep: float, end: str) -> list[tuple[float, float]]:
    """Return diameter and depth of the parts wider than the `bore` (mm) at the mouth (`end` is empty) or at the far end of a hole that is
    `deep` mm, from the bore outwards.

    Of three diameters and more, `diameters` with `step_depths` tell them from the mouth down; else the counterbore's own sizes.
    """
    diameters, depths = _word(feature, "diameters"), _word(feature, "step_depths")
    if isinstance(diameters, tuple) and isinstance(depths, tuple):
        steps = list(zip(map(float, diameters), map(float, depths), strict=False))
        if end:
            begins = [0.0, *(low for _, low in steps)]
            steps = [(d, deep - low) for (d, _), low in zip(steps, begins, strict=False)]
            steps.reverse()
    else:
        names = f"{end}counterbore_diameter", f"{end}counterbore_depth"
        steps = [(hole_size(feature, names[0]), hole_size(feature, names[1]))]
    found: list[tuple[float, float]] = []
    for diameter, depth in steps:
        if diameter <= bore + tolerance.SLIVER or depth <= 0.0:
            break
        found.append((diameter, depth))
    return found[::-1]


def _countersink(feature: Feature, end: str) -> Countersink | None:
    diameter = hole_size(feature, f"{end}countersink_diameter", 0.0)
    angle = hole_size(feature, f"{end}countersink_angle", 0.0)
    return Countersink(diameter=diameter, angle=angle) if diameter > 0.0 and angle > 0.0 else None


def _point_angle(feature: Feature, radius: float) -> float:
    """Return the angle of the cone below a hole's full diameter; in a ball's cap that of the cone that fits into it."""
    ball = hole_size(feature, "bottom_radius")
    if ball < radius - tolerance.SLIVER:
        return hole_size(feature, "point_angle", FLAT)
    height = ball - math.sqrt(max(ball**2 - radius**2, 0.0))
    return math.degrees(2.0 * math.atan2(radius, height))


def is_wider_behind(feature: Feature) -> bool:
    """Return whether a hole has a counterbore or a countersink at its far end."""
    return any(
        hole_size(feature, f"{BACK}{part}_diameter", 0.0) > 0.0
        for part in ("counterbore", "countersink")
    )


def _is_stepped(feature: Feature) -> bool:
    """Return whether a hole has a wider part at its mouth."""
    return any(
        hole_size(feature, f"{part}_diameter", 0.0) > 0.0 for part in ("counterbore", "countersink")
    )


def hole_direction(feature: Feature) -> Floats:
    """Return the way out of a hole, a unit vector in the recognition's frame."""
    given = _word(feature, "direction")
    if not isinstance(given, tuple) or len(given) != 3:
        return np.array([0.0, 0.0, 1.0])
    out = np.array(given, dtype=np.float64)
    return np.asarray(out / np.linalg.norm(out))


def _word(feature: Feature, name: str) -> object:
    return feature.sizes.get(name, feature.attributes.get(name))


def hole_size(feature: Feature, name: str, default: float = 0.0) -> float:
    """Return a size of a hole that is a number, or the default."""
    value = _word(feature, name)
    return float(value) if isinstance(value, (int, float)) else default
