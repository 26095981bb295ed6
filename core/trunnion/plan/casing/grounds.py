"""The bottoms of a casing laid flat, with the bosses and flanges that stand on them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.development import Development
from trunnion.geometry.mesh import Mesh
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.casing.bottoms import CasingBottom, casing_bottoms, casing_faces
from trunnion.plan.development.ground import DevelopedGround, GroundBounds, ground_of
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

    Raises `Refused` where the bottom neither runs round nor is a recess of another one, lies inside, or its meridian is bent or too steep.
    """
    name, line = bottom.pocket.id, bottom.meridian
    if not bottom.full_circle and not bottom.is_recess:
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
    """Return the ground of a bottom with all of the part that stands on it or beside it; of a recess within its walls alone, and up to the
    pocket's bottom that it is sunk into, whose own ground holds what is higher. Raises `Refused` as `development_of` does."""
    development, length = development_of(bottom, found)
    hosts, limit = _hosts(bottom, found, part), None
    faces = casing_faces(found, part.graph())
    if bottom.is_recess:
        development = _across_from_ends(development, bottom, mesh)
        walls = [t for t in bottom.pocket.with_role(SIDE) if not faces.runs_round(t - 1)]
        limit = GroundBounds(
            tags=(*bottom.pocket.with_role(BOTTOM), *walls),
            ceiling=_ceiling(development, hosts[0]) if hosts else None,
        )
    bosses = [_faces_of(b) for b in found.of_kind(BOSS)]
    apart = {t for tags in bosses for t in tags}
    apart |= {t for f in found.of_kind(HOLE) for t in f.tags}
    own = set(bottom.pocket.with_role(BOTTOM))
    others = [t for t in part.tags if t not in apart and t not in own]
    # What a recess is sunk into runs round, but is open over the recess.
    opened = {t for host in hosts for t in host.pocket.with_role(BOTTOM)} | set(bottom.sunk_into)
    rings = tuple(
        t for t in others if t not in opened and faces.turned[t - 1] and faces.runs_round(t - 1)
    )
    rest = tuple(t for t in others if t not in rings)
    obstacles = [(tags, True) for tags in bosses] + [(rest, False)]
    return ground_of(development, (0.0, length), mesh, obstacles, rings, blank, progress, limit)


def _hosts(bottom: CasingBottom, found: Recognition, part: Part) -> list[CasingBottom]:
    """Return the bottoms that a recess is sunk into, the nearest first; raise `Refused` where one of them can't be laid flat."""
    hosts: list[CasingBottom] = []
    name = bottom.recess_of
    while name and name not in {h.pocket.id for h in hosts}:
        host = bottom_of(found, part, name)
        try:
            development_of(host, found)
        except Refused as reason:
            raise Refused(
                f"{bottom.pocket.id}: it is a recess of a bottom that is not planned; {reason}"
            ) from reason
        hosts.append(host)
        name = host.recess_of
    return hosts


def _across_from_ends(development: Development, bottom: CasingBottom, mesh: Mesh) -> Development:
    """Return a development whose plane ends across from the middle of a recess."""
    mine = mesh.triangles[np.isin(mesh.face, bottom.pocket.with_role(BOTTOM))]
    local = development.frame.to_local(mesh.points[np.unique(mine)])
    turn = np.sort(np.arctan2(local[:, 1], local[:, 0]))
    gaps = np.diff(turn, append=turn[0] + 2.0 * math.pi)
    widest = int(np.argmax(gaps))
    return replace(development, middle=float(turn[widest] + 0.5 * gaps[widest]) + math.pi)


def _ceiling(
    development: Development, host: CasingBottom
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the straight line that a host's bottom is over the plane of a recess: two places along its straight lines and heights, mm."""
    line = host.meridian
    (v0, h0), (v1, h1) = (
        tuple(development.from_cylindrical(np.array(r), np.array(0.0), np.array(z))[1:].tolist())
        for z, r in zip(line.ends, (line.low[0], line.high[-1]), strict=True)
    )
    return (v0, h0), (v1, h1)


def _faces_of(boss: Feature) -> tuple[int, ...]:
    return boss.with_role(TOP, SIDE, ROOT_FILLET)


def fine_mesh(part: Part) -> Mesh:
    """Return the part's triangles that stand for it over bottoms laid flat."""
    return part.mesh(tolerance.CHORD)
