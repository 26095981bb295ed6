"""Tool libraries of other programs: what real files give, how units and angles are taken, and what is refused in one line."""

from __future__ import annotations

import dataclasses
import io
import json
import math
import zipfile
from pathlib import Path

import pytest

from random_cutters import CONTEXT, SHOP
from trunnion import registry
from trunnion.findings import BadCall, BadInput, Severity
from trunnion.model.tool import Holder
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange import ExchangeContext, LossKind, ReadTools, findings_of, format_of
from trunnion.shop.exchange.formats.freecad.shapes import pitches_of
from trunnion.shop.exchange.formats.fusion.geometry import corner_excess

LIBRARIES = Path(__file__).parents[2] / "tool_libraries"
INCH = dataclasses.replace(CONTEXT, unit="inch")


def read(path: Path, context: ExchangeContext = CONTEXT) -> ReadTools:
    return format_of(path).read(path, context)


def read_text(tmp_path: Path, name: str, words: str | bytes) -> ReadTools:
    path = tmp_path / name
    path.write_bytes(words if isinstance(words, bytes) else words.encode())
    return read(path)


def refusal(tmp_path: Path, name: str, words: str | bytes) -> str:
    """Return the one line that a file is refused with."""
    with pytest.raises(BadInput) as caught:
        read_text(tmp_path, name, words)
    line = str(caught.value)
    assert "\n" not in line and len(line) < 400
    return line.replace(str(tmp_path), "")


def fields(found: ReadTools, kind: LossKind, tool: str) -> set[str]:
    return {l.field for l in found.losses if l.kind is kind and l.tool == tool}


def named(found: ReadTools, name: str) -> Cutter:
    return next(c for c in found.cutters if c.tool.name == name)


# LinuxCNC


def test_a_real_tool_table_gives_numbers_diameters_and_names():
    found = read(LIBRARIES / "linuxcnc" / "sample_tool.tbl")
    assert [(c.tool.number, c.tool.name, c.tool.diameter) for c in found.cutters] == [
        (1, "5mm Drill HSS", 5.0),
        (2, "6mm Endmill Carbide", 6.0),
        (3, "3mm Probe", 3.0),
        (5, "8mm Ballend", 8.0),
        (10, '1/2" Face Mill', 12.7),
    ]
    # A negative length is an offset from another tool; offsets in X have no place, and pocket 0 is none.
    assert fields(found, LossKind.IGNORED, "6mm Endmill Carbide") == {"Z", "X"}
    assert "form" in fields(found, LossKind.ASSUMED, "5mm Drill HSS")


def test_lathe_tools_of_a_table_are_left_out():
    found = read(LIBRARIES / "linuxcnc" / "sample.tbl")
    assert [c.tool.number for c in found.cutters] == [1, 3]
    left = [l.tool for l in found.losses if l.kind is LossKind.OMITTED]
    assert left == ['1/2" Face Mill', "lathe profiling"]


def test_a_table_is_in_the_unit_of_its_machine(tmp_path):
    (tmp_path / "t.tbl").write_text("T4 P4 D0.25 Z5 ;quarter\n")
    (cutter,) = read(tmp_path / "t.tbl", INCH).cutters
    assert (cutter.tool.diameter, cutter.tool.gauge_length) == (6.35, 127.0)
    # 127 mm less the holder's own height stand out of it.
    assert cutter.tool.stickout == pytest.approx(127.0 - cutter.tool.holder.length)


def test_a_comment_is_cut_to_what_linuxcnc_keeps(tmp_path):
    long = dataclasses.replace(SHOP.cutters[0].tool, name="é" * 30)
    done = format_of(Path("t.tbl")).write(
        [Cutter(tool=long, suits=("N",), use=("face",))], Path("t.tbl"), CONTEXT
    )
    comment = next(iter(done.files.values())).decode().partition(";")[2].strip()
    assert comment == "é" * 19
    assert "name" in {l.field for l in done.losses}


def test_tools_without_numbers_get_the_lowest_free_ones():
    tools = [
        dataclasses.replace(c, tool=dataclasses.replace(c.tool, number=n))
        for c, n in zip(SHOP.cutters, (2, 0, 0, 2), strict=False)
    ]
    done = format_of(Path("t.tbl")).write(tools, Path("t.tbl"), CONTEXT)
    lines = next(iter(done.files.values())).decode().splitlines()
    assert [line.split()[0] for line in lines] == ["T2", "T1", "T3", "T4"]
    assert sum(l.field == "number" for l in done.losses) == 3


# FreeCAD


def test_a_real_freecad_library_gives_its_tools_with_their_numbers():
    found = read(LIBRARIES / "freecad" / "Library" / "Default.fctl")
    assert len(found.cutters) == 11
    drill = named(found, "New Drill").tool
    assert (drill.number, drill.form, drill.diameter, drill.point_angle) == (
        41,
        "drill",
        3.0,
        119.0,
    )
    assert drill.stickout == 25.0, "an attribute of the add-on"
    bull = named(found, "New Torus").tool
    assert (bull.form, bull.corner_radius, bull.flute_length, bull.teeth) == ("bull", 1.0, 30.0, 1)
    assert bull.shank_diameter == 3.0
    assert named(found, "2,5mm uncoated aluminium dual flute HRC50").tool.stickout == 10.0, "1 cm"
    left = {l.tool: l.why for l in found.losses if l.kind is LossKind.OMITTED}
    assert set(left) == {"New Dovetail", "New Probe", "New Slittingsaw", "New Chamfer"}
    assert "cap below its blade" in left["New Slittingsaw"]
    assert fields(found, LossKind.IGNORED, "2,5mm dual flute ball nose") >= {
        "btl-supplier",
        "Length",
    }


def test_an_engraving_point_is_a_cone():
    found = read(LIBRARIES / "freecad" / "Library" / "Default.fctl")
    tool = named(found, "New V-Bit").tool
    # 90 degrees from 1 mm to 10 mm across: 4.5 mm high, whatever the file says of its edge (1 mm).
    assert tool.outline == ((0.5, 0.0, 0.0), (5.0, pytest.approx(4.5), 0.0))
    assert "flute_length" in fields(found, LossKind.ASSUMED, "New V-Bit")


def test_a_thread_mill_of_freecad_cuts_the_pitches_that_its_tooth_has_room_for():
    # A flat of 0.1 mm is that of P = 0.8; a tooth 1 mm high fills a groove of 5/8 H and the extra depth of the narrow flat:
    # 0.541266 P + 0.108253 (P - 0.8) = 1.
    low, high = pitches_of(0.1, 1.0)
    assert low == pytest.approx(0.8)
    assert 0.541266 * high + 0.108253 * (high - low) == pytest.approx(1.0, abs=1e-5)
    tool = named(read(LIBRARIES / "freecad" / "Library" / "Default.fctl"), "New Threadmill").tool
    assert (tool.pitch_low, tool.pitch_high) == (pytest.approx(low), pytest.approx(high))


@pytest.mark.parametrize(
    ("words", "mm"),
    [('0.375 "', 9.525), ("0.25 in", 6.35), ("6,5 mm", 6.5), ("2 cm", 20.0), ("7", 7.0)],
)
def test_lengths_of_freecad_carry_their_unit(tmp_path, words, mm):
    bit = {"shape": "endmill.fcstd", "name": "m", "parameter": {"Diameter": words}}
    (cutter,) = read_text(tmp_path, "m.fctb", json.dumps(bit)).cutters
    assert cutter.tool.diameter == pytest.approx(mm)


def test_a_bullnose_of_older_files_gives_the_flat_between_its_corners(tmp_path):
    bit = {"shape": "bullnose.fcstd", "parameter": {"Diameter": "6 mm", "FlatRadius": "1.5 mm"}}
    (cutter,) = read_text(tmp_path, "m.fctb", json.dumps(bit)).cutters
    assert cutter.tool.corner_radius == 1.5


def test_what_a_kind_of_tool_does_not_have_is_ignored(tmp_path):
    sizes = {"Diameter": "6 mm", "Pitch": "1 mm", "CornerRadius": "0.5 mm"}
    bit = {"shape": "endmill.fcstd", "name": "m", "parameter": sizes}
    found = read_text(tmp_path, "m.fctb", json.dumps(bit))
    assert found.cutters[0].tool.form == "bull"
    assert fields(found, LossKind.IGNORED, "m") == {"pitch"}


def test_a_tap_without_a_pitch_is_left_out(tmp_path):
    bit = {"shape": "tap.fcstd", "parameter": {"Diameter": '0.375 "', "Pitch": "0.000 in"}}
    assert "it gives no pitch" in refusal(tmp_path, "tap.fctb", json.dumps(bit))


def test_a_library_whose_files_are_elsewhere_leaves_their_tools_out(tmp_path):
    library = {"tools": [{"nr": 1, "path": "../../etc/passwd"}]}
    assert "passwd.fctb is neither beside" in refusal(tmp_path, "l.fctl", json.dumps(library))


# Fusion


def test_a_fusion_library_gives_tools_with_their_holders():
    found = read(LIBRARIES / "fusion" / "by-hand.json")
    mill = named(found, "EM-10").tool
    assert (mill.number, mill.form, mill.diameter, mill.teeth) == (2, "flat", 10.0, 3)
    assert (mill.stickout, mill.gauge_length, mill.neck_diameter) == (50.0, 107.0, 9.5)
    assert mill.holder == Holder(
        name="CAT40 ER32",
        rows=((0.0, 19.0, 4.0, 25.0), (4.0, 25.0, 25.0, 25.0), (25.0, 22.25, 57.0, 22.25)),
    )
    assert fields(found, LossKind.IGNORED, "EM-10") == {"OAL", "BMC", "vendor", "presets"}
    cone = named(found, "Countersink 90").tool
    assert cone.outline[0] == (0.6, 0.0, 0.0) and cone.outline[-1][:2] == (6.0, 5.4)
    left = {l.tool for l in found.losses if l.kind is LossKind.OMITTED}
    assert left == {"Left-hand tap", "bare holder"}


def test_the_diameter_of_a_tapered_mill_is_where_its_flank_meets_the_plane_of_its_tip():
    tool = named(read(LIBRARIES / "fusion" / "by-hand.json"), "1/16 inch ball, 11 degrees").tool
    # DC 0.0568 in is rounded: the ball of 1/16 in is found again to its last digit.
    assert tool.diameter == pytest.approx(1.5875, abs=0.0001 * 25.4 / 2)
    assert (tool.form, tool.corner_radius, tool.taper_angle) == ("taper", 0.79375, 5.5)
    r, a = 0.79375, math.radians(5.5)
    flank_at_tip = r * math.cos(a) - (r - r * math.sin(a)) * math.tan(a)
    assert corner_excess(r, 5.5) == pytest.approx(2 * (r - flank_at_tip))


def test_a_holder_ends_at_the_gauge_line(tmp_path):
    entry = json.loads((LIBRARIES / "fusion" / "by-hand.json").read_text())["data"][0]
    entry["holder"]["gaugeLength"] = 30.0
    entry["geometry"]["assemblyGaugeLength"] = 80.0
    found = read_text(tmp_path, "l.json", json.dumps({"data": [entry]}))
    assert found.cutters[0].tool.holder.rows[-1] == (25.0, 22.25, 30.0, 22.25)
    assert "holder segments" in fields(found, LossKind.IGNORED, "EM-10")


def test_a_holder_of_a_name_that_the_catalogue_has_gets_another(tmp_path):
    entry = json.loads((LIBRARIES / "fusion" / "by-hand.json").read_text())["data"][0]
    name = next(iter(CONTEXT.holders))
    entry["holder"]["description"] = name
    found = read_text(tmp_path, "l.json", json.dumps({"data": [entry]}))
    assert found.cutters[0].tool.holder.name == f"{name} (2)"
    assert "holder" in fields(found, LossKind.ASSUMED, "EM-10")


def test_dimensions_for_fusion_have_a_point_and_counts_have_none():
    done = format_of(Path("l.json")).write(SHOP.cutters[:40], Path("l.json"), CONTEXT)
    counts = {"NOF", "NT", "number", "turret", "diameter-offset", "length-offset", "version"}

    def check(value, word=""):
        if isinstance(value, dict):
            for key, inner in value.items():
                check(inner, key)
        elif isinstance(value, list):
            for inner in value:
                check(inner, word)
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            assert isinstance(value, int) == (word in counts), word

    check(json.loads(next(iter(done.files.values()))))


# ISO 13399


def test_an_item_of_iso_13399_is_read_by_its_codes():
    found = read(LIBRARIES / "iso13399" / "iso13399.p21")
    (cutter,) = found.cutters
    tool = cutter.tool
    assert tool.name == "H1TE4SE0250L075HA_KCPM15"
    assert tool.description == "END MILL HARVI I TE 1/4X1/4X3/4X2 1/2 S"
    assert (tool.diameter, tool.flute_length, tool.shank_diameter) == (6.35, 19.05, 6.35)
    assert (tool.teeth, tool.helix_angle) == (4, 36.0)
    assert fields(found, LossKind.IGNORED, tool.name) == {"OAL", "LF"}


def item(values: str, title: str = "tool") -> str:
    """Return a file of one item with values, each `CODE unit number`."""
    lines = [
        f"#{n}=NUMERICAL_VALUE('{code}',$,{'#3' if unit == 'in' else '#2' if unit == 'mm' else '$'},'{value}');"
        for n, (code, unit, value) in enumerate((v.split() for v in values.split(",")), 10)
    ]
    return "\n".join(
        [
            "ISO-10303-21;HEADER;ENDSEC;DATA;",
            f"#1=ITEM('{title}','X1',$);",
            "#2=UNIT('mm');#3=UNIT('in');",
            *lines,
            "ENDSEC;END-ISO-10303-21;",
        ]
    )


@pytest.mark.parametrize(
    ("title", "values", "form", "more"),
    [
        ("Twist drill", "DC mm 8, SIG - 140", "drill", {"point_angle": 140.0}),
        ("Machine tap", "DC mm 6, TP mm 1", "tap", {"pitch": 1.0}),
        ("Thread mill", "DC mm 6, TP mm 1", "thread-mill", {"pitch": 1.0}),
        ("Reamer", "DC mm 6", "reamer", {"fit": "H7"}),
        ("Ball end mill", "DC in 0.25", "ball", {"diameter": 6.35}),
        ("Face mill", "DC mm 50, KAPR - 45", "taper", {"taper_angle": 45.0}),
        ("Mill", "DC mm 10, RE mm 1.5, KAPR - 90", "bull", {"corner_radius": 1.5}),
    ],
)
def test_what_an_item_is_follows_from_its_properties_and_its_name(
    tmp_path, title, values, form, more
):
    (cutter,) = read_text(tmp_path, "t.p21", item(values, title)).cutters
    assert cutter.tool.form == form
    assert {name: getattr(cutter.tool, name) for name in more} == more


def test_values_are_given_to_the_items_that_they_describe():
    two = [c for c in SHOP.cutters if c.tool.form == "drill"][:2]
    path = Path("two.p21")
    data = format_of(path).write(two, path, CONTEXT).files[path].decode()
    assert data.count("=ITEM(") == 2
    assert data.count("=NUMERICAL_VALUE('DC',") == 2
    alone = data.replace("PROPERTY_VALUE_ASSOCIATION", "SOMETHING_ELSE")
    assert "PROPERTY_VALUE_ASSOCIATION($,#" in data and alone != data


# Assumptions


def test_what_is_assumed_is_on_the_safe_side(tmp_path):
    (cutter,) = read_text(tmp_path, "t.p21", item("DC mm 10, SIG - 140")).cutters
    tool = cutter.tool
    assert tool.flute_length == 20.0 and tool.stickout == tool.neck_length == tool.flute_length
    assert tool.teeth == 2


def test_the_holder_is_that_of_the_catalogues_nearest_shank_or_the_chosen_one(tmp_path):
    path = tmp_path / "t.p21"
    path.write_text(item("DC mm 8, DMM mm 8"))
    (cutter,) = read(path).cutters
    shanks = {c.tool.holder.name for c in SHOP.cutters if c.tool.shank_diameter == 8.0}
    assert cutter.tool.holder.name in shanks
    chosen = dataclasses.replace(CONTEXT, holder="HSK-A63 ER32")
    assert read(path, chosen).cutters[0].tool.holder.name == "HSK-A63 ER32"
    with pytest.raises(BadInput, match="unknown holder nought"):
        dataclasses.replace(CONTEXT, holder="nought")


def test_losses_of_the_same_reason_are_one_finding():
    found = findings_of(read(LIBRARIES / "linuxcnc" / "sample_tool.tbl").losses)
    assert len({(f.code, f.text, f.where) for f in found}) == len(found) < 20
    assumed = next(f for f in found if f.code == "tools.assumed")
    assert assumed.severity is Severity.WARNING and "5mm Drill HSS" in assumed.where
    assert assumed.remedy


# What is refused


ENTRY = '{"type": "drill", "unit": "millimeters", "geometry": {"DC": %s}}'
BIT = '{"shape": "endmill.fcstd", "parameter": {"Diameter": %s}}'


@pytest.mark.parametrize(
    ("name", "words", "line"),
    [
        ("t.tbl", "", "the file holds no tools"),
        ("t.tbl", ";nothing\n", "the file holds no tools"),
        ("t.tbl", "T1 D3\n", "/t.tbl: line 1: a tool needs a number T and a pocket P"),
        ("t.tbl", "T1 P1 Dnan\n", "line 1: 'Dnan' is not understood"),
        ("t.tbl", "T1 P1 D1e999\n", "line 1: D can't be 1e999"),
        ("t.tbl", "T1 P1 D5 D6\n", "line 1: D stands twice"),
        ("t.tbl", "T1 P1 D-5\n", "it gives no diameter above 0"),
        ("t.tbl", "T1 P1 D5000\n", "its diameter is larger than 1000 mm"),
        ("t.tbl", "T-1 P1 D5\n", "T can't be -1"),
        ("t.tbl", b"T1 P1 D5 ;\xe9\n", "not a text in UTF-8"),
        ("t.tbl", b"T1 P1 D5\0\n", "not a text"),
        ("t.tbl", "TOOLNO POCKET\n\n 1 1 0.5 0.125\n", "line 1: 'TOOLNO' is not understood"),
        ("t.fctb", BIT % "NaN", "NaN is no number"),
        ("t.fctb", BIT % "-5", "it gives no diameter above 0"),
        ("t.fctb", BIT % '"5 furlong"', "Diameter has the unit 'furlong'"),
        ("t.fctb", BIT % '"nan mm"', "Diameter must be a number with a unit"),
        ("t.fctb", BIT % '"1e999 mm"', "Diameter must be a number"),
        ("t.fctb", BIT % f"1{'0' * 400}", "Diameter must be a number"),
        ("t.fctb", BIT % "[5]", "Diameter must be a number"),
        ("t.fctb", '{"shape": "probe"}', "no kind for FreeCAD's shape probe"),
        ("t.fctb", '{"shape": 5}', "shape must be a text"),
        ("t.fctb", '{"parameter": []}', "parameter must be an object"),
        ("t.fctl", '{"tools": [5]}', "must hold a list of objects, tools"),
        ("t.fctl", '{"tools": [{"nr": 1.5, "path": "a"}]}', "nr must be a whole number"),
        ("t.json", "[" * 100_000, "nested too deep"),
        ("t.json", "[1]", "it must be one object"),
        ("t.json", '{"data": ', "not in JSON"),
        ("t.json", '{"data": []}', "the file holds no tools"),
        ("t.json", '{"data": [' + ENTRY % "Infinity" + "]}", "Infinity is no number"),
        ("t.json", '{"data": [' + ENTRY % "-4" + "]}", "it gives no diameter above 0"),
        ("t.json", '{"data": [' + ENTRY % '"4"' + "]}", "data 1: DC must be a number"),
        ("t.json", '{"data": [' + ENTRY % ("9" * 5000) + "]}", "not in JSON"),
        ("t.json", '{"data": [{"type": "drill", "unit": "miles"}]}', "unit must be millimeters"),
        ("t.json", '{"data": [{"type": "laser cutter"}]}', "Fusion's type laser cutter"),
        ("t.tools", b"PK\x03\x04 no zip", "damaged, or not a zip archive"),
        ("t.p21", "", "it doesn't begin with ISO-10303-21"),
        ("t.p21", "ISO-10303-21;DATA;#1=ITEM('a','b',$);", "the file is cut off"),
        ("t.p21", item("DC mm 5").replace("ITEM", "THING"), "it holds no tool"),
        ("t.p21", item("DC mm nan"), "DC must be a number"),
        ("t.p21", item("DC mm 1e300"), "DC is too large"),
        ("t.p21", item("DC mm -3"), "it gives no diameter above 0"),
        ("t.p21", item("OAL mm 3"), "it gives no diameter above 0"),
        (
            "t.p21",
            item("DC mm 5").replace("ENDSEC;END", "#90=ITEM('b','c',$);ENDSEC;END"),
            "belong to none",
        ),
        ("t.p21", item("DC mm 5").replace("'DC',$,", "((((('DC',$,"), "#10 has a bracket too few"),
        ("t.p21", b"ISO-10303-21;\xff\xfe", "not a text in UTF-8"),
    ],
)
def test_a_bad_file_gets_one_clear_line(tmp_path, name, words, line):
    assert line in refusal(tmp_path, name, words)


def archive(*members: tuple[str, bytes]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as made:
        for name, data in members:
            made.writestr(name, data)
    return file.getvalue()


LIBRARY = (LIBRARIES / "fusion" / "by-hand.json").read_bytes()


def test_an_archive_gives_the_library_in_it(tmp_path):
    found = read_text(tmp_path, "l.tools", archive(("tools.json", LIBRARY)))
    assert found.cutters == read(LIBRARIES / "fusion" / "by-hand.json").cutters


@pytest.mark.parametrize(
    ("members", "line"),
    [
        ([("../tools.json", LIBRARY), ("tools.json", LIBRARY)], "a name in it leaves the archive"),
        ([("/etc/x", b""), ("tools.json", LIBRARY)], "a name in it leaves the archive"),
        ([("C:\\x", b""), ("tools.json", LIBRARY)], "a name in it leaves the archive"),
        ([("other.json", LIBRARY)], "it must hold tools.json once; it holds it 0 times"),
        ([("tools.json", b" " * (33 * 1024**2))], "larger than the 32 MB"),
        ([(f"{n}.txt", b"") for n in range(1001)], "1001 members are more than the 1000"),
    ],
)
def test_an_archive_that_is_a_trap_is_refused(tmp_path, members, line):
    assert line in refusal(tmp_path, "l.tools", archive(*members))


def test_a_library_with_too_much_in_it_is_refused_before_it_is_taken_apart(tmp_path):
    bomb = b'{"data": [' + b"[]," * 2_100_000 + b"[]]}"
    assert "more than the 2000000 objects and lists" in refusal(tmp_path, "l.json", bomb)
    assert "larger than the 32 MB" in refusal(tmp_path, "l.json", b" " * (32 * 1024**2 + 1))


def test_a_part_21_file_whose_references_spread_without_end_is_refused(tmp_path):
    fan = ",".join(f"#{n}" for n in range(1000, 1100))
    words = item("DC mm 5").replace(
        "ENDSEC;END", f"#90=PROPERTY_VALUE_ASSOCIATION($,({fan}),#10,$,$);ENDSEC;END"
    )
    assert "leads to more than 64 entities" in refusal(tmp_path, "t.p21", words)


def test_tools_of_one_name_and_holders_of_one_name_stay_apart(tmp_path):
    entry = json.loads((LIBRARIES / "fusion" / "by-hand.json").read_text())["data"][0]
    other = json.loads(json.dumps(entry))
    other["holder"]["segments"][0]["height"] = 5.0
    other["holder"]["gaugeLength"] = 58.0
    other["geometry"]["assemblyGaugeLength"] = 108.0
    found = read_text(tmp_path, "l.json", json.dumps({"data": [entry, other, entry, other]}))
    assert [(c.tool.name, c.tool.holder.name) for c in found.cutters] == [
        ("EM-10", "CAT40 ER32"),
        ("EM-10 (2)", "CAT40 ER32 (2)"),
        ("EM-10 (3)", "CAT40 ER32"),
        ("EM-10 (4)", "CAT40 ER32 (2)"),
    ]


def test_a_format_is_found_by_ending_or_by_name():
    assert format_of(Path("a.FCTB")).name == "freecad"
    assert format_of(Path("a.txt"), "linuxcnc").name == "linuxcnc"
    with pytest.raises(BadCall, match=r"no format has files with this ending; name one of freecad"):
        format_of(Path("a.txt"))
    with pytest.raises(BadCall, match="unknown tool_formats name nought"):
        format_of(Path("a.tbl"), "nought")
    for name in registry.names(registry.TOOL_FORMATS):
        form = registry.get(registry.TOOL_FORMATS, name)()
        assert form.name == name and form.title and all(s.startswith(".") for s in form.suffixes)


def test_a_missing_file_is_one_line(tmp_path):
    for ending in (".tbl", ".fctb", ".fctl", ".json", ".tools", ".p21"):
        with pytest.raises(BadInput, match="can't be read: No such file"):
            read(tmp_path / f"none{ending}")
