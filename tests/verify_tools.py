"""Tools, paths and small plans of faces that the tests of the proof share."""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.material import Axis, Machine
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.tool import Holder, Tool
from trunnion.part.shape.surfaces import (
    STRIP_COLUMNS,
    ContactFace,
    Guide,
    Profile,
    circle_edges,
    level_face,
    line_edges,
    strips_of,
    surfaces_from,
)
from trunnion.progress import NO_PROGRESS
from trunnion.verify.judge.verdict import prove_surfaces
from trunnion.verify.settings import ProofSettings

HOLDER = Holder(name="test holder", rows=((0.0, 12.0, 10.0, 20.0), (10.0, 20.0, 40.0, 20.0)))


def flat(diameter):
    """Return a maker of flat cutters of a diameter: `flat(10.0)(flute=25.0)`."""
    return bull(diameter, 0.0)


def bull(diameter, corner):
    """Return a maker of cutters of a diameter and a corner radius."""
    form = "flat" if corner == 0.0 else "ball" if corner == diameter / 2 else "bull"

    def make(flute=30.0, number=1):
        return tool_of(
            form, diameter=diameter, corner_radius=corner, flute_length=flute, number=number
        )

    return make


def tool_of(form, *, diameter=10.0, flute_length=30.0, **fields):
    """Return a tool of a form, with a neck 1 mm long and 1 mm thinner, a shank of 2 mm and the test holder unless fields say otherwise."""
    plain = {
        "number": 1,
        "name": f"{form} {diameter:g}",
        "form": form,
        "corner_radius": 0.0,
        "neck_diameter": diameter - 1.0,
        "neck_length": flute_length + 1.0,
        "shank_diameter": diameter,
        "stickout": flute_length + 3.0,
        "gauge_length": flute_length + 60.0,
        "teeth": 3,
        "centre_cutting": True,
        "helix_angle": 30.0,
        "holder": HOLDER,
    }
    return Tool(diameter=diameter, flute_length=flute_length, **{**plain, **fields})


FORMS = {
    "flat": tool_of("flat"),
    "bull": tool_of("bull", corner_radius=2.0),
    "ball": tool_of("ball", corner_radius=5.0, flute_length=8.0),
    "taper": tool_of(
        "taper",
        diameter=6.0,
        corner_radius=1.0,
        taper_angle=10.0,
        flute_length=20.0,
        neck_diameter=13.0,
        shank_diameter=13.0,
    ),
    "taper ball": tool_of(
        "taper", diameter=4.0, corner_radius=2.0, taper_angle=5.0, flute_length=12.0
    ),
    "barrel": tool_of(
        "barrel", corner_radius=2.0, barrel_radius=60.0, flute_length=28.0, neck_diameter=9.0
    ),
    "t-slot": tool_of(
        "t-slot",
        diameter=20.0,
        corner_radius=0.5,
        flute_length=6.0,
        neck_diameter=8.0,
        neck_length=16.0,
        shank_diameter=12.0,
        stickout=20.0,
    ),
    "drill": tool_of("drill", diameter=8.0, point_angle=120.0),
    "reamer": tool_of("reamer", diameter=8.0, lead=1.0, fit="H7"),
    "boring-bar": tool_of(
        "boring-bar", diameter=9.0, smallest=8.0, lead=0.4, flute_length=4.0, neck_diameter=7.0
    ),
    "tap": tool_of("tap", diameter=8.0, pitch=1.25, lead=3.0, neck_diameter=6.0),
    "thread mill": tool_of(
        "thread-mill", diameter=6.0, pitch=1.0, flute_length=9.0, neck_diameter=4.5
    ),
    "single tooth": tool_of(
        "thread-mill",
        diameter=8.0,
        pitch_low=1.0,
        pitch_high=2.0,
        flute_length=8.0,
        neck_diameter=5.0,
        neck_length=40.0,
        stickout=45.0,
    ),
    # A cone, an arc that bends outwards, a cylinder, and a cone that goes in again.
    "form": tool_of(
        "form",
        diameter=14.0,
        flute_length=20.0,
        outline=(
            (1.0, 0.0, 0.0),
            (4.0, 2.0, 0.09),
            (7.0, 5.0, 0.0),
            (7.0, 12.0, 0.0),
            (5.0, 20.0, 0.0),
        ),
        neck_diameter=10.0,
    ),
}
"""One tool of every form, all short enough to touch with every part of it."""


def supports_of(tool):
    """Return a tool's convex parts from below, written anew: rows of arcs (r, z, radius, first and last angle), z low, z high, what it is.

    An arc stands for the lines that touch it; their normals' angles are from straight out, upwards. The depth of a point is its smallest
    distance to all these lines.
    """
    parts = [_cutting(tool)]
    parts += [
        ([_line(math.atan2(r0 - r1, z1 - z0), r0, z0)], z0, z1, (r0, r1), 1)
        for z0, r0, z1, r1 in tool.profile()
    ]
    found = []
    for k, (rows, low, high, (below, above), kind) in enumerate(parts):
        under, over = (
            (parts[k - 1][3][1] if k else 0.0),
            (parts[k + 1][3][0] if k + 1 < len(parts) else 0.0),
        )
        if not k or below > under + 1e-9:
            rows = [(below, low, 0.0, DOWN, rows[0][3]), *rows]
        if above > over + 1e-9:
            rows = [*rows, (above, high, 0.0, rows[-1][4], -DOWN)]
        found.append((rows, low, high, kind))
    return found


def joined_supports_of(tool):
    """Return what `supports_of` does, with the corner of each joint where the outline bends outwards: a neighbour's side may be nearer."""
    parts = supports_of(tool)
    ends = [(rows[0][3], rows[-1][4]) for rows, *_ in parts]
    for k in range(1, len(parts)):
        (_, below), (above, _) = ends[k - 1], ends[k]
        # A free face, which looks straight down or up, belongs to a step; the others meet at the radius that a line has at the joint.
        if DOWN < below < above < -DOWN:
            rows, low = parts[k][:2]
            corner = (next(r for r, z, *_ in rows if z == low), low, 0.0, below, above)
            for at in (k - 1, k):
                parts[at] = ([*parts[at][0], corner], *parts[at][1:])
    return parts


DOWN = -math.pi / 2


def _cutting(tool):
    r, c, top = tool.radius, tool.corner_radius, tool.flute_length
    if tool.form == "taper":
        lean = math.radians(tool.taper_angle)
        edge = r - c + c * math.cos(lean) + (top - c + c * math.sin(lean)) * math.tan(lean)
        return [(r - c, c, c, DOWN, -lean)], 0.0, top, (r - c, edge), 0
    if tool.form == "barrel":
        across, height = r - tool.barrel_radius, tool.widest_height
        touch, end = math.atan2(c - height, -across), math.asin((top - height) / tool.barrel_radius)
        rows = [(0.0, c, c, DOWN, touch), (across, height, tool.barrel_radius, touch, end)]
        return rows, 0.0, top, (0.0, across + tool.barrel_radius * math.cos(end)), 0
    if tool.form == "t-slot":
        return (
            [(r - c, c, c, DOWN, 0.0), (r - c, top - c, c, 0.0, -DOWN)],
            0.0,
            top,
            (r - c, r - c),
            0,
        )
    if tool.form == "drill":
        half = math.radians(tool.point_angle) / 2
        return (
            [(0.0, 0.0, 0.0, DOWN, -half), (r, r / math.tan(half), 0.0, -half, 0.0)],
            0.0,
            top,
            (0.0, r),
            0,
        )
    if tool.form in ("reamer", "boring-bar"):
        edge = r - tool.lead
        rows = [(edge, 0.0, 0.0, DOWN, 0.5 * DOWN), (r, tool.lead, 0.0, 0.5 * DOWN, 0.0)]
        return rows, 0.0, top, (edge, r), 0
    if tool.form == "tap":
        # D - 1.082532 P, the basic minor diameter of ISO 68-1.
        core = 0.5 * (tool.diameter - 1.0825317547305484 * tool.pitch)
        return [(core, 0.0, 0.0, DOWN, 0.0)], 0.0, top, (core, core), 0
    if tool.form == "thread-mill":
        # 5/8 H = 0.541266 P; the single tooth goes (P_high - P_low) sqrt(3) / 16 deeper.
        high = tool.pitch or tool.pitch_high
        extra = 0.0 if tool.pitch else math.sqrt(3.0) / 16.0 * (high - tool.pitch_low)
        core = r - 0.5412658773652742 * high - extra
        return [(core, 0.0, 0.0, DOWN, 0.0)], 0.0, top, (core, core), 0
    if tool.form == "form":
        # The outline of FORMS: what a bulge of 0.09 between (4, 2) and (7, 5) is, by its half angle of 2 atan 0.09.
        half = 2.0 * math.atan(0.09)
        radius = math.hypot(3.0, 3.0) / 2.0 / math.sin(half)
        away = radius * math.cos(half) * math.sqrt(0.5)
        cone, middle, slope = -math.atan2(3.0, 2.0), -math.pi / 4, math.atan2(2.0, 8.0)
        rows = [
            (1.0, 0.0, 0.0, DOWN, cone),
            (4.0, 2.0, 0.0, cone, middle - half),
            (5.5 - away, 3.5 + away, radius, middle - half, middle + half),
            (7.0, 5.0, 0.0, middle + half, 0.0),
            (7.0, 12.0, 0.0, 0.0, slope),
        ]
        return rows, 0.0, top, (1.0, 5.0), 0
    return [(r - c, c, c, DOWN, 0.0)], 0.0, top, (r - c, r), 0


def _line(angle, r, z):
    return r, z, 0.0, angle, angle


def plain_depth(part, rho, h, rise=0.0):
    """Return how deep points (n,) are in one of `supports_of`, swept upwards by `rise`; -inf above and below its ends."""
    rows, low, high, _ = part
    depth = np.full(np.shape(rho), np.inf)
    for r, z, radius, first, last in rows:
        for a, b, at in (
            (first, min(last, 0.0), np.minimum(h, high)),
            (max(first, 0.0), last, np.maximum(h - rise, low)),
        ):
            if a <= b:
                middle, angle = (a + b) / 2, np.arctan2(at - z, rho - r)
                nearest = middle + np.clip(
                    np.remainder(angle - middle + math.pi, math.tau) - math.pi,
                    a - middle,
                    b - middle,
                )
                depth = np.minimum(
                    depth, radius - np.cos(nearest) * (rho - r) - np.sin(nearest) * (at - z)
                )
    return np.where((h >= low) & (h <= high + rise), depth, -np.inf)


def program_section(tool, stops, operation="op", rapid_to=0):
    """Return a section whose blocks go to the stops: a point, (point, None), or (point, centre) for an anticlockwise arc.

    Blocks up to index `rapid_to` are rapids.
    """
    points, centres = [], []
    for stop in stops:
        point, centre = stop if len(stop) == 2 else (stop, None)
        points.append(point)
        centres.append([np.nan] * 3 if centre is None else [*centre[:2], 0.0])
    n = len(points)
    motion = [
        Motion.RAPID
        if k <= rapid_to
        else Motion.LINE
        if np.isnan(centres[k][0])
        else Motion.ARC_CCW
        for k in range(n)
    ]
    path = Toolpath(
        position=points,
        axis=[[0.0, 0.0, 1.0]] * n,
        motion=motion,
        centre=centres,
        feed=[0.0 if m == Motion.RAPID else 1000.0 for m in motion],
        mark=[0] * n,
    )
    return ProgramSection(operation=operation, tool=tool, spindle=10000.0, path=path)


# A block 60 x 36 x 18 with its zero in the middle of the bottom; a rounded pocket 36 x 20 about (5, 0), floor at 8, corners R4, fillet R2.
BLOCK_LOW, BLOCK_HIGH = (-30.0, -18.0, 0.0), (30.0, 18.0, 18.0)
POCKET_LOW, POCKET_HIGH, FLOOR, TOP, CORNER, FILLET = (
    (-13.0, -10.0),
    (23.0, 10.0),
    8.0,
    18.0,
    4.0,
    2.0,
)
TAGS = {
    "top": 1,
    "floor": 2,
    "bottom": 3,
    "outside": 4,
    "wall": 8,
    "corner": 12,
    "fillet": 16,
    "corner fillet": 20,
}
"""The first tag of each kind of face; four of a kind follow each other: right, upper, left, lower."""


def rounded(low, high, radius):
    """Return the edges in plan of a rectangle with rounded corners."""
    edges = []
    for _, start, end, centre, angle in sides(low, high, radius):
        edges += line_edges(np.array([start, end]))
        if radius:
            edges += circle_edges(*centre, radius, angle, angle + math.pi / 2)
    return edges


def sides(low, high, radius):
    """Yield each side of a rounded rectangle anticlockwise: guide with w inwards, start, end, then the centre and angle of its corner."""
    (x0, y0), (x1, y1), r = low[:2], high[:2], radius
    for k, (start, end, centre) in enumerate(
        (
            ((x1, y0 + r), (x1, y1 - r), (x1 - r, y1 - r)),
            ((x1 - r, y1), (x0 + r, y1), (x0 + r, y1 - r)),
            ((x0, y1 - r), (x0, y0 + r), (x0 + r, y0 + r)),
            ((x0 + r, y0), (x1 - r, y0), (x1 - r, y0 + r)),
        )
    ):
        dx, dy = np.sign(end[0] - start[0]), np.sign(end[1] - start[1])
        yield Guide(0, *start, dx, dy), start, end, centre, k * math.pi / 2


def block_with_pocket():
    """Return the faces of the block."""
    faces = [
        level_face(
            TAGS["top"],
            TOP,
            rounded(BLOCK_LOW, BLOCK_HIGH, 0.0) + rounded(POCKET_LOW, POCKET_HIGH, CORNER),
        ),
        level_face(
            TAGS["floor"],
            FLOOR,
            rounded(np.add(POCKET_LOW, FILLET), np.subtract(POCKET_HIGH, FILLET), CORNER - FILLET),
        ),
        level_face(TAGS["bottom"], 0.0, rounded(BLOCK_LOW, BLOCK_HIGH, 0.0), -1.0),
    ]
    for k, (guide, start, end, *_) in enumerate(sides(BLOCK_LOW, BLOCK_HIGH, 0.0)):
        faces.append(
            _swept(
                TAGS["outside"] + k,
                guide,
                Profile(0.0, 0.0, 0.0, 1.0),
                0.0,
                TOP,
                0.0,
                math.dist(start, end),
                -1.0,
            )
        )
    for k, (guide, start, end, centre, angle) in enumerate(sides(POCKET_LOW, POCKET_HIGH, CORNER)):
        length, about, quarter = math.dist(start, end), Guide(1, *centre), angle + math.pi / 2
        faces.append(
            _swept(
                TAGS["wall"] + k,
                guide,
                Profile(0.0, 0.0, 0.0, 1.0),
                FLOOR + FILLET,
                TOP,
                0.0,
                length,
                1.0,
            )
        )
        faces.append(
            _swept(
                TAGS["corner"] + k,
                about,
                Profile(CORNER, 0.0, 0.0, 1.0),
                FLOOR + FILLET,
                TOP,
                angle,
                quarter,
                -1.0,
            )
        )
        faces.append(
            _swept(
                TAGS["fillet"] + k,
                guide,
                Profile(FILLET, FLOOR + FILLET, radius=FILLET),
                math.pi,
                1.5 * math.pi,
                0.0,
                length,
                -1.0,
            )
        )
        faces.append(
            _swept(
                TAGS["corner fillet"] + k,
                about,
                Profile(CORNER - FILLET, FLOOR + FILLET, radius=FILLET),
                1.5 * math.pi,
                2 * math.pi,
                angle,
                quarter,
                -1.0,
            )
        )
    return surfaces_from(faces)


def _swept(tag, guide, profile, u0, u1, s0, s1, side):
    edges = line_edges(np.array([[s0, u0], [s1, u0], [s1, u1], [s0, u1], [s0, u0]]))
    return ContactFace(
        tag, strips_of(guide, profile, edges, side), np.zeros((0, STRIP_COLUMNS)), np.zeros((0, 4))
    )


BLANK = Box(frame=WORLD, low=BLOCK_LOW, high=(30.0, 18.0, 20.0), material="test", density=2.8)
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=30.0, machine="test mill")
MACHINE = Machine(
    name="test mill",
    title="test mill",
    axes=tuple(
        Axis(name=n, kind="linear", low=0.0, high=600.0, rapid=20000.0, acceleration=3000.0)
        for n in "XYZ"
    ),
    spindle_low=100.0,
    spindle_high=20000.0,
    power=((100.0, 1.0), (20000.0, 20.0)),
    feed_max=10000.0,
    tool_change_s=5.0,
    tool_places=20,
)
FACING, POCKETING = flat(16.0)(number=1), bull(6.0, 2.0)(flute=8.0, number=2)


def facing(z=TOP):
    """Return the stops of rows that face the block's top."""
    stops = [(-45.0, -18.0, 30.0), (-45.0, -18.0, z)]
    for k, y in enumerate(np.linspace(-18.0, 18.0, 4)):
        left, right = (-45.0, y, z), (45.0, y, z)
        stops += [left, right] if k % 2 == 0 else [right, left]
    return [*stops, (*stops[-1][:2], 30.0)]


def ring(off, z, tool_radius=3.0):
    """Return the stops of one ring around the pocket, its cutter `off` mm clear of the walls, as points and (point, arc centre)."""
    d = tool_radius + off
    radius = max(CORNER - d, 0.0)
    stops = []
    for _, start, end, centre, _ in sides(
        np.add(POCKET_LOW, d), np.subtract(POCKET_HIGH, d), radius
    ):
        if not stops:
            stops.append((*start, z))
        stops.append((*end, z))
        if radius:
            turn = (end[0] - centre[0], end[1] - centre[1])
            stops.append(((centre[0] - turn[1], centre[1] + turn[0], z), centre))
    return stops


def pocketing(skip_walls=False, approach=20.5):
    """Return the stops that clear the pocket by rings from the middle out, level by level; walls, fillets and floor are finished by it."""
    offs = [6.0, 4.5, 3.0, 1.5] if skip_walls else [6.0, 4.5, 3.0, 1.5, 0.0]
    stops = [(-4.0, 0.0, 30.0), (-4.0, 0.0, approach)]
    for z in (16.0, 14.0, 12.0, 10.0, FLOOR):
        stops += [(-4.0, 0.0, z), (14.0, 0.0, z)]
        for off in offs:
            stops += ring(off, z)
        stops.append((-4.0, 0.0, z))
    return [*stops, (-4.0, 0.0, 30.0)]


def proof(
    *sections,
    blank=BLANK,
    tools=(POCKETING,),
    progress=NO_PROGRESS,
    machine=MACHINE,
    material=None,
    setup=SETUP,
    facets=None,
    **choices,
):
    """Return the verdict on sections that cut the block."""
    program = Program(name="test", setup=setup, sections=sections)
    chosen = ProofSettings(**{"cell": 0.5, "spacing": 1.0, **choices})
    return prove_surfaces(
        (program,),
        (block_with_pocket(),),
        blank,
        tools,
        (machine,),
        chosen,
        progress,
        planned_faces=range(1, 24),
        material=material,
        facets=facets,
    )


def clean_plan(pocket=None, tool=POCKETING, extra=()):
    """Return the sections of the clean plan; `extra` are feed stops added at the end of the pocket's, from above and up again."""
    face = program_section(FACING, facing(), operation="face", rapid_to=1)
    stops = pocketing() if pocket is None else pocket
    if extra:
        stops = [*stops, (*extra[0][:2], 30.0), *extra, (*extra[-1][:2], 30.0)]
    return face, program_section(tool, stops, operation="pocket", rapid_to=1)
