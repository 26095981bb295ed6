"""Casings with milled recesses sunk into the bottoms of their pockets: by hand, and random ones with truth by construction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from random import Random
from typing import Any

import cadquery as cq
import numpy as np

from seeded.casings import (
    MadeBoss,
    MadeCasing,
    Shell,
    _bolted,
    _drilled,
    _is_sound,
    _placed,
    _revolved,
    _row,
    _with_boss,
    outline_of,
    plane_of,
)

MOST_DRAWS = 10
"""Draws of a seed until its solid is valid."""
OVER = 20.0
"""mm over the ground from which a recess is cut down."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeRecess:
    """A recess as it was made: its outline and sizes (mm) as those of a boss, angle (degrees) and height (mm) of its middle, how deep it is
    at the ends of the ground (mm), and the radius of the fillet at its foot. A `radial` one spans an angle, its walls along the normals."""

    outline: str
    theta: float
    z: float
    sizes: tuple[float, ...]
    depth: float
    fillet: float = 0.0
    radial: bool = False


def with_recess(body: Any, shell: Shell, recess: MadeRecess) -> Any:
    """Return the filled body of a casing, without bosses yet, with a recess cut into its ground."""
    tool = _radial(shell, recess) if recess.radial else _straight(shell, recess)
    low, high = 0.0, shell.length
    deep = recess.depth * np.hypot(1.0, shell.slope)
    inside = _revolved(
        [
            (0.0, low),
            (shell.at(low) - deep, low),
            (shell.at(high) - deep, high),
            (0.0, high),
        ]
    )
    tool = tool.cut(inside)
    if recess.fillet:
        foot = [
            e
            for e in tool.edges().vals()
            if all(_depth_of(shell, e.positionAt(t)) > 0.9 * recess.depth for t in (0.0, 0.5, 1.0))
        ]
        tool = cq.Workplane(tool.val().fillet(recess.fillet, foot))
    return body.cut(tool)


def _depth_of(shell: Shell, at: Any) -> float:
    """Return how deep (mm) a point lies under the ground."""
    return float((shell.at(at.z) - np.hypot(at.x, at.y)) / np.hypot(1.0, shell.slope))


def _as_boss(recess: MadeRecess) -> MadeBoss:
    return MadeBoss(
        outline=recess.outline,
        theta=recess.theta,
        z=recess.z,
        height=OVER,
        tilt=0.0,
        fillet=0.0,
        sizes=recess.sizes,
        hole=0.0,
    )


def _straight(shell: Shell, recess: MadeRecess) -> Any:
    """Return a prism along the ground's normal in the middle of a recess."""
    boss = _as_boss(recess)
    deep = OVER + recess.depth + max(recess.sizes) ** 2 / (2.0 * shell.radius) + 4.0
    return outline_of(cq.Workplane(plane_of(shell, boss)), boss).extrude(-deep)


def _radial(shell: Shell, recess: MadeRecess) -> Any:
    """Return a sector of a ring with rounded corners: all its walls go along the axis's normals."""
    wide, long = recess.sizes[:2]
    low, high = recess.z - 0.5 * long, recess.z + 0.5 * long
    points = [
        (0.5 * shell.at(low), low),
        (shell.at(low) + OVER, low),
        (shell.at(high) + OVER, high),
        (0.5 * shell.at(high), high),
    ]
    turn = float(np.degrees(wide / shell.at(recess.z)))
    ring = cq.Workplane("XZ").polyline(points).close().revolve(turn, (0, 0, 0), (0, 1, 0))
    # The sector begins at x and goes one way: its middle is turned to where the recess is.
    middle = ring.val().Center()
    now = float(np.degrees(np.arctan2(middle.y, middle.x)))
    ring = ring.rotate((0, 0, 0), (0, 0, 1), recess.theta - now)
    corners = [
        e
        for e in ring.edges().vals()
        if e.geomType() == "LINE"
        and abs(e.positionAt(0.0).z - e.positionAt(1.0).z) < 1e-6
        and abs(
            np.hypot(*e.positionAt(0.0).toTuple()[:2]) - np.hypot(*e.positionAt(1.0).toTuple()[:2])
        )
        > 5.0
    ]
    return cq.Workplane(ring.val().fillet(recess.sizes[2], corners))


def recessed(shell: Shell, recesses: list[MadeRecess], bosses: list[MadeBoss]) -> Any:
    """Return the solid of a casing with recesses and bosses."""
    body = shell.solid()
    for recess in recesses:
        body = with_recess(body, shell, recess)
    for boss in bosses:
        body = _with_boss(body, shell, boss)
    return body.cut(shell.bore())


@cache
def recessed_ring(
    slope: float = 0.0, radial: bool = False, fillet: float = 0.0, on_it: bool = True
) -> Any:
    """Return a ring with a recess, a boss on it or not, and a boss of the host beside it; the ground a cylinder or a cone."""
    shell = Shell(radius=40.0, slope=slope, length=50.0, wall=6.0, flange=4.0, rim=7.0, rib=0.0)
    recess = MadeRecess(
        outline="rectangle",
        theta=30.0,
        z=25.0,
        sizes=(26.0, 28.0, 5.0),
        depth=2.0,
        fillet=fillet,
        radial=radial,
    )
    bosses = [
        MadeBoss(
            outline="circle",
            theta=theta,
            z=25.0,
            height=3.0,
            tilt=0.0,
            fillet=0.0,
            sizes=(4.0, 4.0),
            hole=0.0,
        )
        for theta in (30.0, 75.0)
    ]
    return recessed(shell, [recess], bosses if on_it else bosses[1:]).val().wrapped


def recessed_casing(seed: int, most: int = 6) -> MadeCasing:
    """Return the random casing with recesses of a seed, with at most so many bosses of the host on each stretch of its ground: the first of
    its draws in whose file the kernel finds no fault."""
    for number in range(MOST_DRAWS):
        try:
            made = _drawn(seed, Random(f"recessed casing {seed}, draw {number}"), most)
        except Exception as reason:  # fillets fail in errors of several kinds
            del reason
            continue
        if _is_sound(made):
            return made
    raise ValueError(f"recessed casing {seed}: {MOST_DRAWS} draws gave no valid solid")


def _drawn(seed: int, draw: Random, most: int) -> MadeCasing:
    shell = Shell(
        radius=draw.uniform(90.0, 260.0),
        slope=draw.choice((0.0, 0.0, draw.uniform(0.05, 0.25))),
        length=draw.uniform(100.0, 160.0),
        wall=draw.uniform(7.0, 10.0),
        flange=draw.uniform(8.0, 14.0),
        rim=draw.uniform(16.0, 24.0),
        rib=0.0,
    )
    (ground,) = shell.grounds
    bosses = [
        replace(b, fillet=0.0) for b in _row(draw, shell, ground, most) if b.outline != "lobe"
    ]
    recesses, on_them = _recesses(draw, shell, ground, bosses)
    body = recessed(shell, recesses, [*bosses, *on_them])
    for boss in (*bosses, *on_them):
        if boss.hole:
            body = body.cut(_drilled(shell, boss))
    bolts = draw.choice((0, 12))
    if bolts:
        body = _bolted(body, shell, bolts)
    every = (*bosses, *on_them)
    counts = {
        "boss": len(every),
        "hole": sum(1 for b in every if b.hole) + 2 * bolts,
        "pocket": 1 + len(recesses),
        "profile": 1,
    }
    return MadeCasing(
        name=f"recessed-{seed}",
        shape=_placed(draw, body.val()).wrapped,
        unit=draw.choice(("mm", "mm", "inch")),
        bosses=every,
        counts={k: v for k, v in counts.items() if v},
        mirrored=False,
    )


def _recesses(
    draw: Random, shell: Shell, ground: tuple[float, float], bosses: list[MadeBoss]
) -> tuple[list[MadeRecess], list[MadeBoss]]:
    """Return recesses in the gaps between bosses that are long enough, and the bosses that stand on them."""
    found: list[MadeRecess] = []
    on_them: list[MadeBoss] = []
    taken = sorted((b.theta, max(b.sizes)) for b in bosses)
    gaps = [
        (a, ra, (b - a) % 360.0 or 360.0, rb)
        for (a, ra), (b, rb) in zip(taken, [*taken[1:], taken[0]], strict=True)
    ]
    for theta, before, wide, after in sorted(gaps, key=lambda g: -g[2])[: draw.choice((1, 2))]:
        free = np.radians(wide) * shell.at(ground[0]) - before - after - 12.0
        span = min(free, draw.uniform(30.0, 90.0), 0.5 * shell.radius)
        if span < 20.0:
            continue
        long = min(draw.uniform(30.0, 80.0), ground[1] - ground[0] - 16.0)
        radial = shell.slope == 0.0 and draw.random() < 0.4
        outline = "rectangle" if radial else draw.choice(("rectangle", "circle", "slot"))
        half = 0.5 * min(span, long)
        sizes = {
            "rectangle": (span, long, draw.uniform(4.0, 0.6 * half)),
            "circle": (half, half),
            "slot": (span, min(long, 0.7 * span)),
        }[outline]
        shift = np.degrees((before - after) / (2.0 * shell.at(ground[0])))
        recess = MadeRecess(
            outline=outline,
            theta=(theta + 0.5 * wide + float(shift)) % 360.0,
            z=0.5 * (ground[0] + ground[1]),
            sizes=sizes,
            depth=draw.uniform(1.5, 4.0),
            fillet=draw.choice((0.0, 0.0, 1.5)),
            radial=radial,
        )
        found.append(recess)
        least = min(sizes[:2]) * (2.0 if outline == "circle" else 1.0)
        if least > 44.0 and draw.random() < 0.6:
            on_them.append(
                MadeBoss(
                    outline="circle",
                    theta=recess.theta,
                    z=recess.z,
                    height=draw.uniform(5.0, 9.0),
                    tilt=0.0,
                    fillet=0.0,
                    sizes=(0.2 * least, 0.2 * least),
                    hole=draw.choice((0.0, 6.0)),
                )
            )
    return found, on_them
