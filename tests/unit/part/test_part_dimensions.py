"""Dimensions that a part carries: from files that give them as data, through bytes and cuts of faces, and none where a file has none."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import samples
from dimensioned import Sized, write_dimensioned
from parts import PARTS, needs_parts
from shaped_parts import face_towards, plate
from trunnion.geometry.cut import plane_cut
from trunnion.model.dimension import DIAMETER, Dimension
from trunnion.part.cut import divided
from trunnion.part.part import Part, PartMetadata
from trunnion.part.read.dimension_faces import _BLOCK, has_dimensions
from trunnion.part.read.part_file import read_part
from trunnion.part.read.step_dimensions import MARK

BORE = Dimension(DIAMETER, 12.0, 0.018, 0.0, "H7", "", "bore A", (2, 5))
TAPPED = Dimension(DIAMETER, 5.0, thread="M6x1", faces=(3,))


def with_dimensions(part: Part, *dimensions: Dimension) -> Part:
    return Part(replace(part.facts, dimensions=dimensions), part.shape, part.as_read)


def test_dimensions_come_through_the_bytes_that_processes_exchange() -> None:
    part = with_dimensions(plate(30.0, 20.0, 5.0), BORE, TAPPED)
    assert Part.from_bytes(part.to_bytes()).dimensions == (BORE, TAPPED)


def test_a_part_of_before_dimensions_were_read_has_none() -> None:
    data = json.loads(plate(30.0, 20.0, 5.0).facts.to_json())
    del data["dimensions"]
    assert PartMetadata.from_json(json.dumps(data)).dimensions == ()


def test_the_pieces_of_a_cut_face_keep_its_size() -> None:
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    other = next(t for t in part.tags if t != top)
    marked = with_dimensions(part, replace(BORE, faces=(top,)), replace(TAPPED, faces=(other,)))
    cut = divided(marked, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert [d.faces for d in cut.dimensions] == [(top, 7), (other,)]


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_a_file_without_sizes_as_data_has_no_dimensions(suffix: str) -> None:
    assert samples.read(samples.box_shape(), suffix).dimensions == ()


@pytest.mark.parametrize("before", [0, _BLOCK - 5, _BLOCK, 3 * _BLOCK - len(MARK)])
def test_the_mark_of_sizes_is_found_wherever_blocks_end(tmp_path: Path, before: int) -> None:
    (path := tmp_path / "long.step").write_bytes(b" " * before + MARK + b"(")
    assert has_dimensions(path)
    path.write_bytes(b" " * before + MARK[:-1])
    assert not has_dimensions(path)


HOLES = (12.0, 12.0, 8.0, 6.0)
SIZES = (
    Sized(holes=(0, 1), value=12.0, lower=0.0, upper=0.021),
    Sized(holes=(2,), value=8.0, fit="H7"),
    Sized(holes=(3,), value=6.0, lower=-0.05, upper=0.05),
)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_dimensioned(tmp_path_factory.mktemp("pmi") / "plate.step", HOLES, SIZES)


def changed(file: Path, tmp_path: Path, pattern: str, by: str) -> Part:
    """Return the part of a file after the first text that fits a pattern was changed."""
    text, count = re.subn(pattern, by, file.read_text(), count=1)
    assert count == 1, pattern
    (path := tmp_path / "changed.step").write_text(text)
    return samples.read_path(path)


def bores(part: Part) -> dict[int, float]:
    """Return the middle in x of every cylinder of a part by its tag."""
    graph = part.graph()
    holes = [t for t in part.tags if graph.radius[t - 1] > 0.0]
    middle = 0.5 * (graph.box_low[:, 0] + graph.box_high[:, 0])
    return {t: round(float(middle[t - 1]), 6) for t in holes}


def test_sizes_deviations_and_fits_of_a_file_lie_on_the_faces_of_their_holes(file: Path) -> None:
    part = samples.read_path(file)
    assert [(d.value, d.lower, d.upper, d.fit) for d in part.dimensions] == [
        (12.0, 0.0, 0.021, ""),
        (8.0, None, None, "H7"),
        (6.0, -0.05, 0.05, ""),
    ]
    at = bores(part)
    assert [[at[t] for t in d.faces] for d in part.dimensions] == [[15.0, 45.0], [75.0], [105.0]]
    assert part.findings == ()


def test_sizes_of_a_file_in_inches_are_mm(tmp_path: Path) -> None:
    sizes = [Sized(holes=(0,), value=0.5, lower=-0.001, upper=0.002)]
    part = samples.read_path(write_dimensioned(tmp_path / "in.step", [12.7], sizes, unit="inch"))
    (found,) = part.dimensions
    assert part.unit == "inch"
    assert (found.value, found.lower, found.upper) == (12.7, -0.0254, 0.0508)
    assert part.graph().radius[found.faces[0] - 1] == pytest.approx(6.35)


@pytest.mark.cold
def test_the_reading_process_hands_dimensions_on(file: Path) -> None:
    assert read_part(file).dimensions == samples.read_path(file).dimensions != ()


def test_the_kernels_wrong_grades_are_not_taken(tmp_path: Path) -> None:
    path = write_dimensioned(tmp_path / "kernel.step", HOLES, SIZES, as_kernel=True)
    assert "LIMITS_AND_FITS('H','hole','9','')" in path.read_text()
    part = samples.read_path(path)
    assert [(d.value, d.fit) for d in part.dimensions] == [(12.0, ""), (8.0, ""), (6.0, "")]
    (said,) = part.findings
    assert said.code == "part.dimensions" and "writes grades of fits wrong" in said.text


@pytest.mark.parametrize(
    ("pattern", "by", "kept", "said"),
    [
        (r"DIMENSIONAL_SIZE\(#\d+", "DIMENSIONAL_SIZE(#99999", [8.0, 6.0], "it names no face"),
        (r"TOLERANCE_VALUE\(#\d+", "TOLERANCE_VALUE(#99999", [12.0, 8.0, 6.0], "#99999 is not in"),
        (r"TOLERANCE_VALUE\(#\d+", "TOLERANCE_VALUE($", [12.0, 8.0, 6.0], "without a value"),
        (
            r"(GEOMETRIC_ITEM_SPECIFIC_USAGE\('','',#\d+,#\d+,)#\d+",
            r"\1#99999",
            [12.0, 8.0, 6.0],
            "is of #99999 too, which is no face",
        ),
        (r"POSITIVE_LENGTH_MEASURE\(12\.\)", "POSITIVE_LENGTH_MEASURE()", [8.0, 6.0], "no value"),
    ],
)
def test_damaged_dimensions_are_a_remark_and_the_rest_is_read(
    file: Path, tmp_path: Path, pattern: str, by: str, kept: list[float], said: str
) -> None:
    part = changed(file, tmp_path, pattern, by)
    assert part.n_faces == 10 and part.is_closed
    assert [d.value for d in part.dimensions] == kept
    (finding,) = part.findings
    assert (finding.code, finding.severity.value) == ("part.dimensions", "remark")
    assert said in finding.text and "\n" not in str(finding)


def test_where_the_kernel_passes_over_entities_no_size_is_tied_to_a_wrong_face(
    file: Path, tmp_path: Path
) -> None:
    part = changed(file, tmp_path, r"DIMENSIONAL_SIZE\((#\d+)", r"DIMENSIONAL_SIZE((\1")
    assert part.n_faces == 10 and part.is_closed and part.dimensions == ()
    (said,) = part.findings
    assert "has a bracket too few" in said.text and "no size can be tied to its faces" in said.text


USAGE = r"(GEOMETRIC_ITEM_SPECIFIC_USAGE\('','',#70\d,#\d+,)#\d+"
"""The usage of the 8 mm hole."""


def test_a_dimension_on_the_circle_at_a_holes_end_is_the_holes(file: Path, tmp_path: Path) -> None:
    # A circle begins and ends at one vertex.
    circle = re.search(r"#(\d+) = EDGE_CURVE\('',#(\d+),#\2,", file.read_text())
    found = changed(file, tmp_path, USAGE, rf"\1#{circle[1]}").dimensions[1]
    assert (found.value, len(found.faces)) == (8.0, 1)
    assert set(found.faces) <= set(bores(samples.read_path(file)))


def test_a_dimension_of_what_has_no_diameter_is_said(file: Path, tmp_path: Path) -> None:
    line = re.search(r"#(\d+) = EDGE_CURVE\('',#(\d+),#(?!\2,)", file.read_text())
    for number in (line[1], "4"):
        folder = tmp_path / number
        folder.mkdir()
        part = changed(file, folder, USAGE, rf"\1#{number}")
        assert [d.value for d in part.dimensions] == [12.0, 6.0]
        assert "is of no cylinder of the shape" in part.findings[0].text


def test_a_part_twice_in_an_assembly_has_its_sizes_twice(tmp_path: Path) -> None:
    sizes = [Sized(holes=(0,), value=10.0)]
    path = write_dimensioned(tmp_path / "twice.step", [10.0], sizes, twice=True)
    for solid in (1, 2):
        part = samples.read_path(path, solid=solid)
        (found,) = part.dimensions
        assert (part.n_solids, part.graph().radius[found.faces[0] - 1]) == (2, pytest.approx(5.0))


THREAD = """
#900001=CONSTRUCTIVE_GEOMETRY_REPRESENTATION('supplemental geometry',(#900002),#{context});
#900002=GEOMETRIC_CURVE_SET('Thread Cylinder.1',(#900003,#900004));
#900003=TRIMMED_CURVE('',#900005,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(4.7)),.T.,.PARAMETER.);
#900004=TRIMMED_CURVE('',#900006,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(8.)),.T.,.PARAMETER.);
#900005=CIRCLE('',#900007,{radius});
#900006=LINE('',#900008,#900009);
#900007=AXIS2_PLACEMENT_3D('',#900010,#900011,#900012);
#900008=CARTESIAN_POINT('',({x}+{radius},15.,{z}));
#900009=VECTOR('',#900011,1.);
#900010=CARTESIAN_POINT('',({x},15.,{z}));
#900011=DIRECTION('',(0.,0.,1.));
#900012=DIRECTION('',(1.,0.,0.));
ENDSEC;
END-ISO-10303-21;
"""
"""A thread about an axis at {x} mm, 8 mm long from the height {z} on."""


def threaded(
    tmp_path: Path, name: str = "M6x1", radius: float = 3.0, x: float = 15.0, z: float = 2.0
) -> Part:
    """Return a plate with holes of 5 mm and a size of 6 mm that is tied to curves of a thread."""
    sizes = [Sized(holes=(0,), value=6.0)]
    text = write_dimensioned(tmp_path / "thread.step", [5.0, 5.0], sizes).read_text()
    context = re.search(r"ADVANCED_BREP_SHAPE_REPRESENTATION\([^;]*,#(\d+)\);", text)[1]
    curves = THREAD.replace("{x}+{radius}", f"{x + radius!r}")
    curves = curves.format(context=context, radius=repr(radius), x=repr(x), z=repr(z))
    text = re.sub(r"ENDSEC;\s*END-ISO-10303-21;\s*$", curves.lstrip(), text)
    text = re.sub(
        r"(GEOMETRIC_ITEM_SPECIFIC_USAGE\('','',#\d+),#\d+,#\d+", r"\1,#900001,#900002", text
    )
    text = text.replace("SHAPE_ASPECT('',''", f"SHAPE_ASPECT('{name}',''")
    (path := tmp_path / "tied.step").write_text(text)
    return samples.read_path(path)


def test_a_thread_that_curves_draw_about_a_hole_is_the_holes(tmp_path: Path) -> None:
    part = threaded(tmp_path)
    (found,) = part.dimensions
    assert (found.value, found.thread) == (6.0, "M6x1") and part.findings == ()
    assert [bores(part)[t] for t in found.faces] == [15.0]
    assert part.graph().radius[found.faces[0] - 1] == pytest.approx(2.5)


@pytest.mark.parametrize(
    "other",
    [
        {"name": "6 mm"},
        {"radius": 2.0},
        {"x": 15.5},
        {"z": 12.0},
    ],
    ids=["no thread named", "narrower than the hole", "another axis", "above the hole"],
)
def test_curves_that_are_no_thread_of_a_hole_are_tied_to_none(tmp_path: Path, other) -> None:
    part = threaded(tmp_path, **other)
    assert part.dimensions == ()
    assert "is of no cylinder of the shape and no thread about one" in part.findings[0].text


def test_only_sizes_of_the_chosen_solid_are_its_own(tmp_path: Path) -> None:
    path = write_dimensioned(
        tmp_path / "two.step",
        [10.0],
        [Sized(holes=(0,), value=10.0), Sized(holes=(1,), value=6.0, fit="H7")],
        second=[6.0],
    )
    first, second = (samples.read_path(path, solid=n) for n in (1, 2))
    assert [d.value for d in first.dimensions] == [10.0]
    assert [(d.value, d.fit) for d in second.dimensions] == [(6.0, "H7")]
    assert set(second.dimensions[0].faces) <= set(second.tags)
    assert not [f for f in (*first.findings, *second.findings) if f.code == "part.dimensions"]


@needs_parts
@pytest.mark.parts
def test_the_diameters_of_ctc_02_are_those_of_their_faces() -> None:
    # NIST CTC-02: seven diameters as data, two of them on circles at the ends of holes.
    path = PARTS / "public" / "nist" / "nist_ctc_02_asme1_ap242-1.stp"
    part = samples.read_path(path)
    assert [(d.value, d.upper, d.lower) for d in part.dimensions] == [
        (52.0, 0.15, -0.15),
        (100.0, 0.15, -0.15),
        (40.0, 0.15, -0.15),
        (22.0, 0.1, -0.1),
        (22.0, 0.1, -0.1),
        (12.0, 0.05, -0.05),
        (12.0, 0.05, -0.05),
    ]
    assert part.dimensions[0].text == "Radial Dimension (17)"
    radius = part.graph().radius
    for dimension in part.dimensions:
        faces = np.array(dimension.faces)
        assert faces.size == 1
        assert np.allclose(2.0 * radius[faces - 1], dimension.value)
    assert "part.dimensions" not in [f.code for f in part.findings]


@needs_parts
@pytest.mark.parts
@pytest.mark.parametrize(
    "name", ["nist_ctc_01_asme1_ap242_colored.stp", "nist_ftc_11_asme1_rb.stp"]
)
def test_nist_files_of_geometry_alone_have_no_dimensions(name: str) -> None:
    assert samples.read_path(PARTS / "public" / "nist" / name).dimensions == ()
