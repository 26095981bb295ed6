"""A panel seen from its sides: from above and below, which share their slices, and along it, at its edges."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.sphere import on_axis
from trunnion.progress import Progress
from trunnion.recognize.contract import Slicer
from trunnion.recognize.extent import box
from trunnion.recognize.panel.classes import FaceClass, FaceClasses, classify
from trunnion.recognize.panel.frame import DECIMALS, flipped
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.recognize.panel.side import BELOW, Direction, PanelSide
from trunnion.recognize.panel.slicing.slices import cut, heights
from trunnion.recognize.tunnels import tunnel_walls

LEVEL = (FaceClass.UP, FaceClass.DOWN)
"""Classes of horizontal faces."""


def upright_views(
    graph: FaceGraph,
    frame: Frame,
    slicer: Slicer,
    settings: PanelSettings,
    holes: frozenset[int],
    progress: Progress,
) -> tuple[PanelSide, PanelSide]:
    """Return the part as seen from above and from below, cut once for both."""
    local = graph.in_frame(frame)
    low, high = box(local)
    width, height = float(high[1]), float(high[2])
    classes = classify(local, settings)
    slices = cut(
        slicer,
        frame,
        heights(_events(local, classes), float(low[2]), height, settings.slicing_depth),
        progress,
    )
    turned = graph.in_frame(flipped(frame, width, height))
    return (
        PanelSide(
            graph=local,
            classes=classes,
            slices=slices,
            height=height,
            settings=settings,
            holes=holes,
        ),
        PanelSide(
            graph=turned,
            classes=classify(turned, settings),
            slices=slices.flipped(width, height),
            height=height,
            settings=settings,
            direction=BELOW,
            holes=holes,
        ),
    )


def level_view(
    above: PanelSide,
    graph: FaceGraph,
    frame: Frame,
    slicer: Slicer,
    direction: Direction,
    rows: Collection[int],
    progress: Progress,
) -> PanelSide:
    """Return the part, by its graph in its own coordinates, as it is seen from a level direction of its frame, cut where some of its faces
    (rows) and what lies before them begin and end. Raises `BadInput` where no plane cuts it."""
    seen = level_frame(graph, frame, direction)
    local = graph.in_frame(seen)
    height = float(box(local)[1][2])
    classes = classify(local, above.settings)
    near = _in_plan(local, rows)
    # All that matters begins and ends with a face: no further slices are needed between.
    ends = (*local.box_low[near, 2].tolist(), *local.box_high[near, 2].tolist())
    levels = heights(ends, 0.0, height, np.inf)
    return PanelSide(
        graph=local,
        classes=classes,
        slices=cut(slicer, seen, levels, progress),
        height=height,
        settings=above.settings,
        direction=direction,
        bottom=bottom_along(frame, seen, direction),
        holes=above.holes,
    )


def _events(graph: FaceGraph, classes: FaceClasses) -> list[float]:
    """Return the heights of horizontal faces, and of the edges of walls of tunnels, which may lie between no such faces."""
    walls = np.flatnonzero(tunnel_walls(graph, np.array([0.0, 0.0, 1.0])))
    return [
        *(float(graph.centre[r][2]) for r in classes.rows(*LEVEL)),
        *graph.box_low[walls, 2].tolist(),
        *graph.box_high[walls, 2].tolist(),
    ]


def named_direction(direction: Floats) -> Direction:
    """Return a level direction as it is written: along an axis within the tolerance of angles it is just that axis."""
    exact = on_axis(direction)
    x, y, _ = (round(float(v), DECIMALS) + 0.0 for v in exact / np.linalg.norm(exact))
    return x, y, 0.0


def level_frame(graph: FaceGraph, frame: Frame, direction: Direction) -> Frame:
    """Return the frame of a part that looks along a level direction of its own frame, y along the panel's z, at the lowest corner."""
    z = frame.world_direction(np.array(direction))
    turned = Frame(np.zeros(3), np.cross(frame.z, z), z)
    low, _ = box(graph.in_frame(turned))
    return turned.moved(low)


def bottom_along(frame: Frame, seen: Frame, direction: Direction) -> float:
    """Return where along a level direction, from a frame's origin, the frame that looks along it begins."""
    return float(frame.to_local(seen.origin) @ np.array(direction))


def _in_plan(graph: FaceGraph, rows: Collection[int]) -> list[int]:
    """Return the faces whose box in plan meets that of any of some (rows), themselves among them."""
    own, low, high = np.array(sorted(rows)), graph.box_low[:, :2], graph.box_high[:, :2]
    return [
        r
        for r in np.flatnonzero(graph.area > 0.0).tolist()
        if ((low[own] <= high[r]) & (high[own] >= low[r])).all(axis=1).any()
    ]
