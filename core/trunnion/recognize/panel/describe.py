"""What faces that a person has chosen are in a feature of a panel: their roles by class and blend, sizes as recognition has them.

Which side a feature is seen from follows from its faces: those that look up from one side of the panel; what has such from both is seen
along it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from trunnion.findings import BadInput
from trunnion.geometry.facegraph import CONCAVE, FaceGraph
from trunnion.model.feature import Feature, Recognition, Size
from trunnion.recognize.extent import box
from trunnion.recognize.panel.classes import STEEP_CLASSES, FaceClass, classify
from trunnion.recognize.panel.features import make_boss, make_island, make_rib, pocket_faces
from trunnion.recognize.panel.frame import flipped
from trunnion.recognize.panel.pockets.rules import Island, Pocket
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.recognize.panel.side import ABOVE, BELOW, Direction, PanelSide
from trunnion.recognize.panel.sizes import pocket_sizes
from trunnion.recognize.panel.slicing.slices import Slices
from trunnion.recognize.panel.views import bottom_along, level_frame, named_direction
from trunnion.tolerance import ANGLE
from trunnion.units import rounded

POCKETS = ("pocket", "open_pocket")
DESCRIBABLE = (*POCKETS, "island", "rib", "boss")
"""Kinds of features that faces alone make; holes, pits and outlines are more than their faces."""


def described(
    feature: Feature, found: Recognition, graph: FaceGraph, settings: PanelSettings
) -> Feature:
    """Return a feature with roles, sizes and attributes of its faces; see `recognize.contract.Describing`."""
    view = _side(feature, found, graph, settings)
    rows = [tag - 1 for tag in feature.tags]
    hidden = [r + 1 for r in rows if view.classes.kind[r] in (FaceClass.DOWN, FaceClass.OVERHANG)]
    if hidden:
        raise BadInput(
            f"{feature.id}: face {hidden[0]} looks away from the side that its other faces are seen from; "
            "put it into a feature of the other side"
        )
    if feature.kind in POCKETS:
        made = _pocket(view, feature, rows, found, graph)
    elif feature.kind == "island":
        made = _island(view, feature, rows, found)
    elif feature.kind == "boss":
        made = _boss(view, feature, rows)
    else:
        made = _rib(view, feature, rows, found)
    return replace(made, by_hand=True)


def _side(
    feature: Feature, found: Recognition, graph: FaceGraph, settings: PanelSettings
) -> PanelSide:
    """Return the panel from the side that a feature's level faces look up on, from above where none does; along it where some of its faces
    look up and others down."""
    local = graph.in_frame(found.frame)
    high = box(local)[1]
    rows = [tag - 1 for tag in feature.tags]
    direction = _direction(local, rows)
    if direction in (ABOVE, BELOW):
        over = flipped(found.frame, float(high[1]), float(high[2]))
        seen, height, bottom = over if direction == BELOW else found.frame, float(high[2]), 0.0
    else:
        seen = level_frame(graph, found.frame, direction)
        height = float(box(graph.in_frame(seen))[1][2])
        bottom = bottom_along(found.frame, seen, direction)
    turned = graph.in_frame(seen)
    return PanelSide(
        graph=turned,
        classes=classify(turned, settings),
        slices=Slices(layers=(), outline=shapely.Polygon()),
        height=height,
        settings=settings,
        direction=direction,
        bottom=bottom,
    )


def _direction(graph: FaceGraph, rows: Sequence[int]) -> Direction:
    """Return where a feature's faces (rows) are seen from: above or below, unless some look up and others down; then the level direction
    that one of them looks in and none away from, if there is one."""
    up, down = (
        sum(bool(s * graph.normal[r, 2] > np.cos(np.pi / 4)) for r in rows) for s in (1.0, -1.0)
    )
    if up and down:
        for r in sorted(rows, key=lambda r: -float(graph.area[r])):
            if graph.surface[r] == "plane" and abs(float(graph.normal[r, 2])) < np.sin(ANGLE):
                out = graph.normal[r]
                if (graph.normal[list(rows)] @ out > -np.sin(ANGLE)).all():
                    return named_direction(out)
    return BELOW if down > up else ABOVE


def _sorted(
    view: PanelSide, rows: Sequence[int]
) -> tuple[list[int], list[int], list[int], list[int]]:
    """Return level faces from the highest down, walls, corners, and fillets at their foot. What is curved and lies rather than stands
    counts as level."""
    level, walls, corners, fillets = [], [], [], []
    for r in rows:
        if r in view.fillets:
            fillets.append(r)
        elif r in view.corners:
            corners.append(r)
        elif view.classes.kind[r] in STEEP_CLASSES or view.classes.rising[r]:
            walls.append(r)
        else:
            level.append(r)
    return sorted(level, key=lambda r: (-view.z(r), r)), walls, corners, fillets


def _pocket_of(view: PanelSide, rows: Sequence[int]) -> Pocket:
    level, walls, corners, fillets = _sorted(view, rows)
    floors = set(level)
    sharp = any(
        view.graph.convexity[e] == CONCAVE and view.graph.across(e, w) in floors
        for w in (*walls, *corners)
        for e in view.graph.edges_of[w]
    )
    return Pocket(
        floors=tuple(level),
        walls=tuple(walls),
        corners=tuple(corners),
        fillets=tuple(fillets),
        sharp=sharp,
    )


def _pocket(
    view: PanelSide, feature: Feature, rows: Sequence[int], found: Recognition, graph: FaceGraph
) -> Feature:
    pocket = _pocket_of(view, rows)
    if not pocket.sides and not pocket.floors:
        raise BadInput(f"{feature.id}: a pocket needs a floor or a wall; add one to it")
    ribs = [f.tags[0] - 1 for f in found.of_kind("rib") if _seen_from(f) == view.direction]
    sizes = pocket_sizes(view, pocket, ribs)
    main = graph.in_frame(found.frame)
    at = list(pocket.floors or pocket.sides)
    middle = 0.5 * (main.box_low[at].min(axis=0) + main.box_high[at].max(axis=0))
    x, y, z = (rounded(v) for v in middle.tolist())
    attributes: dict[str, Size] = {
        "centre": (x, y, z if view.is_level else float(sizes["floor_z"])),  # type: ignore[arg-type]
        "identification": feature.kind,
    }
    if not pocket.floors:
        attributes["through"] = True
    attributes |= view.attributes
    if "nested_in" in feature.attributes:
        attributes["nested_in"] = feature.attributes["nested_in"]
    return replace(feature, faces=pocket_faces(view, pocket), sizes=sizes, attributes=attributes)


def _island(view: PanelSide, feature: Feature, rows: Sequence[int], found: Recognition) -> Feature:
    level, walls, corners, fillets = _sorted(view, rows)
    floors = {t - 1: f.id for f in found.of_kind(*POCKETS) for t in f.with_role("floor")}
    beside = {
        view.graph.across(e, r)
        for r in (*walls, *corners, *fillets)
        for e in view.graph.edges_of[r]
    }
    at = sorted(beside & floors.keys(), key=lambda r: (view.z(r), r))
    if not at:
        raise BadInput(
            f"{feature.id}: an island stands on the floor of a pocket, and none is beside its faces; add the walls at its foot"
        )
    island = Island(
        floor=at[0],
        tops=tuple(level),
        walls=tuple(walls),
        corners=tuple(corners),
        fillets=tuple(fillets),
    )
    return make_island(view, feature.id, island, floors[at[0]])


def _rib(view: PanelSide, feature: Feature, rows: Sequence[int], found: Recognition) -> Feature:
    level = _sorted(view, rows)[0]
    if len(rows) != 1 or len(level) != 1:
        raise BadInput(
            f"{feature.id}: a rib is its top, one level face; its sides are walls of the pockets beside it"
        )
    pockets = [
        _pocket_of(view, [t - 1 for t in f.tags])
        for f in found.of_kind(*POCKETS)
        if _seen_from(f) == view.direction
    ]
    return make_rib(view, feature.id, level[0], pockets)


def _boss(view: PanelSide, feature: Feature, rows: Sequence[int]) -> Feature:
    level = _sorted(view, rows)[0]
    if len(rows) != 1 or len(level) != 1:
        raise BadInput(
            f"{feature.id}: a boss is its top, one level face; its sides are the outline and walls of the pockets beside it"
        )
    return make_boss(view, feature.id, level[0])


def _seen_from(feature: Feature) -> Size:
    return feature.attributes.get("direction", ABOVE)
