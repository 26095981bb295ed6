"""Pictures of a session without a window: features by colour, toolpaths by motion, deviation of the finished part.

pyvista is imported late: a report is written once, and a command that writes none should not pay for it.
"""

from __future__ import annotations

import importlib
import io
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.mesh import Mesh
from trunnion.model.feature import Recognition
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.report.deviation import DeviationMap, deviation_map
from trunnion.report.lines import (
    AXIS,
    MOST_STROKES,
    MOTIONS,
    RAPID,
    STROKE_EVERY,
    STROKE_LENGTH,
    kinds_of,
    opened,
    strokes,
)
from trunnion.report.palette import Colour, Palette
from trunnion.report.points_in_view import seen_from
from trunnion.settings import checked, choose
from trunnion.verify.settings import ProofSettings

if TYPE_CHECKING:
    from pyvista import Plotter

SIZE = (1600, 1000)
FILLED = 0.92
"""How far what is drawn may reach from the middle of a picture towards its border."""
_NAMED_POINTS = 5
"""Worst positions whose figure is written on the deviation's picture."""
_SOLID_RAPIDS, _FAINTEST = 600.0, 0.03
"""Rapids up to this number are drawn solid; more are drawn the fainter the more they are, down to this opacity, or they hide the cuts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A written picture: file name and the words under it."""

    file: str
    caption: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnPicture:
    """A picture that is not written yet: what it shows (the middle of its file's name), the words under it, the bytes of its PNG file."""

    subject: str
    caption: str
    data: bytes


def load_graphics() -> None:
    """Load what pictures are drawn with, ahead of the first one."""
    importlib.import_module("pyvista.plotting.plotter")


def warm_graphics() -> None:
    """Load what pictures are drawn with and open a first, empty one, which takes what the driver needs to begin."""
    load_graphics()
    _plotter().close()


def write_pictures(
    session: Session,
    mesh: Mesh,
    folder: Path,
    name: str,
    palette: Palette,
    progress: Progress = NO_PROGRESS,
    plan: Sequence[DrawnPicture] | None = None,
) -> tuple[Picture, ...]:
    """Write the pictures of a session as PNG files `NAME.*.png` into a folder and return them in the order of the work.

    Those of its plan are drawn here unless they are given.
    """
    if plan is None:
        plan = draw_plan(session, mesh, palette, progress.part(0.0, 0.6))
    made = []
    for drawn in (*plan, *draw_proof(session, mesh, palette, progress.part(0.6, 1.0))):
        picture = Picture(file=f"{name}.{drawn.subject}.png", caption=drawn.caption)
        (folder / picture.file).write_bytes(drawn.data)
        made.append(picture)
    return tuple(made)


def draw_plan(
    session: Session, mesh: Mesh, palette: Palette, progress: Progress = NO_PROGRESS
) -> tuple[DrawnPicture, ...]:
    """Return the pictures of what stands before the proof: features and toolpaths, as far as there are some."""
    made = []
    progress.aside(lambda _: load_graphics(), "drawing pictures")
    if session.recognition is not None:
        progress.at(0.1, "drawing the features")
        data = _shoot(_features(session, mesh, palette), progress)
        caption = features_caption(session.recognition, palette)
        made.append(DrawnPicture(subject="features", caption=caption, data=data))
    if any(len(p.path) for p in session.paths):
        progress.at(0.5, "drawing the toolpaths")
        data = _shoot(_toolpaths(session, mesh, palette), progress)
        caption = "Toolpaths by kind of motion"
        made.append(DrawnPicture(subject="toolpaths", caption=caption, data=data))
    return tuple(made)


def draw_proof(
    session: Session, mesh: Mesh, palette: Palette, progress: Progress = NO_PROGRESS
) -> tuple[DrawnPicture, ...]:
    """Return the pictures of a proof: the deviation of the finished part; none before it."""
    if session.verdict is None or not len(session.verdict.deviation.face):
        return ()
    progress.at(0.0, "drawing the deviation")
    settings = checked(choose(ProofSettings, session.choices))
    shown = deviation_map(
        mesh, session.verdict.deviation, settings.tolerance, settings.allowance, progress
    )
    plotter, seen = _deviation(session, mesh, shown, palette, progress)
    data = _shoot(plotter, progress)
    return (DrawnPicture(subject="deviation", caption=deviation_caption(shown, seen), data=data),)


def _plotter() -> Plotter:
    if sys.platform.startswith("linux"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        # Without it pyvista opens a window of an X server on trial, for a warning that a window without a screen does not need.
        os.environ.setdefault("ALLOW_PLOTTING", "true")
    import pyvista
    from vtkmodules.vtkRenderingCore import vtkMapper

    # One switch for all of VTK, which a window in this process may have set: edges are drawn before the faces that they lie in.
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    made = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    made.set_background("white")
    made.render_window.SetMultiSamples(0)
    made.enable_anti_aliasing("ssaa")
    return made


def _shoot(plotter: Plotter, progress: Progress) -> bytes:
    """Return the bytes of a picture's PNG file."""
    from PIL import Image

    progress.check()
    drawn = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()

    def encoded(_: Progress) -> bytes:
        stream = io.BytesIO()
        Image.fromarray(drawn).save(stream, "PNG")
        return stream.getvalue()

    return progress.aside(encoded)


def _surface(points: Floats, triangles: Ints) -> Any:
    import pyvista

    cells = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    return pyvista.PolyData(np.asarray(points), cells)


def _look(plotter: Plotter, session: Session) -> Plotter:
    frame = session.recognition.frame if session.recognition else None
    if frame is None:
        plotter.view_isometric()
        return plotter
    towards = frame.world_direction(np.array([-0.35, -0.8, 1.1]))
    plotter.view_vector(tuple(towards), viewup=tuple(frame.z))
    plotter.camera.zoom(FILLED / _reach(plotter))
    return plotter


def _reach(plotter: Plotter) -> float:
    """Return how far what is drawn reaches from the middle of the picture; 1 is its border."""
    bounds = np.reshape(plotter.bounds, (3, 2))
    corners = np.array([(*corner, 1.0) for corner in product(*bounds)])
    seen = plotter.camera.GetCompositeProjectionTransformMatrix(SIZE[0] / SIZE[1], -1.0, 1.0)
    projected = corners @ np.array(
        [[seen.GetElement(row, column) for row in range(4)] for column in range(4)]
    )
    return float(np.abs(projected[:, :2] / projected[:, 3:]).max())


def _legend(plotter: Plotter, entries: Mapping[str, Colour]) -> None:
    left, top, line = 30, SIZE[1] - 60, 34
    for n, (word, colour) in enumerate(entries.items()):
        # VTK's built-in font has no filled square: two letters on a ground of their own colour make one.
        key = plotter.add_text("MM", position=(left, top - n * line), font_size=9, color=colour)
        key.prop.background_color, key.prop.background_opacity = colour, 1.0
        plotter.add_text(
            word, position=(left + 50, top - n * line - 4), font_size=12, color="black"
        )


def _colours(mesh: Mesh, by_face: Mapping[int, Colour], rest: Colour) -> Any:
    table = np.tile(np.array(rest, dtype=np.uint8), (int(mesh.face.max()) + 1, 1))
    for face, colour in by_face.items():
        table[face] = colour
    return table[mesh.face]


def _features(session: Session, mesh: Mesh, palette: Palette) -> Plotter:
    plotter, surface = _plotter(), _surface(mesh.points, mesh.triangles)
    recognition = session.recognition
    assert recognition is not None
    own = palette.features(recognition, recognition.neighbours)
    by_face = {tag: own[f.id] for f in reversed(recognition.features) for tag in f.tags}
    surface.cell_data["colour"] = _colours(mesh, by_face, palette.kind("unexplained"))
    plotter.add_mesh(surface, scalars="colour", rgb=True, ambient=0.25, diffuse=0.8)
    _outline(plotter, surface)
    _legend(plotter, feature_legend(recognition, palette))
    return _look(plotter, session)


def features_caption(recognition: Recognition, palette: Palette) -> str:
    """Return what the picture of the features shows: the heading of the first kind that has one, else features by kind."""
    found = (palette.kinds[k].heading for k in recognition.counts() if k in palette.kinds)
    return next(filter(None, found), "Features by kind")


def feature_legend(recognition: Recognition, palette: Palette) -> dict[str, Colour]:
    """Return what the colours of features mean: kinds with their number, or the classes of a kind with theirs."""
    return {
        f"{colour_class.label} {n}": colour_class.colours[0]
        for colour_class, n in palette.classes(recognition.features).items()
    }


def _outline(plotter: Plotter, surface: Any) -> None:
    edges = surface.clean().extract_feature_edges(
        feature_angle=25, boundary_edges=False, non_manifold_edges=False
    )
    if edges.n_cells:
        plotter.add_mesh(edges, color=(60, 66, 74), line_width=1.2)


def _toolpaths(session: Session, mesh: Mesh, palette: Palette) -> Plotter:
    plotter, surface = _plotter(), _surface(mesh.points, mesh.triangles)
    plotter.add_mesh(surface, color=palette.motion("part"), ambient=0.3)
    setups = {s.name: s for s in session.setups}
    operations = {o.id: o for o in session.process.operations} if session.process else {}
    gathered: dict[str, list[Floats]] = {}
    size = float(np.ptp(mesh.points, axis=0).max())
    for made in session.paths:
        if len(made.path) and made.operation in operations:
            _gather(gathered, made.path, setups[operations[made.operation].setup], size)
    for word, pieces in gathered.items():
        count = sum(map(len, pieces))
        plotter.add_mesh(
            _segments(pieces),
            color=palette.motion(word),
            line_width=1.0,
            lighting=False,
            opacity=max(min(1.0, _SOLID_RAPIDS / count), _FAINTEST) if word == RAPID else 1.0,
        )
    _legend(plotter, {word.replace("_", " "): palette.motion(word) for word in gathered})
    return _look(plotter, session)


def _gather(gathered: dict[str, list[Floats]], path: Toolpath, setup: Setup, size: float) -> None:
    points, block = opened(path)
    kind = kinds_of(path)[block]
    world = setup.frame.to_world(points)
    ends = np.stack([world[:-1], world[1:]], axis=1)
    for row in dict.fromkeys(kind.tolist()):
        gathered.setdefault(MOTIONS[row], []).append(ends[kind == row])
    axis_strokes = strokes(path, STROKE_EVERY * size, STROKE_LENGTH * size, MOST_STROKES)
    if len(axis_strokes):
        gathered.setdefault(AXIS, []).append(
            setup.frame.to_world(axis_strokes.reshape(-1, 3)).reshape(-1, 2, 3)
        )


def _segments(pieces: Iterable[Floats]) -> Any:
    import pyvista

    ends = np.concatenate(list(pieces))
    lines = np.column_stack(
        [np.full(len(ends), 2), np.arange(2 * len(ends)).reshape(-1, 2)]
    ).ravel()
    return pyvista.PolyData(ends.reshape(-1, 3), lines=lines)


def _deviation(
    session: Session, mesh: Mesh, shown: DeviationMap, palette: Palette, progress: Progress
) -> tuple[Plotter, Bools]:
    """Return the picture of a map, and which of its worst positions (k,) are seen; the worst of these have their figures in it."""
    progress.check()
    plotter = _plotter()
    surface = _surface(shown.points, shown.triangles)
    surface.point_data["colour"] = palette.deviation.at(
        shown.value, shown.low, shown.high, shown.limit
    )
    plotter.add_mesh(surface, scalars="colour", rgb=True, ambient=0.35, diffuse=0.7)
    _outline(plotter, _surface(mesh.points, mesh.triangles))
    _legend(plotter, deviation_legend(shown, palette))
    _look(plotter, session)
    points = np.array([w.point for w in shown.worst]).reshape(-1, 3)
    seen = seen_from(np.array(plotter.camera.position), points, mesh)
    named = np.flatnonzero(seen)[:_NAMED_POINTS]
    if len(named):
        plotter.add_point_labels(
            points[named],
            [fine_length(shown.worst[row].deviation) for row in named],
            font_size=15,
            text_color="black",
            shape_color="white",
            shape_opacity=0.85,
            point_color="black",
            point_size=8,
            always_visible=True,
            shape="rounded_rect",
            margin=4,
            reset_camera=False,
        )
    return plotter, seen


def deviation_caption(shown: DeviationMap, seen: Bools) -> str:
    """Return the words under a deviation's picture: the worst positions, and by `seen` (k,) which of them are on the far side."""
    words = "Deviation of the finished part: + is material left, - is gouge"
    worst = [
        f"face {w.face} {fine_length(w.deviation)}" + ("" if there else " (not seen from here)")
        for w, there in zip(shown.worst[:_NAMED_POINTS], seen, strict=False)
    ]
    return f"{words}; worst: {', '.join(worst)}" if worst else words


def deviation_legend(shown: DeviationMap, palette: Palette) -> dict[str, Colour]:
    """Return what the colours of a map mean: the ends of both families, their beginnings and middles, and what is finished."""
    above = (shown.limit, 0.5 * (shown.limit + shown.high), np.nextafter(shown.high, np.inf))
    below = (np.nextafter(shown.low, -np.inf), 0.5 * (shown.low - shown.limit), -shown.limit)
    values = np.array([*above, 0.0, *below])
    words = [
        f"{fine_length(v)}{more}"
        for v, more in zip(above, (" or more left", "", " left"), strict=True)
    ]
    words += [
        "finished",
        *(
            f"{fine_length(v)}{more}"
            for v, more in zip(below, (" gouge", "", " or deeper"), strict=True)
        ),
    ]
    colours = palette.deviation.at(values, shown.low, shown.high, shown.limit)
    return {word: (int(r), int(g), int(b)) for word, (r, g, b) in zip(words, colours, strict=True)}


def fine_length(millimetres: float) -> str:
    """Return a small length with its sign in words: µm below a millimetre.

    >>> fine_length(-0.05), fine_length(1.5)
    ('-50 µm', '+1.50 mm')
    """
    microns = 1000.0 * millimetres
    return f"{microns:+.0f} µm" if abs(microns) < 999.5 else f"{millimetres:+.2f} mm"
