"""Features and process tree as XML: they fit their schemas, come back, and hostile or wrong ones are refused with the line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from lxml import etree

import programs
from trunnion.findings import BadCall, BadInput
from trunnion.model.session import Session
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.model.tool import Tool
from trunnion.store import xml
from trunnion.store.features import features_xml, read_features, write_features
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.store.process import process_xml, read_process, write_process
from verify_tools import FORMS

SESSION = programs.session()


def test_a_process_tree_comes_back_as_it_was(tmp_path):
    write_process(SESSION, tmp_path / "a.xml")
    again, before = read_process(tmp_path / "a.xml"), programs.process_tree()
    assert (again.plan, again.material) == (before.plan, before.material)
    assert (again.operations, again.findings) == (before.operations, before.findings)
    assert [(s.name, s.work_offset, s.clearance, s.machine) for s in again.setups] == [
        (s.name, s.work_offset, s.clearance, s.machine) for s in before.setups
    ]
    assert all(
        np.allclose(a.frame.axes, b.frame.axes) and np.allclose(a.frame.origin, b.frame.origin)
        for a, b in zip(again.setups, before.setups, strict=True)
    )


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
    assert read_process(tmp_path / "a.xml").operations[0].data == data
    for kept in (SESSION, changed):
        members = Members()
        text = to_xml(kept, Session, "session", members)
        again = from_xml(text, Session, members)
        assert again.process.operations == kept.process.operations
        assert (text.find(".//spindle-mode") is None) == (kept is SESSION)


@pytest.mark.parametrize("form", FORMS)
def test_a_tool_of_every_form_comes_back_as_it_was(tmp_path, form):
    tree = programs.process_tree()
    operation = replace(tree.operations[0], tool=FORMS[form])
    (tmp_path / "a.xml").write_bytes(
        process_xml(replace(tree, operations=(operation,)), programs.part_info())
    )
    assert read_process(tmp_path / "a.xml").operations[0].tool == FORMS[form]
    members = Members()
    assert from_xml(to_xml(FORMS[form], Tool, "tool", members), Tool, members) == FORMS[form]


def test_features_come_back_as_they_were(tmp_path):
    write_features(SESSION, tmp_path / "a.xml")
    again, before = read_features(tmp_path / "a.xml"), programs.recognition()
    assert (again.family, again.features, again.unexplained, again.findings) == (
        before.family,
        before.features,
        before.unexplained,
        before.findings,
    )
    assert again.unexplained_share == before.unexplained_share


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


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('tool="7"', 'tool="9"', r"line \d+: .*No match found for key-sequence \['9'\]"),
        ('setup="S2"', 'setup="S3"', r"line \d+: .*No match found for key-sequence \['S3'\]"),
        ('teeth="3"', 'teeth="-3"', r"line \d+: .*'-3' is not a valid value"),
        ('form="bull"', 'form="saw"', r"line \d+: .*'saw'"),
        (
            'form="bull"',
            'form="drill"',
            "can't be used: tool bull 10 R1: a drill needs a point angle up to 180 degrees and no corner radius",
        ),
        ("<cutting", "<cuting", r"damaged XML: Opening and ending tag mismatch: cuting"),
        (
            '<operation id="wall-01"',
            '<operation id="pocket-01.rough"',
            r"line \d+: .*Duplicate key-sequence \['pocket-01.rough'\]",
        ),
        ('version="1"', 'version="2"', "written in format 2; this Trunnion reads format 1"),
        ("<process-tree", "<!DOCTYPE x><process-tree", "holds a document type or entities"),
        (
            'corner-radius="1.0"',
            'corner-radius="99.0"',
            "can't be used: tool bull 10 R1: corner radius 99.0 does not fit",
        ),
        (
            'type="truth">true',
            'type="list">true',
            "can't be used: could not convert string to float",
        ),
    ],
)
def test_a_wrong_process_tree_is_refused_with_its_line(tmp_path, old, new, message):
    text = process_xml(programs.process_tree(), programs.part_info()).decode()
    assert old in text
    (tmp_path / "a.xml").write_text(text.replace(old, new, 1))
    with pytest.raises(BadInput, match=message) as refused:
        read_process(tmp_path / "a.xml")
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
def test_wrong_features_are_refused_with_their_line(tmp_path, old, new, message):
    text = features_xml(programs.recognition(), programs.part_info()).decode()
    assert old in text
    (tmp_path / "a.xml").write_text(text.replace(old, new, 1))
    with pytest.raises(BadInput, match=message):
        read_features(tmp_path / "a.xml")


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


def test_a_file_that_is_not_there_is_refused(tmp_path):
    for read in (read_features, read_process):
        with pytest.raises(BadInput, match="can't be read: No such file or directory"):
            read(tmp_path / "none.xml")
