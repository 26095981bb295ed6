"""Recesses in the bottoms of casings: laid flat by themselves, planned after what they are sunk into, their walls along few directions."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import cadquery as cq
import numpy as np
import pytest

import samples
from long_mark import mostly_long
from seeded.casings import MadeBoss, Shell, _with_boss, short_ring
from seeded.recesses import MadeRecess, recessed, recessed_casing, recessed_ring, with_recess
from trunnion.model.session import Session
from trunnion.part.part import Part
from trunnion.part.read.part_file import read_part
from trunnion.pipeline import Engine
from trunnion.plan.casing.bottoms import CasingBottom, casing_bottoms, casing_faces
from trunnion.plan.casing.grounds import fine_mesh, ground_under
from trunnion.plan.casing.recess.walls import recess_walls
from trunnion.plan.casing.route import make_casing_route
from trunnion.plan.development.drives import ring_of
from trunnion.plan.development.ground import DevelopedGround
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.casing import CasingFamily, CasingSettings
from trunnion.recognize.grow import samples as face_samples
from trunnion.settings import choose

CHOICES = {"setup.machine": "Trunnion 650", "recognize.family": "casing"}


SHORT_RING = [
    ("bottom-rough-pocket-01", "AL3-stub D14 R0"),
    ("rest-rough-pocket-01-1", "AL3-stub D5 R0.5"),
    ("boss-tops-boss-01", "AL3-stub D12 R0"),
    ("boss-tops-boss-02", "AL3-stub D12 R0"),
    ("bottoms-pocket-01", "AL3-stub D16 R0"),
    ("feet-pocket-01", "AL3-stub D4 R0"),
    ("boss-sides-boss-01", "AL3-stub D4 R0"),
    ("boss-sides-boss-02", "AL3-stub D5 R0"),
    ("holes-hole-01", "DR-S D4"),
]
"""Operations of the short ring with their tools, as they were before recesses were planned."""


@dataclass(frozen=True, slots=True, eq=False)
class Routed:
    """A casing with its route."""

    part: Part
    session: Session

    @property
    def operations(self) -> tuple[Any, ...]:
        process = self.session.process
        assert process is not None
        return process.operations

    @property
    def findings(self) -> tuple[Any, ...]:
        process = self.session.process
        assert process is not None
        return process.findings

    def bottoms(self) -> dict[str, CasingBottom]:
        found = casing_bottoms(self.session.recognition, self.part.graph())
        return {b.pocket.id: b for b in found}

    def ground(self, pocket: str) -> DevelopedGround:
        session = self.session
        return ground_under(
            self.bottoms()[pocket],
            session.recognition,
            self.part,
            fine_mesh(self.part),
            session.blank,
            NO_PROGRESS,
        )


def routed(shape: Any, until: str = "route") -> Routed:
    engine = Engine()
    session = engine.open(samples.written(shape, name="recessed"))
    session = engine.run(engine.with_choices(session, CHOICES), until=until)
    return Routed(engine.context.part, session)


@cache
def ring(slope: float = 0.0, radial: bool = False, fillet: float = 0.0) -> Routed:
    return routed(recessed_ring(slope, radial, fillet))


@cache
def two_recesses() -> Routed:
    """Return a ring with two recesses, a third sunk into the first of them, without a boss on any."""
    shell = Shell(radius=60.0, slope=0.0, length=60.0, wall=9.0, flange=4.0, rim=7.0, rib=0.0)
    made = [
        MadeRecess(outline="rectangle", theta=30.0, z=30.0, sizes=(40.0, 40.0, 6.0), depth=2.0),
        MadeRecess(outline="circle", theta=150.0, z=30.0, sizes=(14.0, 14.0), depth=3.0),
        MadeRecess(outline="circle", theta=30.0, z=30.0, sizes=(11.0, 11.0), depth=4.0),
    ]
    return routed(recessed(shell, made, [round_boss(90.0, 30.0, 5.0)]).val().wrapped)


@pytest.mark.parametrize("slope", mostly_long((0.0, 0.2), 0.0))
def test_a_recess_is_roughed_finished_and_its_walls_are_cut(slope: float) -> None:
    made = ring(slope)
    own = [(o.group, o.strategy) for o in made.operations if o.feature == "pocket-02"]
    assert own == [
        ("rest rough", "plane.rough"),
        ("bottoms", "plane.floor"),
        ("feet", "plane.floor"),
        ("recess walls", "surface.waterline"),
        ("recess walls", "surface.waterline"),
    ]
    pocket = next(f for f in made.session.recognition.of_kind("pocket") if f.id == "pocket-02")
    cut = {t for o in made.operations for t in o.faces}
    assert set(pocket.tags) <= cut
    assert not [f for f in made.findings if f.code in ("route.not-planned", "route.no-cutter")]


def test_a_boss_on_a_recess_gets_its_top_and_its_sides() -> None:
    made = ring()
    (boss,) = [
        b for b in made.session.recognition.of_kind("boss") if b.attributes["on"] == "pocket-02"
    ]
    groups = [o.group for o in made.operations if o.feature == boss.id]
    assert groups == ["boss tops", "boss sides"]
    # The side goes down to the recess's bottom: 3 mm over the host's, which is 2 mm higher.
    assert boss.sizes["height"] == pytest.approx(5.0, abs=1e-3)


def test_recesses_come_after_what_they_are_sunk_into_in_every_stage() -> None:
    made = two_recesses()
    hosts = {p: b.recess_of for p, b in made.bottoms().items()}
    assert len(hosts) == 4 and len(set(hosts.values())) == 3
    operations = made.operations
    for stage in ("rest rough", "bottoms", "feet"):
        order = [o.feature for o in operations if o.group == stage]
        for pocket, host in hosts.items():
            if host and host in order and pocket in order:
                last = max(n for n, feature in enumerate(order) if feature == host)
                assert last < order.index(pocket), stage
    first = {p: next(n for n, o in enumerate(operations) if o.feature == p) for p in hosts}
    for pocket, host in hosts.items():
        if host:
            assert first[host] < first[pocket]
    assert all(
        any(o.feature == p and o.kind == "rough" for o in operations)
        and any(o.feature == p and o.group == "recess walls" for o in operations)
        for p, host in hosts.items()
        if host
    )


@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_a_recess_lies_flat_on_its_own_radius_up_to_the_bottom_around_it(slope: float) -> None:
    made = ring() if slope == 0.0 else routed(recessed_ring(slope), until="blank")
    ground = made.ground("pocket-02")
    development = ground.development
    assert development.slope == pytest.approx(slope)
    # 2 mm under the ground along the normal; the cone's straight lines begin at the recess's own end.
    expected = 40.0 + slope * development.height - 2.0 * math.hypot(1.0, slope)
    assert development.radius == pytest.approx(expected, abs=1e-6)
    assert development.middle % (2.0 * math.pi) == pytest.approx(math.radians(30.0), abs=1e-3)
    assert ground.top == pytest.approx(2.0, abs=1e-6)
    assert ground.top_with(0.3) == pytest.approx(2.3, abs=1e-6)
    # The blank itself stands higher: a ring is there for the bosses.
    assert ground.ring_top > 4.0


def test_only_what_is_within_a_recess_is_milled_on_its_ground() -> None:
    ground = ring().ground("pocket-02")
    milled = ground.milled()
    (u0, v0), (u1, v1) = milled.box()
    # Its walls are parallel to the normal in its middle: on the bottom's radius of 38 they span 2 asin(13 / 38).
    foot = 38.0 * math.asin(13.0 / 38.0)
    assert (u0, u1) == pytest.approx((-foot, foot), abs=0.1)
    assert (v0, v1) == pytest.approx((0.0, 28.0), abs=0.1)
    assert not ring_of(ground).minus(milled.offset(1e-3))
    # The host's bottom stands around it, the boss in its middle.
    over = ground.over(1.0)
    assert over.contains([[0.0, 14.0], [0.0, -1.5], [20.0, 14.0], [-20.0, 14.0]]).all()
    assert not over.contains([[9.0, 14.0], [0.0, 3.0]]).any()
    # Over it the ring is the host's to cut.
    assert not ground.blank_over(2.01) and ground.blank_over(1.99)


def test_the_ground_of_the_host_is_what_it_was_without_the_recess() -> None:
    host = ring().ground("pocket-01")
    assert host.limit is None and host.ceiling is None
    at = np.array([[40.0 * math.radians(a), 21.0] for a in (30.0, 20.0, 75.0, 60.0)])
    turn = np.array([[40.0 * host.development.middle, 0.0]])
    assert host.over(0.1).contains(at - turn).tolist() == [True, False, True, False]


def test_a_casing_without_a_recess_has_the_operations_that_it_had() -> None:
    made = routed(short_ring())
    assert [(o.id, o.tool.name) for o in made.operations] == SHORT_RING


def test_walls_along_normals_are_upright_to_directions_of_their_own() -> None:
    made = ring(radial=True)
    bottom = made.bottoms()["pocket-02"]
    faces = casing_faces(made.session.recognition, made.part.graph())
    walls = recess_walls(faces, bottom)
    # The two ends of the recess, and the walls square to the axis along the normal in the middle.
    assert len(walls.groups) == 3 and not walls.hidden
    sides = set(bottom.pocket.with_role("side"))
    assert sorted(t + 1 for g in walls.groups for t in g.walls) == sorted(sides)
    for group in walls.groups:
        for row in group.walls:
            assert np.abs(face_samples(faces.graph, row)[1] @ group.direction).max() < 2e-3
    apart = math.acos(float(walls.groups[0].direction @ walls.groups[1].direction))
    # The recess spans 26 mm on the radius of 40, its two ends stand along the radius there.
    assert apart == pytest.approx(26.0 / 40.0, abs=1e-3)
    middle = np.array([math.cos(math.radians(30.0)), math.sin(math.radians(30.0)), 0.0])
    assert np.allclose(walls.groups[2].direction, middle, atol=1e-3)
    assert len([o for o in made.operations if o.group == "recess walls"]) == 3


def test_parallel_walls_are_cut_together_and_lean_in_over_a_round_bottom() -> None:
    made = ring()
    faces = casing_faces(made.session.recognition, made.part.graph())
    upright, group = recess_walls(faces, made.bottoms()["pocket-02"]).groups
    assert np.allclose(upright.direction, group.direction, atol=1e-9)
    # The walls square to the axis stand on the bottom, those along it and the corners lean in over it.
    assert len(upright.walls) == 2 and len(group.walls) == 6
    middle = np.array([math.cos(math.radians(30.0)), math.sin(math.radians(30.0)), 0.0])
    assert np.allclose(group.direction, middle, atol=1e-6)
    assert group.height == pytest.approx(2.0, abs=1e-3) and group.hollow == pytest.approx(5.0)
    assert group.fillets == () and group.fillet == 0.0
    # At the foot a wall 13 mm off the middle leans over the bottom's normal by asin(13 / 38).
    assert group.acute == pytest.approx(13.0 / 38.0, abs=0.02)
    assert "route.acute-corner" in {f.code for f in made.findings}
    steps = [
        o.choices.get("surface.waterline.step", 0.0)
        for o in made.operations
        if o.group == "recess walls"
    ]
    # What leans in is cut level by level as far down as the cutter comes.
    assert steps == [0.0, pytest.approx(0.25, abs=1e-3)]


def test_fillets_at_the_feet_of_walls_are_cut_by_a_ball_no_larger() -> None:
    made = ring(fillet=1.0)
    fillets = [o for o in made.operations if o.group == "recess fillets"]
    assert fillets
    assert all(o.cutter.form == "ball" and o.cutter.radius <= 1.0 for o in fillets)
    walls = [o for o in made.operations if o.group == "recess walls"]
    assert all(o.cutter.corner_radius <= 1.0 for o in walls)
    sides = next(f for f in made.session.recognition.of_kind("pocket") if f.id == "pocket-02")
    cut = [t for o in (*walls, *fillets) for t in o.faces]
    assert sorted(cut) == sorted(sides.with_role("side"))


def test_a_recess_of_a_profile_without_bosses_is_milled_too() -> None:
    shell = Shell(radius=50.0, slope=0.0, length=80.0, wall=7.0, flange=5.0, rim=7.0, rib=7.0)
    recess = MadeRecess(outline="slot", theta=40.0, z=58.0, sizes=(24.0, 14.0), depth=2.5)
    made = routed(recessed(shell, [recess], [round_boss(40.0, 22.0, 5.0)]).val().wrapped)
    bottoms = made.bottoms()
    (sunk,) = [b for b in bottoms.values() if b.is_recess]
    assert sunk.recess_of == "" and sunk.sunk_into
    own = [o.group for o in made.operations if o.feature == sunk.pocket.id]
    assert own[0] == "rest rough" and own[-1] == "recess walls"
    assert not [f for f in made.findings if f.code == "route.not-planned"]
    # It came turned around the recess: nothing is over the ground beside it.
    ground = made.ground(sunk.pocket.id)
    assert ground.ceiling is None and ground.top == pytest.approx(2.5, abs=1e-6)


def test_a_recess_with_a_rounded_upper_edge_is_one_of_the_bottom_beyond() -> None:
    shell = Shell(radius=50.0, slope=0.0, length=50.0, wall=7.0, flange=5.0, rim=7.0, rib=0.0)
    recess = MadeRecess(outline="circle", theta=40.0, z=25.0, sizes=(12.0, 12.0), depth=3.0)
    body = with_recess(shell.solid(), shell, recess)
    rim = [
        e
        for e in body.edges().vals()
        if e.geomType() not in ("LINE", "CIRCLE")
        and e.positionAt(0.2).toTuple()[0] > 0.0
        and all(abs(math.hypot(*e.positionAt(t).toTuple()[:2]) - 50.0) < 1e-3 for t in (0.1, 0.6))
    ]
    body = cq.Workplane(body.val().fillet(0.8, rim))
    body = _with_boss(body, shell, round_boss(160.0, 25.0, 5.0)).cut(shell.bore())
    bottoms = routed(body.val().wrapped, until="recognize").bottoms()
    assert sorted(b.recess_of for b in bottoms.values()) == ["", "pocket-01"]


def round_boss(theta: float, z: float, radius: float) -> MadeBoss:
    return MadeBoss(
        outline="circle",
        theta=theta,
        z=z,
        height=3.0,
        tilt=0.0,
        fillet=0.0,
        sizes=(radius, radius),
        hole=0.0,
    )


def test_a_plan_without_stages_for_recesses_is_told_of() -> None:
    made = ring()
    process = made.session.process
    assert process is not None
    left = without_stages(made, ("recess walls",))
    assert [f.where[0] for f in left if f.code == "route.not-planned"] == ["pocket-02"]


def without_stages(made: Routed, names: tuple[str, ...]) -> tuple[Any, ...]:
    """Return the findings of a route by the program's plan without some of its stages."""
    from trunnion.plan.casing import planner

    found: list[Any] = []

    def shortened(state: Any, plan: Any) -> Any:
        stages = tuple(s for s in plan.stages if s.name not in names)
        process = make_casing_route(state, replace(plan, stages=stages))
        found.extend(process.findings)
        return process

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planner, "make_casing_route", shortened)
        routed(recessed_ring())
    return tuple(found)


@pytest.mark.parametrize("seed", [3, pytest.param(9, marks=pytest.mark.long)])
def test_random_recesses_are_found_with_what_they_are_sunk_into(seed: int, tmp_path: Path) -> None:
    made = recessed_casing(seed)
    part = read_part(made.written(tmp_path))
    found = CasingFamily().recognize(part.graph(), part, choose(CasingSettings, {}))
    assert found.counts() == made.counts and not found.findings
    hosts = [b.recess_of for b in casing_bottoms(found, part.graph())]
    assert hosts == ["", *["pocket-01"] * (made.counts["pocket"] - 1)]
