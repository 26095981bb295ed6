"""What the proof costs: stock beside manifold3d, cost against moves and resolution, five axes, memory, whole parts. See run.py for how."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.verify.motion import Moves, moves_of

Figures = Iterator[dict[str, Any]]
"""Rows of bench.json without their parts: name, seconds, ratio_to, ratio, goal."""
CELL, LEAN = 0.5, (0.0, math.sin(math.radians(25.0)), math.cos(math.radians(25.0)))
RATE, AIM = 150_000.0, 420_000.0
SEGMENTS = 32


def cpu(work: Callable[[], Any]) -> tuple[float, Any]:
    """Return the CPU seconds of some work, and what it returned."""
    began = time.process_time()
    found = work()
    return time.process_time() - began, found


def field(quick: bool) -> Figures:
    """Swept moves of a 16 mm cutter, 1.1 mm each, over cells of 0.5 mm, in CPU seconds beside what the goal allows."""
    n = 10_000 if quick else 50_000
    stock_of(5.0)
    for form in ("flat", "bull", "ball"):
        moves = moves_of([section(tool_of(form), zigzag(n))])
        run(stock_of(5.0), moves)
        seconds = min(cpu(lambda moves=moves: run(stock_of(CELL), moves))[0] for _ in range(3))
        yield {
            "name": f"stock, heights, {form}, {n} moves: {n / seconds:,.0f} a second and core (aim {AIM:,.0f})",
            "seconds": seconds,
            "ratio_to": f"{RATE:,.0f} moves a second and core",
            "ratio": seconds * RATE / n,
            "goal": "< 1",
        }


def manifold(quick: bool) -> Figures:
    """The same paths as mesh booleans: the share that the volumes differ by, and our time beside theirs, one by one and in batches.

    Heights in cells of 0.5 mm; three bundles at 1/160 of the part's length, where the volume is as near as asked for, and at 1/400.
    """
    count, n = (30, 2000) if quick else (100, 5000)
    up, three = (0.0, 0.0, 1.0), ("x", "y", "z")
    cases = (
        ("heights, flat", "flat", up, ("z",), CELL),
        ("heights, ball", "ball", up, ("z",), CELL),
        ("three bundles, leaning ball, 1/160", "ball", LEAN, three, 1.25),
        ("three bundles, leaning ball, 1/400", "ball", LEAN, three, CELL),
    )
    for name, form, axis, bundles, cell in cases:
        path = zigzag(n, side=200.0, step=1.5, axis=axis)
        some, every = (
            moves_of([section(tool_of(form), path[: count + 1], axis)]),
            moves_of([section(tool_of(form), path, axis)]),
        )
        removed = float(run(stock_of(cell, bundles), some).removed.sum())
        ours = (
            cpu(
                lambda every=every, bundles=bundles, cell=cell: run(stock_of(cell, bundles), every)
            )[0]
            / n
        )
        one_by_one, batched, booleans = _booleans(form, path[: count + 1], axis)
        yield {
            "name": f"volume of {count} moves, {name}",
            "seconds": ours * count,
            "ratio_to": "the volume by manifold3d, share it differs",
            "ratio": abs(removed / booleans - 1.0),
            "goal": "< 0.005",
        }
        for kind, theirs, goal in (("one by one", one_by_one, 0.01), ("in a batch", batched, 0.05)):
            yield {
                "name": f"stock, {name}: {theirs / ours:,.0f} x manifold3d {kind}",
                "seconds": ours * n,
                "ratio_to": f"manifold3d {kind}, seconds a move",
                "ratio": ours / theirs,
                "goal": f"< {goal}",
            }


def growth(quick: bool) -> Figures:
    """How cost grows: with the number of moves, and with the resolution of an upright, a leaning and a turning cutter."""
    n = 300 if quick else 1000
    ball = tool_of("ball")
    cases = {
        "heights": (("z",), zigzag(20 * n), (0.0, 0.0, 1.0)),
        "three bundles, leaning": (("x", "y", "z"), zigzag(n), LEAN),
        "three bundles, turning": (("x", "y", "z"), zigzag(n), turning(n)),
    }
    for name, (bundles, path, axis) in cases.items():
        quarter = len(path) // 4
        some = moves_of(
            [
                section(
                    ball, path[:quarter], axis[:quarter] if isinstance(axis, np.ndarray) else axis
                )
            ]
        )
        every = moves_of([section(ball, path, axis)])
        run(stock_of(CELL, bundles), some)
        cell = CELL if name == "heights" else 2.0 * CELL
        few, all_of_it = (
            _least(lambda m=m, cell=cell, bundles=bundles: run(stock_of(cell, bundles), m))
            for m in (some, every)
        )
        fine = _least(
            lambda cell=cell, bundles=bundles, every=every: run(
                stock_of(cell / 2.0, bundles), every
            )
        )
        power = 2.5 if "turning" in name else 2.0
        yield {
            "name": f"stock, {name}: cost against moves",
            "seconds": all_of_it,
            "ratio_to": "a power of the number of moves",
            "ratio": math.log(all_of_it / few, len(every) / len(some)),
            "goal": "< 1.1",
        }
        yield {
            "name": f"stock, {name}: cost against resolution",
            "seconds": fine,
            "ratio_to": "a power of 1 / cell",
            "ratio": math.log2(fine / all_of_it),
            "goal": f"< {power}",
        }


def five_axes(quick: bool) -> Figures:
    """Contact of 200,000 five-axis blocks with a mesh of 100,000 triangles, and their stock at 1/400 of the part's length: CPU seconds
    over the cores. The quick mode takes the first twentieth of the blocks."""
    from five_axis import five_axis_case
    from trunnion.part.shape.facets import Facets
    from trunnion.verify.contact.facets import FacetContact
    from trunnion.verify.stock import Stock, run_stock

    case = five_axis_case(200_000, 100_000)
    blocks = 10_000 if quick else len(case.section.path)
    moves, few = moves_of([_first(case.section, blocks)]), moves_of([_first(case.section, 50)])
    share, cores = blocks / 200_000, os.cpu_count()
    facets = FacetContact(Facets.of_mesh(case.points, case.triangles, case.face, case.tag))
    facets.along(few, np.arange(len(few)))
    seconds = _shared(lambda: facets.along(moves, np.arange(len(moves))))
    yield {
        "name": f"contact, {blocks} five-axis blocks, 100,000 triangles",
        "seconds": seconds,
        "ratio_to": f"60 s for 200,000, on {cores} cores",
        "ratio": seconds / (60.0 * share),
        "goal": "< 1",
    }
    blank = Box(frame=WORLD, low=case.blank_low, high=case.blank_high, material="x", density=1.0)
    cell = (case.blank_high[0] - case.blank_low[0]) / 400.0
    run_stock(Stock.of(blank, 10.0 * cell, ("x", "y", "z")), few, WORLD)
    seconds = _shared(lambda: run_stock(Stock.of(blank, cell, ("x", "y", "z")), moves, WORLD))
    yield {
        "name": f"stock, {blocks} five-axis blocks at 1/400 of the length",
        "seconds": seconds,
        "ratio_to": f"180 s for 200,000, on {cores} cores",
        "ratio": seconds / (180.0 * share),
        "goal": "< 1",
    }


def memory(quick: bool) -> Figures:
    """How much memory a million blocks take beyond their own arrays and the stock, in a process of its own."""
    blocks = 100_000 if quick else 1_000_000
    code = (
        f"import sys; sys.path[:0] = {sys.path[:2]!r}; import proof; proof.print_growth({blocks})"
    )
    began = time.perf_counter()
    told = subprocess.run(
        [sys.executable, "-c", code],
        check=True,
        capture_output=True,
        text=True,
        cwd=Path(__file__).parent,
    )
    grown = json.loads(told.stdout.splitlines()[-1])
    yield {
        "name": f"memory of {blocks} blocks: moves {grown['moves']:.0f} bytes a block, proof {grown['proof']:.0f}",
        "seconds": time.perf_counter() - began,
        "ratio_to": "1000 bytes a block, at the peak, beyond the moves themselves",
        "ratio": grown["proof"] / 1000.0,
        "goal": "< 1",
    }


def print_growth(blocks: int) -> None:
    """Print, as JSON, the bytes a block that moves take, and that the proof takes at its peak beyond them."""
    import resource

    tool = tool_of("flat")
    run(stock_of(CELL), moves_of([section(tool, zigzag(100))]))
    path = section(tool, zigzag(blocks))
    before = _resident()
    moves = moves_of([path])
    after = _resident()
    run(stock_of(CELL), moves)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps({"moves": (after - before) / blocks, "proof": max(peak - after, 0) / blocks}))


def whole_parts(quick: bool) -> Figures:
    """The proof of a whole program, wall time: B1, and B4 where the shared parts are beside the project."""
    import tempfile

    from run import unpacked

    from parts import PARTS
    from trunnion.pipeline import Engine

    with tempfile.TemporaryDirectory() as folder:
        files = {"B1": (unpacked(Path(folder)), 10.0)}
        if PARTS is not None and not quick:
            files["B4"] = (PARTS / "panel" / "B4.step", 40.0)
        # The first proof of all also loads the compiled loops.
        for name, (path, goal) in [("", files["B1"]), *files.items()]:
            engine = Engine()
            session = engine.run(engine.open(path), until="toolpath")
            began = time.perf_counter()
            engine.run(session, until="verify")
            seconds = time.perf_counter() - began
            if name:
                yield {
                    "name": "proof of the whole program",
                    "part": name,
                    "seconds": seconds,
                    "ratio_to": f"{goal:g} s on two cores",
                    "ratio": seconds / goal,
                    "goal": "< 1",
                }


PROOF: dict[str, Callable[[bool], Figures]] = {
    "field": field,
    "manifold": manifold,
    "growth": growth,
    "five-axes": five_axes,
    "memory": memory,
    "whole-parts": whole_parts,
}
"""Cases by the name that `run.py --only` knows them by."""


def tool_of(form: str) -> Tool:
    """Return a 16 mm cutter of a form, in a holder far above the work."""
    from verify_tools import bull

    return bull(16.0, {"flat": 0.0, "bull": 3.0, "ball": 8.0}[form])(flute=60.0)


def stock_of(cell: float, bundles: tuple[str, ...] = ("z",)) -> Any:
    """Return a block of 200 x 200 x 30 as stock."""
    from trunnion.verify.stock import Stock

    return Stock.of(
        Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=(200.0, 200.0, 30.0), material="x", density=1.0),
        cell,
        bundles,
    )


def run(stock: Any, moves: Moves) -> Any:
    """Cut moves out of a stock on one thread."""
    from trunnion.verify.stock import run_stock

    return run_stock(stock, moves, WORLD, threads=1)


def zigzag(n: int, side: float = 200.0, step: float = 1.1, axis: Any = None) -> Floats:
    """Return n stops of level rows to and fro over a block, 4 mm apart, then 2 mm deeper again; the first is a plunge's."""
    per_row = int((side - 40.0) / step)
    k = np.arange(n)
    row, at = np.divmod(k, per_row)
    rows = int((side - 40.0) / 4.0)
    layer, row_there = np.divmod(row, rows)
    x = 20.0 + np.where(row % 2 == 0, at, per_row - 1 - at) * step
    y = 20.0 + np.where(layer % 2 == 0, row_there, rows - 1 - row_there) * 4.0
    return np.column_stack([x, y, np.maximum(22.0 - 2.0 * layer, 2.0)])


def turning(n: int) -> Floats:
    """Return axes (n, 3) that lean by 15 degrees to all sides in turn, 2 degrees a block."""
    angle, lean = np.radians(2.0) * np.arange(n), math.radians(15.0)
    return np.column_stack(
        [math.sin(lean) * np.cos(angle), math.sin(lean) * np.sin(angle), np.full(n, math.cos(lean))]
    )


def section(tool: Tool, stops: Floats, axis: Any = (0.0, 0.0, 1.0)) -> ProgramSection:
    """Return a section that comes to the first stop at rapid along the axis and feeds to all of them."""
    axes = np.asarray(axis) if np.ndim(axis) == 2 else np.tile(axis, (len(stops), 1))
    position, axes = np.vstack([stops[:1] + 60.0 * axes[:1], stops]), np.vstack([axes[:1], axes])
    motion = np.full(len(position), int(Motion.LINE))
    motion[0] = int(Motion.RAPID)
    path = Toolpath(
        position=position,
        axis=axes,
        motion=motion,
        centre=np.full(position.shape, np.nan),
        feed=np.where(motion == int(Motion.RAPID), 0.0, 1000.0),
        mark=np.zeros(len(position), int),
    )
    return ProgramSection(operation="bench", tool=tool, spindle=10000.0, path=path)


def _first(section: ProgramSection, blocks: int) -> ProgramSection:
    """Return the first blocks of a section."""
    path = section.path
    own = {
        name: getattr(path, name)[:blocks]
        for name in ("position", "axis", "motion", "centre", "feed", "mark")
    }
    return replace(section, path=Toolpath(**own))


def _shared(work: Callable[[], Any]) -> float:
    """Return the CPU seconds of work on all cores, a core: its wall time where nothing else runs."""
    return cpu(work)[0] / (os.cpu_count() or 1)


def _least(work: Callable[[], Any]) -> float:
    return min(cpu(work)[0] for _ in range(2))


def _resident() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def _booleans(
    form: str, stops: Floats, axis: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Return manifold3d's CPU seconds a move one by one and in one batch, on a block of 50,000 triangles, and the volume by a finer one."""
    import manifold3d

    block = _wavy_block()
    sweeps = [
        manifold3d.Manifold.batch_hull(
            [_cutter(form, axis, SEGMENTS).translate(p), _cutter(form, axis, SEGMENTS).translate(q)]
        )
        for p, q in pairwise(stops)
    ]

    def one_by_one() -> int:
        left = block
        for sweep in sweeps:
            left = left - sweep
            left.num_tri()
        return int(left.num_tri())

    def batched() -> int:
        return int(
            (block - manifold3d.Manifold.batch_boolean(sweeps, manifold3d.OpType.Add)).num_tri()
        )

    seconds = [cpu(work)[0] / len(sweeps) for work in (one_by_one, batched)]
    plain = manifold3d.Manifold.cube((200.0, 200.0, 30.0))
    fine = _cutter(form, axis, 8 * SEGMENTS)
    # The plunge to the first stop is a move, too.
    down = manifold3d.Manifold.batch_hull(
        [fine.translate(stops[0]), fine.translate(stops[0] + 60.0 * np.asarray(axis))]
    )
    ways = [
        manifold3d.Manifold.batch_hull([fine.translate(p), fine.translate(q)])
        for p, q in _runs(stops)
    ]
    left = plain - manifold3d.Manifold.batch_boolean([down, *ways], manifold3d.OpType.Add)
    return seconds[0], seconds[1], float(plain.volume() - left.volume())


def _runs(stops: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Yield start and end of each straight row: the same volume by fewer hulls."""
    first = 0
    for k in range(1, len(stops)):
        ends = k + 1 == len(stops)
        if (
            ends
            or np.linalg.norm(np.cross(stops[k] - stops[first], stops[k + 1] - stops[k])) > 1e-9
        ):
            yield stops[first], stops[k]
            first = k


def _cutter(form: str, axis: tuple[float, float, float], segments: int) -> Any:
    import manifold3d

    angles = np.linspace(-math.pi / 2, 0.0, segments // 4 + 1)
    outline = (
        [(0.0, 0.0), (8.0, 0.0)]
        if form == "flat"
        else [(8.0 * math.cos(a), 8.0 + 8.0 * math.sin(a)) for a in angles]
    )
    cross = manifold3d.CrossSection([[*outline, (8.0, 60.0), (0.0, 60.0)]])
    lean = math.degrees(math.atan2(-axis[1], axis[2]))
    return manifold3d.Manifold.revolve(cross, segments).rotate((lean, 0.0, 0.0))


@cache
def _wavy_block() -> Any:
    """Return a block of about 50,000 triangles with a wavy top, as in the measurements of the peers."""
    import manifold3d

    n = 111
    across = np.linspace(0.0, 200.0, n + 1)
    x, y = np.meshgrid(across, across, indexing="ij")
    top = np.column_stack(
        [x.ravel(), y.ravel(), (30.0 + np.sin(x / 9.0) * np.cos(y / 7.0)).ravel()]
    )
    corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)[:-1, :-1].ravel()
    upper = np.vstack(
        [
            np.column_stack([corner, corner + n + 1, corner + n + 2]),
            np.column_stack([corner, corner + n + 2, corner + 1]),
        ]
    )
    edges = np.vstack([upper[:, [0, 1]], upper[:, [1, 2]], upper[:, [2, 0]]])
    known = {(int(a), int(b)) for a, b in edges}
    rim = np.array([(a, b) for a, b in known if (b, a) not in known])
    lower = len(top)
    walls = np.vstack(
        [
            np.column_stack([rim[:, 1], rim[:, 0], rim[:, 0] + lower]),
            np.column_stack([rim[:, 1], rim[:, 0] + lower, rim[:, 1] + lower]),
        ]
    )
    points = np.vstack([top, top * [1.0, 1.0, 0.0]]).astype(np.float32)
    return manifold3d.Manifold(
        manifold3d.Mesh(points, np.vstack([upper, upper[:, ::-1] + lower, walls]).astype(np.uint32))
    )
