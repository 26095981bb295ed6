"""Toolpaths, coloured by kind of motion."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista as pv

from trunnion.geometry.frame import Frame
from trunnion.model.toolpath import Mark, Motion, Toolpath
from trunnion_gui.colours import MOTIONS, motions, rgb

_TURN = np.radians(6.0)
"""One chord of an opened arc turns this much at most."""


def draw_paths(view: Any, paths: Iterable[tuple[Toolpath, Frame]], shown: Iterable[str] = MOTIONS) -> None:
    """Show toolpaths (each with its setup's frame) as lines: thin ones for rapids, strong ones for feed moves."""
    for name in ("feed moves", "rapids"):
        view.remove_actor(name, render=False)
    wanted = np.isin(MOTIONS, list(shown))
    opened = [(opened_arcs(path), frame) for path, frame in paths if len(path) > 1]
    for name, is_rapid, width, opacity in (("rapids", True, 1.3, 0.6), ("feed moves", False, 2.2, 1.0)):
        kept = wanted & (np.array([m == "rapid" for m in MOTIONS]) == is_rapid)
        lines = _chords(opened, kept)
        if lines is not None:
            view.add_mesh(lines, scalars="rgb", rgb=True, line_width=width, opacity=opacity, name=name, pickable=False,
                          reset_camera=False, lighting=False, show_scalar_bar=False)


def opened_arcs(path: Toolpath) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of a path with its arcs opened into chords (k + 1, 3), and the row in `MOTIONS` of each chord (k,)."""
    kind = np.where(path.motion == Motion.RAPID, MOTIONS.index("rapid"), path.mark)
    kind = np.where((path.motion != Motion.RAPID) & (path.mark == Mark.RETRACT), MOTIONS.index("retract"), kind)
    start, sweep = path.starts(), path.sweeps()
    pieces = np.maximum(1, np.ceil(np.abs(sweep) / _TURN)).astype(int)
    pieces[0] = 0
    row = np.repeat(np.arange(len(path)), pieces)
    step = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    part = step / pieces[row]
    points = start[row] + (path.position[row] - start[row]) * part[:, None]
    turned = sweep[row] != 0.0
    rows, angle = row[turned], (sweep[row] * part)[turned]
    arm = start[rows, :2] - path.centre[rows, :2]
    cos, sin = np.cos(angle), np.sin(angle)
    points[turned, 0] = path.centre[rows, 0] + cos * arm[:, 0] - sin * arm[:, 1]
    points[turned, 1] = path.centre[rows, 1] + sin * arm[:, 0] + cos * arm[:, 1]
    return np.vstack([path.position[:1], points]), kind[row]


def _chords(paths: list[tuple[tuple[np.ndarray, np.ndarray], Frame]], kept: np.ndarray) -> pv.PolyData | None:
    """Return one mesh of the chords whose kinds are wanted, each with its colour."""
    points, ends, kinds, base = [], [], [], 0
    for (own, kind), frame in paths:
        rows = np.flatnonzero(kept[kind])
        points.append(frame.to_world(own))
        ends.append(np.column_stack([np.full(len(rows), 2), base + rows, base + rows + 1]))
        kinds.append(kind[rows])
        base += len(own)
    if not sum(len(k) for k in kinds):
        return None
    mesh = pv.PolyData(np.vstack(points).astype(np.float32), lines=np.concatenate(ends).ravel())
    palette = np.array([rgb(motions()[m]) for m in MOTIONS], np.uint8)
    mesh.cell_data["rgb"] = palette[np.concatenate(kinds)]
    return mesh
