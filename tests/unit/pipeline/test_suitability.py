"""What kind of part a part is taken for: wheels, shells and flat parts, wherever they lie and in whatever unit they come."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import round_parts
import samples
from blockparts import terrace
from leaning_pockets import bowl_block
from long_mark import mostly_long
from parts import PARTS, needs_parts
from seeded.leaning_panels import leaning_panel
from seeded.panels import panel
from seeded.plates import plate
from shaped_parts import bowl
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.pipeline.planning.family import Rated, ratings
from trunnion.recognize.casing import CasingFamily
from trunnion.recognize.contract import Suitability
from trunnion.recognize.impeller import ImpellerFamily
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.revolution import RevolutionAxis, main_axis, of_revolution
from trunnion.recognize.surface import SurfaceFamily
from trunnion.recognize.symmetry import fold, patterns

FILES = (("step", "mm"), ("igs", "mm"), ("step", "inch"))
"""How the shape of each seed is written and read back."""


def graph_of(seed: int, make=round_parts.wheel, **words) -> tuple[FaceGraph, round_parts.Round]:
    made = make(seed, **words)
    suffix, unit = FILES[seed % len(FILES)]
    return samples.read(made.shape, suffix, unit).graph(), made


def best(graph: FaceGraph) -> Rated:
    return ratings(graph)[0]


@pytest.mark.parametrize("seed", mostly_long(range(3), 0))
def test_a_wheel_with_twisted_blades_is_an_impeller(seed: int) -> None:
    graph, made = graph_of(seed)
    found = best(graph)
    assert (found.name, found.served) == ("impeller", True)
    assert found.suits.score > 0.95
    assert found.suits.reason.startswith(f"{made.count} blades stand evenly about an axis, ")


@pytest.mark.parametrize("seed", mostly_long(range(3), 0))
def test_a_thin_shell_with_bosses_is_a_casing(seed: int) -> None:
    found = best(graph_of(seed, round_parts.shell)[0])
    assert (found.name, found.served) == ("casing", True)
    assert found.suits.score > 0.95 and "round a bore of" in found.suits.reason


@pytest.mark.parametrize("make", [round_parts.gear, round_parts.drilled_ring, round_parts.shaft])
@pytest.mark.parametrize("seed", range(3))
def test_a_gear_a_drilled_ring_and_a_shaft_are_taken_for_panels(make, seed: int) -> None:
    assert best(graph_of(seed, make)[0]).name == "panel"


@pytest.mark.parametrize("seed", range(2))
def test_straight_blades_on_a_disc_are_walls_of_a_panel(seed: int) -> None:
    assert best(graph_of(seed, twist=0.0)[0]).name == "panel"


@pytest.mark.parametrize("seed", mostly_long(range(2), 0))
def test_blades_that_stand_out_from_a_small_hub_are_no_impeller(seed: int) -> None:
    graph, _ = graph_of(seed, hub=0.3)
    assert ImpellerFamily().suits(graph).score == 0.0
    assert best(graph).name == "surface"


def test_a_panel_and_a_plain_block_are_panels() -> None:
    assert best(samples.read(samples.two_pockets_and_a_rib_shape()).graph()).name == "panel"
    assert best(samples.read(samples.box_shape()).graph()).name == "panel"


def test_a_part_without_a_round_edge_is_neither_wheel_nor_shell() -> None:
    graph = terrace((0, 10, 90, 100), (0, 10, 50, 60), [[40] * 3, [40, 8, 40], [40] * 3]).graph()
    assert main_axis(graph) is None
    assert [k.suits(graph).score for k in (ImpellerFamily(), CasingFamily())] == [0.0, 0.0]


def test_faces_that_enclose_no_material_are_only_grouped() -> None:
    graph = samples.read(samples.open_box_shape()).graph()
    assert graph.open_edges
    found = best(graph)
    assert found.name == "surface" and "the faces enclose no material" in found.suits.reason


@pytest.mark.parametrize("suffix", ["step", "igs"])
@pytest.mark.parametrize("seed", mostly_long(range(10), 0, 5))
def test_a_random_panel_is_a_panel_by_far(seed: int, suffix: str) -> None:
    made = panel(seed)
    graph = samples.read(made.shape, suffix, made.unit).graph()
    assert best(graph).name == "panel"
    assert SurfaceFamily().suits(graph).score < 0.25


@pytest.mark.parametrize("seed", mostly_long(range(12), 0))
def test_a_random_panel_with_leaning_walls_and_curved_floors_is_a_panel(seed: int) -> None:
    first, second, *_ = ratings(samples.read(leaning_panel(seed).shape).graph())
    assert first.name == "panel" and first.suits.score > second.suits.score


def test_a_curved_floor_between_walls_is_a_panels_and_a_hollow_in_a_plate_is_not() -> None:
    family = PanelFamily()
    floor = family.suits(samples.read(bowl_block()).graph())
    assert floor.score > 0.99 and "a curved floor between walls" in floor.reason
    assert "curved floor" not in family.suits(bowl(60.0, 50.0, 20.0, 18.0).graph()).reason


@pytest.mark.parametrize("suffix", ["step", "igs"])
@pytest.mark.parametrize("seed", mostly_long(range(10), 0, 4))
def test_a_random_curved_plate_is_a_part_of_curved_surfaces_by_far(seed: int, suffix: str) -> None:
    made = plate(seed)
    graph = samples.read(made.shape, suffix, made.unit).graph()
    assert best(graph).name == "surface"
    assert PanelFamily().suits(graph).score < 0.8


@cache
def still_and_moved(make) -> tuple[FaceGraph, FaceGraph]:
    """Return the graph of a part, and the same seen from far away and askew."""
    still, _ = graph_of(0, make)
    pick = np.random.default_rng(11)
    return still, still.in_frame(
        Frame(pick.uniform(-1000.0, 1000.0, 3), pick.normal(size=3), pick.normal(size=3))
    )


@pytest.mark.parametrize("kind", [ImpellerFamily(), CasingFamily(), PanelFamily(), SurfaceFamily()])
@pytest.mark.parametrize("make", [round_parts.wheel, round_parts.shell])
def test_a_kind_does_not_depend_on_place_and_size(kind, make) -> None:
    still, moved = still_and_moved(make)
    assert kind.suits(moved).score == pytest.approx(kind.suits(still).score, abs=1e-3)


def test_the_main_axis_is_the_one_that_most_area_turns_about() -> None:
    part = round_parts.shell(1)
    graph = samples.read(part.shape).graph()
    axis = main_axis(graph)
    assert axis is not None
    turned = of_revolution(graph, axis)
    assert float(graph.area[turned].sum() / graph.area.sum()) > 0.9
    across = RevolutionAxis(
        point=axis.point,
        direction=np.cross(axis.direction, [0.6, 0.0, 0.8])
        / np.linalg.norm(np.cross(axis.direction, [0.6, 0.0, 0.8])),
    )
    assert float(graph.area[of_revolution(graph, across)].sum()) < 0.1 * float(
        graph.area[turned].sum()
    )


def test_angles_share_a_circle_evenly_though_one_copy_is_missing() -> None:
    turn = 2.0 * np.pi / 9
    assert fold(np.arange(9) * turn + 0.3) == 9
    assert fold(np.arange(8) * turn + 0.3) == 9
    assert fold(np.concatenate([np.arange(7) * turn, np.arange(7) * turn + 0.1])) == 9


def test_four_faces_and_scattered_ones_are_no_pattern() -> None:
    assert fold(np.arange(4) * np.pi / 2) == 0
    assert fold(np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, 9)) == 0


def test_the_patterns_of_a_wheel_have_its_blades() -> None:
    graph, made = graph_of(0)
    axis = main_axis(graph)
    assert axis is not None
    found = patterns(graph, axis)
    assert {p.count for p in found} == {made.count}
    assert all(len(p.rows) == made.count for p in found)


def rated(name: str, score: float, explained: float, served: bool = True) -> Rated:
    return Rated(
        name=name,
        kind=None,
        served=served,
        suits=Suitability(score=score, explained=explained, reason=""),
    )


def test_equal_scores_are_decided_by_explained_area_then_by_a_family_that_serves_the_part_never_by_the_alphabet_first() -> (
    None
):
    assert rated("panel", 0.8, 0.9).rank > rated("zeppelin", 0.8, 0.7).rank
    assert rated("panel", 0.8, 0.9).rank > rated("zeppelin", 0.8, 0.9, served=False).rank
    assert rated("zeppelin", 0.8, 0.9).rank > rated("panel", 0.7, 1.0).rank
    assert rated("panel", 0.8, 0.9).rank == rated("panel", 0.8 + 1e-9, 0.9).rank


@pytest.mark.parametrize("word", ["score", "explained"])
def test_a_suitability_is_a_share(word: str) -> None:
    with pytest.raises(ValueError, match=f"{word} must be from 0 to 1, not 1.5"):
        Suitability(**{"score": 0.5, "explained": 0.5, "reason": "", word: 1.5})


SHARED = (
    ("panel/B3.step", "panel"),
    ("surface/D1.igs", "surface"),
    ("surface/D2.step", "surface"),
    ("casing/A1.step", "casing"),
    ("public/casing/conical_casing_solid_56.step", "casing"),
    ("public/impeller/laufrad_1000.stp", "impeller"),
    ("public/prismatic/control_arm.step", "panel"),
    ("public/surface/fuselage_fuse.igs", "surface"),
    ("public/surface/rounded_plate_model1.igs", "surface"),
    ("public/surface/propeller_blade_upper.iges", "surface"),
    ("public/surface/fillet_patch_buc50025.igs", "surface"),
)


@needs_parts
@pytest.mark.parametrize(
    ("file", "kind"),
    [
        *SHARED,
        *(
            pytest.param(f, k, marks=pytest.mark.long)
            for f, k in (
                ("impeller/C1.step", "impeller"),
                ("impeller/C2.igs", "impeller"),
                ("impeller/C3.step", "impeller"),
                ("casing/A4.igs", "casing"),
                ("casing/A5.step", "casing"),
                ("public/impeller/impeller.igs", "impeller"),
                ("surface/D3.step", "surface"),
            )
        ),
    ],
)
def test_shared_parts_are_taken_for_what_they_are(file: str, kind: str) -> None:
    from trunnion.part.read.part_file import read_part

    assert best(read_part(PARTS / file).graph()).name == kind
