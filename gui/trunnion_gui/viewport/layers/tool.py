"""The tool as bodies of revolution: cutter, shank with neck, and holder, standing where it cuts; and the path it came by."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray

from trunnion.model.tool import FINISHING, Tool
from trunnion_gui.look.colours import Theme, rgb, tool_colours

PARTS = ("cutter", "shank", "holder")
_AROUND = 64
_CHORD = math.radians(7.5)
_SHARP = 30.0
"""Degrees between two faces that leave an edge."""
_HOLDER_OPACITY = 0.45
Outline = list[tuple[float, float]]


def draw_tool(view: Any, tool: Tool | None, theme: Theme) -> None:
    """Show a tool at the origin with its axis up, or none; `move_tool_to` puts it where it is."""
    for part in PARTS:
        view.remove_actor(part, render=False)
    if tool is None:
        return
    for part, body in zip(PARTS, (cutter_outline(tool), *shaft_outlines(tool))):
        if len(body) > 1:
            view.add_mesh(
                revolved(body),
                color=tool_colours()[part],
                name=part,
                pickable=False,
                reset_camera=False,
                ambient=0.28,
                diffuse=0.7,
                specular=0.35,
                specular_power=24,
                smooth_shading=False,
                opacity=_HOLDER_OPACITY if part == "holder" else 1.0,
            )


def move_tool_to(view: Any, tip: np.ndarray, axis: np.ndarray) -> None:
    """Stand the tool with its tip at a point and its axis along a direction."""
    across = np.cross(axis, (0.0, 0.0, 1.0) if abs(axis[2]) < 0.9 else (1.0, 0.0, 0.0))
    across /= np.linalg.norm(across)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = (
        across,
        np.cross(axis, across),
        axis,
        tip,
    )
    for part in PARTS:
        actor = view.actors.get(part)
        if actor is not None:
            actor.user_matrix = matrix


def draw_trail(view: Any, points: np.ndarray, rapid: np.ndarray) -> None:
    """Show the path of the tip so far: points (k + 1, 3), and for each chord (k,) whether it was a rapid."""
    k = len(points) - 1
    if k < 1:
        view.remove_actor("trail", render=False)
        return
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, 2 * k + 1, 2, dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(np.repeat(np.arange(k + 1), 2)[1:-1].astype(np.int64), deep=True),
    )
    line = pv.PolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float32), deep=True))
    line.SetPoints(vtk_points)
    line.SetLines(cells)
    palette = np.array([rgb(tool_colours()[name]) for name in ("feed", "rapid")], np.uint8)
    shown = numpy_to_vtk(palette[rapid.astype(int)], deep=True)
    shown.SetName("rgb")
    line.GetCellData().SetScalars(shown)
    actor = view.actors.get("trail")
    if actor is None:
        actor = view.add_mesh(
            line,
            scalars="rgb",
            rgb=True,
            line_width=1.6,
            name="trail",
            pickable=False,
            reset_camera=False,
            lighting=False,
            show_scalar_bar=False,
            copy_mesh=False,
        )
        actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -6.0)
    else:
        actor.mapper.SetInputData(line)


def cutter_outline(tool: Tool) -> Outline:
    """Return the cutting part's outline as points (radius, height) from the tip to the top of the flutes, arcs opened into chords."""
    c, r, top = tool.corner_radius, tool.radius, tool.flute_length
    if tool.form == "form":
        rows = [(0.0, 0.0, 0.0), *tool.outline]
        return [p for a, b in pairwise(rows) for p in _bulged(a[:2], b[:2], a[2])] + [
            (rows[-1][0], rows[-1][1])
        ]
    if tool.form == "drill":
        return [(0.0, 0.0), (r, tool.point_length), (r, top)]
    if tool.form in FINISHING:
        return [(0.0, 0.0), (r - tool.lead, 0.0), (r, tool.lead), (r, top)]
    if tool.form in ("tap", "thread-mill"):
        return [(0.0, 0.0), (tool.core_radius, 0.0), (tool.core_radius, top)]
    if tool.form == "t-slot":
        return [
            (0.0, 0.0),
            *_arc(r - c, c, c, -90.0, 0.0),
            *_arc(r - c, top - c, c, 0.0, 90.0),
            (0.0, top),
        ]
    if tool.form == "taper":
        lean = math.radians(tool.taper_angle)
        end = _arc(r - c, c, c, -90.0, -tool.taper_angle)
        return [(0.0, 0.0), *end, (end[-1][0] + (top - end[-1][1]) * math.tan(lean), top)]
    if tool.form == "barrel":
        big, high = tool.barrel_radius, tool.widest_height
        centre = r - big
        # The tip's arc and the flank's touch on the line through both centres.
        tangent_angle = math.degrees(math.atan2(c - high, -centre))
        last = math.degrees(math.asin(min((top - high) / big, 1.0)))
        return [
            *_arc(0.0, c, c, -90.0, tangent_angle),
            *_arc(centre, high, big, tangent_angle, last),
        ]
    return [(0.0, 0.0), *_arc(r - c, c, c, -90.0, 0.0), (r, top)]


def shaft_outlines(tool: Tool) -> tuple[Outline, Outline]:
    """Return the outlines of neck with shank and of the holder, closed at the axis."""
    rows = tool.profile()
    holders = len(tool.holder.rows)
    return tuple(
        _stacked(part) for part in (rows[: len(rows) - holders], rows[len(rows) - holders :])
    )  # type: ignore[return-value]


def revolved(outline: Outline) -> pv.PolyData:
    """Return an outline turned about z, smooth but for its sharp edges."""
    corners = np.array(
        [p for n, p in enumerate(outline) if n == 0 or math.dist(p, outline[n - 1]) > 1e-9]
    )
    angle = np.arange(_AROUND) * (2 * np.pi / _AROUND)
    points = np.stack(
        [
            corners[:, :1] * np.cos(angle),
            corners[:, :1] * np.sin(angle),
            np.repeat(corners[:, 1:], _AROUND, axis=1),
        ],
        axis=-1,
    )
    at = np.arange(len(corners) * _AROUND).reshape(-1, _AROUND)
    a, d = at[:-1].ravel(), at[1:].ravel()
    b, c = np.roll(at[:-1], -1, axis=1).ravel(), np.roll(at[1:], -1, axis=1).ravel()
    faces = np.column_stack([np.full(len(a), 4), a, b, c, d])
    body = pv.PolyData(points.reshape(-1, 3).astype(np.float32), faces.ravel())
    return body.compute_normals(
        split_vertices=True,
        feature_angle=_SHARP,
        consistent_normals=False,
        auto_orient_normals=False,
    )


def _stacked(rows: tuple[tuple[float, float, float, float], ...]) -> Outline:
    if not rows:
        return []
    return [
        (0.0, rows[0][0]),
        *((r, z) for z0, r0, z1, r1 in rows for r, z in ((r0, z0), (r1, z1))),
        (0.0, rows[-1][2]),
    ]


def _arc(r: float, z: float, radius: float, first: float, last: float) -> Outline:
    """Return points of an arc about (r, z) from one direction to another, degrees from outwards; one point when it has no radius."""
    if radius == 0.0:
        return [(r, z)]
    steps = max(2, math.ceil(abs(math.radians(last - first)) / _CHORD) + 1)
    return [
        (max(r + radius * math.cos(a), 0.0), z + radius * math.sin(a))
        for a in np.radians(np.linspace(first, last, steps))
    ]


def _bulged(start: tuple[float, float], end: tuple[float, float], bulge: float) -> Outline:
    """Return points from one corner of an outline on the way to the next, without that one; a bulge rounds it outwards."""
    if bulge == 0.0:
        return [start]
    turn = 4 * math.atan(bulge)
    steps = max(2, math.ceil(abs(turn) / _CHORD))
    a, b = complex(*start), complex(*end)
    centre = (a + b) / 2 + (b - a) * 1j * (1 - bulge * bulge) / (4 * bulge)
    return [
        (p.real, p.imag)
        for p in (centre + (a - centre) * np.exp(1j * turn * k / steps) for k in range(steps))
    ]
