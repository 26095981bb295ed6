"""A recess in a pocket's wall hides under material: of all cutters only a T-slot cutter may follow it, as far as its neck lets it."""

from __future__ import annotations

import cadquery as cq
import pytest

from samples import written
from trunnion.pipeline import Engine


@pytest.fixture(scope="module")
def programmed():
    """A block 120 x 90 x 30 with a pocket 60 x 40 x 20 in its middle and a recess 4 mm deep in one wall, from 14 to 25 over the bottom."""
    block = cq.Workplane("XY").box(120, 90, 30, centered=(True, True, False))
    pocket = (
        cq.Workplane("XY", origin=(0, 0, 10))
        .box(60, 40, 20, centered=(True, True, False))
        .edges("|Z")
        .fillet(8)
    )
    recess = cq.Workplane("XY", origin=(20, 0, 14)).box(28, 16, 11, centered=(True, True, False))
    return (lambda e: e.run(e.open(written(block.cut(pocket).cut(recess).val().wrapped))))(Engine())


def test_the_pocket_is_still_found(programmed):
    assert programmed.recognition.counts()["pocket"] == 1


def test_nothing_is_cut_into_what_stands_over_the_recess(programmed):
    assert programmed.verdict.gouge <= 0.02
    assert programmed.verdict.collisions == 0


def test_what_no_disc_gets_to_in_the_recess_is_named(programmed):
    assert [o.kind for o in programmed.process.operations].count("pit") == 1
    assert {"pit.left", "verify.unreachable"} <= {f.code for f in programmed.findings()}
