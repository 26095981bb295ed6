"""Roughing and finishing by turning: what they leave, how deep they cut, and that the proof finds nothing, on a ring between flanges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from pytest import approx

from trunnion.geometry.frame import WORLD
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.meridian import meridian_in, seen_from
from trunnion.plan.turning.settings import TurningSettings
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.turning.finish import finish
from trunnion.toolpath.turning.rough import rough
from trunnion.toolpath.turning_passes.stock import turned_by
from trunnion.verify.turning.moves import MeridianFrame
from trunnion.verify.turning.proof import prove_turning
from turned_rings import (
    HELD,
    RING,
    SETUP,
    SHOP,
    SLENDER,
    STRONG,
    WORK,
    blank_of,
    data_of,
    laid,
    ring_area,
    turned_over,
    turning_tool,
)


@pytest.fixture(scope="module")
def turned():
    """Return the operations on the ring, in their order: name, tool, path, and the stock after each."""
    stock, made = blank_of(), []
    for strategy in (rough, finish):
        for n, (side, name, lowest) in enumerate(WORK):
            tool = turning_tool(name, number=n + 1)
            path = laid(strategy, side, tool, lowest, stock)
            stock = turned_by(stock, WORLD, path, tool)
            made.append((f"{strategy.__name__}-{n}", tool, path, stock))
    return made


@pytest.fixture(scope="module")
def proven(turned):
    sections = tuple(
        ProgramSection(
            operation=name, tool=tool, spindle=1000.0, path=path, surface_speed=350.0, depth=3.0
        )
        for name, tool, path, _ in turned
    )
    return prove_turning(
        Program(name="ring.S1", setup=SETUP, sections=sections),
        MeridianFrame.of(WORLD, WORLD, "S1"),
        ring_area(),
        meridian_in(blank_of(), WORLD),
        SHOP.machine(SETUP.machine),
        SHOP.material("EN AW-7075"),
    )


def test_the_ring_is_turned_to_size_but_for_what_holds_it(turned):
    left = meridian_in(turned[-1][3], WORLD).difference(ring_area())
    above = left.intersection(shapely.box(0.0, HELD + 2.0, 200.0, 200.0))
    assert above.area < 0.6 and above.buffer(-0.2).is_empty


def test_the_proof_finds_nothing(proven):
    assert proven.gouge.max() < 2e-3
    assert proven.collision.max() == 0.0
    assert proven.rapid_depth.max() == 0.0


def test_what_the_proof_leaves_is_what_was_planned(turned, proven):
    planned = meridian_in(turned[-1][3], WORLD)
    assert planned.symmetric_difference(proven.left).area < 0.05


def test_no_pass_is_deeper_than_its_data(proven):
    roughing = proven.moves.section < len(WORK)
    assert proven.depth[roughing].max() <= 3.0 + 0.5
    assert proven.depth[~roughing].max() <= 0.75


def test_chips_come_to_the_volume_that_is_gone(turned, proven):
    def volume(shape):
        return 2.0 * np.pi * shape.centroid.x * shape.area

    gone = volume(meridian_in(blank_of(), WORLD)) - volume(proven.left)
    assert proven.removed.sum() == approx(gone, rel=1e-4)


def test_paths_begin_and_end_over_the_work_and_come_to_it_beside_the_stock(turned):
    for _, _, path, _ in turned:
        assert path.work_turns and path.position[0, 2] == path.position[-1, 2] == SETUP.clearance
        assert (path.motion[:2] == Motion.RAPID).all()
        assert path.position[0, 0] == path.position[1, 0]


def test_contours_leave_as_arcs_where_the_nose_goes_round_a_corner(turned):
    path = {name: path for name, _, path, _ in turned}["finish-1"]
    assert 1 <= (path.motion >= Motion.ARC_CW).sum() <= 12 and len(path) < 60


def test_material_is_entered_at_half_the_feed(turned):
    path = {name: path for name, _, path, _ in turned}["rough-1"]
    entry = path.mark == Mark.ENTRY
    assert entry.any()
    turns = 350.0e3 / (np.pi * 2.0 * path.position[:, 0])
    assert np.allclose(path.feed[entry], 0.15 * turns[entry])
    assert np.allclose(path.feed[path.mark == Mark.CUT], 0.3 * turns[path.mark == Mark.CUT])


def test_finishing_leaves_what_is_too_thick_for_it():
    # Roughed nowhere, the ground between the flanges has 20 mm on it; the flanges themselves have 5.
    path = laid(finish, "outside", turning_tool(SLENDER), HELD, blank_of(), depth=0.3)
    assert len(path) == 0
    thin = blank_of(RING + [(0.0, 0.0), *[(0.4, 0.0)] * 6, (0.0, 0.0)])
    assert len(laid(finish, "outside", turning_tool(SLENDER), HELD, thin, depth=0.3)) > 0


def test_nothing_is_laid_where_nothing_stands():
    done = blank_of(np.array([(94, 0), (119.9, 0), (119.9, 99.9), (94, 99.9)], float))
    tool = turning_tool(STRONG)
    assert len(laid(rough, "face", tool, 100.0, done)) == 0
    assert len(laid(finish, "face", tool, 100.0, done)) == 0


def test_the_same_work_gives_the_same_path(turned):
    again = laid(rough, "face", turned[0][1], 100.0, blank_of())
    assert np.array_equal(again.position, turned[0][2].position)


def test_turned_over_the_same_ring_takes_the_same_path():
    # The ring is its own mirror image: from its other end it looks the same.
    own = laid(rough, "outside", turning_tool(SLENDER), HELD, blank_of())
    frame = turned_over(100.0)
    flipped = blank_of(seen_from(blank_of().outline, WORLD, frame)[::-1])
    other = replace(flipped, frame=frame)
    seen = meridian_in(other, WORLD)
    assert (
        seen.equals_exact(meridian_in(blank_of(), WORLD), 1e-9)
        or seen.symmetric_difference(meridian_in(blank_of(), WORLD)).area < 1e-9
    )
    again = laid(rough, "outside", turning_tool(SLENDER), HELD, other)
    assert np.allclose(again.position, own.position, atol=1e-6)


def test_more_depth_takes_fewer_layers():
    tool = turning_tool(SLENDER)
    settings = TurningSettings(side="outside", lowest=HELD, floor=HELD)
    drive = RevolvedDrive(part=RING, to_cut=1.0)
    few, many = (
        len(rough(drive, tool, data_of(depth=d), blank_of(), SETUP, settings, NO_PROGRESS).path)
        for d in (6.0, 1.5)
    )
    assert few < 0.6 * many
