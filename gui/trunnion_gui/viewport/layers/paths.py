"""Toolpaths, coloured by kind of motion, with short strokes along the tool where it leans."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista as pv

from trunnion.geometry.frame import Frame
from trunnion.model.motion.toolpath import Toolpath
from trunnion.report.lines import (
    MOST_STROKES,
    MOTIONS,
    STROKE_EVERY,
    STROKE_LENGTH,
    kinds_of,
    opened,
    strokes,
)
from trunnion_gui.look.colours import axis_colour, motions, rgb

AXES = "tool axes"


def draw_paths(
    view: Any, paths: Iterable[tuple[Toolpath, Frame]], shown: Iterable[str], size: float
) -> None:
    """Show toolpaths (each with its setup's frame) as lines: thin ones for rapids, strong ones for feed moves.

    `size` mm is the part's, which the strokes of leaning tools are in proportion to.
    """
    for name in ("feed moves", "rapids", AXES):
        view.remove_actor(name, render=False)
    wanted = np.isin(MOTIONS, list(shown))
    listed = [(path, frame) for path, frame in paths if len(path) > 1]
    drawn = [(opened(path), kinds_of(path), frame) for path, frame in listed]
    for name, is_rapid, width, opacity in (
        ("rapids", True, 1.3, 0.6),
        ("feed moves", False, 2.2, 1.0),
    ):
        kept = wanted & (np.array([m == "rapid" for m in MOTIONS]) == is_rapid)
        lines = _chords(drawn, kept)
        if lines is not None:
            view.add_mesh(
                lines,
                scalars="rgb",
                rgb=True,
                line_width=width,
                opacity=opacity,
                name=name,
                pickable=False,
                reset_camera=False,
                lighting=False,
                show_scalar_bar=False,
            )
    axis_strokes = _axis_strokes(listed, size)
    if len(axis_strokes) and wanted[0]:
        lines = np.column_stack(
            [np.full(len(axis_strokes), 2), np.arange(2 * len(axis_strokes)).reshape(-1, 2)]
        ).ravel()
        view.add_mesh(
            pv.PolyData(axis_strokes.reshape(-1, 3).astype(np.float32), lines=lines),
            color=axis_colour(),
            line_width=1.4,
            opacity=0.85,
            name=AXES,
            pickable=False,
            reset_camera=False,
            lighting=False,
            show_scalar_bar=False,
        )


def _axis_strokes(paths: list[tuple[Toolpath, Frame]], size: float) -> np.ndarray:
    """Return the strokes (k, 2, 3) of the paths on which the tool leans, in the part's coordinates."""
    made = [
        frame.to_world(
            strokes(path, STROKE_EVERY * size, STROKE_LENGTH * size, MOST_STROKES).reshape(-1, 3)
        )
        for path, frame in paths
    ]
    return np.vstack([np.zeros((0, 3)), *made]).reshape(-1, 2, 3)


def _chords(
    paths: list[tuple[tuple[np.ndarray, np.ndarray], np.ndarray, Frame]], kept: np.ndarray
) -> pv.PolyData | None:
    """Return one mesh of the chords whose kinds are wanted, each with its colour."""
    points, ends, kinds, base = [], [], [], 0
    for (own, block), kind, frame in paths:
        rows = np.flatnonzero(kept[kind[block]])
        points.append(frame.to_world(own))
        ends.append(np.column_stack([np.full(len(rows), 2), base + rows, base + rows + 1]))
        kinds.append(kind[block[rows]])
        base += len(own)
    if not sum(len(k) for k in kinds):
        return None
    mesh = pv.PolyData(np.vstack(points).astype(np.float32), lines=np.concatenate(ends).ravel())
    palette = np.array([rgb(motions()[m]) for m in MOTIONS], np.uint8)
    mesh.cell_data["rgb"] = palette[np.concatenate(kinds)]
    return mesh
