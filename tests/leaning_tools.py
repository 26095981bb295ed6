"""Tools of every form, paths with leaning and turning axes, boxes to touch, and a plain search for how near a cutter comes."""

from __future__ import annotations

import math

import numpy as np
import shapely

from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.part.shape.facets import Facets
from trunnion.part.shape.surfaces import STRIP_COLUMNS, ContactFace, surfaces_from
from trunnion.verify.contact import PartContact
from trunnion.verify.cutter import outline_of
from verify_tools import HOLDER


def cutter(form, diameter=10.0, corner=0.0, flute=20.0, **more):
    """Return a tool of any form with a shank of its own diameter."""
    return Tool(
        number=1,
        name=form,
        form=form,
        diameter=diameter,
        corner_radius=corner,
        flute_length=flute,
        neck_diameter=diameter,
        neck_length=flute,
        shank_diameter=diameter,
        stickout=flute + 20.0,
        gauge_length=flute + 80.0,
        teeth=3,
        centre_cutting=True,
        helix_angle=30.0,
        holder=HOLDER,
        **more,
    )


EVERY_FORM = {
    "flat": cutter("flat"),
    "bull": cutter("bull", corner=2.0),
    "ball": cutter("ball", corner=5.0),
    "taper": cutter("taper", corner=1.0, taper_angle=10.0),
    "barrel": cutter("barrel", corner=2.0, flute=30.0, barrel_radius=60.0),
    "t-slot": cutter("t-slot", diameter=20.0, corner=1.0, flute=5.0),
    "drill": cutter("drill", point_angle=118.0),
    "form": cutter(
        "form",
        flute=12.0,
        outline=((2.0, 0.0, 0.0), (2.0, 4.0, 0.0), (4.0, 6.0, 0.3), (5.0, 12.0, 0.0)),
    ),
}


def leaning_section(tool, tips, axes, centre=None, motion=Motion.LINE, operation="op"):
    """Return a section: a rapid to the first tip (n, 3), then feed moves; axes (n, 3) are scaled to length one."""
    n, axes = len(tips), np.asarray(axes, dtype=np.float64)
    axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    centres = np.full((n, 3), np.nan)
    if centre is not None:
        centres[1:] = centre
    path = Toolpath(
        position=tips,
        axis=axes,
        motion=[Motion.RAPID] + [motion] * (n - 1),
        centre=centres,
        feed=[0.0] + [1000.0] * (n - 1),
        mark=[0] * n,
    )
    return ProgramSection(operation=operation, tool=tool, spindle=10000.0, path=path)


def contact_of(*boxes):
    """Return contact with boxes, each a low and a high corner."""
    corners = []
    for low, high in boxes:
        c = np.array(
            [
                [x, y, z]
                for x in (low[0], high[0])
                for y in (low[1], high[1])
                for z in (low[2], high[2])
            ],
            dtype=np.float64,
        )
        for a, b, d, e in (
            (0, 1, 3, 2),
            (4, 6, 7, 5),
            (0, 4, 5, 1),
            (2, 3, 7, 6),
            (0, 2, 6, 4),
            (1, 5, 7, 3),
        ):
            corners += [c[[a, b, d]], c[[a, d, e]]]
    triangles, empty = np.array(corners), np.zeros((0, STRIP_COLUMNS))
    joined = ContactFace(1, empty, empty, np.zeros((0, 4)), is_free=True)
    rows = np.arange(3 * len(triangles)).reshape(-1, 3)
    facets = Facets.of_mesh(
        triangles.reshape(-1, 3), rows, np.zeros(len(rows), np.int64), np.array([1])
    )
    return PartContact(surfaces_from([joined]), facets)


class PlainCutter:
    """The signed distance to what cuts of a tool by its outline alone, opened into chords a tenth of a micron from it."""

    def __init__(self, tool: Tool) -> None:
        right = [(0.0, 0.0)]
        for r0, z0, r1, z1, cr, cz, radius in outline_of(tool):
            if radius:
                a, b = math.atan2(z0 - cz, r0 - cr), math.atan2(z1 - cz, r1 - cr)
                turn = (
                    math.remainder(b - a, math.tau)
                    if radius > 0.0
                    else math.remainder(b - a + math.pi, math.tau) - math.pi
                )
                angles = a + turn * np.linspace(
                    0.0, 1.0, max(2, int(abs(turn) * math.sqrt(abs(radius) / 8e-4)) + 2)
                )
                right += [
                    (cr + abs(radius) * math.cos(t), cz + abs(radius) * math.sin(t)) for t in angles
                ]
            else:
                right += [(r0, z0), (r1, z1)]
        right.append((0.0, tool.flute_length))
        self.body = shapely.Polygon([*right, *((-r, z) for r, z in right[::-1])]).buffer(0.0)

    def distance(self, rho, h):
        """Return signed distances (k,) of points at rho (k,) from the axis and h (k,) above the tip."""
        points = shapely.points(rho, h)
        off = shapely.distance(self.body.exterior, points)
        return np.where(shapely.contains(self.body, points), -off, off)

    def nearest(self, section, block, point, rounds=6, steps=160, kept=4):
        """Return the smallest signed distance of a point (3,) along one block, by samples that close in on the best few."""
        best, spans = np.inf, [(0.0, 1.0)]
        for _ in range(rounds):
            t = np.concatenate([np.linspace(a, b, steps) for a, b in spans])
            tip, axis = pose_at(section.path, block, t)
            away = point - tip
            h = (away * axis).sum(axis=1)
            rho = np.linalg.norm(away - h[:, None] * axis, axis=1)
            off = self.distance(rho, h)
            best = min(best, float(off.min()))
            width = (spans[0][1] - spans[0][0]) * 2.0 / steps
            chosen = []
            for k in np.argsort(off):
                if all(abs(t[k] - c) > width for c in chosen):
                    chosen.append(t[k])
                if len(chosen) == kept:
                    break
            spans = [(max(c - width, 0.0), min(c + width, 1.0)) for c in chosen]
        return best


def pose_at(path, block, t):
    """Return tips and axes (k, 3) at shares t (k,) of a block, written anew."""
    start, end, a, b = (
        path.starts()[block],
        path.position[block],
        path.axis[block - 1],
        path.axis[block],
    )
    turn = math.acos(max(-1.0, min(1.0, float(a @ b))))
    t = np.asarray(t)[:, None]
    if turn < 1e-9:
        axis = np.tile(b, (len(t), 1))
    else:
        axis = (np.sin((1 - t) * turn) * a + np.sin(t * turn) * b) / math.sin(turn)
    if path.motion[block] < Motion.ARC_CW:
        return start + t * (end - start), axis
    centre, sweep = path.centre[block], path.sweeps()[block]
    away = start - centre
    away = away - (away @ b) * b
    climb = (end - start) @ b
    spun = np.cos(t * sweep) * away + np.sin(t * sweep) * np.cross(b, away)
    return centre + ((start - centre) @ b) * b + spun + t * climb * b, axis
