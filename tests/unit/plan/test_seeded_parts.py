"""Random parts of the generators: what was made is recognised, and a plan serves all of it. Whole lines are in `tests/long`."""

from __future__ import annotations

import pytest

from long_mark import mostly_long
from seeded.edged_panels import edged_panel
from seeded.panels import panel
from seeded.plates import plate
from trunnion.findings import Severity
from trunnion.pipeline import Engine

SEEDS = mostly_long(range(200, 210), 200, 205)
"""Not those that release rates are measured on."""
SPECKS = 0.005
"""Share of the area that a plan may leave to nobody: an edge of a boss that no cutter of the catalogue gets to."""


def _planned(part, folder):
    engine = Engine()
    return engine.run(engine.open(part.written(folder)), "optimize")


@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_panel_is_recognised_and_planned(seed, tmp_path):
    made = panel(seed)
    session = _planned(made, tmp_path)
    found = session.recognition
    assert found.family == "panel"
    assert {k: len(found.of_kind(k)) for k in ("open_pocket", "island", "rib")} == {
        k: made.counts[k] for k in ("open_pocket", "island", "rib")
    }
    assert len(found.of_kind("pocket")) == made.counts["pocket"]
    assert found.unexplained_share < 0.01
    _serves_all(session)
    roughed = {o.feature for o in session.process.operations if o.kind == "rough"}
    assert {f.id for kind in ("pocket", "open_pocket") for f in found.of_kind(kind)} == roughed


@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_panel_is_cut_on_the_edges_where_something_opens(seed, tmp_path):
    made = edged_panel(seed)
    session = _planned(made, tmp_path)
    found = session.recognition
    assert found.family == "panel" and found.unexplained == ()
    assert {kind: len(found.of_kind(kind)) for kind in made.counts} == made.counts
    _serves_all(session)
    frames = {s.name: s.frame for s in session.setups}
    for feature in found.of_kind(*made.counts):
        out = found.frame.world_direction(feature.attributes.get("direction", (0.0, 0.0, 1.0)))
        own = [o for o in session.process.operations if feature.id in o.all_features]
        assert own and all(frames[o.setup].z == pytest.approx(out, abs=1e-6) for o in own)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_plate_is_recognised_and_planned(seed, tmp_path):
    session = _planned(plate(seed), tmp_path)
    assert session.recognition.family == "surface"
    _serves_all(session)
    assert {"rough", "finish"} <= {o.kind for o in session.process.operations}


def _serves_all(session):
    """No error, and at most specks that no operation is for."""
    assert {f.code for f in session.findings() if f.severity is Severity.ERROR} == set()
    planned = {tag for o in session.process.operations for tag in o.faces}
    lost = {
        int(name.removeprefix("face "))
        for f in session.findings()
        if f.code == "route.not-planned"
        for name in f.where
        if name.startswith("face ")
    }
    area = session.recognition.face_area
    assert sum(area[tag - 1] for tag in lost - planned) < SPECKS * area.sum()
