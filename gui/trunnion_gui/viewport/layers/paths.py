"""Toolpaths, coloured by kind of motion, with short strokes along the tool where it leans."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True, slots=True, eq=False)
class OpenedPath:
    """A path as it is drawn in the part's coordinates, mm: points (k + 1, 3) of its chords, the kind of each chord (k,) as a row of
    `MOTIONS`, and strokes (m, 2, 3) where its tool leans."""

    path: Toolpath
    frame: Frame
    size: float
    points: np.ndarray
    kinds: np.ndarray
    strokes: np.ndarray


class PathLayer:
    """Toolpaths as lines: thin ones for rapids, strong ones for feed moves. What was opened once is kept for as long as it is shown."""

    def __init__(self, view: Any) -> None:
        self._view = view
        self._opened: dict[int, OpenedPath] = {}

    def draw(
        self, paths: Sequence[tuple[Toolpath, Frame]], shown: Iterable[str], size: float
    ) -> Iterator[None]:
        """Show toolpaths (each with its setup's frame) in pieces of work; until the last one is done, those before them stay.

        `size` mm is the part's, which the strokes of leaning tools are in proportion to.
        """
        wanted = np.isin(MOTIONS, list(shown))
        drawn = []
        for path, frame in paths:
            if len(path) > 1:
                drawn.append(self._open(path, frame, size))
                yield
        if len(paths) != 1:
            # One operation alone is shown for a while; the others come back.
            self._opened = {id(one.path): one for one in drawn}
        is_rapid = np.array([m == "rapid" for m in MOTIONS])
        rapids = _chords(drawn, wanted & is_rapid)
        yield
        feeds = _chords(drawn, wanted & ~is_rapid)
        yield
        with_axes = drawn if wanted[0] else []
        axes = _axis_lines(np.vstack([np.zeros((0, 2, 3)), *(d.strokes for d in with_axes)]))
        self._show("rapids", rapids, scalars="rgb", rgb=True, line_width=1.3, opacity=0.6)
        self._show("feed moves", feeds, scalars="rgb", rgb=True, line_width=2.2, opacity=1.0)
        self._show(AXES, axes, color=axis_colour(), line_width=1.4, opacity=0.85)

    def _open(self, path: Toolpath, frame: Frame, size: float) -> OpenedPath:
        kept = self._opened.get(id(path))
        if kept is not None and kept.path is path and (kept.frame, kept.size) == (frame, size):
            return kept
        points, block = opened(path)
        leaning = strokes(path, STROKE_EVERY * size, STROKE_LENGTH * size, MOST_STROKES)
        made = self._opened[id(path)] = OpenedPath(
            path=path,
            frame=frame,
            size=size,
            points=frame.to_world(points),
            kinds=kinds_of(path)[block],
            strokes=frame.to_world(leaning.reshape(-1, 3)).reshape(-1, 2, 3),
        )
        return made

    def _show(self, name: str, lines: pv.PolyData | None, **look: Any) -> None:
        self._view.remove_actor(name, render=False)
        if lines is not None:
            self._view.add_mesh(
                lines,
                name=name,
                pickable=False,
                reset_camera=False,
                lighting=False,
                show_scalar_bar=False,
                **look,
            )


def _axis_lines(axis_strokes: np.ndarray) -> pv.PolyData | None:
    """Return one mesh of strokes (k, 2, 3)."""
    n = len(axis_strokes)
    if not n:
        return None
    lines = np.column_stack([np.full(n, 2), np.arange(2 * n).reshape(-1, 2)]).ravel()
    return pv.PolyData(axis_strokes.reshape(-1, 3).astype(np.float32), lines=lines)


def _chords(paths: Sequence[OpenedPath], kept: np.ndarray) -> pv.PolyData | None:
    """Return one mesh of the chords whose kinds are wanted, each with its colour."""
    points, ends, kinds, base = [], [], [], 0
    for one in paths:
        rows = np.flatnonzero(kept[one.kinds])
        points.append(one.points)
        ends.append(np.column_stack([np.full(len(rows), 2), base + rows, base + rows + 1]))
        kinds.append(one.kinds[rows])
        base += len(one.points)
    if not sum(len(k) for k in kinds):
        return None
    mesh = pv.PolyData(np.vstack(points).astype(np.float32), lines=np.concatenate(ends).ravel())
    palette = np.array([rgb(motions()[m]) for m in MOTIONS], np.uint8)
    mesh.cell_data["rgb"] = palette[np.concatenate(kinds)]
    return mesh
