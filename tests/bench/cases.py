"""What is measured, each beside its reference: see run.py for how."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from trunnion.model.program import ProgramSection
from trunnion.model.session import Session
from trunnion.model.toolpath import Mark, Motion, Toolpath
from trunnion.pipeline import Engine
from trunnion.progress import QUIET

Compare = Callable[..., Any]
UP, NOWHERE = (0.0, 0.0, 1.0), (math.nan,) * 3


def _programmed(path: Path, until: str) -> tuple[Engine, Session]:
    engine = Engine()
    return engine, engine.run(engine.open(path), until=until)


def graph(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """The attributed face graph, beside the kernel's own validity check of the same shape."""
    from OCP.BRepCheck import BRepCheck_Analyzer

    from trunnion.part.part import Part
    from trunnion.part.read import read_part
    part = read_part(path)
    data = part.to_bytes()
    yield compared("face graph", "B1", lambda: Part.from_bytes(data).graph(), lambda: BRepCheck_Analyzer(part.shape).IsValid(),
                   "the CAD kernel's validity check", "< 6")


def recognition(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Recognition with all its sections, beside as many sections by the kernel's boolean."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Section
    from OCP.gp import gp_Dir, gp_Pln, gp_Pnt

    from trunnion.part.part import Part
    from trunnion.part.read import read_part
    from trunnion.recognize.panel import PanelFamily
    part = read_part(path)
    face_graph = part.graph()
    family = PanelFamily()

    data = part.to_bytes()

    def fresh() -> Any:
        return family.recognize(face_graph, Part.from_bytes(data), family.settings(), QUIET)

    def by_boolean() -> None:
        for z in range(1, 26):
            cut = BRepAlgoAPI_Section(part.shape, gp_Pln(gp_Pnt(0, 0, z * 1.51), gp_Dir(0, 0, 1)), False)
            cut.Build()

    yield compared("recognition", "B1", fresh, by_boolean, "25 sections by the CAD kernel's boolean", "< 1.5")


def roughing(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Roughing paths of every pocket, beside the same offsets by shapely alone (chords, no arcs, no entries, no links)."""
    from trunnion import registry
    from trunnion.plan.drive import drive_of
    from trunnion.settings import choose
    from trunnion.toolpath.stock import PlanningStock
    engine, session = _programmed(path, "optimize")
    setup, process = session.setups[0], session.process
    assert process is not None and session.recognition is not None and session.blank is not None
    rough = registry.get("strategies", "plane.rough")
    stock = PlanningStock.of(session.blank, setup)
    jobs = [(o, drive_of(o, process, session.recognition, engine.bench.part, session.blank, setup))
            for o in process.operations if o.strategy == "plane.rough"]

    def ours() -> list[Any]:
        return [rough(drive, o.tool, o.data, stock, setup, choose(rough.settings, dict(o.choices)), QUIET) for o, drive in jobs]

    def offsets() -> int:
        from shapely.geometry import Polygon
        rings = 0
        for o, drive in jobs:
            for level in drive.levels:
                for piece in level.boundary.intersect(level.wanted).pieces:
                    plain = Polygon(piece.outer.sampled(0.01), [h.sampled(0.01) for h in piece.holes])
                    inset = o.tool.radius
                    while not (left := plain.buffer(-inset, quad_segs=16)).is_empty:
                        rings += len(getattr(left, "geoms", [left]))
                        inset += o.data.width
        return rings

    yield compared("roughing, all pockets", "B1", ours, offsets, "the same insets once a band by shapely, as chords", "< 60")


def contact(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Contact of the whole program in closed form, beside sampled points against a hundredth of its blocks in numpy."""
    from trunnion.part.surfaces import surfaces_of
    from trunnion.pipeline.proving import program_of
    from trunnion.verify.contact import PartContact
    from trunnion.verify.motion import moves_of
    engine, session = _programmed(path, "toolpath")
    program = program_of(session, session.setups[0])
    moves = moves_of(program.sections)
    engine_of_contact = PartContact(surfaces_of(engine.bench.part, program.setup.frame))
    points = program.setup.frame.to_local(engine.bench.part.mesh().points)
    starts = np.vstack([s.path.starts() for s in program.sections])
    ends = np.vstack([s.path.position for s in program.sections])

    def sampled() -> float:
        nearest = np.inf
        for a, b in zip(starts[::100, :2], ends[::100, :2], strict=True):
            along = b - a
            share = np.clip((points[:, :2] - a) @ along / max(along @ along, 1e-12), 0.0, 1.0)
            nearest = min(nearest, float(np.linalg.norm(points[:, :2] - a - share[:, None] * along, axis=1).min()))
        return nearest

    yield compared(f"contact, {len(moves)} blocks", "B1", lambda: engine_of_contact.along(moves), sampled,
                   f"the mesh's {len(points)} points against every hundredth block", "< 1")


def stock(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """Swept moves of a 16 mm cutter, 1.1 mm each, in a field of 0.5 mm cells, beside a plain numpy field with a hundredth of the moves."""
    from trunnion.geometry.frame import WORLD
    from trunnion.model.blank import Blank
    from trunnion.verify.motion import moves_of
    from trunnion.verify.stock import Stock, run_stock
    from trunnion.verify.sweep import Sweep
    blank = Blank(frame=WORLD, low=np.zeros(3), high=np.array([300.0, 300.0, 20.0]), material="x", density=1.0)
    tip = _spiral(50_000)
    moves = moves_of((ProgramSection(operation="x", tool=_flat_16(), spindle=1.0, path=tip),))
    sweep = Sweep.of(moves, 1.0)

    def plain() -> float:
        heights = np.full((600, 600), 20.0)
        centres = (np.arange(600) + 0.5) * 0.5
        for a, b in zip(tip.position[:500], tip.position[1:501], strict=True):
            x0, x1 = (np.searchsorted(centres, v) for v in (min(a[0], b[0]) - 8.0, max(a[0], b[0]) + 8.0))
            y0, y1 = (np.searchsorted(centres, v) for v in (min(a[1], b[1]) - 8.0, max(a[1], b[1]) + 8.0))
            gx, gy = np.meshgrid(centres[x0:x1], centres[y0:y1])
            along = (b - a)[:2]
            share = np.clip(((gx - a[0]) * along[0] + (gy - a[1]) * along[1]) / (along @ along), 0.0, 1.0)
            inside = (gx - a[0] - share * along[0]) ** 2 + (gy - a[1] - share * along[1]) ** 2 <= 64.0
            piece = heights[y0:y1, x0:x1]
            piece[inside] = np.minimum(piece[inside], a[2])
        return float(heights.sum())

    yield compared("stock, 50,000 moves", "block", lambda: run_stock(Stock.of(blank, 0.5), moves, WORLD, sweep), plain,
                   "500 moves in a plain numpy field", "< 3")


def whole_line(path: Path, folder: Path, compared: Compare) -> Iterator[Any]:
    """From the file to everything written, beside the bare reading of the file."""
    from run import bare_reader

    def ours() -> Any:
        engine, session = _programmed(path, "verify")
        return engine.write(session, folder / "out")

    yield compared("whole line", "B1", ours, bare_reader(path), "the CAD kernel's own reader", "< 200")


def _flat_16() -> Any:
    from trunnion.shop import load_shop
    return next(t for t in load_shop().tools if t.diameter == 16.0 and t.corner_radius == 0.0)


def _spiral(n: int) -> Toolpath:
    turn = np.sqrt(np.arange(n) * 1.1 * 2 * 4.0 / math.pi / 4.0)
    position = np.column_stack([150.0 + 0.636 * turn * np.cos(turn), 150.0 + 0.636 * turn * np.sin(turn), np.full(n, 10.0)])
    steps = np.linalg.norm(np.diff(position, axis=0), axis=1)
    position[:, :2] = 150.0 + (position[:, :2] - 150.0) * (1.1 / np.median(steps))
    motion = np.full(n, int(Motion.LINE))
    motion[0] = int(Motion.RAPID)
    feed = np.where(motion == Motion.RAPID, 0.0, 1000.0)
    return Toolpath(position=position, axis=np.tile(UP, (n, 1)), motion=motion, centre=np.tile(NOWHERE, (n, 1)), feed=feed,
                    mark=np.full(n, int(Mark.CUT)))


