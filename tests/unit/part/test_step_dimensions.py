"""Diameters as data in the text of a STEP file: every form that files give them in, without the CAD kernel."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.part.read.step_dimensions import FileDimension, dimensions_in

UNITS = """
#1=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));
#2=(CONVERSION_BASED_UNIT('INCH',#3) LENGTH_UNIT() NAMED_UNIT(#4));
#3=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1);
#5=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.));
#6=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));
"""
FACES = """
#10=ADVANCED_FACE('',(#90),#91,.T.);
#11=ADVANCED_FACE('',(#90),#91,.T.);
#12=EDGE_CURVE('',#90,#91,#92,.T.);
"""
HOLE = """
#20=SHAPE_ASPECT('bore A','',#99,.T.);
#21=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#20,#98,#10);
#22=DIMENSIONAL_SIZE(#20,'diameter');
"""
SIZE = """
#23=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#22,#24);
#24=SHAPE_DIMENSION_REPRESENTATION('',(#25),#97);
"""


def measure(number: int, value: float, unit: int = 1, name: str = "nominal value") -> str:
    """Return a length as an item of a representation."""
    return (
        f"#{number}=(LENGTH_MEASURE_WITH_UNIT() MEASURE_REPRESENTATION_ITEM() "
        f"MEASURE_WITH_UNIT(POSITIVE_LENGTH_MEASURE({value!r}),#{unit}) REPRESENTATION_ITEM('{name}'));"
    )


def deviations(lower: float, upper: float, unit: int = 1) -> str:
    """Return the tolerance of the hole."""
    return (
        f"#30=PLUS_MINUS_TOLERANCE(#31,#22);#31=TOLERANCE_VALUE(#32,#33);"
        f"#32=MEASURE_WITH_UNIT(LENGTH_MEASURE({lower!r}),#{unit});"
        f"#33=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({upper!r}),#{unit});"
    )


def read(*parts: str) -> tuple[list[FileDimension], tuple[str, ...]]:
    """Return the dimensions and the problems of a text of some entities."""
    text = "ISO-10303-21;HEADER;ENDSEC;DATA;" + UNITS + FACES + "".join(parts) + "ENDSEC;"
    found = dimensions_in(text.encode())
    return list(found.dimensions), found.problems


def only(*parts: str) -> FileDimension:
    """Return the one dimension of a text without problems."""
    (found,), problems = read(*parts)
    assert problems == ()
    return found


def test_a_size_has_its_value_its_deviations_its_faces_and_its_name() -> None:
    found = only(HOLE, SIZE, measure(25, 12.0), deviations(0.0, 0.021))
    assert (found.number, found.items) == (22, (10,))
    own = found.dimension
    assert (own.kind, own.value, own.lower, own.upper) == ("diameter", 12.0, 0.0, 0.021)
    assert (own.text, own.fit, own.thread, own.faces) == ("bore A", "", "", ())


@given(st.floats(0.001, 1e4), st.floats(-1.0, -0.001), st.floats(0.0, 1.0))
def test_inches_are_converted_and_deviations_with_their_own_unit(value, lower, upper) -> None:
    own = only(HOLE, SIZE, measure(25, value, unit=2), deviations(lower, upper)).dimension
    assert own.value == pytest.approx(25.4 * value, abs=1e-9)
    assert (own.lower, own.upper) == (round(lower, 9), round(upper, 9))


def test_a_metre_is_a_thousand_mm() -> None:
    assert only(HOLE, SIZE, measure(25, 0.012, unit=5)).dimension.value == 12.0


@pytest.mark.parametrize(
    ("words", "fit"),
    [
        ("'H','hole','7',''", "H7"),
        ("'h','hole','7',''", "H7"),
        ("'G','','6',''", "G6"),
        ("'G6','hole','',''", "G6"),
        ("'js','shaft','IT5',$", "js5"),
        ("'ZC','hole','11',''", "ZC11"),
    ],
)
def test_a_fit_is_a_class_of_iso_286(words: str, fit: str) -> None:
    text = f"#30=PLUS_MINUS_TOLERANCE(#31,#22);#31=LIMITS_AND_FITS({words});"
    own = only(HOLE, SIZE, measure(25, 12.0), text).dimension
    assert (own.fit, own.lower, own.upper) == (fit, None, None)


@pytest.mark.parametrize("words", ["'Q','hole','7',''", "'H','hole','19',''", "'','','',''"])
def test_a_fit_that_iso_286_has_not_is_said_and_the_size_taken(words: str) -> None:
    text = f"#30=PLUS_MINUS_TOLERANCE(#31,#22);#31=LIMITS_AND_FITS({words});"
    (found,), problems = read(HOLE, SIZE, measure(25, 12.0), text)
    assert (found.dimension.value, found.dimension.fit) == (12.0, "")
    assert len(problems) == 1 and "#31 is no tolerance class of ISO 286" in problems[0]


LIMITS = SIZE.replace("(#25)", "(#25,#26,#27)")


def test_limits_beside_a_nominal_size_are_its_deviations() -> None:
    own = only(
        HOLE,
        LIMITS,
        measure(25, 12.018, name="upper limit"),
        measure(26, 12.0),
        measure(27, 11.9, name="lower limit"),
    ).dimension
    assert (own.value, own.lower, own.upper) == (12.0, -0.1, 0.018)


def test_limits_alone_are_deviations_from_the_lower_one() -> None:
    own = only(
        HOLE,
        SIZE.replace("(#25)", "(#25,#26)"),
        measure(25, 12.5, name="upper limit"),
        measure(26, 12.0, name="lower limit"),
    ).dimension
    assert (own.value, own.lower, own.upper) == (12.0, 0.0, 0.5)


@pytest.mark.parametrize(
    ("word", "lower", "upper"), [("maximum", None, 0.0), ("minimum", 0.0, None)]
)
def test_a_size_that_is_a_limit_has_one_deviation(word, lower, upper) -> None:
    item = (
        "#25=(LENGTH_MEASURE_WITH_UNIT() MEASURE_REPRESENTATION_ITEM() MEASURE_WITH_UNIT("
        "POSITIVE_LENGTH_MEASURE(12.),#1) QUALIFIED_REPRESENTATION_ITEM((#26)) "
        f"REPRESENTATION_ITEM(''));#26=TYPE_QUALIFIER('{word}');"
    )
    own = only(HOLE, SIZE, item).dimension
    assert (own.value, own.lower, own.upper) == (12.0, lower, upper)


def test_the_limits_of_a_value_range_of_ap214_are_read() -> None:
    own = only(
        HOLE,
        SIZE,
        "#25=VALUE_RANGE('',(#26,#27));",
        "#26=MEASURE_REPRESENTATION_ITEM('lower limit',LENGTH_MEASURE(9.99),#1);",
        "#27=MEASURE_REPRESENTATION_ITEM('upper limit',LENGTH_MEASURE(10.01),#1);",
    ).dimension
    assert (own.value, own.lower, own.upper) == (9.99, 0.0, 0.02)


def test_a_size_of_several_holes_has_the_faces_of_all() -> None:
    group = """
    #20=COMPOSITE_GROUP_SHAPE_ASPECT('2 bores','',#99,.T.);
    #40=SHAPE_ASPECT('','',#99,.T.);#41=SHAPE_ASPECT('','',#99,.T.);
    #42=SHAPE_ASPECT_RELATIONSHIP('',$,#20,#40);#43=SHAPE_ASPECT_RELATIONSHIP('',$,#20,#41);
    #44=SHAPE_ASPECT_RELATIONSHIP('',$,#41,#20);
    #45=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#40,#98,#10);
    #46=ITEM_IDENTIFIED_REPRESENTATION_USAGE('','',#41,#98,(#11,#12));
    #22=DIMENSIONAL_SIZE(#20,'Diameter');
    """
    found = only(group, SIZE, measure(25, 12.0))
    assert (found.items, found.dimension.text) == ((10, 11, 12), "2 bores")


def test_an_aspect_that_is_only_related_to_others_has_none_of_their_faces() -> None:
    other = """
    #40=DATUM_FEATURE('','',#99,.T.);
    #41=SHAPE_ASPECT_RELATIONSHIP('','',#20,#40);
    #42=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#40,#98,#11);
    """
    assert only(HOLE, SIZE, measure(25, 12.0), other).items == (10,)


def test_an_aspect_of_an_older_file_has_its_faces_by_a_property() -> None:
    older = """
    #20=SHAPE_ASPECT('','bore of AP214',#99,.T.);
    #40=PROPERTY_DEFINITION('','',#20);
    #41=SHAPE_DEFINITION_REPRESENTATION(#40,#42);
    #42=SHAPE_REPRESENTATION('',(#11),#97);
    #22=DIMENSIONAL_SIZE(#20,'diameter');
    """
    found = only(older, SIZE, measure(25, 12.0))
    assert (found.items, found.dimension.text) == ((11,), "bore of AP214")


def test_a_size_that_is_a_datum_feature_too_is_read() -> None:
    datum = """
    #22=(COMPOSITE_SHAPE_ASPECT() DATUM_FEATURE() DIMENSIONAL_SIZE(#22,'diameter')
    DIMENSIONAL_SIZE_WITH_DATUM_FEATURE() SHAPE_ASPECT('datum B','',#99,.T.));
    #40=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#22,#98,#10);
    #50=DIMENSIONAL_SIZE_WITH_DATUM_FEATURE('datum C','',#99,.T.,#51,'diameter');
    #51=SHAPE_ASPECT('','',#99,.T.);
    #52=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#51,#98,#11);
    #53=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#50,#24);
    """
    found, problems = read(datum, SIZE, measure(25, 12.0))
    assert ([f.items for f in found], problems) == ([(10,), (11,)], ())
    assert found[0].dimension.text == "datum B"


@pytest.mark.parametrize("name", ["radius", "thickness", "curve length", "spherical diameter"])
def test_sizes_that_are_no_diameter_are_none_of_ours(name: str) -> None:
    assert read(HOLE.replace("diameter", name), SIZE, measure(25, 12.0)) == ([], ())


@pytest.mark.parametrize(
    ("damaged", "problem"),
    [
        (HOLE, "it has no size"),
        (HOLE + SIZE + measure(25, -12.0), "its size is -12 mm"),
        (HOLE + SIZE + measure(25, 1.0).replace("1.0", "1.E999"), "#25 has no value"),
        (HOLE + SIZE + measure(25, 1.0).replace("1.0", "'x'"), "#25 has no value"),
        (HOLE + SIZE + measure(25, 12.0, unit=77), "#77 is not in the file"),
        (HOLE + SIZE + measure(25, 12.0, unit=6), "#6 is no unit of length"),
        (HOLE + SIZE + "#25=MEASURE_REPRESENTATION_ITEM('',&);", "#25 can't be understood"),
        (HOLE.replace("#20,'d", "#88,'d") + SIZE + measure(25, 12.0), "it names no face"),
        (
            HOLE + LIMITS + measure(25, 12.0) + measure(26, 13.0),
            "it has two sizes: 12 mm and 13 mm",
        ),
    ],
)
def test_a_size_that_says_not_enough_is_left_out_and_said(damaged: str, problem: str) -> None:
    found, (said,) = read(damaged)
    assert found == []
    assert said.startswith(f"#22 is left out, {problem}")


@pytest.mark.parametrize(
    ("tolerance", "problem"),
    [
        (deviations(0.1, -0.1), "the lower deviation of #31, 0.1 mm, is not below the upper"),
        (deviations(0.05, 0.05), "the lower deviation of #31"),
        (deviations(0.0, 0.1).replace("(#32,", "($,"), "#31 has a deviation without a value"),
        (deviations(0.0, 0.1).replace("(#32,", "("), "#31 has a deviation without a value"),
        (deviations(0.0, 0.1).replace("(#32,", "(#78,"), "#78 is not in the file"),
        (deviations(0.0, 0.1).replace("(#31,#22", "($,#22"), "#30 names no deviations"),
        (deviations(0.0, 0.1).replace("(#31,#22", "(#1,#22"), "#1 is neither deviations nor a fit"),
    ],
)
def test_a_damaged_tolerance_is_said_and_the_size_taken(tolerance: str, problem: str) -> None:
    (found,), (said,) = read(HOLE, SIZE, measure(25, 12.0), tolerance)
    own = found.dimension
    assert (own.value, own.lower, own.upper, own.fit) == (12.0, None, None, "")
    assert said.startswith(f"#22 has no tolerance, {problem}")


def test_a_unit_defined_by_itself_is_no_endless_loop() -> None:
    circle = "#7=(CONVERSION_BASED_UNIT('X',#8) LENGTH_UNIT() NAMED_UNIT(*));"
    circle += "#8=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.),#7);"
    found, (said,) = read(HOLE, SIZE, measure(25, 12.0, unit=7), circle)
    assert found == [] and "has no unit" in said


NOTE = SIZE.replace("(#25)", "(#25,#26)")
SHOWN = """
#60=DRAUGHTING_MODEL_ITEM_ASSOCIATION('','',#22,#96,#61);
#62=CHARACTERIZED_ITEM_WITHIN_REPRESENTATION('','',#61,#96);
#63=PROPERTY_DEFINITION('pmi validation property','',#62);
#64=PROPERTY_DEFINITION_REPRESENTATION(#63,#65);
#65=REPRESENTATION('',(#66,#67),#97);
#67=DESCRIPTIVE_REPRESENTATION_ITEM('font name','Arial');
"""


def test_a_thread_stands_in_a_note_of_the_size() -> None:
    note = "#26=DESCRIPTIVE_REPRESENTATION_ITEM('dimensional note','M6x1 - 6H THRU');"
    own = only(HOLE, NOTE, measure(25, 5.0), note).dimension
    assert (own.thread, own.text) == ("M6x1 - 6H", "bore A")


def test_a_thread_stands_in_the_name_of_the_aspect() -> None:
    named = HOLE.replace("bore A", "1/4-20 UNC tapped hole")
    assert only(named, SIZE, measure(25, 5.1)).dimension.thread == "1/4-20 UNC"


@pytest.mark.parametrize(
    ("words", "thread"),
    [("TXT\\\\wM6", "M6"), ("TXT\\\\w2X/nM8x1.25-6H", "M8x1.25-6H"), ("TXT\\\\wFOR M6", "")],
)
def test_a_thread_stands_in_what_the_annotation_shows(words: str, thread: str) -> None:
    shown = f"#66=DESCRIPTIVE_REPRESENTATION_ITEM('equivalent unicode string','{words}');"
    assert only(HOLE, SIZE, measure(25, 5.0), SHOWN, shown).dimension.thread == thread


def test_what_the_annotation_shows_is_the_name_where_the_aspect_has_none() -> None:
    shown = r"#66=DESCRIPTIVE_REPRESENTATION_ITEM('equivalent unicode string','\X2\00D8\X0\12');"
    assert only(
        HOLE.replace("bore A", ""), SIZE, measure(25, 12.0), SHOWN, shown
    ).dimension.text == ("Ø12")


def test_what_a_dimension_shows_is_its_name_and_tolerances_shown_beside_are_not() -> None:
    shown = (
        r"#66=DESCRIPTIVE_REPRESENTATION_ITEM('equivalent unicode string',"
        r"'DIM\\w4X M12x1.75-6H\\n+0.1\\xFCF\\w\X2\2316\X0\0.05\\wA');"
    )
    own = only(HOLE, SIZE, measure(25, 12.0), SHOWN, shown).dimension
    assert (own.text, own.thread) == ("4X M12x1.75-6H +0.1", "M12x1.75-6H")


def test_the_name_is_one_line() -> None:
    named = HOLE.replace("bore A", r"bore\X\0A  A ")
    assert only(named, SIZE, measure(25, 12.0)).dimension.text == "bore A"


def test_two_threads_of_one_size_are_said_and_none_is_taken() -> None:
    note = "#26=DESCRIPTIVE_REPRESENTATION_ITEM('dimensional note','M6x1');"
    (found,), (said,) = read(HOLE.replace("bore A", "M6x0.75 hole"), NOTE, measure(25, 5.0), note)
    assert found.dimension.thread == ""
    assert said == "#22 names more than one thread: M6x1, M6x0.75"


def test_items_that_place_a_dimension_in_a_picture_are_passed_over() -> None:
    placed = "#26=AXIS2_PLACEMENT_3D('orientation',#90,#91,#92);"
    assert only(HOLE, NOTE, measure(25, 12.0), placed).dimension.value == 12.0


@given(st.integers(0, 2000), st.binary(min_size=1, max_size=3))
def test_bytes_changed_anywhere_never_stop_the_reading(place: int, damage: bytes) -> None:
    text = (
        UNITS + FACES + HOLE + SIZE + measure(25, 12.0) + deviations(0.0, 0.021) + SHOWN
    ).encode()
    at = place % len(text)
    found = dimensions_in(text[:at] + damage + text[at + len(damage) :])
    for dimension in found.dimensions:
        assert dimension.dimension.value > 0.0 and dimension.items
