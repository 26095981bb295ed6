"""Random casings with truth by construction: a cylinder or cone between flanges, with a ring rib or without, bosses of all outlines close
together or apart, tilted, filleted, drilled, cut by the rib; on the part's own axis or askew, far away, mirrored, in millimetres or inches.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import cadquery as cq
import numpy as np

LEAST_HOLE, HOLE_STEP = 3.0, 0.5
"""mm: the smallest hole through a boss, and the step of holes' diameters: sizes that drills are sold in."""
OUTLINES = ("circle", "rectangle", "slot", "triangle", "lobe")
SIDES = {"circle": 1, "rectangle": 8, "slot": 4, "triangle": 6, "lobe": 6}
"""Side faces of a boss by its outline."""
MOST_DRAWS = 10
"""Draws of a seed until its solid is valid: fillets round a closed foot often are not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeBoss:
    """A boss as it was made: angle (degrees from the maker's x) and height (mm) of its middle on the ground, and its sizes in mm."""

    outline: str
    theta: float
    z: float
    height: float
    tilt: float
    fillet: float
    sizes: tuple[float, ...]
    hole: float
    cut: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeCasing:
    """A random casing: its solid, the unit of its file, its bosses, and how many features of each kind it has."""

    name: str
    shape: Any
    unit: str
    bosses: tuple[MadeBoss, ...]
    counts: dict[str, int]
    mirrored: bool

    def written(self, folder: Path) -> Path:
        """Return its STEP file in a folder."""
        from trunnion.part.write import write_step

        path = folder / f"{self.name}.step"
        write_step(self.shape, path, unit=self.unit)
        return path


@dataclass(frozen=True, slots=True, kw_only=True)
class Shell:
    """The body of a casing: radius (mm) of its ground at z = 0 and change of it over z, length, wall, flanges and the rib in the middle."""

    radius: float
    slope: float
    length: float
    wall: float
    flange: float
    rim: float
    rib: float

    @property
    def grounds(self) -> list[tuple[float, float]]:
        """Heights between which the ground is free: one stretch, or two beside the rib."""
        low, high, middle = self.flange, self.length - self.flange, 0.5 * self.length
        half = 0.5 * self.flange
        return [(low, middle - half), (middle + half, high)] if self.rib else [(low, high)]

    def at(self, z: float) -> float:
        """Return the radius of the ground at a height."""
        return self.radius + self.slope * z

    def solid(self) -> Any:
        """Return the body, still filled inside."""
        stretches = self.grounds
        points = [(0.0, 0.0), (self.at(0.0) + self.rim, 0.0)]
        for n, (low, high) in enumerate(stretches):
            before = self.rib if n else self.rim
            points += [(self.at(low) + before, low), (self.at(low), low), (self.at(high), high)]
            after = self.rib if n + 1 < len(stretches) else self.rim
            points.append((self.at(high) + after, high))
        points += [(self.at(self.length) + self.rim, self.length), (0.0, self.length)]
        return _revolved(points)

    def bore(self) -> Any:
        """Return what is inside."""
        low, high = self.at(0.0) - self.wall, self.at(self.length) - self.wall
        return _revolved([(0.0, 0.0), (low, 0.0), (high, self.length), (0.0, self.length)])


def _revolved(points: list[tuple[float, float]]) -> Any:
    return cq.Workplane("XZ").polyline(points).close().revolve(360, (0, 0, 0), (0, 1, 0))


def casing(seed: int, most: int = 8) -> MadeCasing:
    """Return the random casing of a seed, with at most so many bosses on each stretch of its ground: the first of its draws in whose file
    the kernel finds no fault."""
    for number in range(MOST_DRAWS):
        try:
            made = _drawn(seed, Random(f"casing {seed}, draw {number}"), most)
        except Exception as reason:  # fillets fail in errors of several kinds
            del reason
            continue
        if _is_sound(made):
            return made
    raise ValueError(f"casing {seed}: {MOST_DRAWS} draws gave no valid solid")


@cache
def small_casing() -> Any:
    """Return a small casing with three bosses, one of them drilled, and a flange at either end."""
    shell = Shell(radius=40.0, slope=0.0, length=50.0, wall=3.0, flange=5.0, rim=9.0, rib=0.0)
    bosses = [
        MadeBoss(
            outline=outline,
            theta=theta,
            z=25.0,
            height=5.0,
            tilt=0.0,
            fillet=0.0,
            sizes=sizes,
            hole=hole,
        )
        for outline, theta, sizes, hole in (
            ("circle", 20.0, (7.0, 7.0), 5.0),
            ("rectangle", 60.0, (12.0, 14.0, 2.0), 0.0),
            ("lobe", 200.0, (5.0, 3.0, 3.5), 0.0),
        )
    ]
    body = shell.solid()
    for boss in bosses:
        body = _with_boss(body, shell, boss)
    return body.cut(shell.bore()).cut(_drilled(shell, bosses[0])).val().wrapped


@cache
def short_ring(theta: float = 20.0, z: float = 13.0) -> Any:
    """Return a short ring with two bosses, one of them drilled, and a flange at either end: the least that all of a casing's operations are
    on. The drilled boss is at an angle (degrees) and a height (mm): off the middle it is nearer to a flange."""
    shell = Shell(radius=24.0, slope=0.0, length=26.0, wall=3.0, flange=4.0, rim=5.0, rib=0.0)
    bosses = [
        MadeBoss(
            outline=outline,
            theta=angle,
            z=height,
            height=3.0,
            tilt=0.0,
            fillet=0.0,
            sizes=sizes,
            hole=hole,
        )
        for outline, angle, height, sizes, hole in (
            ("circle", theta, z, (4.0, 4.0), 4.0),
            ("rectangle", 200.0, 13.0, (7.0, 7.0, 2.0), 0.0),
        )
    ]
    body = shell.solid()
    for boss in bosses:
        body = _with_boss(body, shell, boss)
    return body.cut(shell.bore()).cut(_drilled(shell, bosses[0])).val().wrapped


@cache
def bolted_ring() -> Any:
    """Return a ring with two bosses and a bolt circle in each flange: the upper flange hangs over the lower one's bolts."""
    shell = Shell(radius=34.0, slope=0.0, length=90.0, wall=3.0, flange=5.0, rim=16.0, rib=0.0)
    body = shell.solid()
    for theta in (20.0, 200.0):
        boss = MadeBoss(
            outline="circle",
            theta=theta,
            z=45.0,
            height=3.0,
            tilt=0.0,
            fillet=0.0,
            sizes=(5.0, 5.0),
            hole=0.0,
        )
        body = _with_boss(body, shell, boss)
    return _bolted(body.cut(shell.bore()), shell, 6).val().wrapped


@cache
def ribbed_ring() -> Any:
    """Return a ring with a rib in the middle and a boss that the rib cuts in two, a round boss beside it."""
    shell = Shell(radius=34.0, slope=0.0, length=60.0, wall=3.0, flange=5.0, rim=10.0, rib=9.0)
    body = shell.solid()
    for outline, theta, z, sizes, cut in (
        ("rectangle", 20.0, 30.0, (12.0, 24.0, 2.0), True),
        ("circle", 160.0, 15.0, (5.0, 5.0), False),
    ):
        boss = MadeBoss(
            outline=outline,
            theta=theta,
            z=z,
            height=4.0,
            tilt=0.0,
            fillet=0.0,
            sizes=sizes,
            hole=0.0,
            cut=cut,
        )
        body = _with_boss(body, shell, boss)
    return body.cut(shell.bore()).val().wrapped


def _bolted(body: Any, shell: Shell, count: int) -> Any:
    """Return a casing with holes of D6 in the middle of both flanges, along its axis."""
    for at, high in ((0.0, shell.at(0.0)), (shell.length - shell.flange, shell.at(shell.length))):
        circle = cq.Workplane("XY").workplane(offset=at - 1.0)
        around = circle.polarArray(high + 0.5 * shell.rim, 0.0, 360.0, count)
        body = body.cut(around.circle(3.0).extrude(shell.flange + 2.0))
    return body


def _is_sound(made: MadeCasing) -> bool:
    """Return whether a casing's file holds a solid without faults."""
    with tempfile.TemporaryDirectory() as folder:
        read = cq.importers.importStep(str(made.written(Path(folder))))
    return all(solid.isValid() for solid in read.solids().vals())


def _drawn(seed: int, draw: Random, most: int) -> MadeCasing:
    radius = draw.uniform(80.0, 300.0)
    shell = Shell(
        radius=radius,
        slope=draw.choice((0.0, 0.0, draw.uniform(0.05, 0.25))),
        length=draw.uniform(110.0, 200.0),
        wall=draw.uniform(4.0, 9.0),
        flange=draw.uniform(8.0, 14.0),
        rim=draw.uniform(16.0, 24.0),
        rib=draw.choice((0.0, 15.0)),
    )
    bosses: list[MadeBoss] = []
    for ground in shell.grounds:
        bosses += _row(draw, shell, ground, most)
    if shell.rib and shell.slope == 0.0 and draw.random() < 0.6:
        bosses.append(_crossing(draw, shell, bosses))
    body = shell.solid()
    for boss in bosses:
        body = _with_boss(body, shell, boss)
    body = body.cut(shell.bore())
    bolts = draw.choice((0, 12, 20))
    for boss in bosses:
        if boss.hole:
            body = body.cut(_drilled(shell, boss))
    if bolts:
        body = _bolted(body, shell, bolts)
    pieces = sum(2 if b.cut else 1 for b in bosses)
    counts = {
        "boss": pieces,
        "hole": sum(1 for b in bosses if b.hole) + 2 * bolts,
        "pocket": len(shell.grounds),
        "profile": 2 if shell.rib else 1,
    }
    mirrored = draw.random() < 0.3
    shape = body.val()
    if mirrored:
        shape = shape.mirror("XZ")
    return MadeCasing(
        name=f"casing-{seed}",
        shape=_placed(draw, shape).wrapped,
        unit=draw.choice(("mm", "mm", "inch")),
        bosses=tuple(bosses),
        counts={k: v for k, v in counts.items() if v},
        mirrored=mirrored,
    )


def _placed(draw: Random, shape: Any) -> Any:
    """Return a solid where it was drawn, askew, or far from the origin."""
    how = draw.choice(("drawn", "askew", "far"))
    if how == "drawn":
        return shape
    axis = cq.Vector(*(draw.gauss(0.0, 1.0) for _ in range(3)))
    turned = shape.rotate(cq.Vector(0, 0, 0), axis, draw.uniform(10.0, 350.0))
    reach = 20_000.0 if how == "far" else 400.0
    return turned.translate(cq.Vector(*(draw.uniform(-reach, reach) for _ in range(3))))


def _row(draw: Random, shell: Shell, ground: tuple[float, float], most: int) -> list[MadeBoss]:
    """Return bosses round a stretch of ground, each at a random gap behind the one before."""
    found: list[MadeBoss] = []
    room = 0.5 * (ground[1] - ground[0]) - 4.0
    cursor, used = draw.uniform(0.0, 2.0), 0.0
    while len(found) < most:
        outline = draw.choice(OUTLINES)
        sizes, reach = _sizes(draw, outline, min(room - 6.0, 0.16 * shell.radius, 32.0))
        tilt = draw.choice((0.0, 0.0, draw.uniform(3.0, 9.0)))
        fillet = draw.choice((0.0, 0.0, 0.0, 2.5)) if not tilt else 0.0
        gap = draw.choice((draw.uniform(3.0, 8.0), draw.uniform(10.0, 60.0))) + 2.0 * fillet
        height = (
            draw.uniform(5.0, 11.0) + 0.2 * reach * bool(tilt) + reach**2 / (2.0 * shell.radius)
        )
        turn = (reach + gap + 3.0 + fillet) / shell.at(ground[0])
        used += turn + reach / shell.at(ground[0])
        if used > 2.0 * np.pi - 2.0 * (reach + 8.0) / shell.radius:
            break
        cursor += turn
        z = draw.uniform(ground[0] + reach + 5.0 + fillet, ground[1] - reach - 5.0 - fillet)
        hole = draw.choice((0.0, _drillable(0.35 * min(sizes[:2]))))
        found.append(
            MadeBoss(
                outline=outline,
                theta=float(np.degrees(cursor)) % 360.0,
                z=z,
                height=height,
                tilt=tilt,
                fillet=fillet,
                sizes=sizes,
                hole=hole,
            )
        )
        cursor += reach / shell.at(ground[0])
    return found


def _drillable(diameter: float) -> float:
    return max(HOLE_STEP * round(diameter / HOLE_STEP), LEAST_HOLE)


def _sizes(draw: Random, outline: str, most: float) -> tuple[tuple[float, ...], float]:
    """Return sizes of an outline that fits a circle of a radius, and the radius that it needs."""
    reach = draw.uniform(0.6, 1.0) * most
    if outline == "circle":
        return (reach, reach), reach
    if outline == "rectangle":
        a, b = 1.3 * reach, draw.uniform(1.0, 1.5) * reach
        return (a, b, 0.2 * reach), float(np.hypot(0.5 * a, 0.5 * b))
    if outline == "slot":
        return (2.0 * reach, 0.9 * reach), reach
    if outline == "triangle":
        return (reach, reach, 0.2 * reach), reach
    return (0.5 * reach, 0.3 * reach, 0.35 * reach), 0.8 * reach


def _crossing(draw: Random, shell: Shell, bosses: list[MadeBoss]) -> MadeBoss:
    """Return a rectangle that the rib cuts into two bosses, across from where the others begin and out of their way."""
    taken = sorted(b.theta for b in bosses)
    gaps = [
        ((b - a) % 360.0 or 360.0, a)
        for a, b in zip(taken, [*taken[1:], taken[0] + 360.0], strict=True)
    ]
    wide, at = max(gaps)
    return MadeBoss(
        outline="rectangle",
        theta=(at + 0.5 * wide) % 360.0,
        z=0.5 * shell.length,
        height=7.0,
        tilt=0.0,
        fillet=0.0,
        sizes=(min(16.0, 0.12 * shell.radius), shell.flange + 22.0, 2.0),
        hole=0.0,
        cut=True,
    )


def plane_of(shell: Shell, boss: MadeBoss) -> Any:
    """Return the plane of a boss's top: u around the axis, its normal out."""
    turn = np.radians(boss.theta)
    away = np.array([np.cos(turn), np.sin(turn), 0.0])
    around = np.array([-np.sin(turn), np.cos(turn), 0.0])
    ground = shell.at(boss.z) * away + np.array([0.0, 0.0, boss.z])
    normal = away - shell.slope * np.array([0.0, 0.0, 1.0])
    normal /= np.linalg.norm(normal)
    lean = np.radians(boss.tilt)
    normal, around = (
        np.cos(lean) * normal + np.sin(lean) * around,
        np.cos(lean) * around - np.sin(lean) * normal,
    )
    return cq.Plane(
        origin=tuple(ground + boss.height * normal), xDir=tuple(around), normal=tuple(normal)
    )


def _with_boss(body: Any, shell: Shell, boss: MadeBoss) -> Any:
    plane = plane_of(shell, boss)
    deep = boss.height + 0.5 * shell.wall + max(boss.sizes) ** 2 / (2.0 * shell.radius) + 4.0
    prism = outline_of(cq.Workplane(plane), boss).extrude(-deep)
    if not boss.fillet:
        return body.union(prism)
    before = {_key(e) for e in body.edges().vals()}
    joined = body.union(prism)
    top = cq.Vector(*plane.origin.toTuple())
    normal = cq.Vector(*plane.zDir.toTuple())
    foot = [
        e
        for e in joined.edges().vals()
        if _key(e) not in before
        and (e.Center() - top).dot(normal) < -0.6 * boss.height
        and abs(e.positionAt(0.0).sub(e.positionAt(1.0)).dot(normal)) < 0.6 * boss.height
        and (e.positionAt(0.5) - top).dot(normal) < -0.6 * boss.height
        and (e.positionAt(0.0) - top).Length < 3.0 * max(boss.sizes) + deep
    ]
    return cq.Workplane(joined.val().fillet(boss.fillet, foot))


def _key(edge: Any) -> tuple[float, ...]:
    return tuple(round(v, 3) for v in (*edge.Center().toTuple(), edge.Length()))


def outline_of(work: Any, boss: MadeBoss) -> Any:
    """Return a workplane with the outline of a boss drawn on it."""
    s = boss.sizes
    if boss.outline == "circle":
        return work.circle(s[0])
    if boss.outline == "rectangle":
        return work.placeSketch(cq.Sketch().rect(s[0], s[1]).vertices().fillet(s[2]))
    if boss.outline == "slot":
        return work.slot2D(s[0], s[1])
    if boss.outline == "triangle":
        corners = [
            (s[0] * np.cos(a), s[0] * np.sin(a)) for a in np.radians([90.0, 210.0, 330.0, 90.0])
        ]
        return work.placeSketch(cq.Sketch().polygon(corners).vertices().fillet(s[2]))
    return _lobes(work, *s)


def _lobes(work: Any, distance: float, lobe: float, hollow: float, count: int = 3) -> Any:
    """Draw lobes of a radius at a distance from the middle, with hollow arcs tangent to both neighbours between them."""
    half = np.pi / count
    across = distance * np.sin(half)
    middle = distance * np.cos(half) + np.sqrt((lobe + hollow) ** 2 - across**2)

    def polar(r: float, a: float) -> np.ndarray:
        return r * np.array([np.cos(a), np.sin(a)])

    centres = [polar(distance, 2.0 * half * k) for k in range(count)]
    between = [polar(middle, 2.0 * half * k + half) for k in range(count)]

    def touch(c: np.ndarray, b: np.ndarray) -> np.ndarray:
        return c + lobe * (b - c) / np.linalg.norm(b - c)

    path = work.moveTo(*touch(centres[0], between[-1]))
    for k in range(count):
        c, b, after = centres[k], between[k], centres[(k + 1) % count]
        path = path.threePointArc(tuple(polar(distance + lobe, 2.0 * half * k)), tuple(touch(c, b)))
        path = path.threePointArc(
            tuple(polar(middle - hollow, 2.0 * half * k + half)), tuple(touch(after, b))
        )
    return path.close()


def _drilled(shell: Shell, boss: MadeBoss) -> Any:
    deep = boss.height + shell.wall + max(boss.sizes) + 10.0
    return cq.Workplane(plane_of(shell, boss)).circle(0.5 * boss.hole).extrude(-deep)
