"""Walls of random panels left out of their operations by hand: the part is not harmed, what is not finished is named, and with the walls
back the program is the same."""

from __future__ import annotations

from random import Random

import pytest

from seeded.panels import panel
from trunnion import tolerance
from trunnion.findings import Severity
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.guide_faces import with_guide_faces

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]
SHARE = 0.4
"""Of the walls of an operation that are left out."""
LITTLE = 2.0
"""mm2 that is less finished of a wall than with all walls beside it."""


@pytest.mark.parametrize("seed", range(300, 308))
def test_walls_are_left_out_without_harm_and_come_back_to_the_same_program(seed, tmp_path):
    engine, dice = Engine(), Random(seed)
    session = engine.run(engine.open(panel(seed).written(tmp_path)), until="toolpath")
    graph = engine.context_of(session).part.graph()
    changed, gone = session, dict[str, list[int]]()
    for o in session.process.operations:
        if o.strategy not in ("plane.wall", "plane.profile_finish") or len(o.faces) < 4:
            continue
        on = {t for g in engine.guides(session, o.id).lines for t in g.chain.on}
        walls = sorted(t for t in on.intersection(o.faces) if graph.surface[t - 1] == "plane")
        out = sorted(dice.sample(walls, max(1, int(SHARE * len(walls)))))
        changed = with_guide_faces(engine, changed, o.id, leave_out=out)
        gone[o.id] = out
    assert gone
    checked = engine.run(changed, until="verify")
    proven = checked.verdict
    assert proven.gouge <= tolerance.GOUGE and proven.rapids_in_stock == 0
    # What roughing left on a wall stands beside the shank of a tool that comes to the corner next to it: the proof says so.
    errors = {f.code for f in checked.findings() if f.severity is Severity.ERROR}
    assert errors <= {"verify.coverage", "verify.collision-stock"}
    unplanned = {f.face for f in proven.faces if not f.planned}
    out = {t for tags in gone.values() for t in tags}
    led = {t for o in changed.process.operations if o.own_faces for t in o.faces} - out
    whole = {f.face: f.finished for f in engine.run(session, until="verify").verdict.faces}
    short = {f.face for f in proven.faces if f.face in led and f.finished < whole[f.face] - LITTLE}
    assert not short
    left_to_others = {t for o in changed.process.operations for t in o.faces}
    assert unplanned >= out - left_to_others

    again = changed
    for id, out in gone.items():
        again = with_guide_faces(engine, again, id, add=out)
    again = engine.run(again, until="toolpath")
    for one, other in zip(session.paths, again.paths, strict=True):
        assert (one.path.position == other.path.position).all(), one.operation
