"""Stepovers as a metric of the faces: how many passes lie between two places.

A cutter and a face that touch leave between them a gap that opens with the square of the distance across the feed, by the sum of both
curvatures (the face's + convex). So the stepover for a scallop height h is a length in the metric (I/R + II) / 8h of the faces, I and
II their fundamental forms: a distance in it counts passes (Kim, Constant cusp height tool paths as geodesic parallels on an abstract
Riemannian manifold, 2007). For a cutter that is not a ball, 1/R is the curvature of its own surface where it touches.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.fields import Metric
from trunnion.geometry.kernels.drop import ROUND, C
from trunnion.geometry.sheet import Measure, Sheet, between
from trunnion.model.tool import Tool
from trunnion.toolpath.surface.cutter import lower_side, touching

WIDEST = 0.5
"""Stepover at most, as a share of the diameter: a cutter that fits a hollow, or stands flat on a plane, would allow any."""
CORNER = math.cos(math.radians(15.0))
"""Cosine of the least turn from one piece of a line to the next that is a corner."""


def stepover_measure(tool: Tool, height: float) -> Measure:
    """Return how edges are measured in stepovers of a cutter at a scallop height (mm).

    A cutter that is not a ball stands along z. Raises `Refused` for a flat end, which leaves steps and no scallops.
    """
    if tool.corner_radius <= 0.0:
        raise Refused(f"{tool.name}: a flat end leaves steps on curved faces; choose a ball, bull, taper or barrel end")
    least = 1.0 / (WIDEST * tool.diameter) ** 2
    # A groove's chord is shorter than a parabola's by a share of the height over the radius.
    depth = height * (1.0 - 0.5 * min(height / tool.corner_radius, 1.0))

    def measure(a: Floats, a_normal: Floats, b: Floats, b_normal: Floats) -> Floats:
        way = b - a
        gap = _own_curvature(tool, way, a_normal + b_normal) + (way * (b_normal - a_normal)).sum(axis=1)
        return np.sqrt(np.maximum(gap / (8.0 * depth), least * (way * way).sum(axis=1)))

    return measure


def _own_curvature(tool: Tool, way: Floats, normal: Floats) -> Floats:
    """Return the second fundamental form (e,) of ways (e, 3) on the cutter's own surface where it touches faces of normals (e, 3)."""
    square = (way * way).sum(axis=1)
    if tool.form == "ball":
        return np.asarray(square / tool.radius)
    sine, cosine = np.hypot(normal[:, 0], normal[:, 1]), normal[:, 2]
    rho, _ = touching(tool, np.arctan2(sine, cosine))
    # Round about the axis, and along the profile.
    cross = way[:, 1] * normal[:, 0] - way[:, 0] * normal[:, 1]
    level = np.divide(cross, sine, out=np.zeros(len(way)), where=sine > 0.0) ** 2
    around = np.divide(sine, np.hypot(sine, cosine) * rho, out=np.zeros(len(way)), where=rho > tolerance.COINCIDENT)
    return np.asarray(level * around + np.maximum(square - level, 0.0) * _profile_curvature(tool, rho))


def _profile_curvature(tool: Tool, rho: Floats) -> Floats:
    """Return how curved (k,) 1/mm the profile of a cutter is at distances (k,) from its axis, on the rounder side of a bend."""
    out = np.zeros(rho.shape)
    for row in lower_side(tool):
        if row[ROUND]:
            here = (rho >= row[0] - tolerance.COINCIDENT) & (rho <= row[1] + tolerance.COINCIDENT)
            out = np.where(here, np.maximum(out, 1.0 / row[C]), out)
    return out


def metric_of(sheet: Sheet, measure: Measure) -> Metric:
    """Return a sheet's metric by a measure of its edges."""
    a, b = sheet.edges()[0].T
    return Metric.of(sheet, measure(sheet.points[a], sheet.normals[a], sheet.points[b], sheet.normals[b]))


def spread(point: Floats, normal: Floats, closed: bool, radius: float, chord: float, longest: float) -> tuple[Floats, Floats]:
    """Return contacts (m, 3) with normals over the curved way through contacts (k, 3), at most `longest` mm apart, and so close that
    straight moves between them, and between points a radius above them, leave the way by no more than a chord error. Corners stay."""
    size = np.linalg.norm(np.diff(point, axis=0), axis=1)
    kept = np.concatenate([[True], size > tolerance.SHORT_MOVE])
    if not kept[-1]:
        kept[-1], kept[np.flatnonzero(kept)[-1]] = True, kept.sum() < 2
    point, normal = point[kept], normal[kept]
    way = np.diff(point, axis=0)
    size, turn = np.linalg.norm(way, axis=1), np.linalg.norm(np.diff(normal, axis=0), axis=1)
    pieces = np.maximum(np.sqrt((size + radius * turn) * turn / (8.0 * chord)), size / longest)
    along = way / size[:, None]
    section = np.concatenate([[0], np.cumsum((along[1:] * along[:-1]).sum(axis=1) < CORNER)])
    # Each section between corners has a whole number of pieces, so that corners stay.
    whole = np.bincount(section, pieces)
    count = np.maximum(np.ceil(whole), max(1, -(-6 // len(whole))) if closed else 1)
    run = np.concatenate([[0.0], np.cumsum(pieces * (count / whole)[section])])
    at = np.arange(int(count.sum()) + 1.0)
    run[-1] = at[-1]
    row = np.clip(np.searchsorted(run, at, side="right") - 1, 0, len(run) - 2)
    share = np.clip((at - run[row]) / np.maximum(run[row + 1] - run[row], tolerance.PARAMETRIC), 0.0, 1.0)
    return between(point[row], normal[row], point[row + 1], normal[row + 1], share)
