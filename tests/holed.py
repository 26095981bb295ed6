"""Parts with holes for the tests of planning, strategies and proof, and their features made by hand."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.hole_demands import with_hole_demand
from trunnion.plan.holes.demand import fit_demand, thread_demand

HIGH = 20.0
"""mm: how thick the plates are."""


def plate(file: Path, *holes: dict[str, Any], length: float = 100.0, width: float = 60.0) -> Path:
    """Write a plate with holes from its top and return the file; `holes` have the sizes of their features in the part's coordinates."""
    import cadquery as cq

    solid = cq.Workplane("XY").box(length, width, HIGH, centered=False)
    for h in holes:
        depth, radius = h["depth"], h["diameter"] / 2
        # A through hole goes on past the underside, so that no film stays.
        more = 1.0 if h.get("through") else 0.0
        solid = solid.cut(_cylinder(cq, h, radius, depth + more))
        if "point_angle" in h:
            cone = radius / np.tan(np.radians(h["point_angle"] / 2))
            tip = cq.Solid.makeCone(
                radius, 0.0, cone, pnt=_at(cq, h, depth), dir=cq.Vector(0, 0, -1)
            )
            solid = solid.cut(cq.Workplane(tip))
        if "counterbore_diameter" in h:
            wide = _cylinder(cq, h, h["counterbore_diameter"] / 2, h["counterbore_depth"])
            solid = solid.cut(wide)
        if "countersink_diameter" in h:
            r = h["countersink_diameter"] / 2
            down = (r - radius) / np.tan(np.radians(h["countersink_angle"] / 2))
            sink = cq.Solid.makeCone(r, radius, down, pnt=_at(cq, h, 0.0), dir=cq.Vector(0, 0, -1))
            solid = solid.cut(cq.Workplane(sink))
    cq.exporters.export(solid, str(file))
    return file


def _at(cq: Any, h: dict[str, Any], depth: float) -> Any:
    return cq.Vector(h["x"], h["y"], h.get("top_z", HIGH) - depth)


def _cylinder(cq: Any, h: dict[str, Any], radius: float, depth: float) -> Any:
    made = cq.Solid.makeCylinder(radius, depth, _at(cq, h, 0.0), cq.Vector(0, 0, -1))
    return cq.Workplane(made)


def hole(x: float, y: float, diameter: float, depth: float = HIGH, **sizes: Any) -> dict[str, Any]:
    """Return the sizes of a hole from the plate's top; it goes through unless it is less deep than the plate."""
    through = depth >= sizes.get("top_z", HIGH)
    return {
        "x": x,
        "y": y,
        "top_z": HIGH,
        "diameter": diameter,
        "depth": depth,
        "through": through,
        **sizes,
    }


def feature(
    number: int, sizes: dict[str, Any], graph: FaceGraph | None = None, frame: Frame = WORLD
) -> Feature:
    """Return the feature of a hole, `sizes` in the part's coordinates, with its position in a frame; its faces are those of the graph on
    its axis."""
    faces = () if graph is None else tuple(_faces(sizes, graph))
    x, y, z = frame.to_local(np.array([sizes["x"], sizes["y"], sizes["top_z"]])).tolist()
    own = {**sizes, "x": x, "y": y, "top_z": z}
    return Feature(id=f"hole-{number:02}", kind="hole", faces=faces, sizes=own)


def _faces(sizes: dict[str, Any], graph: FaceGraph) -> list[FaceRole]:
    found = []
    middle = 0.5 * (graph.box_low + graph.box_high)
    size = graph.box_high - graph.box_low
    for row, surface in enumerate(graph.surface):
        on_axis = np.hypot(middle[row, 0] - sizes["x"], middle[row, 1] - sizes["y"]) < 0.01
        wide = float(size[row, 0])
        if (
            not on_axis
            or wide
            > max(
                sizes["diameter"],
                sizes.get("counterbore_diameter", 0.0),
                sizes.get("countersink_diameter", 0.0),
            )
            + 0.1
        ):
            continue
        deep = sizes["top_z"] - middle[row, 2]
        bore = abs(wide - sizes["diameter"]) < 0.01
        if surface == "cylinder":
            role = "side" if bore else "counterbore_side"
        elif surface == "cone":
            role = "bottom" if deep > sizes["depth"] else "countersink"
        else:
            role = "bottom" if bore and deep > sizes["depth"] - 0.01 else "counterbore_floor"
        found.append(FaceRole(role=role, face=row + 1))
    return found


def with_holes(recognition: Recognition, graph: FaceGraph, *holes: dict[str, Any]) -> Recognition:
    """Return a recognition with the features of holes in place of what it has for their faces."""
    made = tuple(feature(n, sizes, graph, recognition.frame) for n, sizes in enumerate(holes, 1))
    own = {tag for f in made for tag in f.tags}
    kept = tuple(
        replace(f, faces=tuple(r for r in f.faces if r.face not in own))
        for f in recognition
        if f.kind != "hole"
    )
    kept = tuple(f for f in kept if f.faces)
    loose = set(recognition.unexplained) - own
    return replace(recognition, features=(*kept, *made)).with_unexplained(loose)


@cache
def holed_plate() -> tuple[Engine, Session]:
    """Return an engine and the session of a plate with holes of every sort, fits and threads in some, up to its toolpaths; its features are
    made by hand."""
    holes = (
        hole(20, 15, 8),
        hole(80, 15, 8, 10.0),
        hole(20, 45, 9, counterbore_diameter=15, counterbore_depth=6),
        hole(80, 45, 6, countersink_diameter=12, countersink_angle=90),
        hole(50, 30, 7.7),
        hole(50, 12, 10),
        hole(50, 48, 9),
        hole(35, 30, 5),
        hole(65, 30, 5, 14.0, point_angle=140.0),
    )
    demands = {
        "hole-06": fit_demand("H7"),
        "hole-07": fit_demand("K7"),
        "hole-08": thread_demand("M6"),
        "hole-09": thread_demand("M6", 8.0),
    }
    engine = Engine()
    with TemporaryDirectory() as folder:
        session = engine.open(plate(Path(folder) / "plate.step", *holes))
    session = replace(session, choices={"recognize.family": "panel"})
    session = engine.run(session, until="recognize")
    made = with_holes(session.recognition, engine.context.part.graph(), *holes)
    session = replace(session, recognition=made)
    for id, demand in demands.items():
        session = with_hole_demand(engine, session, [id], demand)
    return engine, engine.run(session, until="toolpath")
