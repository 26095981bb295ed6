"""Faults that need two setups, a fixture or a machine to be seen, each with its clean twin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning import FIVE_AXES, SMALL, block_facets, lean, section_through
from trunnion.findings import BadInput
from trunnion.geometry.frame import Frame
from trunnion.geometry.mesh import Mesh
from trunnion.model.fixture import Fixture
from trunnion.model.motion.program import Program
from trunnion.model.verdict import Outcome
from trunnion.part.read.fixture import read_fixture, stl_mesh
from trunnion.part.shape.surfaces import surfaces_from
from trunnion.verify.judge.setups import bundles_of
from trunnion.verify.judge.verdict import prove_surfaces
from trunnion.verify.settings import ProofSettings
from verify_tools import (
    BLANK,
    FACING,
    MACHINE,
    SETUP,
    TOP,
    clean_plan,
    flat,
    program_section,
    proof,
)

UNDER = Frame(np.array([0.0, 0.0, 20.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
"""A setup from below: y runs the other way, and what is at z in the part is at 20 - z."""
SLOTTER = flat(10.0)(flute=25.0)


def slot(y, z, rapid_to=1):
    """Return a section that crosses the blank at a height of its setup; blocks up to one are rapids."""
    return program_section(
        SLOTTER,
        [(-45.0, y, 30.0), (-45.0, y, z), (45.0, y, z), (45.0, y, 30.0)],
        operation="cross",
        rapid_to=rapid_to,
    )


def two_setups(below):
    """Return the verdict on a slot from above at y = 6, right through, and a program from below."""
    above = Program(name="above", setup=SETUP, sections=(slot(6.0, -1.0),))
    second = Program(name="below", setup=replace(SETUP, name="S2", frame=UNDER), sections=(below,))
    nothing = surfaces_from([])
    return prove_surfaces(
        (above, second),
        (nothing, nothing),
        BLANK,
        (),
        (MACHINE, MACHINE),
        ProofSettings(coverage=0.0),
    )


def codes(verdict):
    return {f.code for f in verdict.findings if f.severity == "error"}


def box(low, high):
    """Return a box as a mesh, anticlockwise from outside."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    points = [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return Mesh(
        points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.ones(12, int)
    )


def clamped(x, setup=""):
    """Return the setup with a clamp that ends at x on the left of the block, higher than its top."""
    fixture = Fixture(
        name="left clamp", mesh=box((-60.0, -5.0, 0.0), (x, 5.0, TOP + 12.0)), setup=setup
    )
    return replace(SETUP, fixtures=(fixture,))


def stl_text(mesh):
    rows = ["solid clamp"]
    for corners in mesh.corners():
        rows += [
            "facet normal 0 0 0",
            "outer loop",
            *(f"vertex {x:g} {y:g} {z:g}" for x, y, z in corners),
            "endloop",
            "endfacet",
        ]
    return "\n".join([*rows, "endsolid clamp"]).encode()


def stl_bytes(mesh):
    record = np.zeros(
        len(mesh.triangles), np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    )
    record["c"] = mesh.corners()
    return b"solid but binary".ljust(80) + len(record).to_bytes(4, "little") + record.tobytes()


def test_a_rapid_of_the_second_setup_through_what_the_first_removed_is_clean():
    # Seen from below, the slot at y = 6 lies at y = -6.
    verdict = two_setups(slot(-6.0, 12.0, rapid_to=3))
    assert not codes(verdict)
    assert "verify.stock-per-setup" not in {f.code for f in verdict.findings}


def test_a_rapid_of_the_second_setup_through_what_the_first_left_is_caught():
    verdict = two_setups(slot(6.0, 12.0, rapid_to=3))
    (finding,) = [f for f in verdict.findings if f.code == "verify.rapid-in-stock"]
    assert (codes(verdict), verdict.outcome) == ({"verify.rapid-in-stock"}, Outcome.FAILED)
    assert [o.rapids_in_stock for o in verdict.operations] == [0, 1]
    assert finding.where[0] == "cross"


def test_the_second_setup_removes_only_what_the_first_left():
    # A slot 10 wide and 8 deep along 60 mm, half of it over the first one.
    assert two_setups(slot(6.0, 12.0)).operations[1].removed == approx(60 * 10 * 8, rel=0.01)
    assert two_setups(slot(-1.0, 12.0)).operations[1].removed == approx(60 * 5 * 8, rel=0.05)


def test_a_fixture_that_is_touched_fails_with_place_and_depth():
    # Facing runs to x = -45 with a cutter of radius 8: the clamp reaches to x = -52.95, into its way by 50 um.
    verdict = proof(*clean_plan(), setup=clamped(-52.95))
    (finding,) = [f for f in verdict.findings if f.severity == "error"]
    assert (
        finding.code == "verify.fixture" and "enters fixture left clamp by 0.050 mm" in finding.text
    )
    assert verdict.outcome is Outcome.FAILED and verdict.collisions > 0


def test_a_fixture_beside_the_way_is_clean():
    verdict = proof(*clean_plan(), setup=clamped(-53.001))
    assert verdict.outcome is Outcome.PASSED and verdict.coverage == approx(1.0)


def test_what_a_clamp_covers_still_counts_as_reachable():
    verdict = proof(clean_plan()[0], setup=clamped(-20.0))
    assert verdict.coverage == approx(proof(clean_plan()[0]).coverage)
    assert verdict.reachable == approx(proof(clean_plan()[0]).reachable)


@pytest.mark.parametrize("written", [stl_text, stl_bytes], ids=["text", "binary"])
def test_a_fixture_is_read_from_stl(written, tmp_path):
    clamp = box((-1.0, 2.0, 3.0), (4.0, 5.5, 6.0))
    (tmp_path / "clamp.stl").write_bytes(written(clamp))
    read = read_fixture(tmp_path / "clamp.stl")
    assert [v.tolist() for v in read.box()] == [v.tolist() for v in clamp.box()]
    assert (len(read.points), len(read.triangles)) == (8, 12)
    assert np.einsum(
        "ij,ij->", read.normals() * read.areas()[:, None], read.corners()[:, 0]
    ) / 3 == approx(5 * 3.5 * 3)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "not an STL"),
        (b"hello", "not an STL"),
        (b"vertex 1 2 3\nvertex 1 2", "cut off"),
        (b"vertex 1 2 x " * 3, "no number"),
        (b"vertex 1 2 nan " * 3, "not finite"),
    ],
)
def test_an_stl_file_that_is_none_is_refused_in_one_line(data, says):
    with pytest.raises(BadInput, match=says):
        stl_mesh(data, "clamp.stl")


def test_a_fixture_is_read_from_step_as_parts_are(tmp_path):
    import cadquery

    solid = (
        cadquery.Workplane()
        .box(10.0, 20.0, 30.0)
        .add(cadquery.Workplane().center(50.0, 0.0).box(10.0, 10.0, 10.0))
    )
    cadquery.exporters.export(
        cadquery.Workplane(cadquery.Compound.makeCompound(solid.vals())),
        str(tmp_path / "vice.step"),
    )
    low, high = read_fixture(tmp_path / "vice.step").box()
    assert low == approx([-5.0, -10.0, -15.0]) and high == approx([55.0, 10.0, 15.0])


def test_a_leaning_tool_on_three_axes_fails_in_words_and_passes_on_five():
    section = section_through(
        FACING, "lean", [((0.0, 0.0, 60.0), lean(10.0)), ((5.0, 0.0, 60.0), lean(10.0))]
    )
    high = replace(
        section, path=replace(section.path, position=section.path.position + [0.0, 0.0, 40.0])
    )
    facets = block_facets()
    assert codes(proof(*clean_plan(), high, facets=facets, bundles="z")) == {"verify.rotary"}
    assert codes(proof(*clean_plan(), high, facets=facets, bundles="z", machine=FIVE_AXES)) == set()


def test_a_rotary_axis_beyond_its_limit_fails():
    section = section_through(
        FACING, "lean", [((0.0, 0.0, 60.0), lean(10.0)), ((5.0, 0.0, 60.0), lean(35.0))]
    )
    high = replace(
        section, path=replace(section.path, position=section.path.position + [0.0, 0.0, 60.0])
    )
    narrow = replace(
        FIVE_AXES,
        axes=tuple(
            replace(a, low=-30.0, high=30.0) if a.name == "A" else a for a in FIVE_AXES.axes
        ),
    )
    facets = block_facets()
    assert codes(proof(*clean_plan(), high, facets=facets, bundles="z", machine=narrow)) == {
        "verify.rotary"
    }
    assert codes(proof(*clean_plan(), high, facets=facets, bundles="z", machine=FIVE_AXES)) == set()


def test_one_bundle_serves_while_every_cut_comes_straight_from_above():
    above = Program(name="above", setup=SETUP, sections=clean_plan())
    below = replace(above, setup=replace(SETUP, frame=UNDER))
    under = replace(
        above, sections=(program_section(SMALL["t-slot"], [(0.0, 0.0, 30.0), (1.0, 0.0, 30.0)]),)
    )
    leaning = replace(
        above, sections=(section_through(FACING, "lean", [((0.0, 0.0, 60.0), lean(5.0))] * 2),)
    )
    auto = ProofSettings()
    assert bundles_of((above,), BLANK, auto) == ("z",)
    assert (
        bundles_of((above, below), BLANK, auto)
        == bundles_of((under,), BLANK, auto)
        == ("x", "y", "z")
    )
    assert bundles_of((leaning,), BLANK, auto) == ("x", "y", "z")
    assert bundles_of((leaning,), BLANK, replace(auto, bundles="z")) == ("z",)
