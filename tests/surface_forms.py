"""Skins of surfaces in closed form, drives over them, and how far places are from passes: what tests of surface strategies stand on."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.frame import WORLD
from trunnion.geometry.sheet.fields import distances
from trunnion.geometry.sheet.refine_sheet import split_finely
from trunnion.geometry.sheet.sheet import sheet_of
from trunnion.geometry.sheet.skin import Skin
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.toolpath.contact_passes.stepover.metric import metric_of, stepover_measure


def grid(place, normal, u, v, tag=1) -> Skin:
    """The skin of a surface over a grid of its parameters; place(u, v) and normal(u, v) give (k, 3)."""
    a, b = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    points, normals, row = (
        place(a, b),
        normal(a, b),
        np.arange(len(u) * len(v)).reshape(len(u), len(v)),
    )
    p, q, r, s = (
        row[:-1, :-1].ravel(),
        row[1:, :-1].ravel(),
        row[1:, 1:].ravel(),
        row[:-1, 1:].ravel(),
    )
    triangles = np.vstack([np.column_stack([p, q, r]), np.column_stack([p, r, s])])
    facing = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]],
        points[triangles[:, 2]] - points[triangles[:, 0]],
    )
    if (facing * normals[triangles[:, 0]]).sum() < 0.0:
        triangles = triangles[:, [0, 2, 1]]
    return Skin(
        points=points,
        normals=normals,
        triangles=triangles,
        face=np.full(len(triangles), tag),
        bound=0.0,
    )


def plane(width=6.0, height=4.0, n=2, tag=1, start=0.0) -> Skin:
    """A level rectangle from (start, 0)."""
    return grid(
        lambda u, v: np.column_stack([u, v, 0 * u]),
        lambda u, v: np.column_stack([0 * u, 0 * u, 0 * u + 1.0]),
        start + np.linspace(0.0, width, n),
        np.linspace(0.0, height, n),
        tag,
    )


def cylinder(radius=10.0, length=4.0, angle=0.3, n=61, hollow=False) -> Skin:
    """A strip about the x axis, to an angle on both sides of the top; of a hollow one, about its bottom."""
    side = -1.0 if hollow else 1.0
    return grid(
        lambda u, v: np.column_stack([u, radius * np.sin(v), side * radius * np.cos(v)]),
        lambda u, v: np.column_stack([0 * u, side * np.sin(v), np.cos(v)]),
        np.linspace(0.0, length, 9),
        np.linspace(-angle, angle, n),
    )


def zone(radius=10.0, top=0.2, bottom=0.5, n=120, m=16, turn=2.0 * np.pi) -> Skin:
    """A zone of a sphere about the z axis, between two angles from it."""

    def place(u, v):
        return radius * np.column_stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)])

    return grid(
        place,
        lambda u, v: place(u, v) / radius,
        np.linspace(0.0, turn, n),
        np.linspace(top, bottom, m),
    )


def saddle(bend=0.02, half=3.0, n=81) -> Skin:
    """The saddle z = bend (x^2 - y^2) over a square."""

    def normal(u, v):
        slope = np.column_stack([-2.0 * bend * u, 2.0 * bend * v, 0 * u + 1.0])
        return slope / np.linalg.norm(slope, axis=1, keepdims=True)

    side = np.linspace(-half, half, n)
    return grid(lambda u, v: np.column_stack([u, v, bend * (u * u - v * v)]), normal, side, side)


def joined(*skins: Skin) -> Skin:
    """Several skins as one."""
    first = np.cumsum([0, *(len(s.points) for s in skins)])
    return Skin(
        points=np.vstack([s.points for s in skins]),
        normals=np.vstack([s.normals for s in skins]),
        triangles=np.vstack([s.triangles + k for s, k in zip(skins, first[:-1], strict=True)]),
        face=np.concatenate([s.face for s in skins]),
        bound=max(s.bound for s in skins),
    )


def drive_of(skin: Skin, faces=(1,), height=0.01) -> SurfaceDrive:
    """A drive of faces of a skin, which is all there is of its part."""
    low, high = skin.box()
    fields = {
        "feature": "group-01",
        "kind": "group",
        "faces": faces,
        "exact": (),
        "skin": skin,
        "frame": WORLD,
        "low": low - [1.0, 1.0, 5.0],
        "high": high + 1.0,
        "clearance": float(high[2]) + 20.0,
        "allowance": 0.0,
        "height": height,
        "digest": "",
    }
    return SurfaceDrive(
        **{f.name: fields[f.name] for f in dataclasses.fields(SurfaceDrive) if f.name in fields}
    )


def stepovers_away(drive: SurfaceDrive, tool, ways) -> np.ndarray:
    """How many stepovers the points of a finer sheet than a strategy's are from passes of contacts."""
    measure = stepover_measure(tool, drive.height)
    sheet = split_finely(sheet_of(drive.skin, drive.faces), measure, 0.12, evenly=True)
    dense = np.concatenate([np.linspace(w.point[:-1], w.point[1:], 9).reshape(-1, 3) for w in ways])
    size = 2.0 * np.sqrt(2.0 * tool.corner_radius * drive.height)
    plain = cKDTree(dense).query(sheet.points)[0] / size
    near = np.flatnonzero(plain < 0.15)
    return distances(metric_of(sheet, measure), near, plain[near])[0]


def length(ways) -> float:
    """How long passes of contacts are together, in mm."""
    return float(sum(np.linalg.norm(np.diff(w.point, axis=0), axis=1).sum() for w in ways))
