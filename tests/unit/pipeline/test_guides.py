"""The guide lines of a plan's operations: made from faces, whatever was cut, and anew for another plan."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from trunnion.findings import BadCall
from trunnion.model.guides import GuideKind
from trunnion.pipeline import Engine
from trunnion.pipeline.guides import digest_of


@pytest.fixture(scope="module")
def routed(sample_panel):
    """An engine and its session of the small panel, with operations but no path."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="optimize")


def test_every_operation_of_a_panel_is_led_by_lines_on_the_part(routed) -> None:
    engine, session = routed
    low, high = session.blank.box_in(session.blank.frame)
    kinds = set()
    for operation in session.process.operations:
        guides = engine.guides(session, operation.id)
        assert guides.operation == operation.id and guides.lines and not guides.refused
        kinds |= {line.kind for line in guides.lines}
        for line in guides.lines:
            there = session.blank.frame.to_local(line.points)
            assert (there >= low - 1e-6).all() and (there <= high + 1e-6).all()
    assert {GuideKind.WALL, GuideKind.AREA} <= kinds


def test_walls_are_led_at_their_feet(routed) -> None:
    engine, session = routed
    wall = next(o for o in session.process.operations if o.kind == "wall")
    lines = [g for g in engine.guides(session, wall.id).lines if g.kind is GuideKind.WALL]
    frame = session.process.setup(wall.setup).frame
    assert all(np.ptp(frame.to_local(line.points)[:, 2]) < 1e-9 for line in lines)
    assert {t for line in lines for t in line.chain.faces} <= set(
        next(f for f in session.recognition if f.id == wall.feature).tags
    ) | set(wall.faces)


def test_an_operation_that_is_not_there_is_told(routed) -> None:
    engine, session = routed
    with pytest.raises(BadCall, match="no operation wall-99"):
        engine.guides(session, "wall-99")
    with pytest.raises(BadCall, match="generate the route"):
        engine.guides(replace(session, process=None), "wall-99")


def test_guides_of_another_part_are_others_though_its_plan_were_the_same(routed) -> None:
    _, session = routed
    other = replace(session, part=replace(session.part, digest="another file"))
    assert digest_of(other) != digest_of(session) == digest_of(replace(session))


def test_a_feature_that_is_gone_is_told_in_its_guides(routed) -> None:
    engine, session = routed
    first = next(o for o in session.process.operations if o.kind == "wall")
    gone = replace(first, feature="pocket-99")
    process = replace(
        session.process,
        operations=tuple(gone if o is first else o for o in session.process.operations),
    )
    assert engine.guides(session, first.id).lines
    guides = engine.guides(replace(session, process=process), first.id)
    assert not guides.lines and "pocket-99 is not there any more" in guides.refused
