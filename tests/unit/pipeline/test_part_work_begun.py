"""Which triangles are begun before steps want them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

import samples
from trunnion import registry, tolerance
from trunnion.model.session import Session
from trunnion.part.part import Part
from trunnion.part.read.part_file import PartReading
from trunnion.part.work import MeshWork, PartWork, RefinedMeshWork
from trunnion.pipeline import Engine
from trunnion.pipeline.part_work import before_blank, before_proof, before_route
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.registry import PLANNERS


class Recorder:
    """Stands in for the process that has the part: it is asked, and does nothing."""

    def __init__(self) -> None:
        self.begun: list[PartWork] = []

    def begin(self, work: PartWork) -> None:
        """Remember what was begun."""
        self.begun.append(work)

    def made(self, work: PartWork, progress: Progress) -> Any | None:
        """Return nothing: it is to be done here."""
        return None


def routed(words: dict[str, str]) -> tuple[Engine, Session, Part, Recorder]:
    """Return an engine with a block that is planned, its part, and who is asked to work beside."""
    engine, asked = Engine(), Recorder()
    session = engine.with_choices(engine.open(samples.block_with_pocket()), words)
    part = engine.context.part.accompanied(asked)
    return engine, engine.run(session, "route"), part, asked


def opening(part: Part, chords: Sequence[float]) -> list[PartWork]:
    """Return the openings of a whole part within chord errors."""
    return [RefinedMeshWork.of(part.tags, chord) for chord in chords]


def test_pictures_are_begun_as_soon_as_a_part_is_read() -> None:
    with PartReading.of_file(samples.block_with_pocket(), stays=True) as reading:
        engine = Engine()
        engine.open(samples.block_with_pocket(), reading=reading)
        part = engine.context.part
        assert part.finished(MeshWork(part.picture_chord), NO_PROGRESS) is not None


def test_three_axes_need_no_triangles_to_be_proven_against_before_they_are_asked_for() -> None:
    _, _, _, asked = routed({})
    assert asked.begun == []


def test_where_a_tool_may_lean_what_it_is_proven_against_is_begun_with_the_route() -> None:
    _, _, part, asked = routed({"setup.machine": "Trunnion 650"})
    assert asked.begun == opening(part, [tolerance.FACET_CHORD])


@pytest.mark.parametrize(
    ("kind", "family", "wants"),
    [
        ("auto", "panel", []),
        ("box", "casing", []),
        ("cylinder", "panel", [MeshWork()]),
        ("auto", "casing", [MeshWork()]),
    ],
)
def test_the_triangles_of_a_round_blank_are_begun_once_it_is_known(
    kind: str, family: str, wants: list[PartWork]
) -> None:
    engine, session, _, asked = routed({})
    assert session.recognition is not None
    asked.begun.clear()
    session = replace(session, recognition=replace(session.recognition, family=family))
    before_blank(engine.with_choices(session, {"blank.kind": kind}), engine.context)
    assert asked.begun == wants


@pytest.mark.parametrize("family", ["casing", "impeller", "surface"])
def test_the_skins_that_a_family_looks_at_are_begun_once_it_is_known(family: str) -> None:
    engine, session, part, asked = routed({})
    assert session.recognition is not None
    asked.begun.clear()
    before_route(
        replace(session, recognition=replace(session.recognition, family=family)), engine.context
    )
    assert asked.begun == opening(part, registry.get(PLANNERS, family).skins)


def test_nothing_is_begun_for_faces_that_are_planned_with_a_backing() -> None:
    engine, session, part, asked = routed({"setup.machine": "Trunnion 650"})
    assert session.recognition is not None
    asked.begun.clear()
    part.facts = replace(part.facts, is_closed=False)
    surface = replace(session.recognition, family="surface")
    before_route(replace(session, recognition=surface), engine.context)
    before_proof(session, engine.context)
    assert asked.begun == []
