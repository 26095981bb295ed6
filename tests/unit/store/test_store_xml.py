"""Features and process tree as XML: they say all there is, fit their schemas, and hostile or wrong ones are refused with the line."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from lxml import etree

import programs
from trunnion.findings import BadCall, BadInput
from trunnion.model.session import Session
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.model.tool import Tool
from trunnion.plan.manual.operation_copy import with_copy
from trunnion.plan.manual.operation_order import with_operation_before
from trunnion.settings import unwritten
from trunnion.store import xml
from trunnion.store.features import features_xml, write_features
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.store.process import process_xml, write_process
from verify_tools import FORMS

SESSION = programs.session()


def says(element, data):
    """Return the scalars of a dataclass as the attributes of an element say them."""
    kinds = {f.name: type(getattr(data, f.name)) for f in fields(data)}
    named = {name.replace("_", "-"): kind for name, kind in kinds.items()}
    return {
        name.replace("-", "_"): text == "true" if named[name] is bool else named[name](text)
        for name, text in element.attrib.items()
        if name in named
    }


def scalars(data, *others):
    """Return the scalar fields of a dataclass, but for some and for those that files leave out."""
    left_out = {*others, *unwritten(data)}
    every = {f.name: getattr(data, f.name) for f in fields(data) if f.name not in left_out}
    return {name: v for name, v in every.items() if isinstance(v, (bool, int, float, str))}


def root_of(write, tmp_path):
    write(SESSION, tmp_path / "a.xml")
    return etree.parse(tmp_path / "a.xml").getroot()


def test_a_process_tree_says_every_number_of_its_operations(tmp_path):
    tree, root = programs.process_tree(), root_of(write_process, tmp_path)
    assert (root.get("plan"), root.get("material")) == (tree.plan, tree.material)
    assert [e.get("id") for e in root.findall("operation")] == [o.id for o in tree.operations]
    for element, operation in zip(root.findall("operation"), tree.operations, strict=True):
        assert says(element, replace(operation, tool=0)) == {
            **scalars(operation),
            "tool": operation.tool.number,
        }
        assert says(element.find("cutting"), operation.data) == scalars(operation.data)
        assert [int(f.get("tag")) for f in element.findall("face")] == list(operation.faces)
        assert [r.text for r in element.findall("rule")] == list(operation.rules)
        assert [r.text for r in element.findall("cutting/rule")] == list(operation.data.rules)
        assert {c.get("key") for c in element.findall("choice")} == set(operation.choices)
    assert [e.findtext("text") for e in root.findall("finding")] == [f.text for f in tree.findings]


def test_a_process_tree_says_what_led_its_toolpaths(tmp_path):
    root = root_of(write_process, tmp_path)
    wall = next(e for e in root.findall("operation") if e.get("id") == "wall-01")
    run, round_wall, floor = wall.findall("guide")
    assert [dict(e.attrib) for e in (run, round_wall, floor)] == [
        {"kind": "wall", "closed": "false"},
        {"kind": "wall", "closed": "true"},
        {"kind": "area", "closed": "true"},
    ]
    assert [dict(e.attrib) for e in run] == [
        {"move": "GOFWD", "face": "12", "link": "TO"},
        {"move": "GOLFT", "face": "13", "link": "PAST"},
        {"move": "GORGT"},
    ]
    assert [dict(e.attrib) for e in round_wall] == [
        {"move": "GOFWD", "face": "15", "link": "TANTO"}
    ]
    assert [dict(e.attrib) for e in floor] == [{"tag": "9"}]
    assert all(not e.findall("guide") for e in root.findall("operation") if e is not wall)


def test_a_process_tree_says_where_its_setups_are(tmp_path):
    tree, root = programs.process_tree(), root_of(write_process, tmp_path)
    for element, setup in zip(root.findall("setup"), tree.setups, strict=True):
        assert says(element, setup) == scalars(setup)
        for name in ("origin", "x", "z"):
            vector = [float(element.find(f"frame/{name}").get(axis)) for axis in "xyz"]
            assert vector == pytest.approx(getattr(setup.frame, name))


def test_what_a_program_gives_of_speed_and_feed_comes_back_and_is_not_written_where_it_is_plain(
    tmp_path,
):
    tree, words = programs.process_tree(), (b"spindle-mode", b"highest-spindle", b"feed-mode")
    plain = process_xml(tree, SESSION.part)
    assert not any(word in plain for word in words)
    first = tree.operations[0]
    data = replace(
        first.data,
        spindle_mode=SpindleMode.SURFACE,
        highest_spindle=9000.0,
        feed_mode=FeedMode.REVOLUTION,
    )
    changed = replace(SESSION, process=tree.with_operation(replace(first, data=data)))
    write_process(changed, tmp_path / "a.xml")
    assert all(word in (tmp_path / "a.xml").read_bytes() for word in words)
    for kept in (SESSION, changed):
        members = Members()
        text = to_xml(kept, Session, "session", members)
        again = from_xml(text, Session, members)
        assert again.process.operations == kept.process.operations
        assert (text.find(".//spindle-mode") is None) == (kept is SESSION)


def test_copies_and_places_by_hand_are_written_where_there_are_any(tmp_path):
    tree = programs.process_tree()
    assert not any(word in process_xml(tree, SESSION.part) for word in (b" copy-of=", b" moved="))
    copied, name = with_copy(tree, "face-02")
    moved = with_operation_before(copied, name, "face-02")
    (made,) = [
        e
        for e in etree.fromstring(process_xml(moved, SESSION.part)).findall("operation")
        if e.get("copy-of")
    ]
    assert (made.get("id"), made.get("copy-of"), made.get("moved")) == (name, "face-02", "true")
    members = Members()
    session = replace(SESSION, process=moved)
    again = from_xml(to_xml(session, Session, "session", members), Session, members)
    assert again.process.operations == moved.operations


@pytest.mark.parametrize("form", FORMS)
def test_a_tool_of_every_form_has_all_its_sizes_and_its_outline(form):
    tree = programs.process_tree()
    operation = replace(tree.operations[0], tool=FORMS[form])
    text = process_xml(replace(tree, operations=(operation,)), programs.part_info())
    element, tool = etree.fromstring(text).find("tool"), FORMS[form]
    assert says(element, tool) == scalars(tool)
    points = [tuple(map(float, p.attrib.values())) for p in element.findall("point")]
    assert points == [tuple(p) for p in tool.outline]
    cones = [tuple(map(float, c.attrib.values())) for c in element.findall("holder/cone")]
    assert cones == [tuple(row) for row in tool.holder.rows]
    members = Members()
    assert from_xml(to_xml(tool, Tool, "tool", members), Tool, members) == tool


def test_features_are_named_with_their_faces_and_sizes(tmp_path):
    found, root = programs.recognition(), root_of(write_features, tmp_path)
    assert root.get("family") == found.family
    for element, feature in zip(root.findall("feature"), found.features, strict=True):
        assert says(element, feature) == scalars(feature)
        faces = [(f.get("role"), int(f.get("tag"))) for f in element.findall("face")]
        assert faces == [(f.role, f.face) for f in feature.faces]
        assert {s.get("name") for s in element.findall("size")} == set(feature.sizes)
    left = root.find("unexplained")
    assert [int(f.get("tag")) for f in left.findall("face")] == list(found.unexplained)
    assert float(left.get("area-share")) == found.unexplained_share
    assert [e.get("code") for e in root.findall("finding")] == [f.code for f in found.findings]


def test_same_session_same_bytes():
    part = programs.part_info()
    assert process_xml(programs.process_tree(), part) == process_xml(programs.process_tree(), part)
    assert features_xml(programs.recognition(), part) == features_xml(programs.recognition(), part)


def test_a_pocket_carries_the_papers_model():
    root = etree.fromstring(features_xml(programs.recognition(), programs.part_info()))
    pocket = root.find("feature[@id='pocket-01']/generalized-pocket")
    assert (pocket.get("identification"), pocket.get("through")) == ("pocket", "false")
    assert dict(pocket.find("centre").attrib) == {"x": "10.0", "y": "20.0", "z": "4.0"}
    assert (pocket.find("top").get("z"), pocket.find("bottom").get("z")) == ("24.0", "4.0")
    assert [line.get("face") for line in pocket.findall("guide-profile/guide-line")] == ["4", "5"]
    assert [i.get("feature") for i in pocket.findall("island")] == ["island-01"]
    assert [a.get("feature") for a in pocket.findall("auxiliary")] == ["pocket-02"]


def test_a_pocket_without_a_floor_is_through():
    root = etree.fromstring(features_xml(programs.recognition(), programs.part_info()))
    assert root.find("feature[@id='pocket-02']/generalized-pocket").get("through") == "true"


def test_features_name_faces_by_tag_and_copy_no_geometry():
    root = etree.fromstring(features_xml(programs.recognition(), programs.part_info()))
    assert {e.tag for e in root.iter()} == {
        "features",
        "part",
        "frame",
        "origin",
        "x",
        "z",
        "feature",
        "face",
        "size",
        "attribute",
        "generalized-pocket",
        "centre",
        "top",
        "bottom",
        "guide-profile",
        "guide-line",
        "island",
        "auxiliary",
        "unexplained",
        "removed",
        "finding",
        "text",
        "where",
        "remedy",
    }


def test_a_name_that_xml_cannot_hold_is_written_with_a_mark():
    part = replace(programs.part_info(), name="B\udc801\x01")
    assert (
        etree.fromstring(process_xml(programs.process_tree(), part)).find("part").get("name")
        == "B\ufffd1\ufffd"
    )


def test_two_tools_of_one_number_are_refused():
    tree = programs.process_tree()
    odd = replace(tree.operations[0], tool=replace(programs.FLAT_16, diameter=15.5))
    with pytest.raises(BadInput, match=r"operation pocket-01\.rough: two tools have the number 1"):
        process_xml(replace(tree, operations=(tree.operations[1], odd)), programs.part_info())


def test_an_empty_session_has_nothing_to_write(tmp_path):
    with pytest.raises(BadCall, match="recognise first"):
        write_features(Session(), tmp_path / "a.xml")
    with pytest.raises(BadCall, match="generate the route first"):
        write_process(Session(), tmp_path / "a.xml")


def checked(text, schema):
    """Read a text as the program reads XML, and hold it against a schema as what is written is."""
    return xml.validated(xml.parse(text.encode(), "a.xml"), schema, "a.xml")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('tool="7"', 'tool="9"', r"line \d+: .*No match found for key-sequence \['9'\]"),
        ('setup="S2"', 'setup="S3"', r"line \d+: .*No match found for key-sequence \['S3'\]"),
        ('teeth="3"', 'teeth="-3"', r"line \d+: .*'-3' is not a valid value"),
        ('form="bull"', 'form="saw"', r"line \d+: .*'saw'"),
        ("<cutting", "<cuting", r"damaged XML: Opening and ending tag mismatch: cuting"),
        (
            '<operation id="wall-01"',
            '<operation id="pocket-01.rough"',
            r"line \d+: .*Duplicate key-sequence \['pocket-01.rough'\]",
        ),
        ("<process-tree", "<!DOCTYPE x><process-tree", "holds a document type or entities"),
    ],
)
def test_a_process_tree_that_does_not_fit_its_schema_is_refused_with_the_line(old, new, message):
    text = process_xml(programs.process_tree(), programs.part_info()).decode()
    assert old in text
    with pytest.raises(BadInput, match=message) as refused:
        checked(text.replace(old, new, 1), "process")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('tag="3"', 'tag="0"', r"line 10: .*'0'"),
        (
            'feature="island-01"',
            'feature="nobody"',
            r"No match found for key-sequence \['nobody'\]",
        ),
        ('<z x="0.1', '<z x="zero', r"is not a valid value of the atomic type 'xs:double'"),
        ("<features", "<feature-list", "damaged XML"),
    ],
)
def test_features_that_do_not_fit_their_schema_are_refused_with_the_line(old, new, message):
    text = features_xml(programs.recognition(), programs.part_info()).decode()
    assert old in text
    with pytest.raises(BadInput, match=message):
        checked(text.replace(old, new, 1), "features")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "damaged XML"),
        (b"<a>&b;</a>", "damaged XML"),
        ("<a/>".encode("utf-16"), "must be UTF-8"),
        (b'<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>', "holds a document type"),
        (b'<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>', "holds a document type"),
        (b"<a>" * 300, "damaged XML"),
    ],
)
def test_hostile_xml_is_refused(data, message):
    with pytest.raises(BadInput, match=f"x.xml: {message}"):
        xml.parse(data, "x.xml")


def test_xml_over_the_stated_size_is_not_opened(monkeypatch):
    monkeypatch.setattr(xml, "LARGEST_XML", 3)
    with pytest.raises(BadInput, match="4 bytes of XML are more than the 3 that are read"):
        xml.parse(b"<a/>", "x.xml")
