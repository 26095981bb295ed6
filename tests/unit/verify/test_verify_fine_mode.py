"""The fine mode: scallops, gouges and steps on surfaces in closed form and on a part's own faces, to a fifth of a micron."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from pytest import approx

from leaning_tools import EVERY_FORM, leaning_section
from samples import ball_shape, box_shape, oblique_cylinder_shape, read
from trunnion.cli.main import BAD, main
from trunnion.findings import BadCall, BadInput, Cancelled
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion
from trunnion.part.shape.exact import ExactFace, ExactPoints
from trunnion.pipeline.proof import fine_faces
from trunnion.pipeline.proof.fine_faces import (
    FineResult,
    faces_named,
    fine_dict,
    fine_text,
    measure_fine,
)
from trunnion.progress import Progress
from trunnion.verify.finish.fine_mode import FINE_BOUND, fine_measure
from trunnion.verify.motion import moves_of
from verify_tools import SETUP

UP = (0.0, 0.0, 1.0)


class Plane:
    """The plane z = 0 from (0, 0) to a corner."""

    def __init__(self, tag=1, start=(0.0, 0.0), end=(4.0, 4.0), height=0.0):
        self.tag, self.start, self.end, self.height = tag, start, end, height

    def bounds(self):
        return self.start[0], self.end[0], self.start[1], self.end[1]

    def inside(self, places):
        return ((places >= self.start) & (places <= self.end)).all(axis=1)

    def at(self, places):
        flat, ones = np.zeros((len(places), 1)), np.ones((len(places), 1))
        return ExactPoints(
            point=np.hstack([places, flat + self.height]),
            normal=np.hstack([flat, flat, ones]),
            du=np.hstack([ones, flat, flat]),
            dv=np.hstack([flat, ones, flat]),
            normal_du=np.zeros((len(places), 3)),
            normal_dv=np.zeros((len(places), 3)),
            bend=np.zeros((len(places), 3)),
        )


class Cylinder:
    """A quarter of a cylinder about the x axis, its parameters x and the angle from the top."""

    def __init__(self, radius, length=3.0, angle=0.3):
        self.tag, self.radius, self.end = 7, radius, (length, angle)

    def bounds(self):
        return 0.0, self.end[0], 0.0, self.end[1]

    def inside(self, places):
        return ((places >= 0.0) & (places <= self.end)).all(axis=1)

    def at(self, places):
        x, angle = places.T
        flat, ones = np.zeros_like(x), np.ones_like(x)
        normal, along = (
            np.column_stack([flat, np.sin(angle), np.cos(angle)]),
            np.column_stack([flat, np.cos(angle), -np.sin(angle)]),
        )
        return ExactPoints(
            point=np.column_stack([x, flat, flat]) + self.radius * normal,
            normal=normal,
            du=np.column_stack([ones, flat, flat]),
            dv=self.radius * along,
            normal_du=np.zeros((len(x), 3)),
            normal_dv=along,
            bend=np.column_stack([flat, flat, self.radius * ones]),
        )


def passes(tool, ys, z=0.0, x=(-10.0, 20.0), operation="op"):
    """Return a section of parallel passes along x, up between them so that only they touch."""
    tips = [[x[0], ys[0], 50.0]]
    for y in ys:
        tips += [[x[0], y, 50.0], [x[0], y, z], [x[1], y, z], [x[1], y, 50.0]]
    return leaning_section(tool, tips, [UP] * len(tips), operation=operation)


def scallop(radius, pitch):
    """Return how high a ball leaves ridges between passes on a plane."""
    return radius - math.sqrt(radius**2 - (pitch / 2) ** 2)


@pytest.mark.parametrize("pitch", [0.4, 1.0])
def test_parallel_ball_passes_leave_their_scallop_on_a_plane(pitch):
    found = fine_measure(
        [Plane()], moves_of([passes(EVERY_FORM["ball"], np.arange(-2.0, 7.0, pitch))]), 0.2
    )
    assert found.scallop.value == approx(scallop(5.0, pitch), abs=FINE_BOUND)
    assert found.scallop.value <= scallop(5.0, pitch) + 1e-9
    assert found.gouge.value == approx(0.0, abs=FINE_BOUND) and found.step.value == 0.0


def test_ball_passes_along_a_cylinder_leave_the_scallop_of_their_centres():
    # Centres on radius R + r, an angle apart: the ridge is where two balls meet on the normal half way between.
    big, ball, angle = 30.0, 5.0, 0.04
    tips, tool = [[-10.0, 0.0, 90.0]], EVERY_FORM["ball"]
    for a in np.arange(-0.1, 0.45, angle):
        centre = (big + ball) * np.array([0.0, math.sin(a), math.cos(a)])
        tips += [
            [-10.0, centre[1], 90.0],
            [-10.0, centre[1], centre[2] - ball],
            [13.0, centre[1], centre[2] - ball],
            [13.0, centre[1], 90.0],
        ]
    found = fine_measure(
        [Cylinder(big)], moves_of([leaning_section(tool, tips, [UP] * len(tips))]), 0.2
    )
    half = angle / 2
    true = (
        (big + ball) * math.cos(half)
        - math.sqrt(ball**2 - ((big + ball) * math.sin(half)) ** 2)
        - big
    )
    assert found.scallop.value == approx(true, abs=FINE_BOUND) and found.gouge.value == approx(
        0.0, abs=FINE_BOUND
    )


def test_a_leaning_bull_leaves_the_scallop_of_its_corner():
    # Leaning back along its way by 20 degrees, the torus is seen across the way as an ellipse's end: searched finely in plain numpy.
    tool, lean, pitch = EVERY_FORM["bull"], math.radians(20.0), 1.0
    axis = np.array([math.sin(lean), 0.0, math.cos(lean)])
    lowest = 3.0 * math.sin(lean) + 2.0 - 2.0 * math.cos(lean)
    drop = lowest - 2.0 + 2.0 * math.cos(lean)
    height = 2.0 - 2.0 * math.cos(lean) + 3.0 * math.sin(lean)
    tips = [[-30.0, 0.0, 50.0]]
    for y in np.arange(-3.0, 7.0, pitch):
        tips += [[-30.0, y, 50.0], [-30.0, y, height], [30.0, y, height], [30.0, y, 50.0]]
    found = fine_measure(
        [Plane(end=(2.0, 2.0))], moves_of([leaning_section(tool, tips, [axis] * len(tips))]), 0.1
    )
    # The torus is all points 2 from its circle of radius 3: what a point beside has left is its distance to the swept circle.
    turn = np.linspace(0.0, 2.0 * math.pi, 400_001)
    across, level = np.cross(axis, [0.0, 1.0, 0.0]), np.array([0.0, 1.0, 0.0])
    circle = (
        2.0 * axis
        + 3.0 * (np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * level)
        + [0.0, 0.0, height]
    )
    assert drop == approx(3.0 * math.sin(lean))
    true = np.hypot(circle[:, 1] - pitch / 2, circle[:, 2]).min() - 2.0
    assert found.scallop.value == approx(true, abs=FINE_BOUND)
    assert found.gouge.value == approx(0.0, abs=FINE_BOUND)


def test_two_operations_5_microns_apart_make_a_step_of_5_microns():
    flat = EVERY_FORM["flat"]
    sections = [
        passes(flat, [2.0], operation="first"),
        passes(flat, [10.0], z=-0.005, operation="second"),
    ]
    found = fine_measure([Plane(end=(4.0, 9.0))], moves_of(sections), 0.2)
    assert found.step.value == approx(0.005, abs=FINE_BOUND)
    assert found.step.position[1] == approx(5.0, abs=0.3) and found.gouge.value == approx(
        0.005, abs=FINE_BOUND
    )
    assert found.scallop.value == approx(0.0, abs=FINE_BOUND)


def test_ball_passes_of_two_operations_5_microns_apart_are_told_by_their_valleys():
    ball = EVERY_FORM["ball"]
    sections = [
        passes(ball, np.arange(-1.0, 2.1, 0.5)),
        passes(ball, np.arange(2.5, 6.0, 0.5), z=-0.005),
    ]
    found = fine_measure([Plane(end=(1.0, 4.0))], moves_of(sections), 0.05)
    assert found.step.value == approx(0.005, abs=FINE_BOUND)


def test_two_faces_that_one_pass_leaves_at_two_heights_make_a_step():
    faces = [Plane(1, (0.0, 0.0), (2.0, 2.0)), Plane(2, (0.0, 2.0), (2.0, 4.0), -0.003)]
    found = fine_measure(faces, moves_of([passes(EVERY_FORM["flat"], [2.0])]), 0.2)
    assert found.step.value == approx(0.003, abs=FINE_BOUND) and set(found.face) == {1, 2}


@pytest.mark.parametrize("tilt", [0.0, 0.02])
def test_a_dip_between_the_samples_of_its_map_is_found(tilt):
    # A ball's tip plunges 4 um deep in a spot 0.4 mm wide; a tilted rim cuts a far narrower strip.
    tool = EVERY_FORM["ball" if tilt == 0.0 else "flat"]
    axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    # The rim's lowest place comes to where the ball's tip does.
    tip = np.array([1.234, 2.345, -0.004]) + (
        5.0 * np.array([-math.cos(tilt), 0.0, math.sin(tilt)]) if tilt else 0.0
    )
    section = leaning_section(tool, [tip + 20.0 * axis, tip, tip + 20.0 * axis], [axis] * 3)
    found = fine_measure([Plane()], moves_of([section]), 1.0)
    # What enters by the rim is as deep as it is far from end and flank at once.
    assert found.gouge.value == approx(0.004 / (math.sin(tilt) + math.cos(tilt)), abs=FINE_BOUND)


def test_an_axis_that_turns_keeps_its_ball_on_the_plane():
    tool, lean = EVERY_FORM["ball"], 0.5
    axes = np.array([[0, 0, 1.0], [math.sin(lean), 0, math.cos(lean)]])
    tips = []
    for y in np.arange(-1.0, 3.0, 0.5):
        # In small steps, as a post writes them: the tip's chords leave the ball's centre line by under a tenth of a micron.
        for x in np.linspace(-2.0, 4.0, 121):
            a = axes[0] + (x + 2.0) / 6.0 * (axes[1] - axes[0])
            a /= np.linalg.norm(a)
            tips.append((np.array([x, y, 5.0]) - 5.0 * a, a))
        tips += [
            (tips[-1][0] + 30.0 * tips[-1][1], tips[-1][1]),
            (np.array([-2.0, y, 40.0]), axes[0]),
        ]
    tips = [(tips[0][0] + [0, 0, 40.0], axes[0]), *tips]
    found = fine_measure(
        [Plane(end=(2.0, 2.0))],
        moves_of([leaning_section(tool, [t for t, _ in tips], [a for _, a in tips])]),
        0.2,
    )
    assert (
        found.scallop.value == approx(scallop(5.0, 0.5), abs=2 * FINE_BOUND)
        and found.gouge.value < 2 * FINE_BOUND
    )


def test_a_box_keeps_the_rest_of_a_face_out():
    found = fine_measure(
        [Plane()],
        moves_of([passes(EVERY_FORM["flat"], [1.0])]),
        0.2,
        low=[0.0, 0.0, -1.0],
        high=[4.0, 2.0, 1.0],
    )
    assert found.point[:, 1].max() < 2.0 and found.scallop.value == approx(0.0, abs=1e-9)
    with pytest.raises(BadInput, match="nothing to measure"):
        fine_measure(
            [Plane()],
            moves_of([passes(EVERY_FORM["flat"], [1.0])]),
            low=[9.0, 9.0, 9.0],
            high=[10.0, 10.0, 10.0],
        )


def test_rings_leave_the_scallop_of_their_pitch():
    # Quarter rings about (20, 0): on the line through their middle the passes are parallel.
    tool, pitch, turn = EVERY_FORM["ball"], 1.0, 0.1
    sections = []
    for r in np.arange(15.0, 22.0, pitch):
        ends = [[20.0 - r * math.cos(turn), sign * r * math.sin(turn), 0.0] for sign in (1.0, -1.0)]
        sections.append(
            leaning_section(tool, ends, [UP] * 2, centre=[20.0, 0.0, 0.0], motion=Motion.ARC_CCW)
        )
    found = fine_measure([Plane(start=(0.0, -0.05), end=(3.0, 0.05))], moves_of(sections), 0.1)
    assert found.scallop.value == approx(scallop(5.0, pitch), abs=FINE_BOUND)


def test_any_number_of_threads_measures_the_same_and_it_stops_when_asked():
    moves = moves_of([passes(EVERY_FORM["ball"], np.arange(-1.0, 5.0, 0.7))])
    one, three = (fine_measure([Plane(end=(2.0, 2.0))], moves, 0.2, threads=n) for n in (1, 3))
    assert (
        one.residual.tobytes() == three.residual.tobytes()
        and one.scallop.value == three.scallop.value
    )
    with pytest.raises(Cancelled):
        fine_measure([Plane()], moves, 0.05, progress=Progress(cancelled=lambda: True))


def test_an_exact_face_knows_its_surface_in_any_frame():
    part, axis = read(oblique_cylinder_shape()), np.array([0.5, 0.0, math.cos(math.radians(30.0))])
    frame = Frame(np.array([3.0, 4.0, 5.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    faces = [ExactFace(part, tag, frame) for tag in part.tags]
    side = max(faces, key=lambda f: f.at(np.array([[f.bounds()[0], f.bounds()[2]]])).bend.max())
    u0, u1, v0, v1 = side.bounds()
    at = side.at(np.random.default_rng(0).uniform([u0, v0], [u1, v1], (50, 2)))
    points, normals = frame.to_world(at.point), frame.world_direction(at.normal)
    out = points - (points @ axis)[:, None] * axis
    assert np.linalg.norm(out, axis=1) == approx(np.full(50, 10.0)) and normals == approx(
        out / 10.0
    )
    assert at.bend.max(axis=1) == approx(np.full(50, 11.0))
    # On a cylinder of radius 10 the normal turns by a tenth of what the point moves about the axis.
    assert at.normal_du == approx(at.du / 10.0) and at.normal_dv == approx(np.zeros((50, 3)))
    assert side.inside(np.array([[u0 + 0.1, v0 + 1.0], [u0 + 0.1, v1 + 1.0]])).tolist() == [
        True,
        False,
    ]


def test_a_pole_has_the_normal_beside_it():
    part = read(ball_shape())
    for tag in part.tags:
        face = ExactFace(part, tag, WORLD)
        u0, _, v0, v1 = face.bounds()
        at = face.at(np.array([[u0, v0], [u0, v1]]))
        assert np.linalg.norm(at.normal, axis=1) == approx([1.0, 1.0])


def test_the_top_of_a_block_is_measured_on_its_own_face():
    part = read(box_shape())
    top = next(
        tag
        for tag in part.tags
        if part.graph().box_low[tag - 1][2] > 19.0
        or part.graph().box_low[tag - 1][2] == part.high[2]
    )
    z, pitch = float(part.high[2]), 0.8
    middle = 0.5 * (part.low + part.high)
    moves = moves_of(
        [
            passes(
                EVERY_FORM["ball"],
                np.arange(part.low[1] - 1.0, part.high[1] + 2.0, pitch),
                z=z,
                x=(-60.0, 60.0),
            )
        ]
    )
    found = fine_measure(
        [ExactFace(part, top, WORLD)],
        moves,
        0.2,
        low=middle - [1.0, 1.0, 50.0],
        high=middle + [1.0, 1.0, 50.0],
    )
    assert found.scallop.value == approx(scallop(5.0, pitch), abs=FINE_BOUND) and set(
        found.face
    ) == {top}
    with pytest.raises(BadInput, match="face 99"):
        ExactFace(part, 99, WORLD)


def test_faces_are_named_by_their_tags_and_figures_told_with_their_places():
    assert faces_named("face 12, face 13") == (12, 13) == faces_named("12 13 12")
    with pytest.raises(BadCall, match="name faces by their tags"):
        faces_named("the floor")
    nowhere = np.full(3, np.nan)
    figures = FineResult(
        faces=(12,),
        scallop=0.0123,
        scallop_at=np.array([1.0, 2.0, 3.0]),
        gouge=0.0,
        gouge_at=nowhere,
        step=0.005,
        step_at=np.zeros(3),
        lower="floor-1",
        bound=0.0002,
    )
    assert fine_dict(figures)["gouge_at"] is None and fine_dict(figures)["scallop_at"] == [
        1.0,
        2.0,
        3.0,
    ]
    assert "highest scallop  0.0123 mm at x 1.000 y 2.000 z 3.000" in fine_text(figures)


def test_both_sides_of_a_block_are_measured_with_the_programs_of_both_setups(monkeypatch):
    part, pitch = read(box_shape(4.0, 3.0, 2.0)), 0.8
    middle = 0.5 * (part.low + part.high)
    frames = [
        Frame(
            np.array([*middle[:2], part.high[2]]),
            np.array([1.0, 0.0, 0.0]),
            np.array([0.0, 0.0, 1.0]),
        ),
        Frame(
            np.array([*middle[:2], part.low[2]]),
            np.array([1.0, 0.0, 0.0]),
            np.array([0.0, 0.0, -1.0]),
        ),
    ]
    programs = tuple(
        Program(
            name=f"S{k}",
            setup=replace(SETUP, name=f"S{k}", frame=frame),
            sections=(
                passes(
                    EVERY_FORM["ball"],
                    np.arange(-3.0, 3.5, pitch),
                    z=-0.003 * k,
                    x=(-9.0, 9.0),
                    operation=f"face-{k}",
                ),
            ),
        )
        for k, frame in enumerate(frames)
    )
    monkeypatch.setattr(fine_faces, "read_back", lambda session, posted, machines: programs)
    bench = SimpleNamespace(
        context_of=lambda session: SimpleNamespace(part=part, shop=SimpleNamespace(machines={}))
    )
    session = SimpleNamespace(posted=("a program",))
    level = [
        tag
        for tag in part.tags
        if part.graph().box_low[tag - 1][2] == approx(part.graph().box_high[tag - 1][2], abs=1e-3)
    ]
    for tag in level:
        found = measure_fine(bench, session, [tag], 0.5)
        below = bool(found.scallop_at[2] == approx(part.low[2]))
        assert found.scallop == approx(scallop(5.0, pitch) - 0.003 * below, abs=2 * FINE_BOUND)
        assert found.gouge == approx(0.003 * below, abs=2 * FINE_BOUND)
    with pytest.raises(BadCall, match="no programs yet"):
        measure_fine(bench, SimpleNamespace(posted=()), level, 2.0)


def test_a_call_for_faces_without_tags_is_one_line_and_exit_2(capsys):
    assert main(["verify", "x.step", "--fine", "the floor"]) == BAD
    assert main(["verify", "x.step", "--fine", "12", "--fine-spacing", "0"]) == BAD
    assert len(capsys.readouterr().err.strip().splitlines()) == 2
