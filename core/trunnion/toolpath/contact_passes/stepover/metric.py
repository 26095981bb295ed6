"""Stepovers as a metric of the faces: how many passes lie between two positions.

A cutter and a face that touch leave between them a gap that opens with the square of the distance across the feed, by the sum of both
curvatures (the face's + convex). So the stepover for a scallop height h is a length in the metric (I/R + II) / 8h of the faces, I and
II their fundamental forms: a distance in it counts passes (Kim, Constant cusp height tool paths as geodesic parallels on an abstract
Riemannian manifold, 2007). For a cutter that is not a ball, 1/R is the curvature of its own surface where it touches.

Where the curvature jumps, as at the rim of a fillet, two passes that count one stepover apart leave more than the wanted height between
them if most of that stepover is on the flatter side: there the gap opens at once as fast as it does on the rounder side, but the stepover
is that of the flatter one. So the rounder side's measure holds a little past the jump; a quarter of a stepover is enough for any jump.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.kernels.cutter_contact.drop_cutter import ROUND, C
from trunnion.geometry.sheet.fields import Metric
from trunnion.geometry.sheet.sheet import Measure, Sheet, between
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side, touching

WIDEST = 0.5
"""Stepover at most, as a share of the diameter: a cutter that fits a hollow, or stands flat on a plane, would allow any."""
SNUG, UNSURE = 0.5, 0.03
"""Of the cutter's own curvature: from where on a hollow is nearly as round as the cutter; and how much of what its curvature is past that
may be missing, for modellers' fillets ripple. The gap is what little is left of the cutter's curvature there, and passes would lie too
far apart."""
JUMP = 1.25
"""Of two squares of stepovers beside an edge: from this ratio on the curvature jumps there."""
PAST = 0.28
"""Stepovers of the rounder side that its measure holds past a jump."""
NEARBY = 4
"""Positions on jumps that are queried from each position of an edge."""
SHARES = 8
"""Positions of an edge that are tested for being past a jump."""
CORNER = math.cos(math.radians(15.0))
"""Cosine of the least turn from one piece of a line to the next that is a corner."""
ASIDE = 0.01
"""Of the longest piece: how far straight moves may cut a path's bends along the face; neighbours are farther apart there by that."""


def stepover_measure(tool: Tool, height: float) -> Measure:
    """Return how edges are measured in stepovers of a cutter at a scallop height (mm).

    A cutter that is not a ball stands along z. Raises `Refused` for a flat end, which leaves steps and no scallops.
    """
    if tool.corner_radius <= 0.0:
        raise Refused(
            f"{tool.name}: a flat end leaves steps on curved faces; choose a ball, bull, taper or barrel end"
        )
    least = 1.0 / (WIDEST * tool.diameter) ** 2
    # A groove's chord is shorter than a parabola's by a share of the height over the radius.
    depth = height * (1.0 - 0.5 * min(height / tool.corner_radius, 1.0))

    def measure(a: Floats, a_normal: Floats, b: Floats, b_normal: Floats) -> Floats:
        direction = b - a
        own, bend = (
            _own_curvature(tool, direction, a_normal + b_normal),
            (direction * (b_normal - a_normal)).sum(axis=1),
        )
        gap = own + bend + UNSURE * np.maximum(-bend - SNUG * own, 0.0)
        return np.sqrt(np.maximum(gap / (8.0 * depth), least * (direction * direction).sum(axis=1)))

    return measure


def _own_curvature(tool: Tool, direction: Floats, normal: Floats) -> Floats:
    """Return the second fundamental form (e,) of paths (e, 3) on the cutter's own surface where it touches faces of normals (e, 3)."""
    square = (direction * direction).sum(axis=1)
    if tool.form == "ball":
        return np.asarray(square / tool.radius)
    sine, cosine = np.hypot(normal[:, 0], normal[:, 1]), normal[:, 2]
    rho, _ = touching(tool, np.arctan2(sine, cosine))
    # Round about the axis, and along the profile.
    cross = direction[:, 1] * normal[:, 0] - direction[:, 0] * normal[:, 1]
    level = np.divide(cross, sine, out=np.zeros(len(direction)), where=sine > 0.0) ** 2
    around = np.divide(
        sine,
        np.hypot(sine, cosine) * rho,
        out=np.zeros(len(direction)),
        where=rho > tolerance.COINCIDENT,
    )
    return np.asarray(
        level * around + np.maximum(square - level, 0.0) * _profile_curvature(tool, rho)
    )


def _profile_curvature(tool: Tool, rho: Floats) -> Floats:
    """Return how curved (k,) 1/mm the profile of a cutter is at distances (k,) from its axis, on the rounder side of a bend."""
    out = np.zeros(rho.shape)
    for row in lower_side(tool):
        if row[ROUND]:
            here = (rho >= row[0] - tolerance.COINCIDENT) & (rho <= row[1] + tolerance.COINCIDENT)
            out = np.where(here, np.maximum(out, 1.0 / row[C]), out)
    return out


def metric_of(sheet: Sheet, measure: Measure) -> Metric:
    """Return a sheet's metric by a measure of its edges, a little past jumps of the curvature that of their rounder side."""
    ends, side = sheet.edges()
    a, b = ends.T
    lengths = measure(sheet.points[a], sheet.normals[a], sheet.points[b], sheet.normals[b])
    return Metric.of(sheet, _held_past_jumps(sheet, ends, side, lengths))


def stepover_area(sheet: Sheet, measure: Measure) -> Floats:
    """Return the area of each triangle (t,) of a sheet in square stepovers, jumps of the curvature left out."""
    a, b = sheet.edges()[0].T
    lengths = measure(sheet.points[a], sheet.normals[a], sheet.points[b], sheet.normals[b])
    return Metric.of(sheet, lengths).area()


def _held_past_jumps(sheet: Sheet, ends: Ints, side: Ints, lengths: Floats) -> Floats:
    """Return the lengths (e,) of edges, `PAST` stepovers past each jump at least as long as on its rounder side."""
    slope, form = _forms(sheet, lengths[side])

    def along(triangle: Ints, direction: Floats) -> Floats:
        """Return the square of the length of paths (k, 3) in triangles (k,)."""
        part = np.einsum("kij,kj->ki", slope[triangle], direction)
        return np.asarray(
            np.maximum(-(part * np.roll(part, -1, axis=1) * form[triangle]).sum(axis=1), 0.0)
        )

    order = np.argsort(side.ravel(), kind="stable")
    twice = np.flatnonzero(np.diff(side.ravel()[order]) == 0)
    one, two, edge = order[twice] // 3, order[twice + 1] // 3, side.ravel()[order[twice]]
    run = sheet.points[ends[:, 1]] - sheet.points[ends[:, 0]]
    size = np.linalg.norm(run, axis=1)
    across = np.cross(run[edge], sheet.normals[ends[edge, 0]] + sheet.normals[ends[edge, 1]])
    across = across / np.maximum(
        np.linalg.norm(across, axis=1, keepdims=True), tolerance.PARAMETRIC
    )
    squares = along(one, across), along(two, across)
    rounder, square = np.where(squares[0] > squares[1], one, two), np.maximum(*squares)
    jumps = np.flatnonzero((square > JUMP * np.minimum(*squares)) & (square > 0.0))
    if not len(jumps):
        return lengths
    count = np.maximum(
        np.ceil(size[edge[jumps]] * np.sqrt(square[jumps]) / (0.5 * PAST)), 1.0
    ).astype(np.int64)
    jump, number = items_of(count)
    row, share = jumps[jump], (number + 0.5) / count[jump]
    tree = cKDTree(sheet.points[ends[edge[row], 0]] + share[:, None] * run[edge[row]])
    # The rounder side holds no farther than the flatter one's stepovers are wide.
    middle = 0.5 * (sheet.points[ends[:, 0]] + sheet.points[ends[:, 1]])
    # An edge without length lies nowhere near: it has no stepovers.
    long = size > 0.0
    density = np.divide(lengths, size, out=np.full(len(size), np.inf), where=long)
    limit = np.where(long, 0.5 * size + PAST / density, -np.inf)
    nearest = tree.query(middle, distance_upper_bound=np.nextafter(limit.max(), np.inf))[0]
    near = np.flatnonzero(nearest <= limit)
    position = (
        sheet.points[ends[near, 0]][:, None]
        + ((np.arange(SHARES) + 0.5) / SHARES)[:, None] * run[near][:, None]
    )
    farthest = PAST / float(density[near].min(initial=np.inf))
    away, found = (
        np.asarray(x)
        for x in tree.query(position.reshape(-1, 3), k=NEARBY, distance_upper_bound=farthest)
    )
    of, which = np.nonzero(np.isfinite(away))
    mine = near[of // SHARES]
    jump = row[found[of, which]]
    direction = run[mine] / size[mine, None]
    here = np.sqrt(along(rounder[jump], direction))
    facing = (sheet.normals[ends[mine, 0]] * sheet.normals[ends[edge[jump], 0]]).sum(axis=1) > 0.5
    holds = facing & (away[of, which] * here <= PAST)
    most = np.repeat(density[near], SHARES)
    np.maximum.at(most, of[holds], here[holds])
    out = lengths.copy()
    out[near] = size[near] * most.reshape(-1, SHARES).mean(axis=1)
    return out


def _forms(sheet: Sheet, lengths: Floats) -> tuple[Floats, Floats]:
    """Return for each triangle the slopes (t, 3, 3) of its corners' shares and the squares (t, 3) of its sides' lengths: a way that changes
    the shares by d has the square -(d0 d1 q0 + d1 d2 q1 + d2 d0 q2), side k being that from corner k to the next."""
    a, b, c = np.moveaxis(sheet.points[sheet.triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    double = np.maximum((normal * normal).sum(axis=1), np.finfo(float).tiny)[:, None]
    slope = np.stack([np.cross(normal, side) / double for side in (c - b, a - c, b - a)], axis=1)
    return slope, lengths**2


def spread(
    point: Floats, normal: Floats, closed: bool, radius: float, chord: float, longest: float
) -> tuple[Floats, Floats]:
    """Return contacts (m, 3) with normals over the curved way through contacts (k, 3), at most `longest` mm apart, and so close that
    straight moves between them, and between points a radius above them, leave the path by no more than a chord error, and along
    the face by no more than `ASIDE`. Corners stay."""
    size = np.linalg.norm(np.diff(point, axis=0), axis=1)
    kept = np.concatenate([[True], size > tolerance.SHORT_MOVE])
    if not kept[-1]:
        kept[-1], kept[np.flatnonzero(kept)[-1]] = True, kept.sum() < 2
    point, normal = point[kept], normal[kept]
    direction = np.diff(point, axis=0)
    size, turn = np.linalg.norm(direction, axis=1), np.linalg.norm(np.diff(normal, axis=0), axis=1)
    along = direction / size[:, None]
    cosine = (along[1:] * along[:-1]).sum(axis=1)
    bend = np.where(cosine < CORNER, 0.0, np.arccos(np.clip(cosine, -1.0, 1.0)))
    bend = 0.5 * (np.append(bend, 0.0) + np.insert(bend, 0, 0.0))
    pieces = np.maximum(np.sqrt((size + radius * turn) * turn / (8.0 * chord)), size / longest)
    pieces = np.maximum(pieces, np.sqrt(size * bend / (8.0 * ASIDE * longest)))
    section = np.concatenate([[0], np.cumsum(cosine < CORNER)])
    # Each section between corners has a whole number of pieces, so that corners stay.
    whole = np.bincount(section, pieces)
    count = np.maximum(np.ceil(whole), max(1, -(-6 // len(whole))) if closed else 1)
    run = np.concatenate([[0.0], np.cumsum(pieces * (count / whole)[section])])
    at = np.arange(int(count.sum()) + 1.0)
    run[-1] = at[-1]
    row = np.clip(np.searchsorted(run, at, side="right") - 1, 0, len(run) - 2)
    share = np.clip(
        (at - run[row]) / np.maximum(run[row + 1] - run[row], tolerance.PARAMETRIC), 0.0, 1.0
    )
    return between(point[row], normal[row], point[row + 1], normal[row + 1], share)
