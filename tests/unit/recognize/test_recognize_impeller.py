"""Impellers: features and roles on random wheels by construction, whatever a file does to them, and on the shared parts."""

from __future__ import annotations

from collections import Counter
from functools import cache

import numpy as np
import pytest

import round_parts
import samples
from long_mark import mostly_long
from parts import PARTS, needs_parts
from scoring import scored, truth_of
from seeded.impellers import SeededImpeller, impeller
from trunnion.part.part import Part
from trunnion.part.read.limits import ReadLimits
from trunnion.part.read.part_file import read_part
from trunnion.part.shape.gap import least_gap
from trunnion.plan.size import size_table
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.impeller import ImpellerFamily
from trunnion.recognize.impeller.lines import MeridianCurve
from trunnion.recognize.impeller.settings import CLOCKWISE, ImpellerSettings

PATIENT = ReadLimits(seconds=1000.0)
QUICK = (1,)
"""Two rows of splitters, walls in two pieces, more bolt holes than blades."""
QUICK_ROUNDED = (3,)
"""Walls in two pieces and the lathe's faces in sectors."""


def recognized(part: Part, **settings):
    return ImpellerFamily().recognize(part.graph(), part, ImpellerSettings(**settings))


@cache
def wheel(seed: int) -> tuple[SeededImpeller, Part]:
    made = impeller(seed)
    return made, samples.read(made.shape, unit=made.unit)


@cache
def rounded_wheel(seed: int) -> tuple[SeededImpeller, Part]:
    made = impeller(seed, rounded=True)
    return made, samples.read(made.shape, unit=made.unit)


def senses(part: Part, found, feature, role: str) -> np.ndarray:
    """Return how far normals of a feature's faces look round the frame's z, right-handed."""
    graph = part.graph()
    mine = np.isin(graph.sample_face, [t - 1 for t in feature.with_role(role)])
    point = found.frame.to_local(graph.sample_point[mine])
    normal = found.frame.local_direction(graph.sample_normal[mine])
    return normal[:, 1] * point[:, 0] - normal[:, 0] * point[:, 1]


@pytest.mark.parametrize("seed", mostly_long(range(20), *QUICK))
def test_a_random_wheel_has_the_features_that_it_was_made_with(seed: int) -> None:
    made, part = wheel(seed)
    found = recognized(part)
    assert found.counts() == made.counts
    assert (found.unexplained, found.findings) == ((), ())
    for blade in found.of_kind("blade", "splitter"):
        roles = Counter(f.role for f in blade.faces)
        assert roles.pop("pressure") == roles.pop("suction") == made.wall_faces
        assert set(roles) == {"leading_edge", "trailing_edge", "shroud"}


@pytest.mark.parametrize("seed", mostly_long(range(20), *QUICK))
def test_the_pressure_side_faces_the_way_of_turning(seed: int) -> None:
    made, part = wheel(seed)
    found = recognized(part)
    for blade in found.of_kind("blade", "splitter"):
        assert (senses(part, found, blade, "pressure") * made.turns > 0.0).all()
        assert (senses(part, found, blade, "suction") * made.turns < 0.0).all()


@pytest.mark.parametrize("seed", mostly_long(range(12), *QUICK_ROUNDED))
def test_a_random_wheel_with_root_fillets_has_the_features_that_it_was_made_with(seed: int) -> None:
    made, part = rounded_wheel(seed)
    found = recognized(part)
    assert found.counts() == made.counts
    assert (found.unexplained, found.findings) == ((), ())
    blades = found.of_kind("blade", "splitter")
    for blade in blades:
        roles = Counter(f.role for f in blade.faces)
        assert roles.pop("pressure") == roles.pop("suction") == made.wall_faces
        assert roles.pop("root_fillet") >= 3
        assert set(roles) == {"leading_edge", "trailing_edge", "shroud"}
        assert (senses(part, found, blade, "pressure") * made.turns > 0.0).all()
    assert sum(bool(f.attributes.get("pair")) for f in blades) == 2


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_the_radius_of_the_root_fillets_is_measured(seed: int) -> None:
    made, part = rounded_wheel(seed)
    table = size_table(recognized(part), part.graph(), part)
    size = {s.name: s.value for s in table if s.feature == "part"}
    assert size["root_fillet_radius"] == pytest.approx(made.fillet, abs=0.02)
    assert size["outlet_diameter"] == pytest.approx(made.outlet_diameter, abs=0.02)
    assert size["bore_diameter"] == pytest.approx(made.bore_diameter, abs=0.02)


@pytest.mark.parametrize("seed", [1])
def test_a_person_may_say_which_way_the_wheel_turns(seed: int) -> None:
    _, part = wheel(seed)
    found = recognized(part, rotation=CLOCKWISE)
    blade = found.of_kind("blade")[0]
    assert (senses(part, found, blade, "pressure") < 0.0).all()


@pytest.mark.parametrize("seed", mostly_long(range(20), *QUICK))
def test_blades_stand_in_order_and_splitters_between_their_main_blades(seed: int) -> None:
    made, part = wheel(seed)
    found = recognized(part)
    blades = found.of_kind("blade", "splitter")
    assert [f.attributes["order"] for f in blades] == list(range(1, len(blades) + 1))
    turn = np.diff([float(f.attributes["angle"]) for f in blades]) % 360.0
    assert turn == pytest.approx(np.full(len(turn), 360.0 / len(blades)), abs=0.1)
    each = len(blades) // made.counts["blade"]
    for n, f in enumerate(blades):
        assert f.kind == ("splitter" if n % each else "blade")
        if n % each:
            main = blades[n - n % each], blades[(n - n % each + each) % len(blades)]
            assert f.attributes["channel"] == f"{main[0].id} {main[1].id}"
        assert f.attributes["next"] == blades[(n + 1) % len(blades)].id
    assert sum(bool(f.attributes.get("pair")) for f in blades) == 2


@pytest.mark.long
@pytest.mark.parametrize("seed", range(10))
def test_sizes_are_those_that_it_was_made_with(seed: int) -> None:
    made, part = wheel(seed)
    table = size_table(recognized(part), part.graph(), part)
    size = {s.name: s for s in table if s.feature == "part"}
    assert size["outlet_diameter"].value == pytest.approx(made.outlet_diameter, abs=0.02)
    assert size["bore_diameter"].value == pytest.approx(made.bore_diameter, abs=0.02)
    assert size["ruled"].value == 1.0
    width = size["channel_width"]
    assert np.linalg.norm(np.subtract(width.at, width.to)) == pytest.approx(width.value, abs=1e-3)


def test_a_wheel_of_straight_blades_on_a_disc_stands_on_its_hub() -> None:
    made = round_parts.wheel(0)
    found = recognized(samples.read(made.shape))
    assert found.counts()["blade"] == made.count and not found.unexplained


def test_the_gap_of_two_faces_is_their_least_distance() -> None:
    part = samples.read(samples.box_shape(40.0, 30.0, 20.0))
    graph = part.graph()
    low, high = (int(np.argmax(graph.normal[:, 2] * s)) + 1 for s in (-1.0, 1.0))
    gap = least_gap(part, [low], [high])
    assert gap.distance == pytest.approx(20.0, abs=1e-9) and gap.faces == (low, high)


PLANNED = {
    "bore_diameter": ("bore", "diameter"),
    "bore_depth": ("bore", "depth"),
    "channel_width": ("channel_width", "min"),
    "outlet_diameter": ("outlet_diameter",),
    "root_fillet_radius": ("root_fillet_radius",),
    "blade_height_inlet": ("blade_height", "inlet"),
    "blade_height_outlet": ("blade_height", "outlet"),
}


@needs_parts
@pytest.mark.parts
@pytest.mark.long
@pytest.mark.parametrize("suffix", ["step", "igs"])
@pytest.mark.parametrize("name", ["C1", "C2", "C3", "C4"])
def test_the_shared_wheels_are_recognised_and_measured(name: str, suffix: str) -> None:
    assert PARTS is not None
    file = PARTS / "impeller" / f"{name}.{suffix}"
    part = read_part(file, limits=PATIENT)
    found = recognized(part)
    score = scored(name, file, found, family="impeller")
    assert [score[k] for k in ("recall", "precision", "faces", "roles")] == [1.0] * 4
    truth = truth_of(name, "impeller")["planning"]
    first: dict[str, float] = {}
    for entry in size_table(found, part.graph(), part, NO_PROGRESS):
        first.setdefault(entry.name, entry.value)
    for size, path in PLANNED.items():
        value = truth
        for key in path:
            value = value[key]
        assert first[size] == pytest.approx(value, abs=0.02), size
    assert first["ruled"] == float(truth["ruled"])


@needs_parts
@pytest.mark.parts
def test_a_closed_wheel_says_that_its_passages_are_covered() -> None:
    assert PARTS is not None
    part = read_part(PARTS / "public" / "impeller" / "laufrad_1000.stp", limits=PATIENT)
    found = recognized(part)
    assert not found.of_kind("blade", "splitter") and found.of_kind("hub", "plane", "profile")
    codes = {f.code: f for f in found.findings}
    assert codes["impeller.covered"].text.startswith("the wheel is closed: its 14 blades stand")
    assert {f"face {t}" for t in found.unexplained} <= set(codes["impeller.unexplained"].where)


@pytest.mark.parametrize("seed", range(5))
def test_the_foot_on_a_meridian_is_the_nearest_of_all_its_pieces(seed):
    """Against every piece in turn, the plain way."""
    draw = np.random.default_rng(seed)
    angle = np.linspace(0.1, 1.4, 40) + draw.uniform(-0.01, 0.01, 40)
    curve = MeridianCurve(
        point=np.column_stack([60.0 - 50.0 * np.cos(angle), 40.0 * np.sin(angle)])
    )
    points = draw.uniform((0.0, -10.0), (80.0, 60.0), (200, 2))
    feet, along = curve.foot(points)
    for point, foot, way in zip(points, feet, along, strict=True):
        start, step = curve.point[:-1], np.diff(curve.point, axis=0)
        share = np.clip(((point - start) * step).sum(axis=1) / (step * step).sum(axis=1), 0.0, 1.0)
        away = np.linalg.norm(point - start - share[:, None] * step, axis=1)
        assert np.linalg.norm(point - foot) == pytest.approx(away.min(), abs=1e-9)
        row = int(np.searchsorted(curve.along, way, side="right")) - 1
        row = min(row, len(step) - 1)
        on = start[row] + step[row] * (way - curve.along[row]) / np.linalg.norm(step[row])
        assert on == pytest.approx(foot, abs=1e-6)
