"""What an eye sees of a part, and what a picture of deviations says of what it does not."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

import samples
from trunnion.geometry.mesh import Mesh
from trunnion.progress import NO_PROGRESS
from trunnion.report.deviation import DeviationMap, WorstPoint
from trunnion.report.pictures import deviation_caption
from trunnion.report.points_in_view import seen_from

CORNERS = np.array([[x, y, z] for x in (-5.0, 5.0) for y in (-5.0, 5.0) for z in (-5.0, 5.0)])
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
NORMALS = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]], float)


def cubes(*offsets: tuple[float, float, float]) -> Mesh:
    """Return cubes of 10 mm as one mesh."""
    triangles = np.array([t for a, b, c, d in SIDES for t in ((a, b, c), (a, c, d))])
    return Mesh(
        np.vstack([CORNERS + np.array(at) for at in offsets]),
        np.vstack([triangles + 8 * k for k in range(len(offsets))]),
        np.tile(np.repeat(np.arange(1, 7), 2), len(offsets)),
    )


DIRECTION = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: max(map(abs, v)) > 0.1)
INSIDE = st.floats(-4.0, 4.0)


@example(direction=(-1.0, 1.0, 1.0), side=1, u=-3.0, v=-3.0).via("between two triangles")
@settings(deadline=None)
@given(direction=DIRECTION, side=st.integers(0, 5), u=INSIDE, v=INSIDE)
def test_of_a_convex_body_those_points_are_seen_whose_faces_look_at_the_eye(direction, side, u, v):
    eye = 60.0 * np.array(direction) / max(map(abs, direction))
    normal = NORMALS[side]
    point = 5.0 * normal + u * np.roll(np.abs(normal), 1) + v * np.roll(np.abs(normal), 2)
    towards = float((eye - point) @ normal)
    if abs(towards) > 1.0:
        assert seen_from(eye, point[None], cubes((0.0, 0.0, 0.0)))[0] == (towards > 0.0)


def test_what_stands_before_another_body_hides_it():
    both = cubes((0.0, 0.0, 0.0), (30.0, 0.0, 0.0))
    points = np.array([[25.0, 1.0, 2.0], [35.0, 1.0, 2.0], [30.0, 1.0, 5.0]])
    assert seen_from(np.array([-200.0, 0.0, 0.0]), points, both).tolist() == [False, False, False]
    assert seen_from(np.array([200.0, 0.0, 30.0]), points, both).tolist() == [False, True, True]
    assert not len(seen_from(np.zeros(3), np.zeros((0, 3)), both))


def test_the_caption_names_what_is_not_seen():
    none = np.zeros((0, 3))
    shown = DeviationMap(
        points=none,
        triangles=none.astype(int),
        face=np.zeros(0, int),
        value=np.zeros(0),
        low=-0.02,
        high=0.02,
        limit=0.05,
        worst=(
            WorstPoint(face=3, point=(0.0, 0.0, 0.0), deviation=-0.05),
            WorstPoint(face=81, point=(0.0, 0.0, 9.0), deviation=14.0),
        ),
    )
    assert deviation_caption(shown, np.array([True, False])).endswith(
        "worst: face 3 -50 µm, face 81 +14.00 mm (not seen from here)"
    )


def test_figures_are_those_of_the_worst_that_are_seen(monkeypatch):
    """Six places at the back are worse than the one in front: its figure is written all the same, and the caption names the five worst."""
    import pyvista

    from trunnion.pipeline import Engine
    from trunnion.report.palette import load_palette
    from trunnion.report.pictures import _deviation

    session = Engine().open(samples.written(samples.block_with_pocket_shape()))
    mesh = cubes((0.0, 0.0, 0.0))
    written = []
    monkeypatch.setattr(
        pyvista.Plotter, "add_point_labels", lambda _, points, labels, **__: written.extend(labels)
    )
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    behind, before = low + [1.0, 1.0, 0.0], high - [1.0, 1.0, 0.0]
    shown = DeviationMap(
        points=mesh.points,
        triangles=mesh.triangles,
        face=mesh.face,
        value=np.zeros(len(mesh.points)),
        low=-0.02,
        high=0.02,
        limit=0.05,
        worst=tuple(
            WorstPoint(face=n, point=tuple(behind.tolist()), deviation=14.0) for n in range(6)
        )
        + (WorstPoint(face=9, point=tuple(before.tolist()), deviation=0.2),),
    )
    plotter, seen = _deviation(session, mesh, shown, load_palette(), NO_PROGRESS)
    plotter.close()
    assert seen.tolist() == [False] * 6 + [True]
    assert written == ["+200 µm"]
    assert deviation_caption(shown, seen).count("face") == 5
