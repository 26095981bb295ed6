"""The entities of an IGES file: counted by type, trimmed surfaces with what they are made of, and faces with the entity they come from."""

from __future__ import annotations

import json

import pytest

from parts import PARTS, needs_parts
from shaped_parts import bowl
from trunnion.cli.main import DONE, main
from trunnion.part.read.iges_text import iges_entities
from trunnion.part.read.part_file import read_part
from trunnion.part.write import write_faces, write_step
from trunnion.pipeline import Engine
from trunnion.pipeline.part_entities import FileEntities, file_entities, type_name


def text(*entities, start=b",,") -> bytes:
    """Return an IGES text of entities (type, parameters); the n-th stands in line 2 n + 1 of the directory."""
    lines = [b" " * 72 + b"S      1", start.ljust(72) + b"G      1"]
    directory, parameters = [], []
    for type, words in entities:
        first = len(parameters) + 1
        own = [words[k : k + 64] for k in range(0, len(words), 64)]
        parameters += own
        for fields in ((type, first, 0, 0), (type, 0, 0, len(own))):
            directory.append(b"".join(b"%8d" % f for f in fields).ljust(72))
    lines += [line + b"D%7d" % n for n, line in enumerate(directory, 1)]
    lines += [line.ljust(72) + b"P%7d" % n for n, line in enumerate(parameters, 1)]
    return b"\r\n".join([*lines, b"".ljust(72) + b"T      1"])


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("iges") / "bowl.igs"
    part = bowl(40.0, 30.0, 12.0, 10.0)
    write_faces([part.face_shape(t) for t in part.tags], path)
    return path


TRIMMED = (
    (144, b"144,3,1,1,5,7;"),
    (128, b"128,1,1,1,1,0,0,1,0,0,0.,1.;"),
    (142, b"142,1,3,9,9,2;"),
    (142, b"142,1,3,0,9,2;"),
    (102, b"102,2,11,13;"),
    (110, b"110,0.,0.,0.,1.,0.,0.;"),
    (126, b"126,1,1,0,0,1,0,0.,0.,1.,1.;"),
)


def test_a_trimmed_surface_names_its_surface_its_boundaries_and_their_curves():
    found = iges_entities(text(*TRIMMED))
    assert [e.type for e in found.values()] == [144, 128, 142, 142, 102, 110, 126]
    assert found[1].parts == (3, 5, 7)
    assert (found[5].parts, found[7].parts, found[9].parts) == ((9, 9), (9,), (11, 13))
    assert found[3].parts == found[11].parts == ()


def test_other_marks_between_parameters_are_read_from_the_global_section():
    own = [(type, words.replace(b",", b"/").replace(b";", b"#")) for type, words in TRIMMED]
    found = iges_entities(text(*own, start=b"1H//1H#/"))
    assert found[1].parts == (3, 5, 7)


def test_parameters_go_on_over_lines():
    lines = b",".join(b"%d" % n for n in range(3, 63, 2))
    found = iges_entities(text((102, b"102,30," + lines + b";")))
    assert found[1].parts == tuple(range(3, 63, 2))


def test_bounded_surfaces_and_faces_of_solids_name_theirs():
    found = iges_entities(
        text(
            (143, b"143,1,3,1,5;"),
            (128, b"128;"),
            (141, b"141,1,3,3,2,7,1,2,9,11,13,1,0;"),
            (510, b"510,3,1,1,9;"),
        )
    )
    assert found[1].parts == (3, 5)
    assert found[5].parts == (7, 9, 11, 13)
    assert found[7].parts == (3, 9)


@pytest.mark.parametrize(
    "words", [b"144,;", b"144,x,y,z;", b"", b"144,3,1,999999,5,7;", b"144,-3,0,0,-5;"]
)
def test_damaged_parameters_leave_what_can_be_read(words):
    assert set(iges_entities(text((144, words)))[1].parts) <= {3, 5, 7}


def test_what_refers_to_itself_is_named_once_with_its_parts():
    found = iges_entities(text((102, b"102,2,1,3;"), (102, b"102,2,1,3;")))
    listed = FileEntities(entities=found, faces={1: 1})
    assert listed.words(1) == "102 D1 (102 D1, 102 D3 (102 D1, 102 D3))"


def test_every_face_of_a_file_comes_from_a_trimmed_surface_of_its_own(file):
    part = read_part(file)
    assert sorted(part.entities) == list(part.tags)
    found = iges_entities(file.read_bytes())
    assert {found[line].type for line in part.entities.values()} == {144}
    assert len(set(part.entities.values())) == len(part.tags)


def test_a_face_on_a_spline_comes_from_the_entity_on_a_spline(file):
    part, found = read_part(file), iges_entities(file.read_bytes())
    graph = part.graph()
    for tag, line in part.entities.items():
        surface = found[found[line].parts[0]].type
        assert (surface == 108) == (graph.surface[tag - 1] == "plane") == (surface != 128)


def test_info_lists_types_and_faces(file, capsys):
    assert main(["info", str(file), "--json"]) == DONE
    listed = json.loads(capsys.readouterr().out)["entities"]
    types = {t["number"]: (t["name"], t["count"]) for t in listed["types"]}
    assert types[144] == ("trimmed surface", 7)
    assert types[108][1] + types[128][1] == 7
    first = listed["faces"][0]
    assert first["entity"]["number"] == 144 and first["entity"]["parts"][0]["number"] in (108, 128)
    assert main(["info", str(file)]) == DONE
    lines = capsys.readouterr().out.splitlines()
    assert any(line.split() == ["144", "trimmed", "surface", "7"] for line in lines)
    assert any(line.strip().startswith("7  144 D") and "(1" in line for line in lines)


def test_a_step_file_has_no_such_entities(tmp_path, capsys):
    write_step(bowl(40.0, 30.0, 12.0, 10.0).shape, tmp_path / "bowl.step")
    assert main(["info", str(tmp_path / "bowl.step"), "--json"]) == DONE
    assert json.loads(capsys.readouterr().out)["entities"] is None


def test_many_faces_are_cut_short_in_words_alone():
    from trunnion.cli import info

    listed = FileEntities(
        entities=iges_entities(text(*TRIMMED)), faces=dict.fromkeys(range(1, 46), 1)
    )
    said = info.entity_text(listed)
    assert "and 5 more faces: --json has all" in said
    assert len(listed.as_dict()["faces"]) == 45


def test_pieces_of_a_cut_face_keep_its_entity(file):
    from trunnion.geometry.cut import plane_cut
    from trunnion.pipeline.planning.patches import with_cut

    engine = Engine()
    session = engine.open(file)
    before = file_entities(engine, session)
    (face,) = (
        tag
        for tag, line in before.faces.items()
        if before.entities[before.entities[line].parts[0]].type == 128
    )
    cut = with_cut(engine, session, plane_cut(face, (20.0, 15.0, 8.0), (0.0, 0.0, 1.0)))
    listed = file_entities(engine, cut)
    assert listed.faces[face] == listed.faces[8]


def test_a_number_that_the_specification_lacks_is_unknown():
    assert (type_name(142), type_name(9999)) == ("curve on a parametric surface", "unknown")


@needs_parts
@pytest.mark.parametrize(
    ("name", "type", "count"),
    [
        pytest.param("public/impeller/impeller.igs", 144, 277, marks=pytest.mark.long),
        ("public/surface/fillet_patch_buc50025.igs", 128, 7),
        ("public/surface/propeller_blade_upper.iges", 144, 1),
        ("nasty/not_sewn.igs", 144, 16),
    ],
)
def test_faces_of_files_from_elsewhere_are_linked(name, type, count):
    engine = Engine()
    session = engine.open(PARTS / name)
    listed = file_entities(engine, session)
    assert listed.counts()[type] == count
    assert {listed.entities[line].type for line in listed.faces.values()} == {type}
    assert len(listed.faces) == count
