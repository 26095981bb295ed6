"""What every registered strategy whose tool rotates must do, whoever wrote it: ours, and those of packages in `tests/families`.

A strategy is looked at in an operation of a small part that uses it, after all that comes before; one that no small part's plan uses takes
the place of an operation that is driven by the same class of geometry.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from gap_turning import ring_with_gaps
from holed import holed_plate
from long_mark import mostly_long
from pitted import pitted_block
from subjects import (
    DEAR,
    MILLING,
    PLANNERS,
    STRATEGIES,
    check_cancel,
    check_settings,
    dear_ones_long,
    is_one_line,
    own,
    until,
)
from trunnion import registry
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.model.tool import Tool
from trunnion.pipeline import Engine
from trunnion.pipeline.toolpaths import make_paths
from trunnion.plan.contract import ToolAxis
from trunnion.plan.freeform.reach import samples_on
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.motion import moves_of

by_name = pytest.mark.parametrize("name", MILLING)
by_name_often = pytest.mark.parametrize("name", dear_ones_long(MILLING))
COARSE = {"surface.scallop": 0.3}
"""Scallops in mm for passes that nobody proves."""
NOT_LESS = 0.95
"""Foreseen over measured power: the stock's cells let the proof see a little more than there is."""
LARGER, LITTLE_LARGER = 4.0, 1.25
"""Diameters of cutters that are far too large, and of the next ones, over that of the one that was chosen."""
PLACES, NEAR, FAR = 2000, 5.0, 10.0
"""Places on faces that material left is measured at; mm: how far it is listed by cells, and the most that counts."""
UNEVEN = 0.005
"""mm: by how much the mean of material left differs by where passes lie."""


@dataclass(frozen=True, eq=False)
class Case:
    """An operation by a strategy, in a session whose process ends with it; `is_own` where a plan chose the strategy for it."""

    engine: Engine
    session: Session
    operation: Operation
    is_own: bool

    def path(self, operation=None, progress=NO_PROGRESS, alone=False) -> OperationPath:
        """Return the toolpath of the operation, or of a changed one in its place."""
        last = operation or self.operation
        before = () if alone else self.session.process.operations[:-1]
        process = replace(self.session.process, operations=(*before, last))
        paths = tuple(p for p in self.session.paths if p.operation != last.id)
        session = replace(self.session, process=process, paths=paths)
        return make_paths(session, self.engine.context, progress)[-1]


def declared_drive(name) -> type:
    return registry.get("strategies", name).drive


@cache
def case(name) -> Case:
    """Return the case of a strategy: an operation of its own, else one of the same class of drive."""
    parts = [(own(f)[0], until(f, "toolpath")) for f in PLANNERS]
    mine, alike = of_strategy(name, parts)
    if not mine:
        mine, others = of_strategy(name, [holed_plate(), pitted_block()])
        alike = alike or others
    if not (mine or alike):
        mine, alike = of_strategy(name, [ring_with_gaps()])
    engine, session, operation = mine[-1] if mine else min(alike, key=substitute)
    rows = [o.id for o in session.process.operations]
    before = session.process.operations[: rows.index(operation.id)]
    strategy = registry.get("strategies", name)
    if not mine:
        operation = replace(operation, strategy=name)
    if strategy.tool_axis(choose(strategy.settings, operation.choices)) is ToolAxis.LEANING:
        session = with_five_axes(engine, session)
    operation = replace(operation, choices={**operation.choices, **COARSE})
    process = replace(session.process, operations=(*before, operation))
    return Case(engine, replace(session, process=process), operation, bool(mine))


def of_strategy(name, parts):
    """Return the operations of planned parts by a strategy, and those that are driven by the same class of geometry: each with its engine
    and session."""
    chosen = [(e, s, o) for e, s in parts for o in s.process.operations]
    return (
        [c for c in chosen if c[2].strategy == name],
        [c for c in chosen if declared_drive(c[2].strategy) is declared_drive(name)],
    )


def substitute(chosen) -> tuple[bool, float]:
    """Return what makes an operation a good one to take the place of: a ball goes everywhere, and little is soon done."""
    return chosen[2].tool.form != "ball", finished_area(chosen)


def finished_area(chosen) -> float:
    """Return the area in mm2 that an operation of a small part finishes; infinite where it finishes none."""
    engine, _, operation = chosen
    area = engine.context.part.graph().area
    return float(area[np.array(operation.faces) - 1].sum()) if operation.faces else np.inf


def with_five_axes(engine, session):
    """Return a session whose setups stand on a machine with two rotary axes."""
    machines = engine.context.shop.machines
    machine = next(name for name, m in machines.items() if len(m.rotary) == 2)
    setups = tuple(replace(s, machine=machine) for s in session.setups)
    return replace(session, setups=setups, process=replace(session.process, setups=setups))


@cache
def made(name) -> OperationPath:
    return case(name).path()


def test_a_strategy_of_a_package_is_among_them():
    assert any(not name.startswith(("plane.", "surface.")) for name in STRATEGIES)


@by_name
def test_its_settings_are_complete(name):
    check_settings(registry.get("strategies", name).settings)
    group = registry.get("strategies", name).settings.GROUP
    assert group == name


@by_name
def test_it_declares_what_it_takes_and_leaves(name):
    strategy = registry.get("strategies", name)
    settled = {c for other in STRATEGIES for c in registry.get("strategies", other).settles}
    assert hasattr(strategy.drive, "is_empty")
    assert set(strategy.leaves) <= settled
    assert strategy.tool_axis(strategy.settings()) in ToolAxis
    assert is_one_line(strategy.__doc__.split("\n")[0])


@by_name
def test_the_engagement_that_it_can_meet_fits_the_cutter(name):
    o, strategy = case(name).operation, registry.get("strategies", name)
    met = strategy.meets(o.tool, o.data, choose(strategy.settings, {}), None)
    assert 0.0 < met.width <= max(o.tool.diameter, o.data.width) and met.depth > 0.0
    assert 0.0 < met.share <= 1.0


@by_name
def test_it_moves_or_says_why_not(name):
    found = made(name)
    assert len(found.path) or found.findings
    if case(name).is_own:
        assert len(found.path)


@cache
def coarse(name) -> OperationPath:
    """Return the operation with a cutter that is far too large."""
    o = case(name).operation
    return case(name).path(replace(o, tool=scaled(o.tool, LARGER)))


def scaled(tool, share):
    """Return a cutter of the same form that is larger, its flutes as long as its corner asks for."""
    wide = (
        "diameter",
        "neck_diameter",
        "shank_diameter",
        "smallest",
        *(() if tool.form == "bull" else ("corner_radius",)),
    )
    length = max(tool.flute_length, 0.5 * share * tool.diameter)
    high = ("flute_length", "neck_length", "stickout", "gauge_length")
    sizes = {f: getattr(tool, f) * share for f in wide}
    if tool.outline:
        length = share * tool.flute_length
        top = tool.flute_length + length - tool.flute_length
        sizes["outline"] = tuple((share * r, share * z, b) for r, z, b in tool.outline[:-1]) + (
            (share * tool.outline[-1][0], top, 0.0),
        )
    return replace(
        tool, **sizes, **{f: getattr(tool, f) + length - tool.flute_length for f in high}
    )


@by_name_often
def test_what_it_leaves_is_said_in_words_with_what_to_do(name):
    for found in (made(name), coarse(name)):
        assert len(found.path) or found.findings
        for f in found.findings:
            assert is_one_line(f.text) and f.code.count(".") == 1, f
            assert f.remedy or f.code == "toolpath.refused", f


@by_name
def test_positions_are_numbers_and_axes_unit(name):
    path = made(name).path
    assert np.isfinite(path.position).all() and np.isfinite(path.feed).all()
    assert np.linalg.norm(path.axis, axis=1) == pytest.approx(1.0)
    assert (path.feed[path.motion != Motion.RAPID] > 0.0).all()


@by_name
def test_it_begins_and_ends_at_the_clearance_height_or_above_the_part(name):
    path, setup, engine = made(name).path, case(name).session.setups[0], case(name).engine
    if not len(path):
        return
    assert path.motion[0] == path.motion[-1] == Motion.RAPID
    for tip, axis in zip(path.position[[0, -1]], path.axis[[0, -1]], strict=True):
        if axis[2] > 1.0 - 1e-12:
            assert tip[2] >= setup.clearance - 1e-9
        else:
            # From another direction it is clear of all that the part has on that side.
            part = setup.frame.to_local(engine.mesh(case(name).session).points)
            assert tip @ axis > (part @ axis).max()


@by_name
def test_a_rapid_of_an_upright_tool_never_moves_in_xy_and_z_at_once(name):
    path = made(name).path
    upright = path.axis[:, 2] > 1.0 - 1e-12
    # One that leaned before turns over the part, clear of it.
    rapid = (path.motion == Motion.RAPID) & upright & np.append(True, upright[:-1])
    steps = np.abs(path.position - path.starts())[rapid]
    assert not ((steps[:, :2].max(axis=1, initial=0.0) > 1e-9) & (steps[:, 2] > 1e-9)).any()


@by_name
def test_arcs_keep_their_radius_from_start_to_end(name):
    path = made(name).path
    arcs = path.motion >= Motion.ARC_CW
    at_start = np.linalg.norm((path.starts() - path.centre)[arcs, :2], axis=1)
    at_end = np.linalg.norm((path.position - path.centre)[arcs, :2], axis=1)
    assert at_end == pytest.approx(at_start, abs=1e-6)


@by_name
def test_no_block_stands_still(name):
    path = made(name).path
    turns = np.linalg.norm(np.diff(path.axis, axis=0), axis=1) > 1e-9
    assert ((path.lengths()[1:] > 1e-4) | turns).all()


@by_name_often
def test_the_same_input_gives_the_same_bytes(name):
    first, again = made(name), case(name).path()
    for column in ("position", "axis", "motion", "centre", "feed", "mark"):
        assert getattr(again.path, column).tobytes() == getattr(first.path, column).tobytes()
    assert (again.key, again.findings) == (first.key, first.findings)


def standing(name: str, tool: Tool, found: OperationPath | None) -> float:
    """Return the mean distance in mm of the operation's faces, or of the whole part where it roughs, to what has cut when a path is done.

    It is the proof's residual: the faces' distance to the volume that cutters have swept, here with `tool` on the path and those of the
    operations before; what is farther than `FAR` counts as so far.
    """
    at, operation = case(name), case(name).operation
    process = at.session.process
    setup, paths = process.setup(operation.setup), {p.operation: p.path for p in at.session.paths}
    cut = [
        (o.tool, paths[o.id])
        for o in process.of_setup(setup.name)
        if o.id != operation.id and not o.suppressed
    ]
    cut += [] if found is None else [(tool, found.path)]
    tags = operation.faces or at.engine.context.part.tags
    points = samples_on(at.engine.context.skin(), tuple(tags), PLACES).point
    far = np.full(len(points), FAR)
    sections = [
        ProgramSection(operation="", tool=t, spindle=1000.0, path=p) for t, p in cut if len(p)
    ]
    if not sections:
        return FAR
    sweep = Sweep.of(moves_of(sections), NEAR)
    return float(sweep.residual(setup.frame.to_local(points), far)[0].mean())


@pytest.mark.parametrize("times", mostly_long((LARGER, LITTLE_LARGER), LARGER))
@pytest.mark.parametrize(
    "name", mostly_long(MILLING, *(n for n in MILLING if not n.startswith("channel.")))
)
def test_a_smaller_cutter_leaves_no_more(name, times):
    tool = case(name).operation.tool
    larger = scaled(tool, times)
    with_larger = (
        coarse(name)
        if times == LARGER
        else case(name).path(replace(case(name).operation, tool=larger))
    )
    assert standing(name, tool, made(name)) <= standing(name, larger, with_larger) + UNEVEN


@by_name_often
def test_it_brings_its_faces_nearer_to_what_is_wanted(name):
    """Else the check above would compare what nothing was taken off."""
    tool = case(name).operation.tool
    # A tap is taken for its core: the threads that it cuts are judged by its strokes.
    if len(made(name).path) and tool.core_diameter == tool.diameter:
        assert standing(name, tool, made(name)) < standing(name, tool, None) - UNEVEN


@pytest.mark.parametrize(
    "family", mostly_long(PLANNERS, *(n for n in PLANNERS if n not in (*DEAR, "casing")))
)
def test_no_path_meets_more_than_its_strategy_declares(family):
    session = until(family, "verify")
    proofs = {p.operation: p for p in session.verdict.operations}
    assert session.verdict.releases and set(proofs) == {o.id for o in session.process.operations}
    measured = {o.id: proofs[o.id].power or 0.0 for o in session.process.operations}
    more = {
        (o.strategy, session.part.name)
        for o in session.process.operations
        if o.data.highest_power < NOT_LESS * measured[o.id]
    }
    assert more == set()


@by_name_often
def test_it_stops_soon_after_it_was_asked_to(name):
    made(name)
    check_cancel(lambda progress: case(name).path(progress=progress, alone=True))
