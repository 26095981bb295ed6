"""The blank: a box, a round bar or a turned envelope around the part, one that is turned to size, or what a file holds."""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.meridian_outline import meridian_outline
from trunnion.geometry.mesh import Mesh
from trunnion.geometry.turned_outline import outer_meridian
from trunnion.geometry.turned_state import round_and_straight, turned_state
from trunnion.model.blank import AXES, Blank, Box, Faceted, Revolved
from trunnion.model.material import Material
from trunnion.recognize.revolution import RevolutionAxis, of_revolution
from trunnion.settings import setting, settings
from trunnion.tolerance import CHORD, COINCIDENT

AUTOMATIC, BOX, CYLINDER, TURNED, FINISH_TURNED, RING_TURNED, FILE = (
    "auto",
    "box",
    "cylinder",
    "turned",
    "finish-turned",
    "ring-turned",
    "file",
)
KINDS = (AUTOMATIC, BOX, CYLINDER, TURNED, FINISH_TURNED, RING_TURNED, FILE)
LEVELS = 64
"""Bands along the axis that a turned envelope follows the part in: of 2 mm on a wheel of 120 mm."""
DECIMALS = 7
"""Decimals of a radius in mm: ten times finer than two points are told apart."""


@settings("blank")
class BlankSettings:
    """What the blank is, how much larger than the part, and what it is made of."""

    kind: str = setting(
        AUTOMATIC,
        choices=KINDS,
        label="Kind of blank",
        help="A box, a round bar or a turned envelope around the part; turned to size: finish-turned by its own meridian, ring-turned "
        "with even rings where bosses stand; or the solid of a file. auto: what parts of the family are usually cut from, a box for most.",
    )
    side: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Side allowance",
        help="Material on each of the four sides; on what is round beyond the part, and at the ends of a lying bar.",
    )
    top: float = setting(
        2.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Top allowance",
        help="Material over the part's top, a wheel's front.",
    )
    bottom: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Bottom allowance",
        help="Material under the part's bottom, a wheel's back.",
    )
    axis: str = setting(
        "z",
        choices=AXES,
        label="Axis of the bar",
        help="The axis of the part's frame that a round bar lies along; z: it stands.",
    )
    diameter: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Diameter of the bar",
        help="Diameter of a round bar; 0: what the part needs and the side allowance.",
    )
    bored: bool = setting(
        False,
        label="Bored",
        help="Whether a turned envelope has the part's through bore already, with the bore allowance.",
    )
    bore: float = setting(
        2.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Bore allowance",
        help="Material inside the bore of a turned envelope that is bored.",
    )
    file: str = setting(
        "",
        label="File of the blank",
        files=(".step", ".stp", ".iges", ".igs", ".stl"),
        help="STEP, IGES or STL file of a blank of kind file, in the part's coordinates.",
    )
    material: str = setting(
        "EN AW-7075",
        label="Material",
        catalogue="materials",
        help="Name of a material of the catalogue.",
    )


def make_blank(
    frame: Frame, low: Floats, high: Floats, material: Material, settings: BlankSettings
) -> Box:
    """Return the box blank of a part whose box in `frame` reaches from `low` to `high` (3,) mm."""
    low, high = _allowed(low, high, settings)
    return Box(frame=frame, low=low, high=high, material=material.name, density=material.density)


def make_bar(
    frame: Frame,
    low: Floats,
    high: Floats,
    points: Floats,
    material: Material,
    settings: BlankSettings,
) -> Revolved:
    """Return the round bar of a part whose box in `frame` reaches from `low` to `high` (3,) mm; points (v, 3) are its own there.

    Its axis goes through the middle of the box.
    """
    k = AXES.index(settings.axis)
    across = [(k + 1) % 3, (k + 2) % 3]
    middle = 0.5 * (np.asarray(low) + np.asarray(high))
    middle[k] = 0.0
    needed = float(np.linalg.norm((points - middle)[:, across], axis=1).max()) + settings.side
    radius = 0.5 * settings.diameter or round(needed, DECIMALS)
    first, last = _allowed(low, high, settings)
    return Revolved.cylinder(
        frame.moved(middle),
        radius,
        (float(first[k]), float(last[k])),
        material.name,
        material.density,
        settings.axis,
    )


def make_envelope(
    frame: Frame, points: Floats, triangles: Ints, material: Material, settings: BlankSettings
) -> Revolved:
    """Return the turned envelope of a part whose triangles (t, 3) of points (v, 3) are given in `frame`: the outermost meridian of all its
    faces about the frame's z, with the allowances beyond it.

    Recesses of the ends are filled. Raises `BadInput` where the part is nowhere round the axis.
    """
    level, outer, inner = outer_meridian(points, triangles, LEVELS)
    near = np.abs(level[:, None] - level) <= settings.side
    radius = np.where(near, outer, 0.0).max(axis=1) + settings.side + CHORD
    level = level.copy()
    level[0] -= settings.bottom
    level[-1] += settings.top
    hollow = inner - settings.bore if settings.bored else 0.0
    hollow = max(0.0, hollow - CHORD)
    outline = np.vstack([[hollow, level[0]], np.column_stack([radius, level]), [hollow, level[-1]]])
    if radius.min() <= hollow + COINCIDENT:
        raise BadInput("the bore leaves nothing of the envelope: set blank.bored = no")
    return Revolved(
        frame=frame,
        outline=np.round(_straightened(outline), DECIMALS),
        material=material.name,
        density=material.density,
    )


def make_ring_turned(frame: Frame, mesh: Mesh, graph: FaceGraph, material: Material) -> Revolved:
    """Return what is left of a part's surroundings, its mesh in the part's coordinates, when all that turning about the frame's z reaches
    is turned to size: faces of revolution are done, rings stand where other features rise from them."""
    return Revolved(
        frame=frame,
        outline=ring_turned_outline(frame, mesh, graph),
        material=material.name,
        density=material.density,
    )


def ring_turned_outline(frame: Frame, mesh: Mesh, graph: FaceGraph) -> Floats:
    """Return the outline (k, 2) of that blank: radius and height about the frame's z in mm, anticlockwise."""
    turned = of_revolution(graph, RevolutionAxis(point=frame.origin, direction=frame.z))
    outline = turned_state(
        frame.to_local(mesh.points),
        mesh.triangles,
        mesh.face,
        *round_and_straight(turned, graph.surface),
    )
    return np.round(outline, DECIMALS)


def make_finish_turned(
    frame: Frame, points: Floats, triangles: Ints, face: Ints, material: Material
) -> Revolved:
    """Return the blank whose turned faces are finished: what the part's triangles (t, 3) of points (v, 3) with tags `face` (t,), given in
    `frame`, sweep about its z.

    Raises `BadInput` where the part is in pieces about that axis.
    """
    try:
        outline = meridian_outline(points, triangles, face)
    except ValueError as reason:
        raise BadInput(f"no finish-turned blank: {reason}; choose blank.kind = turned") from None
    return Revolved(
        frame=frame,
        outline=np.round(outline, DECIMALS),
        material=material.name,
        density=material.density,
    )


def _straightened(outline: Floats) -> Floats:
    """Return an outline without the points that lie on the line between their neighbours."""
    before, after = np.roll(outline, 1, axis=0), np.roll(outline, -1, axis=0)
    along, step = after - before, outline - before
    off = np.abs(along[:, 0] * step[:, 1] - along[:, 1] * step[:, 0])
    return outline[off > COINCIDENT * np.maximum(np.linalg.norm(along, axis=1), COINCIDENT)]


def make_faceted(
    frame: Frame, points: Floats, triangles: Ints, material: Material, source: str
) -> Blank:
    """Return the blank inside triangles (t, 3) of points (v, 3) of the part's coordinates, in `frame`.

    Raises `ValueError` when they enclose no solid.
    """
    return Faceted(
        frame=frame,
        points=frame.to_local(points),
        triangles=triangles,
        material=material.name,
        density=material.density,
        source=source,
    )


def _allowed(low: Floats, high: Floats, settings: BlankSettings) -> tuple[Floats, Floats]:
    """Return the corners of a part's box with the allowances."""
    below = np.array([settings.side, settings.side, settings.bottom])
    above = np.array([settings.side, settings.side, settings.top])
    return np.asarray(low) - below, np.asarray(high) + above
