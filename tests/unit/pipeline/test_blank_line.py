"""A part out of a round bar and out of a near-net block: programmed, proven, and faults planted against what the blank really is."""

from __future__ import annotations

import json
import math

import cadquery as cq
import numpy as np
import pytest
from cadquery import exporters
from pytest import approx

from samples import POCKET, block_with_pocket_shape
from trunnion import tolerance
from trunnion.cli.main import main
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box, Revolved
from trunnion.model.verdict import Outcome
from trunnion.part.part import Part
from trunnion.pipeline import Engine
from verify_tools import flat, program_section, proof

SPACING = 1.0
NEAR_NET = 66.0 * 42.0 * 20.0 - 30.0 * 14.0 * 9.0
"""mm3: 3 mm around and 2 over the block, its pocket cast already, 3 mm smaller all round."""


@pytest.fixture(scope="module")
def line(tmp_path_factory):
    """An engine with the block with a pocket, its session, and the folder of its files."""
    folder = tmp_path_factory.mktemp("blanks")
    exporters.export(cq.Shape.cast(block_with_pocket_shape()), str(folder / "block.step"))
    near = cq.Workplane().box(66, 42, 20, centered=False).translate((-3, -3, 0))
    near = near.cut(cq.Workplane().box(30, 14, 9, centered=False).translate((15, 11, 11)))
    exporters.export(near, str(folder / "near.stl"))
    exporters.export(near, str(folder / "near.step"))
    engine = Engine()
    return engine, engine.open(folder / "block.step"), folder


def programmed(line, until="verify", **words):
    engine, session, _ = line
    chosen = {f"blank.{key}": value for key, value in words.items()}
    return engine.run(
        engine.with_choices(session, {**chosen, "verify.spacing": SPACING}), until=until
    )


def removed(session):
    return sum(o.removed for o in session.verdict.operations)


def test_a_part_out_of_a_standing_bar_is_programmed_and_proven(line):
    session = programmed(line, kind="cylinder")
    radius = math.hypot(30.0, 18.0) + 5.0
    assert session.blank.radius == approx(radius, abs=1e-6)
    assert session.verdict.outcome is Outcome.PASSED and session.verdict.coverage == 1.0
    bar = math.pi * radius**2 * (POCKET["height"] + 2.0)
    assert removed(session) == approx(bar - line[0].context.part.volume, rel=2e-3)


def test_a_part_out_of_a_lying_bar_is_freed_of_the_bar_below_it(line):
    session = programmed(line, kind="cylinder", axis="x")
    radius = math.hypot(18.0, 9.0) + 5.0
    bar = math.pi * radius**2 * (POCKET["length"] + 10.0)
    assert removed(session) == approx(bar - line[0].context.part.volume, rel=4e-3)
    # The underside is in the bar still when the first setup is done: it is faced from there.
    assert [o.id for o in session.process.of_setup("S2")] == ["face-S2"]
    assert session.verdict.outcome is Outcome.PASSED and session.verdict.coverage == 1.0


@pytest.mark.parametrize("file", ["near.stl", "near.step"])
def test_a_part_out_of_a_near_net_block_is_programmed_and_proven(line, file):
    session = programmed(line, kind="file", file=str(line[2] / file))
    assert session.blank.volume == approx(NEAR_NET)
    assert session.verdict.outcome is Outcome.PASSED and session.verdict.coverage == 1.0
    assert removed(session) == approx(NEAR_NET - line[0].context.part.volume, rel=3e-3)
    # Its underside is the block's own: there is nothing to finish on it.
    assert sum(f.blank_surface for f in session.verdict.faces) == 1


def test_a_blank_of_a_file_is_stale_when_the_file_changes_and_not_when_it_is_gone(line, tmp_path):
    file = tmp_path / "own.stl"
    file.write_bytes((line[2] / "near.stl").read_bytes())
    session = programmed(line, until="blank", kind="file", file=str(file))
    assert line[0].states(session)["blank"] == "done"
    exporters.export(cq.Workplane().box(200, 200, 100), str(file))
    assert line[0].states(session)["blank"] == "stale"
    file.unlink()
    assert line[0].states(session)["blank"] == "done"


def test_a_project_keeps_the_blank_of_a_file(line, tmp_path):
    session = programmed(line, until="blank", kind="file", file=str(line[2] / "near.stl"))
    line[0].save(session, tmp_path / "own.trunnion")
    again = Engine().open(tmp_path / "own.trunnion")
    assert again.blank.volume == session.blank.volume and again.blank.kind == "mesh"


def test_a_box_around_a_part_asks_for_no_fine_triangles(line, monkeypatch):
    engine = Engine()
    session = engine.run(engine.open(line[2] / "block.step"), until="recognize")
    asked, mesh = [], Part.mesh

    def recorded(part, chord=tolerance.CHORD, angle=tolerance.MESH_ANGLE):
        asked.append(chord)
        return mesh(part, chord, angle)

    monkeypatch.setattr(Part, "mesh", recorded)
    session = engine.run(session, until="blank")
    assert session.blank.kind == "box" and asked == []


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ({"diameter": 60.0, "kind": "cylinder"}, r"stands out of its blank by 4\.99 mm"),
        ({"kind": "file", "file": "small.stl"}, "stands out of its blank"),
    ],
)
def test_a_blank_that_the_part_stands_out_of_is_an_error(line, words, says):
    exporters.export(cq.Workplane().box(20, 20, 20), str(line[2] / "small.stl"))
    if "file" in words:
        words = {**words, "file": str(line[2] / words["file"])}
    session = programmed(line, until="blank", **words)
    (finding,) = [f for f in session.records["blank"].findings if f.code == "blank.too-small"]
    import re

    assert re.search(says, finding.text) and finding.severity == "error"


@pytest.mark.parametrize(
    ("content", "says"),
    [(None, "needs one"), (b"nothing", "not an STL"), (b"open", "not closed, 3 edges")],
)
def test_a_file_that_holds_no_blank_is_refused_in_one_line(line, content, says, tmp_path):
    file = tmp_path / "blank.stl"
    if content == b"open":
        content = (line[2] / "near.stl").read_bytes()
        lines = content.splitlines(keepends=True)
        content = (
            b"".join(lines[:1] + lines[8:])
            if content.startswith(b"solid")
            else content[:80]
            + (int.from_bytes(content[80:84], "little") - 1).to_bytes(4, "little")
            + content[134:]
        )
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(BadInput, match=says) as told:
        programmed(line, until="blank", kind="file", file=str(file) if content else "")
    assert "\n" not in str(told.value)


BAR = Revolved.cylinder(WORLD, 36.0, (0.0, 20.0), "test", 2.8)
LYING = Revolved.cylinder(WORLD, 20.0, (-35.0, 35.0), "test", 2.8, "x")
BESIDE = Box(frame=WORLD, low=(-36, -36, 0), high=(36, 36, 20), material="test", density=2.8)
AROUND = Box(frame=WORLD, low=(-35, -20, -20), high=(35, 20, 20), material="test", density=2.8)
MILL = flat(8.0)(flute=30.0)


def in_stock(blank, *stops, **choices):
    """Return the rapids in stock of a section that only goes in rapids from stop to stop."""
    verdict = proof(
        program_section(MILL, stops, operation="pass", rapid_to=len(stops)), blank=blank, **choices
    )
    return verdict.rapids_in_stock


CORNER = [(34.0, 34.0, 60.0), (34.0, 34.0, 5.0), (34.0, 34.0, 60.0)]
"""Down and up beside the standing bar, where its box has a corner."""
MIDDLE = [(20.0, 20.0, 60.0), (20.0, 20.0, 5.0), (20.0, 20.0, 60.0)]
EDGE = [(0.0, 24.0, 60.0), (0.0, 24.0, 12.0), (0.0, 24.0, 60.0)]
"""Down beside the upper side of the lying bar: at y = 20 and z = 12 its box is solid, the bar reaches to y = 16."""


@pytest.mark.parametrize("bundles", ["z", "xyz"])
def test_a_rapid_where_only_the_box_has_material_is_none_in_a_round_bar(bundles):
    assert in_stock(BAR, *CORNER, bundles=bundles) == 0
    assert in_stock(BESIDE, *CORNER, bundles=bundles) > 0


@pytest.mark.parametrize("bundles", ["z", "xyz"])
def test_a_rapid_through_a_round_bar_is_found(bundles):
    assert in_stock(BAR, *MIDDLE, bundles=bundles) > 0


def test_a_lying_bar_is_round_for_rapids_from_above():
    near = [(x, y - 2.0, z) for x, y, z in EDGE]
    assert in_stock(LYING, *near, bundles="xyz") == 0
    assert in_stock(AROUND, *near, bundles="xyz") > 0
    inside = [(x, y - 9.0, z) for x, y, z in EDGE]
    assert in_stock(LYING, *inside, bundles="xyz") > 0


def test_a_gouge_in_the_part_is_found_whatever_the_blank():
    stops = [(0.0, 0.0, 60.0), (0.0, 0.0, 7.0), (5.0, 0.0, 7.0), (5.0, 0.0, 60.0)]
    section = program_section(MILL, stops, operation="deep", rapid_to=0)
    depth = {round(proof(section, blank=b).gouge, 6) for b in (BAR, BESIDE)}
    assert len(depth) == 1 and depth.pop() > 0.9


def test_the_volume_that_a_slot_takes_from_a_round_bar_is_that_of_the_bar():
    stops = [(-50.0, 0.0, 60.0), (-50.0, 0.0, 15.0), (50.0, 0.0, 15.0), (50.0, 0.0, 60.0)]
    section = program_section(MILL, stops, operation="slot", rapid_to=1)
    half = 4.0
    area = 2 * (half * math.sqrt(36.0**2 - half**2) + 36.0**2 * math.asin(half / 36.0))
    for bundles in ("z", "xyz"):
        verdict = proof(section, blank=BAR, bundles=bundles, cell=0.25)
        assert verdict.operations[0].removed == approx(5.0 * area, rel=5e-3)


def test_the_blank_command_names_the_bar_and_writes_it_as_step(line, tmp_path, capsys):
    part, out = str(line[2] / "block.step"), tmp_path / "bar.step"
    words = ["--set", "blank.kind=cylinder", "--set", "blank.axis=y", "--step", str(out)]
    assert main(["blank", part, *words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    solid = cq.importers.importStep(str(out)).val()
    assert told["kind"] == "revolved" and told["volume"] == approx(solid.Volume())
    centre = solid.Center().toTuple()
    assert centre == approx((30.0, 18.0, 9.0), abs=1e-6)
    assert np.ptp([solid.BoundingBox().ymin, solid.BoundingBox().ymax]) == approx(46.0, abs=1e-3)


def test_the_blank_command_writes_a_mesh_as_step(line, tmp_path, capsys):
    part, out = str(line[2] / "block.step"), tmp_path / "near.step"
    words = ["--set", "blank.kind=file", "--set", f"blank.file={line[2] / 'near.stl'}"]
    assert main(["blank", part, *words, "--step", str(out)]) == 0
    assert "mesh 66.000 x 42.000 x 20.000 mm" in capsys.readouterr().out
    assert cq.importers.importStep(str(out)).val().Volume() == approx(NEAR_NET)
