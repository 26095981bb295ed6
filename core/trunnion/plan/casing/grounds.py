"""The bottoms of a casing laid flat, with the bosses and flanges that stand on them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.development import Development
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.casing.bottoms import CasingBottom, casing_bottoms, casing_faces
from trunnion.plan.development.ground import DevelopedGround, ground_of
from trunnion.progress import Progress
from trunnion.recognize.casing.kinds import BOSS, BOTTOM, HOLE, ROOT_FILLET, SIDE, TOP

if TYPE_CHECKING:
    from trunnion.part.part import Part

BENT = 0.02
"""mm by which the meridian of a bottom may leave a straight line and still be laid flat."""
STEEPEST = 2.0
"""Change of a bottom's radius over its height up to which it is laid flat: beyond, its two ends come too near to each other."""


def bottom_of(found: Recognition, part: Part, pocket: str) -> CasingBottom:
    """Return the bottom of a pocket; raise `Refused` where there is none that is milled from outside all round."""
    bottom = next((b for b in casing_bottoms(found, part.graph()) if b.pocket.id == pocket), None)
    if bottom is None:
        raise Refused(f"{pocket}: there is no such pocket with a turned bottom; route again")
    return bottom


def development_of(bottom: CasingBottom, found: Recognition) -> tuple[Development, float]:
    """Return the development of a bottom, the plane's ends in its widest gap, and its length along the straight lines in mm.

    Raises `Refused` where the bottom does not run round, lies inside, or its meridian is bent or too steep.
    """
    name, line = bottom.pocket.id, bottom.meridian
    if not bottom.full_circle:
        raise Refused(f"{name}: its bottom does not run round the casing")
    if line.outward < 0.0:
        raise Refused(f"{name}: its bottom lies on the inner side")
    z0, z1 = line.ends
    r0, r1 = float(line.low[0]), float(line.high[-1])
    slope = (r1 - r0) / (z1 - z0)
    at = np.concatenate([line.z[:-1], line.z[1:]])
    off = np.abs(np.concatenate([line.low, line.high]) - (r0 + slope * (at - z0)))
    if float(off.max()) > BENT:
        raise Refused(f"{name}: the meridian of its bottom is bent")
    if abs(slope) > STEEPEST:
        raise Refused(f"{name}: its bottom is too steep to be laid flat")
    development = Development(
        frame=found.frame, radius=r0, height=z0, slope=slope, middle=_middle(bottom)
    )
    return development, math.hypot(z1 - z0, r1 - r0)


def _middle(bottom: CasingBottom) -> float:
    """Return the angle (rad) across from the middle of the widest gap between bosses."""
    bounds = [b.bounds(bottom.meridian, toe=False) for b in bottom.bosses]
    if not bounds:
        return 0.0
    turn = 2.0 * math.pi
    spans = sorted((b.theta_low % turn, b.theta_high - b.theta_low) for b in bounds)
    best, widest, reached = 0.0, -math.inf, spans[-1][0] + spans[-1][1] - turn
    for start, size in spans:
        if start - reached > widest:
            widest, best = start - reached, 0.5 * (start + reached)
        reached = max(reached, start + size)
    return best + math.pi


def ground_under(
    bottom: CasingBottom,
    found: Recognition,
    part: Part,
    mesh: Mesh,
    blank: Blank,
    progress: Progress,
) -> DevelopedGround:
    """Return the ground of a bottom with all of the part that stands on it or beside it."""
    development, length = development_of(bottom, found)
    bosses = [_faces_of(b) for b in found.of_kind(BOSS)]
    apart = {t for tags in bosses for t in tags}
    apart |= {t for f in found.of_kind(HOLE) for t in f.tags}
    own = set(bottom.pocket.with_role(BOTTOM))
    faces = casing_faces(found, part.graph())
    others = [t for t in part.tags if t not in apart and t not in own]
    rings = tuple(t for t in others if faces.turned[t - 1] and faces.runs_round(t - 1))
    rest = tuple(t for t in others if t not in rings)
    obstacles = [(tags, True) for tags in bosses] + [(rest, False)]
    return ground_of(development, (0.0, length), mesh, obstacles, rings, blank, progress)


def _faces_of(boss: Feature) -> tuple[int, ...]:
    return boss.with_role(TOP, SIDE, ROOT_FILLET)


def fine_mesh(part: Part) -> Mesh:
    """Return the part's triangles that stand for it over bottoms laid flat."""
    return part.mesh(tolerance.CHORD)
