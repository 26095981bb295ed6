"""`recognize.family = auto` says what it takes a part for, and stops before anything is planned where it explains too little."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from lxml import etree

import programs
import round_parts
import samples
from trunnion.cli.main import BAD, DONE, main
from trunnion.findings import BadInput, Severity
from trunnion.model.feature import FaceRole, Feature, Recognition, TakenFor
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.pipeline.planning import family
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.contract import Suitability
from trunnion.settings import settings
from trunnion.store.features import features_xml
from trunnion.store.project import load_project, save_project


@settings("recognize.zoo")
class NoSettings:
    """Nothing to choose."""


@dataclass
class Kind:
    """A made-up kind of part with a fixed opinion, and a family that leaves a share of the area unexplained."""

    name: str
    score: float
    left: float = 0.0
    settings: type = NoSettings
    asked: list[str] = field(default_factory=list)

    @property
    def noun(self) -> str:
        return f"a {self.name}"

    def suits(self, graph) -> Suitability:
        return Suitability(
            score=self.score, explained=1.0 - self.left, reason=f"{self.name} through and through"
        )

    def recognize(self, graph, slicer, settings, progress) -> Recognition:
        self.asked.append(self.name)
        return Recognition(
            family=self.name,
            features=(Feature(id="a-01", kind="a", faces=(FaceRole(role="face", face=1),)),),
            unexplained=(2,),
            unexplained_share=self.left,
        )


def recognised(
    monkeypatch, families: list[Kind], kinds: Sequence[Kind] = (), wanted: str = "auto"
) -> Recognition:
    by_group = {"families": {k.name: k for k in families}, "part_kinds": {k.name: k for k in kinds}}
    monkeypatch.setattr(family.registry, "names", lambda group: tuple(sorted(by_group[group])))
    monkeypatch.setattr(family.registry, "get", lambda group, name: lambda: by_group[group][name])
    monkeypatch.setattr(family, "checked", lambda chosen: chosen)
    monkeypatch.setattr(family, "choose", lambda group, words: SimpleNamespace(family=wanted))
    bench = SimpleNamespace(part=SimpleNamespace(graph=lambda: None, tags=(1, 2, 3)))
    return family.recognised(Session(), bench, NO_PROGRESS)


def severities(found: Recognition) -> dict[str, Severity]:
    return {f.code: f.severity for f in found.findings}


def test_the_best_family_is_told_with_how_sure_and_why(monkeypatch) -> None:
    found = recognised(monkeypatch, [Kind("cow", 0.7), Kind("dog", 0.9)])
    assert found.family == "dog" and not found.doubt
    assert found.taken_for == TakenFor(
        kind="dog", noun="a dog", score=0.9, reason="dog through and through"
    )
    assert severities(found) == {"recognize.family": Severity.INFO}
    assert found.findings[-1].text == "taken for a dog (0.90): dog through and through"


def test_a_kind_that_no_family_serves_stops_with_nothing_recognised(monkeypatch) -> None:
    cow = Kind("cow", 0.7)
    found = recognised(monkeypatch, [cow, Kind("dog", 0.6)], [Kind("emu", 0.95)])
    assert (found.family, found.features, found.unexplained, found.unexplained_share) == (
        "emu",
        (),
        (1, 2, 3),
        1.0,
    )
    assert severities(found) == {
        "recognize.family": Severity.INFO,
        "recognize.no-family": Severity.ERROR,
    }
    assert (
        found.findings[-1].remedy
        == "choose recognize.family = cow or dog to go on with one of the families there are"
    )
    assert found.doubt == f"{found.findings[-1].text}: {found.findings[-1].remedy}"
    assert not cow.asked


def test_a_kind_that_no_family_serves_and_that_is_unlikely_stops_nothing(monkeypatch) -> None:
    found = recognised(monkeypatch, [Kind("cow", 0.3)], [Kind("emu", 0.4)])
    assert found.family == "cow" and not found.doubt


def test_a_family_that_explains_less_than_half_of_the_area_stops_and_keeps_its_features(
    monkeypatch,
) -> None:
    found = recognised(monkeypatch, [Kind("cow", 0.9, left=0.88), Kind("dog", 0.2)])
    assert [f.id for f in found] == ["a-01"]
    assert severities(found)["recognize.unexplained"] is Severity.ERROR
    assert (
        "88 % of the area is explained by no feature; the part was taken for a cow (0.90)"
        in found.doubt
    )
    assert found.doubt.endswith(
        "choose recognize.family = cow to go on with it, or dog to try another one"
    )


def test_half_of_the_area_is_enough(monkeypatch) -> None:
    assert not recognised(monkeypatch, [Kind("cow", 0.9, left=0.5)]).doubt


def test_a_chosen_family_is_never_stopped_but_told(monkeypatch) -> None:
    found = recognised(
        monkeypatch,
        [Kind("cow", 0.1, left=0.88), Kind("dog", 0.9)],
        [Kind("emu", 0.95)],
        wanted="cow",
    )
    assert (
        found.family == "cow"
        and not found.doubt
        and found.taken_for is not None
        and found.taken_for.kind == "cow"
    )
    assert severities(found) == {
        "recognize.no-family": Severity.WARNING,
        "recognize.unexplained": Severity.WARNING,
    }


@pytest.fixture(scope="module")
def shell() -> Path:
    return samples.written(round_parts.shell(4).shape, name="shell")


def test_program_refuses_a_casing_without_rotary_axes_in_one_line(shell, tmp_path, capsys) -> None:
    three_axes = ["--set", "setup.machine=Mill 1200"]
    assert main(["program", str(shell), "-o", str(tmp_path / "out"), *three_axes]) == BAD
    said = capsys.readouterr().err
    assert "the machine has no rotary axes; choose a machine" in said
    assert said.startswith("trunnion: ") and len(said.splitlines()) == 1


def test_a_casing_gets_a_machine_that_leans_its_tools_where_none_is_named(shell) -> None:
    engine = Engine()
    session = engine.run(engine.open(shell), until="route")
    (machine,) = {engine.context.shop.machine(s.machine) for s in session.setups}
    assert len(machine.rotary) == 2 and session.process.operations


def test_recognize_says_what_it_takes_a_casing_for_and_finds_its_features(shell, capsys) -> None:
    assert main(["recognize", str(shell)]) == DONE
    assert capsys.readouterr().out.startswith("taken for a casing (1.00): ")
    assert main(["recognize", str(shell), "--json"]) == DONE
    data = json.loads(capsys.readouterr().out)
    assert data["family"] == "casing" and data["unexplained"]["faces"] == []
    kinds = {f["kind"] for f in data["features"]}
    assert {"hole", "profile"} <= kinds <= {"boss", "hole", "pocket", "profile"}


def test_a_casing_is_recognised_as_the_family_that_a_person_chooses(shell, capsys) -> None:
    assert main(["recognize", str(shell), "--set", "recognize.family=surface"]) == DONE
    assert capsys.readouterr().out.startswith("taken for a part of curved surfaces ")
    engine = Engine()
    session = engine.with_choices(engine.open(shell), {"recognize.family": "surface"})
    assert engine.run(session, "blank").blank is not None


@pytest.mark.parametrize("step", ["size", "blank", "route"])
def test_every_step_after_recognition_refuses_while_the_kind_is_in_doubt(shell, step: str) -> None:
    engine = Engine()
    session = engine.run(engine.open(shell), "recognize")
    doubtful = replace(session, recognition=replace(session.recognition, doubt="choose a family"))
    with pytest.raises(BadInput, match="choose a family"):
        engine.run(doubtful, step)


def test_a_panel_is_told_as_one(sample_panel, capsys) -> None:
    assert main(["recognize", str(sample_panel), "--quiet"]) == DONE
    assert capsys.readouterr().out.startswith("taken for a panel (0.9")


def test_a_person_s_edit_of_what_was_recognised_changes_no_doubt() -> None:
    found = Recognition(
        family="cow", features=(Feature(id="a-01", kind="a", faces=()),), doubt="choose a family"
    )
    assert found.without("a-01").doubt == "choose a family"


DOUBTED = TakenFor(kind="casing", noun="a casing", score=0.875, reason="96 % of the area, < & >")


def test_features_xml_and_the_project_keep_what_a_part_was_taken_for(tmp_path) -> None:
    found = replace(programs.recognition(), taken_for=DOUBTED, doubt="no family: choose one")
    root = etree.fromstring(features_xml(found, programs.part_info()))
    taken = root.find("taken-for")
    assert dict(taken.attrib) == {"kind": "casing", "noun": "a casing", "score": "0.875"}
    assert (taken.text, root.findtext("doubt")) == (DOUBTED.reason, "no family: choose one")
    save_project(
        replace(programs.session(), recognition=found),
        tmp_path / "a.trunnion",
        programs.PART_BYTES,
        ".step",
    )
    kept = load_project(tmp_path / "a.trunnion")[0].recognition
    assert kept is not None and (kept.taken_for, kept.doubt) == (DOUBTED, "no family: choose one")


def test_a_project_from_before_it_was_kept_still_opens(tmp_path) -> None:
    import re
    import zipfile

    save_project(programs.session(), tmp_path / "a.trunnion", programs.PART_BYTES, ".step")
    with zipfile.ZipFile(tmp_path / "a.trunnion") as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    older = re.sub(rb"<taken-for[^>]*/>|<doubt[^>]*/>", b"", members["session.xml"])
    assert older != members["session.xml"]
    with zipfile.ZipFile(tmp_path / "b.trunnion", "w") as archive:
        for name, data in {**members, "session.xml": older}.items():
            archive.writestr(name, data)
    found = load_project(tmp_path / "b.trunnion")[0].recognition
    assert found is not None and found.taken_for is None and found.doubt == ""
