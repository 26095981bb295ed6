"""Three bundles of rays: volumes worked out by hand for each form and motion, setups that hand stock on, and what goes wrong."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_tools import leaning_section
from trunnion import tolerance
from trunnion.findings import BadInput, Cancelled, OutOfMemory
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Motion
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.kernels.stock.intervals import COUNT, FIRST, Rays, subtract_from_ray
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from verify_tools import FORMS, bull, flat, program_section, tool_of

BOX = Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=(40.0, 32.0, 20.0), material="test", density=2.8)
UP = (0.0, 0.0, 1.0)
XYZ = ("x", "y", "z")


def whole(cell=0.25, opened=True):
    stock = Stock.of(BOX, cell, XYZ)
    if opened:
        stock.open_field()
    return stock


def cut(section, cell=0.25, stock=None, frame=WORLD, **options):
    stock = stock or whole(cell)
    return stock, run_stock(stock, moves_of([section]), frame, **options)


def gone(stock):
    """Return what each bundle has lost, mm3."""
    return [BOX.volume - b.volume for b in stock.rays.values()] + (
        [BOX.volume - stock.field.volume] if stock.field is not None else []
    )


def ends_of(stock, name, *at):
    """Return the intervals of the ray of a bundle that is nearest to a place (u, v)."""
    b = stock.rays[name]
    column, row = np.floor((np.array(at) - b.origin) / b.pitch).astype(int)
    cell = row * b.columns + column
    bounds, low, high = b.packed()
    own = slice(bounds[cell], bounds[cell + 1])
    return list(zip(low[own].tolist(), high[own].tolist(), strict=True))


def cap(radius, height):
    return math.pi * height**2 * (3 * radius - height) / 3


PLUNGES = {
    "flat": 6 * math.pi * 25,
    "bull": 4 * math.pi * 25
    + 2 * math.pi * 3**2
    + math.pi**2 / 2 * 3 * 2**2
    + 2 / 3 * math.pi * 2**3,
    "ball": math.pi * 25 + 2 / 3 * math.pi * 125,
    # A disc 20 wide, rounded by 0.5, comes down from above through all of it.
    "t-slot": math.pi * (5.5 * 10**2 + 0.5 * 9.5**2)
    + math.pi**2 / 2 * 9.5 * 0.5**2
    + 2 / 3 * math.pi * 0.5**3,
    "drill": math.pi * 16 * (6 - 4 / math.tan(math.radians(60.0)))
    + math.pi * 16 / 3 * 4 / math.tan(math.radians(60.0)),
    # A cylinder without the ring that its chamfer leaves: of a triangle of 1 by 1, by Pappus.
    "reamer": math.pi * 16 * 6 - 0.5 * math.tau * (4 - 1 / 3),
    # The core of M8x1.25.
    "tap": math.pi * (6.6468 / 2) ** 2 * 6,
}


@pytest.mark.parametrize("form", PLUNGES)
def test_a_plunge_takes_off_what_the_cutter_is_below_the_top(form):
    # Beside the middle of a cell: the rays at a rim are not all at its four corners.
    stock, run = cut(program_section(FORMS[form], [(20.03, 16.07, 21), (20.03, 16.07, 14)]))
    assert gone(stock) == approx([PLUNGES[form]] * 3, rel=1e-2)
    assert run.removed.sum() == approx(PLUNGES[form], rel=5e-3)


@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 0, 0), (0, -1, 0), (-1, 0, 0), (0, 0, -1)])
def test_a_slot_through_the_block_is_as_wide_and_deep_from_every_side(axis):
    axis = np.array(axis, dtype=float)
    way = np.eye(3)[(np.flatnonzero(axis)[0] + 1) % 3]
    face = np.where(axis > 0, BOX.high, np.where(axis < 0, BOX.low, BOX.high / 2))
    tip = face - 6.0 * axis
    section = leaning_section(flat(10.0)(), [tip - 60 * way, tip + 60 * way], [axis, axis])
    stock, _ = cut(section)
    assert gone(stock) == approx([10 * 6 * (BOX.high @ way)] * 3, rel=1e-6)


def test_a_slot_across_a_leaning_tool_is_as_deep_on_average_as_its_axis():
    lean = math.radians(30.0)
    axis = [math.sin(lean), 0.0, math.cos(lean)]
    stock, _ = cut(
        leaning_section(flat(8.0)(), [(18, -30, 14), (18, 60, 14)], [axis, axis]), cell=0.125
    )
    assert gone(stock) == approx([8 * 6 / math.cos(lean) * 32] * 3, rel=2e-3)


def test_a_ramp_leaves_a_slope_under_a_flat_end_as_it_comes_along():
    # From the top at x = 10 down to 5 deep at x = 30, beyond the block's end in y: the lower rim leads on the way down.
    stock, _ = cut(leaning_section(flat(10.0)(), [(0, 16, 20), (40, 16, 10)], [UP, UP]))
    top = ends_of(stock, "z", 20.125, 16.125)[0][1]
    assert top == approx(20.0 - 10.0 * (20.125 + math.sqrt(25 - 0.125**2)) / 40.0)


def test_an_arc_takes_off_a_bent_slot_in_every_bundle():
    stock, _ = cut(
        program_section(flat(8.0)(), [(30, 16, 25), (30, 16, 15), ((10, 16, 15), (20, 16))]),
        cell=0.125,
    )
    assert gone(stock) == approx([(math.pi * 16 + math.pi * 10 * 8) * 5] * 3, rel=2e-3)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_arcs_about_every_axis_of_the_blank_are_as_their_chords(axis):
    unit = np.roll(np.eye(3), axis, axis=0)
    centre, tip = (
        np.array([20.0, 16.0, 10.0]),
        np.array([20.0, 16.0, 10.0]) + 3.0 * unit[0] + 4.0 * unit[1] - 4.0 * unit[2],
    )
    angles = np.linspace(0.0, 4.0, 400)
    arm = tip - centre
    ways = [
        centre
        + math.cos(a) * (arm + 4.0 * unit[2])
        + math.sin(a) * np.cross(unit[2], arm)
        - 4.0 * unit[2]
        for a in angles
    ]
    bent, _ = cut(
        leaning_section(
            bull(8.0, 2.0)(flute=6.0),
            [ways[0], ways[-1]],
            [unit[2]] * 2,
            centre=centre,
            motion=Motion.ARC_CCW,
        ),
        0.5,
    )
    chords, _ = cut(leaning_section(bull(8.0, 2.0)(flute=6.0), ways, [unit[2]] * 400), 0.5)
    assert gone(bent) == approx(gone(chords), rel=2e-4)
    for one, other in zip(bent.rays.values(), chords.rays.values(), strict=True):
        assert one.count.tolist() == other.count.tolist()


def test_an_arc_of_more_than_a_turn_takes_off_all_of_its_ring():
    def ring_of(sweep):
        moves = moves_of(
            [program_section(flat(8.0)(), [(30, 16, 15), ((10, 16, 15), (20, 16))], rapid_to=0)]
        )
        stock = whole(0.5)
        run_stock(stock, replace(moves, sweep=np.array([0.0, sweep])), WORLD)
        return gone(stock)

    assert ring_of(3.0 * math.pi) == approx(ring_of(2.0 * math.pi), rel=1e-9)


def test_a_helix_leaves_its_lowest_turn():
    stops = [
        (25, 16, 22),
        *(((x, 16, z), (20, 16)) for x, z in ((15, 19), (25, 16), (15, 13), (25, 13), (15, 13))),
    ]
    stock, _ = cut(program_section(flat(10.0)(), stops), cell=0.125)
    assert gone(stock) == approx([math.pi * 100 * 7] * 3, rel=2e-3)


def test_a_t_slot_undercut_leaves_a_roof():
    tool = tool_of(
        "t-slot",
        diameter=16.0,
        flute_length=4.0,
        neck_diameter=6.0,
        neck_length=20.0,
        shank_diameter=6.0,
        stickout=40.0,
    )
    slot = leaning_section(flat(8.0)(), [(20, -20, 6), (20, 60, 6)], [UP, UP])
    undercut = leaning_section(tool, [(20, -20, 6), (20, 60, 6)], [UP, UP])
    stock, _ = cut(slot)
    _, after = cut(undercut, stock=stock)
    assert ends_of(stock, "z", 14.125, 16.125) == [(0.0, approx(6.0)), (approx(10.0), 20.0)]
    assert after.removed.sum() == approx(2 * 4 * 4 * 32, rel=1e-3)
    assert after.body_depth.max() == approx(0.0, abs=tolerance.COINCIDENT)


def test_a_flip_goes_on_with_what_the_first_side_has_left():
    stock, first = cut(
        leaning_section(flat(10.0)(), [(20, -20, 8), (20, 60, 8)], [UP, UP]),
        stock=whole(opened=False),
    )
    assert stock.field is not None
    flipped = Frame(
        np.array([40.0, 0.0, 20.0]), np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    )
    # The same slot from below, 10 deep: 8 of it were left.
    _, second = cut(
        leaning_section(flat(10.0)(), [(20, -20, 10), (20, 60, 10)], [UP, UP]),
        stock=stock,
        frame=flipped,
    )
    assert (first.removed.sum(), second.removed.sum()) == (
        approx(10 * 12 * 32),
        approx(10 * 8 * 32),
    )
    assert ends_of(stock, "x", 16.125, 10.125) == [(0.0, approx(15.0)), (approx(25.0), 40.0)]
    assert not stock.contains(np.array([[20.0, 16.0, 4.0]]))[0]


def test_a_setup_on_its_side_drills_across_the_slot_of_the_first():
    stock, _ = cut(
        leaning_section(flat(10.0)(), [(20, -20, 8), (20, 60, 8)], [UP, UP]),
        stock=whole(0.125, opened=False),
    )
    side = Frame(np.array([40.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    hole = program_section(flat(6.0)(flute=45.0), [(16, 14, 5), (16, 14, -41)])
    _, run = cut(hole, stock=stock, frame=side)
    assert run.removed.sum() == approx(math.pi * 9 * 30, rel=3e-3)
    # The hole's crown is at 17, its middle at 14.
    assert ends_of(stock, "z", 5.0, 16.0) == [
        (0.0, approx(11.0, abs=2e-3)),
        (approx(17.0, abs=2e-3), 20.0),
    ]


def test_a_tool_that_turns_about_its_ball_centre_removes_just_the_ball():
    centre, r = np.array([20.0, 16.0, 22.5]), 5.0
    lean = np.radians(np.linspace(-20.0, 20.0, 81))
    axes = np.column_stack([np.sin(lean), 0 * lean, np.cos(lean)])
    stock, run = cut(leaning_section(bull(10.0, 5.0)(), centre - r * axes, axes))
    assert gone(stock) == approx([cap(r, 2.5)] * 3, rel=1e-2)
    assert run.removed[2:].sum() < 1e-3 * cap(r, 2.5)


def test_a_tool_that_swings_about_its_middle_leaves_what_is_beside_its_waist():
    tool = flat(4.0)(flute=40.0)
    lean = math.radians(8.0)
    ends = [np.array([s * math.sin(lean), 0.0, math.cos(lean)]) for s in (-1.0, 1.0)]
    middle = np.array([20.0, 16.0, 10.0])
    section = leaning_section(tool, [middle - 20.0 * ends[0], middle - 20.0 * ends[1]], ends)
    stock, _ = cut(section, cell=0.125)
    # 2.3 beside the pivot: the flank, leaning by up to 8 degrees, passes there but for 2 mm or so about the waist.
    waist = (2.3125 - 2.0 / math.cos(lean)) / math.tan(lean)
    inner = ends_of(stock, "z", 22.3125, 16.0625)
    assert len(inner) == 1
    assert inner[0] == (approx(10.0 - waist, abs=0.02), approx(10.0 + waist, abs=0.02))


@pytest.mark.parametrize("z", [7.5, 10.0, 12.5])
def test_a_tool_that_swings_by_little_about_a_point_of_its_axis_leaves_what_is_beside_it(z):
    lean, beside = 0.00705, 0.017
    ends = [np.array([s * math.sin(lean), 0.0, math.cos(lean)]) for s in (-1.0, 1.0)]
    # A ray of the z bundle stands `beside` off the flank of the upright tool, whose pivot is half way up its flutes.
    pivot = np.array([22.3125 - 2.0 - beside, 16.0625, z])
    stock, _ = cut(
        leaning_section(flat(4.0)(flute=40.0), [pivot - 20.0 * e for e in ends], ends), cell=0.125
    )
    waist = (2.0 + beside - 2.0 / math.cos(lean)) / math.tan(lean)
    left = [p for p in ends_of(stock, "z", 22.3125, 16.0625) if p[0] < z < p[1]]
    assert left == [(approx(z - waist, abs=0.05), approx(z + waist, abs=0.05))]


def test_a_cutter_that_leaves_the_blank_or_never_meets_it_takes_off_nothing_else():
    _, run = cut(
        leaning_section(
            flat(10.0)(),
            [(20, 16, 25), (20, 16, 20), (60, 16, 20), (60, 16, 0), (20, 16, 40)],
            [UP] * 5,
        )
    )
    assert run.removed[:4].max() == 0.0
    assert run.removed[4] > 0.0


def test_rays_cut_again_by_the_same_move_lose_nothing():
    section = leaning_section(
        bull(10.0, 2.0)(), [(5, 5, 12), (30, 20, 10)], [(0.2, 0.1, 1.0), (0.1, 0.3, 1.0)]
    )
    stock, first = cut(section)
    _, again = cut(section, stock=stock)
    assert first.removed.sum() > 1000.0
    assert again.removed.max() < 1e-3


# Rapids and collisions.


@pytest.mark.parametrize("depth", [0.05, 0.5])
def test_a_leaning_rapid_through_stock_is_as_deep_as_it_goes(depth):
    lean = 0.4
    axis = np.array([0.0, math.sin(lean), math.cos(lean)])
    rest = np.array([20.0, 16.0, 20.0 + 5.0 * math.sin(lean)])
    tips = [rest + (-60, 0, 30), rest + (-60, 0, -depth), rest + (60, 0, -depth)]
    moves = moves_of([with_rapids(leaning_section(flat(10.0)(), tips, [axis] * 3))])
    run = run_stock(whole(0.5), moves, WORLD, Sweep.of(moves, 2.0))
    assert run.rapid_depth[:2].max() == 0.0
    # The rim's corner is square: of the material's triangle in it the deepest is on the top, as far from end as from flank.
    deepest = depth / (math.sin(lean) + math.cos(lean))
    assert 0.5 * deepest < run.rapid_depth[2] <= deepest + 1e-6
    assert run.rapid_position[2, 2] == approx(20.0, abs=depth)


@pytest.mark.parametrize("left", [0.0004, 0.009, 0.02, 0.3])
def test_a_rapid_through_a_film_is_in_stock_where_the_film_is_thicker_than_a_rapid_may_be_deep(
    left,
):
    over = program_section(flat(60.0)(), [(-60.0, 16.0, left), (60.0, 16.0, left)])
    axis = np.array([0.0, math.sin(0.4), math.cos(0.4)])
    tips = [(-60.0, 16.0, -8.0), (60.0, 16.0, -8.0)]
    through = with_rapids(leaning_section(flat(10.0)(), tips, [axis] * 2))
    moves = moves_of([over, through])
    run = run_stock(whole(0.5), moves, WORLD, Sweep.of(moves, 2.0))
    assert (run.rapid_depth.max() > tolerance.RAPID_DEPTH) == (left > tolerance.RAPID_DEPTH)


def with_rapids(section):
    n = len(section.path)
    return replace(section, path=replace(section.path, motion=np.zeros(n, int), feed=np.zeros(n)))


def test_a_rapid_in_a_leaning_slot_that_was_just_cut_is_clear():
    axis = np.array([0.0, math.sin(0.4), math.cos(0.4)])
    there = leaning_section(flat(10.0)(), [(-20, 16, 12), (60, 16, 12)], [axis, axis])
    back = with_rapids(leaning_section(flat(10.0)(), [(60, 16, 12), (-20, 16, 12)], [axis, axis]))
    stock = whole()
    moves = moves_of([there, back])
    run = run_stock(stock, moves, WORLD, Sweep.of(moves, 2.0))
    assert run.rapid_depth.max() == 0.0


def test_a_holder_that_leans_into_standing_stock_is_seen():
    # Nose radius 12 and 9 above the tip; leaning by 60 degrees, 2 deep, it meets the top.
    axis = np.array([math.sin(math.pi / 3), 0.0, 0.5])
    _, run = cut(
        leaning_section(bull(10.0, 5.0)(flute=6.0), [(10, -30, 18), (10, 60, 18)], [axis, axis])
    )
    assert run.body_depth[1] > 3.0
    assert run.body_depth[0] == 0.0


# Memory, threads, snapshots, cancel.


def test_every_number_of_threads_leaves_the_same_bytes():
    section = leaning_section(
        bull(10.0, 2.0)(),
        np.random.default_rng(3).uniform(2, 18, (40, 3)),
        UP + 0.4 * np.random.default_rng(4).normal(size=(40, 3)),
    )
    results = []
    for threads in (1, 2, 5):
        stock, run = cut(section, cell=0.5, threads=threads)
        results.append(
            [
                run.removed.tobytes(),
                run.engagement.tobytes(),
                run.body_depth.tobytes(),
                *(
                    part.tobytes()
                    for b in stock.rays.values()
                    for tile in b.parts()
                    for part in tile
                ),
            ]
        )
    assert results[0] == results[1] == results[2]


def test_where_the_work_is_cut_in_chunks_changes_nothing(monkeypatch):
    section = leaning_section(
        bull(10.0, 2.0)(),
        np.random.default_rng(3).uniform(2, 18, (20, 3)),
        UP + 0.4 * np.random.default_rng(4).normal(size=(20, 3)),
    )
    _, run = cut(section, cell=0.5)
    monkeypatch.setattr("trunnion.verify.stock.rays.LOOKS", 1)
    monkeypatch.setattr("trunnion.verify.stock.rays.SPANS", 10)
    assert cut(section, cell=0.5)[1].removed == approx(run.removed, rel=1e-12)


def test_a_snapshot_brings_back_every_interval_and_shares_what_has_not_changed():
    stock, _ = cut(leaning_section(flat(10.0)(), [(10, -20, 8), (10, 60, 8)], [UP, UP]), cell=0.5)
    first = stock.snapshot()
    cut(
        leaning_section(flat(4.0)(), [(20, 3, 15), (30, 3, 15)], [(0.1, 0.0, 1.0)] * 2), stock=stock
    )
    second = stock.snapshot()
    shared = [
        a is b
        for name in first.parts
        for a, b in zip(first.parts[name], second.parts[name], strict=True)
    ]
    assert 0.5 < np.mean(shared) < 1.0
    bytes_after = [
        a.tobytes() for name in second.parts for tile in second.parts[name] for a in tile
    ]
    stock.restore(first)
    assert [a.tobytes() for b in stock.rays.values() for tile in b.parts() for a in tile] == [
        a.tobytes() for name in first.parts for tile in first.parts[name] for a in tile
    ]
    cut(
        leaning_section(flat(4.0)(), [(20, 3, 15), (30, 3, 15)], [(0.1, 0.0, 1.0)] * 2), stock=stock
    )
    assert [
        a.tobytes() for b in stock.rays.values() for tile in b.parts() for a in tile
    ] == bytes_after


def test_a_snapshot_of_heights_is_gone_back_to_after_a_cut_from_the_side():
    stock, _ = cut(
        leaning_section(flat(10.0)(), [(10, -20, 8), (10, 60, 8)], [UP, UP]),
        stock=whole(0.5, opened=False),
    )
    kept, volume = stock.snapshot(), stock.volume
    cut(
        leaning_section(flat(4.0)(), [(20, 3, 15), (30, 3, 15)], [(0.1, 0.0, 1.0)] * 2), stock=stock
    )
    assert stock.field is None
    stock.restore(kept)
    assert stock.field is not None
    assert stock.volume == volume


def test_memory_is_known_before_and_refused_with_a_remedy():
    assert Stock.need(BOX, 0.5) == 80 * 64 * 8
    stock = whole(0.5)
    taken = sum(b.nbytes for b in stock.rays.values())
    assert Stock.need(BOX, 0.5, XYZ) == approx(taken, rel=0.01)
    with pytest.raises(OutOfMemory, match=r"choose verify\.cell of at least 0\.01 mm"):
        Stock.of(BOX, 0.005, XYZ)
    with pytest.raises(BadInput, match="bundles are some of x, y, z"):
        Stock.of(BOX, 0.5, ("w",))


def test_stock_that_grows_too_ragged_is_refused_with_a_remedy(monkeypatch):
    monkeypatch.setattr("trunnion.verify.stock.rays.MOST_BYTES", Stock.need(BOX, 0.5, XYZ) + 1)
    tips = [
        p
        for x in range(2, 40, 4)
        for p in ((x, -20, 10), (x, 60, 10), (x + 2, 60, 30), (x + 4, -20, 30))
    ]
    with pytest.raises(OutOfMemory, match="coarser"):
        cut(leaning_section(flat(2.0)(), tips, [UP] * len(tips)), cell=0.5)


def test_where_memory_has_no_room_gaps_shorter_than_a_cell_are_filled(monkeypatch):
    # Grooves of 1.4 mm, 2 mm apart, along y: rays along x have fifteen gaps that are shorter than a cell.
    tips = [
        p
        for x in np.arange(4.0, 34.0, 2.0)
        for p in ((x, -20, 10), (x, 60, 10), (x + 1.0, 60, 30), (x + 2.0, -20, 30))
    ]
    section = leaning_section(flat(1.4)(), tips, [UP] * len(tips))
    ample, tight = whole(2.0), whole(2.0)
    cut(section, stock=ample)
    before, after = (sum(b.nbytes for b in s.rays.values()) for s in (tight, ample))
    assert after > 1.3 * before
    monkeypatch.setattr("trunnion.verify.stock.rays.MOST_BYTES", (2 * before + after) // 3)
    run = cut(section, stock=tight)[1]
    along_x, exact = tight.rays["x"], ample.rays["x"]
    assert along_x.count.sum() < exact.count.sum() and run.removed.sum() > 0.0
    points = np.random.default_rng(2).uniform(BOX.low, BOX.high, (20000, 3))
    there, kept = exact.contains(points), along_x.contains(points)
    # Nothing that stands is lost, and what was filled lies in a groove.
    assert (kept | ~there).all()
    more = points[kept & ~there]
    assert len(more)
    off = (more[:, 0] - 4.0) % 2.0
    assert np.minimum(off, 2.0 - off).max() <= 0.7 + 1e-6


def test_cancel_is_heard_within_a_fifth_of_a_second():
    rng = np.random.default_rng(1)
    section = leaning_section(
        flat(16.0)(), rng.uniform(0, 30, (3000, 3)), UP + 0.3 * rng.normal(size=(3000, 3))
    )
    moves, stock, asked = moves_of([section]), whole(), []

    def cancelled():
        if asked or time.perf_counter() - began > 0.5:
            asked.append(time.perf_counter())
        return bool(asked)

    run_stock(
        whole(5.0),
        moves_of([leaning_section(flat(16.0)(), [(0, 0, 0), (1, 1, 1)], [UP, UP])]),
        WORLD,
        progress=NO_PROGRESS,
    )
    began = time.perf_counter()
    with pytest.raises(Cancelled):
        run_stock(stock, moves, WORLD, progress=Progress(cancelled=cancelled))
    assert time.perf_counter() - asked[0] < 1.0


def test_a_patch_shows_a_place_more_finely():
    section = leaning_section(
        bull(10.0, 5.0)(), [(20, -20, 15), (20, 60, 15)], [(0.3, 0.0, 1.0)] * 2
    )
    stock, _ = cut(section, cell=1.0)
    patch = stock.patch((15.0, 10.0, 12.0), (25.0, 12.0, 20.0), 0.1)
    run_stock(patch, moves_of([section]), WORLD)
    points = np.random.default_rng(0).uniform((15, 10, 12), (25, 12, 20), (2000, 3))
    axis = np.array([0.3, 0.0, 1.0]) / math.hypot(0.3, 1.0)
    centre = np.array([20.0, 0.0, 15.0]) + 5.0 * axis
    away = (points - centre) * (1.0, 0.0, 1.0)
    along = np.maximum(away @ axis, 0.0)
    depth = 5.0 - np.linalg.norm(away - along[:, None] * axis, axis=1)
    sure = np.abs(depth) > 0.15
    assert (patch.contains(points) == (depth < 0.0))[sure].all()
    with pytest.raises(BadInput, match="patch"):
        stock.patch((50.0, 0.0, 0.0), (60.0, 1.0, 1.0), 0.1)


def test_engagement_of_a_leaning_slot_is_half_its_circumference():
    axis = np.array([0.0, math.sin(0.2), math.cos(0.2)])
    _, run = cut(
        leaning_section(flat(10.0)(), [(0, 16, 12), (20, 16, 12), (30, 16, 12)], [axis] * 3)
    )
    assert run.engagement[2] == approx(math.pi, abs=0.2)
    assert run.depth_of_cut[2] == approx(8.0 / math.cos(0.2), abs=1.5)


@pytest.mark.parametrize("name", [("z",), XYZ])
def test_a_rapid_straight_up_is_seen_in_what_a_t_slot_cutter_has_left_over_its_slot(name):
    tool = tool_of(
        "t-slot",
        diameter=20.0,
        corner_radius=0.5,
        flute_length=6.0,
        neck_diameter=8.0,
        neck_length=26.0,
        shank_diameter=8.0,
        stickout=30.0,
    )
    section = _rapid_at_the_end(
        program_section(
            tool,
            [(-15.0, 16.0, 30.0), (-15.0, 16.0, 8.0), (-6.0, 16.0, 8.0), (-6.0, 16.0, 30.0)],
            rapid_to=1,
        )
    )
    moves = moves_of([section])
    run = run_stock(Stock.of(BOX, 0.5, name), moves, WORLD, Sweep.of(moves, 2.0))
    assert run.rapid_depth[:3].max() == 0.0 and run.rapid_depth[3] > 1.0


THREAD_MILLS = {"thread mill", "single tooth"}
"""In rapids they are as thick as their teeth."""


@pytest.mark.parametrize("form", sorted(set(FORMS) - {"t-slot"} - THREAD_MILLS))
def test_a_rapid_straight_up_out_of_what_was_just_plunged_is_clear(form):
    section = _rapid_at_the_end(
        program_section(FORMS[form], [(20.1, 16.2, 60.0), (20.1, 16.2, 13.0), (20.1, 16.2, 60.0)])
    )
    moves = moves_of([section])
    run = run_stock(whole(0.5), moves, WORLD, Sweep.of(moves, 2.0))
    assert run.rapid_depth.max() == 0.0 and run.body_depth.max() <= tolerance.CONTACT_BOUND


@pytest.mark.parametrize("form", sorted(THREAD_MILLS))
def test_a_rapid_straight_up_is_seen_where_a_thread_mills_teeth_are_in_what_its_core_has_left(form):
    section = _rapid_at_the_end(
        program_section(FORMS[form], [(20.1, 16.2, 60.0), (20.1, 16.2, 13.0), (20.1, 16.2, 60.0)])
    )
    moves = moves_of([section])
    run = run_stock(whole(0.5), moves, WORLD, Sweep.of(moves, 2.0))
    teeth = FORMS[form].radius - FORMS[form].core_radius
    assert run.rapid_depth[-1] == approx(teeth, abs=1e-6)


def _rapid_at_the_end(section):
    """Return a section whose last block is a rapid."""
    path = section.path
    motion, feed = path.motion.copy(), path.feed.copy()
    motion[-1], feed[-1] = Motion.RAPID, 0.0
    return replace(section, path=replace(path, motion=motion, feed=feed))


def random_rays(rng, count):
    """Return rays of one tile with random sorted intervals, and the same as lists of (low, high)."""
    lists = [
        np.sort(rng.choice(1000, 2 * n, replace=False)).reshape(-1, 2).astype(float)
        for n in rng.integers(0, 3, count)
    ]
    capacity = np.full(count, 2)
    ends = np.zeros((2 * count + 40 * count, 2))
    for k, own in enumerate(lists):
        ends[2 * k : 2 * k + len(own)] = own
    ray = np.column_stack([2 * np.arange(count), [len(own) for own in lists], capacity])
    free = np.array([2 * count, len(ends)])
    return Rays(ray, ends, free), [own.tolist() for own in lists]


def without(intervals, a, b):
    """Return sorted intervals without [a, b]."""
    kept = [
        piece for low, high in intervals for piece in ([low, min(high, a)], [max(low, b), high])
    ]
    return [[low, high] for low, high in kept if high > low]


@pytest.mark.parametrize("seed", range(4))
def test_rays_that_are_full_move_and_lose_nothing(seed):
    rng = np.random.default_rng(seed)
    rays, lists = random_rays(rng, 12)
    for _ in range(400):
        cell = int(rng.integers(12))
        a, b = np.sort(rng.uniform(0.0, 1000.0, 2)) if rng.random() < 0.1 else (0.0, 0.0)
        if a == b:
            a = rng.uniform(0.0, 1000.0)
            b = a + rng.uniform(0.5, 5.0)
        gone, whole = subtract_from_ray(rays, cell, a, b)
        left = without(lists[cell], a, b)
        assert whole
        assert gone == approx(
            sum(y - x for x, y in lists[cell]) - sum(y - x for x, y in left), abs=1e-9
        )
        lists[cell] = left
    moved = rays.ray[:, FIRST] >= 24
    assert moved.any()
    for own, (first, count, capacity) in zip(lists, rays.ray, strict=True):
        assert count <= capacity
        assert rays.ends[first : first + count].tolist() == own
    # No two rays share a row.
    taken = np.concatenate([np.arange(first, first + n) for first, _, n in rays.ray])
    assert len(np.unique(taken)) == len(taken) and taken.max() < rays.free[0]


def test_a_full_tile_says_so_and_keeps_what_it_has():
    rays = Rays(
        np.array([[0, 2, 2]]), np.array([[0.0, 10.0], [20.0, 30.0], [0.0, 0.0]]), np.array([2, 3])
    )
    gone, whole = subtract_from_ray(rays, 0, 4.0, 5.0)
    assert not whole and gone == 0.0
    assert rays.ends[:2].tolist() == [[0.0, 10.0], [20.0, 30.0]] and rays.ray[0, COUNT] == 2
