"""Scallops of whole strategies, measured in the fine mode: where a tight fillet meets a flat face, and where two areas meet."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from surface_drives import DATA, driven
from surface_forms import cylinder, grid, joined, plane
from trunnion.geometry.sheet.sheet import sheet_of
from trunnion.model.motion.program import ProgramSection
from trunnion.part.shape.exact import ExactPoints
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.partition import PART
from trunnion.plan.freeform.finishing.rest import HOLDER_CLEARANCE, remaining_of, without_met
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.shop import load_shop
from trunnion.toolpath.contact_passes.overrun import OverrunStrip
from trunnion.toolpath.surface.constant import ConstantSettings, constant
from trunnion.toolpath.surface.parallel import ParallelSettings, parallel
from trunnion.verify.finish.fine_mode import fine_measure
from trunnion.verify.motion import moves_of
from verify_tools import bull

BALL = bull(6.0, 3.0)()
SMALL = bull(2.0, 1.0)()
HEIGHT = 0.004


class Bend:
    """A face along x whose section is an arc: its parameters are x and the angle from the top of a circle of a radius about a line at
    (y, z); a radius of infinity makes it level, its second parameter y."""

    def __init__(self, radius, y, z, start, end, length, tag):
        self.radius, self.y, self.z, self.start, self.end, self.length, self.tag = (
            radius,
            y,
            z,
            start,
            end,
            length,
            tag,
        )

    def bounds(self):
        return 0.0, self.length, self.start, self.end

    def inside(self, places):
        return ((places >= [0.0, self.start]) & (places <= [self.length, self.end])).all(axis=1)

    def at(self, places):
        x, v = places.T
        flat, ones = np.zeros_like(x), np.ones_like(x)
        if math.isinf(self.radius):
            normal, dv, turn, bend = (
                np.column_stack(c)
                for c in ((flat, flat, ones), (flat, ones, flat), (flat, flat, flat), (flat,) * 3)
            )
            point = np.column_stack([x, v, flat + self.z])
        else:
            out = np.column_stack([flat, np.sin(v), np.cos(v)])
            side, r = np.sign(self.radius), abs(self.radius)
            turn = side * np.column_stack([flat, np.cos(v), -np.sin(v)])
            normal, dv, bend = side * out, r * side * turn, np.column_stack([flat, flat, flat + r])
            point = np.column_stack([x, flat + self.y, flat + self.z]) + r * out
        return ExactPoints(
            point=point,
            normal=normal,
            du=np.column_stack([ones, flat, flat]),
            dv=dv,
            normal_du=np.zeros((len(x), 3)),
            normal_dv=turn,
            bend=bend,
        )

    def skin(self, n):
        """Return the face as triangles, n strips across."""

        def of(name):
            return lambda u, v: getattr(self.at(np.column_stack([u, v])), name)

        return grid(
            of("point"),
            of("normal"),
            np.linspace(0.0, self.length, 25),
            np.linspace(self.start, self.end, n + 1),
            self.tag,
        )


LEVEL = Bend(math.inf, 0.0, 0.0, -4.0, 0.0, 6.0, 1)
EDGE = Bend(1.0, 0.0, -1.0, 0.0, 0.8, 6.0, 2)
HOLLOW = Bend(-2.0, 0.0, 2.0, math.pi - 1.1, math.pi, 6.0, 2)


def cut(strategy, settings, skin, faces, **chosen):
    drive, setup, stock = driven(skin, faces=faces, height=HEIGHT)
    return strategy(drive, BALL, DATA, stock, setup, choose(settings, chosen), NO_PROGRESS).path


def measured(paths, faces, low, high):
    sections = [
        ProgramSection(operation=f"op-{n}", tool=BALL, spindle=1.0, path=path)
        for n, path in enumerate(paths)
    ]
    return fine_measure(faces, moves_of(sections), 0.1, low=np.array(low), high=np.array(high))


@pytest.mark.parametrize("width", [3.86, 3.93, 4.0, 4.07])
def test_constant_scallops_stay_low_where_a_tight_fillet_meets_a_level_face(width: float) -> None:
    # Counted from the far rim, the join lies at another share of a stepover each time.
    level = Bend(math.inf, 0.0, 0.0, -width, 0.0, 6.0, 1)
    path = cut(constant, ConstantSettings, joined(level.skin(12), EDGE.skin(24)), (1, 2))
    found = measured([path], [level, EDGE], (2.0, -1.0, -2.0), (4.0, 0.6, 1.0))
    assert found.scallop.value <= 1.1 * HEIGHT and found.gouge.value <= 0.001


@pytest.mark.parametrize("angle", [0.0, 10.0, 90.0])
def test_no_ridge_stays_where_two_areas_meet(angle: float) -> None:
    # An area on both sides of another one: no pass in planes along the joins lies on them by itself.
    around, inside = (
        (LEVEL, Bend(math.inf, 0.0, 0.0, 2.0, 5.0, 6.0, 1)),
        Bend(math.inf, 0.0, 0.0, 0.0, 2.0, 6.0, 2),
    )
    skin = joined(*(face.skin(12) for face in (*around, inside)))
    paths = [
        cut(parallel, ParallelSettings, skin, (1,), direction="angle", angle=angle),
        cut(constant, ConstantSettings, skin, (2,)),
    ]
    found = measured(paths, [*around, inside], (1.5, -1.5, -1.0), (4.5, 3.5, 1.0))
    assert (
        found.scallop.value <= 1.1 * HEIGHT
        and found.step.value <= 0.005
        and found.gouge.value <= 0.001
    )


def test_what_a_cutter_leaves_before_a_hollow_too_tight_for_it_is_another_ones_area() -> None:
    # The ball of radius 3 stands on the level face as far as it may beside the hollow's foot of radius 2 at y = 0.
    skin = joined(LEVEL.skin(12), HOLLOW.skin(40))
    tips = np.array([[3.0, y] for y in np.linspace(-2.0, 0.0, 2001)])
    free = tips[skin.drop.drop(tips, lower_side(BALL), -9.0) <= 1e-4, 1].max()
    found, tags = remaining_of(skin, (1,), BALL, -9.0, HEIGHT)
    assert tags == (1 + PART,)
    kept = found.points[found.triangles[found.face == 1]]
    # Where it stands last it is finished, and what is left goes on below it for a stepover.
    assert free < -0.1 and kept[:, :, 1].max() <= free - stepover_on_plane(3.0, HEIGHT) + 0.34
    assert kept[:, :, 1].max() > free - 1.5


def channel(length: float, n: int = 2):
    """A long level floor and an upright wall at its edge y = 0, both in two triangles."""
    wall = grid(
        lambda u, v: np.column_stack([u, 0 * u, v]),
        lambda u, v: np.column_stack([0 * u, 0 * u + 1.0, 0 * u]),
        np.linspace(0.0, length, n),
        np.linspace(0.0, 40.0, n),
        2,
    )
    return replace(joined(plane(length, 30.0, n=n), wall), bound=5e-4)


@pytest.mark.parametrize(("length", "exact"), [(60.0, 0.03), (600.0, 0.08)])
def test_what_is_left_of_a_long_wall_is_a_strip_at_its_foot_with_few_triangles(
    length, exact
) -> None:
    # A ball of radius 3 on the floor leaves the lowest 3 mm of the wall, 600 mm long or more; the rim is as exact
    # as there are triangles enough for.
    found, tags = remaining_of(channel(length), (2,), BALL, -9.0, HEIGHT)
    strip = found.areas(found.of(tags)).sum()
    assert strip == pytest.approx(length * (3.0 + stepover_on_plane(3.0, HEIGHT)), rel=exact)
    assert found.areas(found.face == 2).sum() + strip == pytest.approx(40.0 * length)
    # As many as the strip's length needs, none over the wall.
    assert len(found.triangles) < 600.0 * length
    top = found.points[found.triangles[found.face == 2]]
    assert top[:, :, 2].min() > 3.0 and np.ptp(top[:, :, 0], axis=1).max() > 10.0


def test_a_strip_within_large_triangles_that_only_the_next_cutter_comes_to_is_its_area() -> None:
    # The ball of radius 3 is lifted as far as 3 mm beside the wall, that of radius 1 as far as 1 mm.
    found, tags = remaining_of(channel(60.0), (1,), BALL, -9.0, HEIGHT, upright=SMALL)
    strip, around = found.points[found.triangles[found.of(tags)]][:, :, :2], 0.5
    assert strip[..., 0].min() < 0.1 and strip[..., 0].max() > 59.9
    assert strip[..., 1].min() < 1.1 and 2.9 < strip[..., 1].max() < 3.0 + around
    assert found.areas(found.of(tags)).sum() > 60.0 * 2.0


def test_what_hangs_over_is_left_to_leaning_tools_alone() -> None:
    roof = grid(
        lambda u, v: np.column_stack([u, v, 9.0 + 0 * u]),
        lambda u, v: np.column_stack([0 * u, 0 * u, 0 * u - 1.0]),
        np.linspace(0.0, 6.0, 7),
        np.linspace(0.0, 4.0, 5),
        2,
    )
    skin = joined(plane(), roof)
    assert remaining_of(skin, (2,), BALL, -9.0, HEIGHT, upright=SMALL)[1] == ()
    assert remaining_of(skin, (2,), BALL, -9.0, HEIGHT)[1] == (2 + PART,)


def test_what_the_next_cutter_is_lifted_off_too_is_none_of_its_area() -> None:
    # The last 8 mm of the floor are under a low roof that neither ball gets under.
    roof = grid(
        lambda u, v: np.column_stack([u, v, 1.0 + 0 * u]),
        lambda u, v: np.column_stack([0 * u, 0 * u, 0 * u - 1.0]),
        np.linspace(12.0, 20.0, 9),
        np.linspace(0.5, 30.0, 10),
        3,
    )
    skin = replace(joined(channel(20.0, 21), roof), bound=5e-4)
    rests = [remaining_of(skin, (1,), BALL, -9.0, HEIGHT, upright=u) for u in (None, SMALL)]
    ends = [s.points[s.triangles[s.of(tags)]][:, :, 0].max() for s, tags in rests]
    assert ends[0] > 19.0 and 10.0 < ends[1] < 12.5


@pytest.mark.parametrize(("radius", "tags"), [(3.0, ()), (2.9, (1 + PART,))])
def test_a_ball_as_round_as_a_hollow_leaves_nothing_of_it(radius, tags) -> None:
    # Chords of 90 steps lie inside of the hollow by up to 0.44 um, where it is steep, too.
    hollow = cylinder(radius, 6.0, 0.5 * math.pi - 0.001, 90, hollow=True)
    bound = radius * (1.0 - math.cos(0.5 * math.pi / 89))
    assert remaining_of(replace(hollow, bound=bound), (1,), BALL, -9.0, HEIGHT)[1] == tags


def test_what_a_cutter_leaves_has_a_rim_that_passes_can_follow() -> None:
    # A wall slantwise across wide triangles: the ball of radius 3 leaves all that is nearer than 3 mm to its foot.
    floor = plane(16.0, 12.0, n=9)
    foot = np.array([[0.0, 1.0], [16.0, 5.0]])
    wall = grid(
        lambda u, v: np.column_stack([16.0 * u, 1.0 + 4.0 * u, v]),
        lambda u, v: np.column_stack([-4.0 + 0 * u, 16.0 + 0 * u, 0 * u]),
        np.linspace(0.0, 1.0, 9),
        np.linspace(0.0, 6.0, 3),
        2,
    )
    skin = joined(floor, wall)
    found, tags = remaining_of(skin, (1,), BALL, -9.0, HEIGHT)
    sheet = sheet_of(found, tags)
    along = (foot[1] - foot[0]) / np.linalg.norm(foot[1] - foot[0])
    for rim in sheet.rims():
        at = sheet.points[rim, :2] - foot[0]
        run, away = at @ along, at[:, 1] * along[0] - at[:, 0] * along[1]
        inner = (
            (np.abs(sheet.points[rim, :2] - [8.0, 6.0]) < [7.0, 5.0]).all(axis=1)
            & (run > 3.0)
            & (run < 13.0)
            & (away > 1.0)
        )
        past = away[inner] - 3.0 - stepover_on_plane(3.0, HEIGHT)
        assert inner.any() and past.min() > -0.01 and past.max() < 0.15 and np.ptp(past) < 0.02
    # Nothing of the faces is lost or doubled.
    both = sheet_of(found, (1, *tags))
    assert both.area().sum() == pytest.approx(16.0 * 12.0, abs=1e-6) and len(both.rims()) == 1


def test_a_strip_goes_on_over_smooth_joins_but_not_round_edges() -> None:
    wall = grid(
        lambda u, v: np.column_stack([u, 0.0 * u - 4.0, v]),
        lambda u, v: np.column_stack([0 * u, 0 * u - 1.0, 0 * u]),
        np.linspace(0.0, 6.0, 25),
        np.linspace(-3.0, 0.0, 9),
        3,
    )
    skin = joined(LEVEL.skin(12), EDGE.skin(24), wall)
    strip = OverrunStrip.of(skin, (1,), 0.3)
    middle, facet = skin.points[skin.triangles].mean(axis=1), np.arange(len(skin.triangles))
    inside = (middle[:, 0] > 1.0) & (middle[:, 0] < 5.0) & strip.has(middle, facet)
    assert (inside & (skin.face == 2)).any() and not (inside & (skin.face == 3)).any()
    assert middle[inside & (skin.face == 2), 1].max() < 0.3
    assert not strip.has(middle[:1], np.array([-1])).any()


def test_where_a_shank_would_meet_the_part_is_none_of_a_cutters_area() -> None:
    # A floor beside a wall that stands higher than the flutes: the wide shank keeps the ball off, nearer than it would touch by itself.
    floor = plane(24.0, 16.0, n=13)
    wall = grid(
        lambda u, v: np.column_stack([u, 0 * u, v]),
        lambda u, v: np.column_stack([0 * u, 0 * u + 1.0, 0 * u]),
        np.linspace(0.0, 24.0, 13),
        np.linspace(0.0, 30.0, 3),
        2,
    )
    skin = joined(floor, wall)
    wide = next(
        t
        for t in load_shop().tools
        if t.form == "ball" and max(max(r0, r1) for _, r0, _, r1 in t.profile()) > t.radius + 4.0
    )
    reach = max(max(r0, r1) for z0, r0, _, r1 in wide.profile() if z0 < 30.0)
    found, tags = without_met(skin, (1,), wide, -200.0, HEIGHT)
    kept = found.points[found.triangles[found.of(tags)]]
    around = 2.0 * max(0.3, stepover_on_plane(wide.corner_radius, HEIGHT))
    assert tags == (1,) and reach > wide.radius
    assert kept[:, :, 1].min() == pytest.approx(reach + HOLDER_CLEARANCE + around, abs=0.5)
    # All that is kept hangs together as one piece with one rim.
    assert len(sheet_of(found, tags).components()) == 1 and len(sheet_of(found, tags).rims()) == 1
    # Away from walls nothing changes.
    alone = plane(24.0, 16.0, n=13)
    assert without_met(alone, (1,), wide, -200.0, HEIGHT) == (alone, (1,))
