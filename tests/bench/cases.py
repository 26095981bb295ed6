"""What is measured, each beside its reference: see run.py for how."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.progress import NO_PROGRESS

Compare = Callable[..., Any]


def _programmed(path: Path, until: str) -> tuple[Engine, Session]:
    engine = Engine()
    return engine, engine.run(engine.open(path), until=until)


def graph(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """The attributed face graph, beside the kernel's own validity check of the same shape."""
    from OCP.BRepCheck import BRepCheck_Analyzer

    from trunnion.part.part import Part
    from trunnion.part.read.part_file import read_part

    part = read_part(path)
    data = part.to_bytes()
    yield compared(
        "face graph",
        "B1",
        lambda: Part.from_bytes(data).graph(),
        lambda: BRepCheck_Analyzer(part.shape).IsValid(),
        "the CAD kernel's validity check",
        "< 6",
    )


def recognition(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Recognition with all its sections, beside as many sections by the kernel's boolean."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Section
    from OCP.gp import gp_Dir, gp_Pln, gp_Pnt

    from trunnion.part.part import Part
    from trunnion.part.read.part_file import read_part
    from trunnion.recognize.panel import PanelFamily

    part = read_part(path)
    face_graph = part.graph()
    family = PanelFamily()

    data = part.to_bytes()

    def fresh() -> Any:
        return family.recognize(face_graph, Part.from_bytes(data), family.settings(), NO_PROGRESS)

    def by_boolean() -> None:
        for z in range(1, 26):
            cut = BRepAlgoAPI_Section(
                part.shape, gp_Pln(gp_Pnt(0, 0, z * 1.51), gp_Dir(0, 0, 1)), False
            )
            cut.Build()

    yield compared(
        "recognition", "B1", fresh, by_boolean, "25 sections by the CAD kernel's boolean", "< 1.5"
    )


def roughing(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Roughing paths of every pocket, beside the same offsets by shapely alone (chords, no arcs, no entries, no links)."""
    from trunnion import registry
    from trunnion.plan.prismatic.drive import drive_of
    from trunnion.plan.prismatic.regions import SetupSpace
    from trunnion.settings import choose
    from trunnion.toolpath.stock.heightfield import PlanningStock

    engine, session = _programmed(path, "optimize")
    setup, process = session.setups[0], session.process
    assert process is not None and session.recognition is not None and session.blank is not None
    rough = registry.get("strategies", "plane.rough")
    stock = PlanningStock.of(session.blank, setup)
    space = SetupSpace.of(engine.context.part, session.recognition, session.blank, setup)
    jobs = [
        (o, drive_of(o, process, space)) for o in process.operations if o.strategy == "plane.rough"
    ]

    def ours() -> list[Any]:
        return [
            rough(
                drive,
                o.tool,
                o.data,
                stock,
                setup,
                choose(rough.settings, dict(o.choices)),
                NO_PROGRESS,
            )
            for o, drive in jobs
        ]

    def offsets() -> int:
        from shapely.geometry import Polygon

        rings = 0
        for o, drive in jobs:
            for level in drive.levels:
                for piece in level.boundary.intersect(level.wanted).pieces:
                    plain = Polygon(
                        piece.outer.sampled(0.01), [h.sampled(0.01) for h in piece.holes]
                    )
                    inset = o.tool.radius
                    while not (left := plain.buffer(-inset, quad_segs=16)).is_empty:
                        rings += len(getattr(left, "geoms", [left]))
                        inset += o.data.width
        return rings

    yield compared(
        "roughing, all pockets",
        "B1",
        ours,
        offsets,
        "the same insets once a band by shapely, as chords",
        "< 60",
    )


def contact(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Contact of the whole program in closed form, beside sampled points against a hundredth of its blocks in numpy."""
    from trunnion.part.shape.surfaces import surfaces_of
    from trunnion.pipeline.proof.posted_programs import program_of
    from trunnion.verify.contact import PartContact
    from trunnion.verify.motion import moves_of

    engine, session = _programmed(path, "toolpath")
    program = program_of(session, session.setups[0])
    moves = moves_of(program.sections)
    engine_of_contact = PartContact(surfaces_of(engine.context.part, program.setup.frame))
    points = program.setup.frame.to_local(engine.context.part.mesh().points)
    starts = np.vstack([s.path.starts() for s in program.sections])
    ends = np.vstack([s.path.position for s in program.sections])

    def sampled() -> float:
        nearest = np.inf
        for a, b in zip(starts[::100, :2], ends[::100, :2], strict=True):
            along = b - a
            share = np.clip((points[:, :2] - a) @ along / max(along @ along, 1e-12), 0.0, 1.0)
            nearest = min(
                nearest,
                float(np.linalg.norm(points[:, :2] - a - share[:, None] * along, axis=1).min()),
            )
        return nearest

    yield compared(
        f"contact, {len(moves)} blocks",
        "B1",
        lambda: engine_of_contact.along(moves),
        sampled,
        f"the mesh's {len(points)} points against every hundredth block",
        "< 1",
    )


def whole_line(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """From the file to everything written, beside the bare reading of the file."""
    from run import bare_reader

    def ours() -> Any:
        engine, session = _programmed(path, "verify")
        return engine.write(session, folder / "out")

    yield compared(
        "whole line", "B1", ours, bare_reader(path), "the CAD kernel's own reader", "< 200"
    )
