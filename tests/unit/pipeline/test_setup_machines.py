"""Each setup is posted for, read back for and proven on its own machine."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytest import approx

from own_packages import with_own_packages
from trunnion.findings import BadInput
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.context import Context
from trunnion.pipeline.proof.external_nc import verify_texts
from trunnion.pipeline.proof.playback import Playback
from trunnion.pipeline.proof.posted_programs import post_texts, prove_session, read_back
from trunnion.post.header import Header
from trunnion.progress import NO_PROGRESS

FIRST, SECOND = "Mill 1200", "Kestrel 300"
CHANGE_S = 40.0


@pytest.fixture(scope="module")
def planned(sample_panel):
    """An engine and the small panel with toolpaths, its last two operations in a second setup, clamped alike."""
    engine = Engine()
    session = engine.run(engine.open(sample_panel), until="toolpath")
    (setup,) = session.setups
    operations = session.process.operations
    moved = tuple(replace(o, setup="S2") if o in operations[-2:] else o for o in operations)
    setups = (setup, replace(setup, name="S2", work_offset="G55", machine=SECOND))
    process = replace(session.process, setups=setups, operations=moved)
    coarse = {**session.choices, "verify.cell": 2.0, "verify.spacing": 4.0}
    return engine, replace(session, setups=setups, process=process, choices=coarse)


def shop_of(engine, **changes):
    """Return the engine's shop with a machine for the second setup: the first one's, on another control, with changes."""
    shop = engine.context.shop
    second = replace(shop.machine(FIRST), name=SECOND, title=SECOND, control="kestrel", **changes)
    return replace(shop, machines={**shop.machines, SECOND: second})


def proven(planned, **changes):
    engine, session = planned
    context = Context(engine.context.part, shop_of(engine, **changes))
    with with_own_packages():
        return prove_session(session, context, NO_PROGRESS)


@pytest.fixture(scope="module")
def alike(planned):
    """The verdict and the texts where the second machine differs from the first in its control alone."""
    return proven(planned)


def findings(verdict, code):
    return [f for f in verdict.findings if f.code == code]


def test_each_setups_text_is_of_its_own_machines_control(planned):
    engine, session = planned
    with with_own_packages():
        texts = post_texts(session, Header.of(session), shop_of(engine).machines)
    assert [(f.dialect, f.suffix) for f in texts] == [
        ("linuxcnc", "S1.nc"),
        ("kestrel", "S2.krl"),
        ("apt", "cl"),
    ]
    assert "G21" in texts[0].text and "G21" not in texts[1].text
    assert "G71" in texts[1].text and "G71" not in texts[0].text


def test_a_control_chosen_for_all_is_that_of_all(planned):
    engine, session = planned
    chosen = replace(session, choices={**session.choices, "post.dialect": "linuxcnc"})
    texts = post_texts(chosen, Header.of(chosen), shop_of(engine).machines)
    assert [f.dialect for f in texts] == ["linuxcnc", "linuxcnc", "apt"]


def test_texts_of_two_controls_are_read_back_each_by_its_own(planned):
    engine, session = planned
    machines = shop_of(engine).machines
    with with_own_packages():
        posted = post_texts(session, Header.of(session), machines)
        read = read_back(session, posted, machines)
    assert [p.setup.name for p in read] == ["S1", "S2"]
    assert len(read[1].sections) == 2


def test_setups_on_machines_that_can_do_it_pass(alike):
    verdict, posted = alike
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert [p.dialect for p in posted] == ["linuxcnc", "kestrel", "apt"]


def test_the_second_machines_travel_binds_its_own_setup_alone(planned):
    axes = planned[0].context.shop.machine(FIRST).axes
    short = tuple(replace(a, high=a.low + 60.0) if a.name == "X" else a for a in axes)
    verdict, _ = proven(planned, axes=short)
    (finding,) = findings(verdict, "verify.travel")
    assert "setup S2 needs" in finding.text and f"{SECOND} has 60 mm" in finding.text
    assert verdict.outcome is Outcome.FAILED


def test_the_second_machines_spindle_and_power_bind_its_own_setup_alone(planned):
    _, session = planned
    slow = 0.5 * max(o.data.spindle for o in session.process.of_setup("S1"))
    verdict, _ = proven(planned, spindle_high=slow, power=((50.0, 0.01), (slow, 0.02)))
    own = {o.id for o in session.process.of_setup("S2")}
    told = findings(verdict, "verify.spindle")
    assert told and {f.where[0] for f in told} <= own
    limits = {o.setup: o.power_limit for o in verdict.operations}
    assert limits["S2"] <= 0.02 < limits["S1"]


def test_the_time_is_each_machines_own(planned, alike):
    quick, slow = alike[0], proven(planned, tool_change_s=CHANGE_S)[0]
    change = planned[0].context.shop.machine(FIRST).tool_change_s

    def seconds(verdict, setup):
        return [o.time_s for o in verdict.operations if o.setup == setup]

    assert seconds(slow, "S1") == seconds(quick, "S1")
    assert seconds(slow, "S2")[0] == approx(seconds(quick, "S2")[0] + CHANGE_S - change)


def test_playback_takes_each_setups_own_time(planned):
    engine, session = planned
    whole = []
    for change in (6.0, CHANGE_S):
        context = Context(engine.context.part, shop_of(engine, tool_change_s=change))
        whole.append(Playback(session, context, 2.0).timeline)
    changes = len({o.tool.number for o in session.process.of_setup("S2")})
    assert whole[1].seconds == approx(whole[0].seconds + changes * (CHANGE_S - 6.0))
    start = whole[0].first[-3]
    assert whole[1].time[start] == approx(whole[0].time[start])


def test_a_machine_that_is_gone_is_named(planned):
    engine, session = planned
    with pytest.raises(BadInput, match=f"setup S2: there is no machine {SECOND} in the catalogue"):
        post_texts(session, Header.of(session), engine.context.shop.machines)


def test_texts_from_outside_are_read_in_their_setups_control(planned, alike, tmp_path, monkeypatch):
    engine, session = planned
    _, posted = alike
    files = [tmp_path / p.suffix for p in posted if p.setup]
    for file, text in zip(files, posted, strict=False):
        file.write_text(text.text)
    context = Context(engine.context.part, shop_of(engine))
    monkeypatch.setattr(engine, "context_of", lambda *_: context)
    with with_own_packages():
        after = verify_texts(engine, session, files, NO_PROGRESS)
    assert [p.dialect for p in after.posted] == ["linuxcnc", "kestrel"]
    assert after.verdict.outcome is not Outcome.FAILED
