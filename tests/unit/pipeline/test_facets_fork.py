"""Triangles of the part for the proof, made beside posting and reading back: the same verdict, and no copy is left behind."""

from __future__ import annotations

import os
import pickle

import pytest

import trunnion.pipeline.proof.facets_fork as facets_fork
import trunnion.pipeline.proof.posted_programs as proof
from samples import box_shape, written
from trunnion.findings import BadInput
from trunnion.forks import Fork
from trunnion.pipeline import Engine

can_copy = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system can't copy processes")


@pytest.fixture(scope="module")
def planned():
    """An engine and a session with toolpaths, on a machine with rotary axes."""
    engine = Engine()
    session = engine.open(written(box_shape(40.0, 30.0, 10.0)))
    session = engine.with_choices(session, {"setup.machine": "Trunnion 650"})
    return engine, engine.run(session, "toolpath")


@pytest.fixture
def begun(monkeypatch):
    """Copies that are begun, in a list, as where there are two cores."""
    made = []

    def counted(work):
        made.append(Fork(work))
        return made[-1]

    monkeypatch.setattr(facets_fork, "Fork", counted)
    monkeypatch.setattr(facets_fork, "copies", lambda: 2)
    return made


@can_copy
def test_the_verdict_is_the_same_as_without_a_copy(planned, begun, monkeypatch):
    engine, session = planned
    beside = engine.run(session, "verify").verdict
    assert len(begun) == 1 and begun[0].is_done()
    monkeypatch.setattr(facets_fork, "copies", lambda: 0)
    alone = engine.run(session, "verify").verdict
    assert len(begun) == 1
    assert pickle.dumps(beside) == pickle.dumps(alone)


@can_copy
def test_a_copy_is_ended_when_posting_fails(planned, begun, monkeypatch):
    def refused(*_):
        raise BadInput("no such dialect")

    engine, session = planned
    monkeypatch.setattr(proof, "post_texts", refused)
    with pytest.raises(BadInput, match="no such dialect"):
        proof.prove_session(session, engine.context, proof.NO_PROGRESS)
    assert len(begun) == 1 and begun[0].is_done()


@can_copy
def test_a_face_that_can_not_be_meshed_is_told(planned, begun, monkeypatch):
    def refused(*_, **__):
        raise BadInput("face 3 can't be meshed")

    engine, session = planned
    monkeypatch.setattr(facets_fork, "facets_of", refused)
    with pytest.raises(BadInput, match="face 3 can't be meshed"):
        proof.prove_session(session, engine.context, proof.NO_PROGRESS)
    assert begun[0].is_done()


def test_where_no_tool_may_lean_nothing_is_begun(begun):
    engine = Engine()
    session = engine.open(written(box_shape(40.0, 30.0, 10.0)))
    session = engine.with_choices(session, {"recognize.family": "surface"})
    assert engine.run(session, "verify").verdict is not None
    assert begun == []
