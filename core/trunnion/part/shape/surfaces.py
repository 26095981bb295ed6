"""Which exact surface lies under every trimmed face, as plain arrays for a vertical tool: strips and level regions.

A *strip* is a profile (w, z) carried along a guide in plan, between two ends. With a vertical tool axis every plane, every cylinder with
a vertical or level axis, and every cone, torus and sphere about a vertical axis is one, exactly:

    vertical or sloped plane       line guide, straight profile
    level cylinder (floor fillet)  line guide, arc profile
    vertical cylinder, cone        arc guide, straight profile in (r, z)
    torus, sphere                  arc guide, arc profile in (r, z)

The trim is read from the edges' own curves in the surface's parameters: the face is cut into bands at every vertex, and a band's two ends
are lines or circles in (s, u), s along the guide and u along the profile. Level planes are regions: an outline of lines and arcs for the
question whether a point is inside, strips of one point for their boundary. What none of this fits is only
listed, in `Surfaces.free`: `part/shape/facets.py` has it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame
from trunnion.part.topology.canonical import xyz
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

# Columns of a strip.
(
    GUIDE,
    OX,
    OY,
    DX,
    DY,
    PROFILE,
    PW0,
    PZ0,
    PW1,
    PZ1,
    U0,
    U1,
    L_KIND,
    LA,
    LB,
    LC,
    L_SIGN,
    R_KIND,
    RA,
    RB,
    RC,
    R_SIGN,
    FIXED,
    L_COS,
    L_SIN,
    R_COS,
    R_SIN,
    M_COS,
    M_SIN,
    H_COS,
    BX0,
    BY0,
    BX1,
    BY1,
    BZ0,
    BZ1,
    SIDE,
) = range(37)
"""GUIDE 0 line, 1 arc; O its origin or centre, D its direction (a line's w grows to the left of it, an arc's w is its radius, s its angle).
PROFILE 0 straight from (PW0, PZ0) at U0 to (PW1, PZ1) at U1; 1 an arc about (PW0, PZ0) of radius PW1, u its angle, monotone in w and z.
Ends left and right: kind 0 is s = A + B (u - U0), kind 1 is s = A + SIGN sqrt(B^2 - (u - C)^2); FIXED when both are constant, then the
cosines and sines of an arc's ends, of its middle, and the cosine of half its sweep. B: the box. SIDE (t_z, -t_w) is the outward normal,
t the profile's direction."""
STRIP_COLUMNS = 37

# Columns of an outline's edge: both ends, then of an arc its centre and radius, positive when it goes anticlockwise; 0 for a line.
EX0, EY0, EX1, EY1, ECX, ECY, ERADIUS = range(7)
EDGE_COLUMNS = 7
FEWEST_CHORDS, MOST_CHORDS = 8, 4096
"""Chords that follow an edge whose curve in the surface's parameters is neither a line nor a circle."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Surfaces:
    """The trimmed faces of a part in a frame. f faces in rows, m strips, r level regions, c edges of their outlines.

    tag (f,); strip (m, 37) with face row strip_face (m,); boundaries of level faces are strips of one point. level (k, 37) and level_face
    (k,): the areas of level faces as strips, for samples. region_z (r,), region_face (r,), region_box (r, 4), region_start (r + 1,) into
    outline (c, 7), whose arcs are less than half a turn. free (k,): rows of the faces without closed form, of which nothing else is here.
    """

    tag: Ints
    strip: Floats
    strip_face: Ints
    level: Floats
    level_face: Ints
    region_z: Floats
    region_face: Ints
    region_box: Floats
    region_start: Ints
    outline: Floats
    free: Ints

    def __post_init__(self) -> None:
        object.__setattr__(self, "tag", ints(self.tag, (None,), "tag"))
        for name in ("strip", "level"):
            rows = floats(getattr(self, name), (None, STRIP_COLUMNS), name)
            object.__setattr__(self, name, rows)
            object.__setattr__(
                self,
                f"{name}_face",
                ints(getattr(self, f"{name}_face"), (len(rows),), f"{name}_face"),
            )
        n = len(np.asarray(self.region_z))
        object.__setattr__(self, "region_z", floats(self.region_z, (n,), "region_z"))
        object.__setattr__(self, "region_face", ints(self.region_face, (n,), "region_face"))
        object.__setattr__(self, "region_box", floats(self.region_box, (n, 4), "region_box"))
        object.__setattr__(self, "region_start", ints(self.region_start, (n + 1,), "region_start"))
        object.__setattr__(self, "outline", floats(self.outline, (None, EDGE_COLUMNS), "outline"))
        object.__setattr__(self, "free", ints(self.free, (None,), "free"))


@dataclass(frozen=True, slots=True)
class TrimEdge:
    """A piece of a trim, monotone in s and u: a line from (s0, u0) to (s1, u1), or (radius > 0) a quarter or less of a circle about
    (sc, uc) on the side `sign` of s."""

    s0: float
    u0: float
    s1: float
    u1: float
    sc: float = 0.0
    uc: float = 0.0
    radius: float = 0.0
    sign: float = 0.0

    def s_at(self, u: float) -> float:
        """Return s where the edge passes u."""
        if self.radius:
            return self.sc + self.sign * math.sqrt(max(self.radius**2 - (u - self.uc) ** 2, 0.0))
        share = (u - self.u0) / (self.u1 - self.u0) if self.u1 != self.u0 else 0.0
        return self.s0 + (self.s1 - self.s0) * min(max(share, 0.0), 1.0)

    def end_columns(self, u0: float, u1: float) -> tuple[float, float, float, float, float]:
        """Return the five columns of an end for a band from u0 to u1."""
        if self.radius:
            return 1.0, self.sc, self.radius, self.uc, self.sign
        a, b = self.s_at(u0), self.s_at(u1)
        # An end that moves by less than the noise of its file is constant, and constant ends are the quick ones.
        return (
            (0.0, 0.5 * (a + b), 0.0, 0.0, 0.0)
            if abs(b - a) < tolerance.PARAMETRIC
            else (0.0, a, (b - a) / (u1 - u0), 0.0, 0.0)
        )


@dataclass(frozen=True, slots=True)
class Guide:
    """A guide in plan: kind 0 a line through (x, y) along the unit (dx, dy), kind 1 arcs about (x, y)."""

    kind: int
    x: float
    y: float
    dx: float = 0.0
    dy: float = 0.0


@dataclass(frozen=True, slots=True)
class Profile:
    """A profile: straight, (w, z) = (w, z) + u (dw, dz); or with a radius, an arc about (w, z) whose parameter is its angle."""

    w: float
    z: float
    dw: float = 0.0
    dz: float = 0.0
    radius: float = 0.0

    def at(self, u: float) -> tuple[float, float]:
        """Return (w, z) at a parameter."""
        if self.radius:
            return self.w + self.radius * math.cos(u), self.z + self.radius * math.sin(u)
        return self.w + u * self.dw, self.z + u * self.dz

    def unit_lengths(self, u: Floats, turned: bool) -> tuple[Floats, float]:
        """Return how many mm a unit of s (k,) and one of u are at parameters u (k,); `turned` where s is an angle about an axis."""
        along = self.w + (self.radius * np.cos(u) if self.radius else u * self.dw)
        return np.abs(along) if turned else np.ones(len(u)), self.radius or 1.0

    def levels(self, low: float, high: float) -> list[float]:
        """Return the parameters between which the profile is monotone in w and z."""
        if not self.radius:
            return []
        quarter = math.pi / 2
        return [
            k * quarter for k in range(math.ceil(low / quarter), math.floor(high / quarter) + 1)
        ]


def line_edges(points: Floats) -> list[TrimEdge]:
    """Return the edges of a chain of points (k, 2) in (s, u)."""
    return [
        TrimEdge(a[0], a[1], b[0], b[1])
        for a, b in zip(points[:-1].tolist(), points[1:].tolist(), strict=True)
    ]


def circle_edges(sc: float, uc: float, radius: float, start: float, end: float) -> list[TrimEdge]:
    """Return the edges of a circle's arc in (s, u) between two angles, cut where it turns back."""
    low, high = min(start, end), max(start, end)
    quarter = math.pi / 2
    cuts = [
        low,
        *(k * quarter for k in range(math.ceil(low / quarter), math.floor(high / quarter) + 1)),
        high,
    ]
    edges = []
    for a, b in pairwise(cuts):
        if b - a > tolerance.PARAMETRIC:
            sign = 1.0 if math.cos(0.5 * (a + b)) > 0 else -1.0
            edges.append(
                TrimEdge(
                    sc + radius * math.cos(a),
                    uc + radius * math.sin(a),
                    sc + radius * math.cos(b),
                    uc + radius * math.sin(b),
                    sc,
                    uc,
                    radius,
                    sign,
                )
            )
    return edges


def strips_of(
    guide: Guide,
    profile: Profile,
    edges: list[TrimEdge],
    side: float,
    progress: Progress = NO_PROGRESS,
) -> Floats | None:
    """Return the strips (m, 37) of a face trimmed by edges in (s, u), or None when the edges don't close."""
    ends = [u for e in edges for u in (e.u0, e.u1)]
    if not ends:
        return np.zeros((0, STRIP_COLUMNS))
    levels = np.array(_distinct(ends + profile.levels(min(ends), max(ends))))
    # Each edge goes from level to level; ends that nearly meet are on the same one, so that bands hold whole edges however thin they are.
    spans = [
        sorted((np.searchsorted(levels, (e.u0, e.u1), side="right") - 1).tolist()) for e in edges
    ]
    rows = []
    for k, (u0, u1) in enumerate(pairwise(levels.tolist())):
        progress.check()
        across = [e for e, (low, high) in zip(edges, spans, strict=True) if low <= k < high]
        if len(across) % 2:
            return None
        across.sort(key=lambda e: e.s_at(0.5 * (u0 + u1)))
        rows += [
            strip_row(guide, profile, u0, u1, left, right, side)
            for left, right in zip(across[::2], across[1::2], strict=True)
        ]
    return np.array(rows).reshape(-1, STRIP_COLUMNS)


def strip_row(
    guide: Guide,
    profile: Profile,
    u0: float,
    u1: float,
    left: TrimEdge,
    right: TrimEdge,
    side: float = 1.0,
) -> Floats:
    """Return one strip (37,) between two parameters of a profile and two ends."""
    row = np.zeros(STRIP_COLUMNS)
    row[[GUIDE, OX, OY, DX, DY]] = guide.kind, guide.x, guide.y, guide.dx, guide.dy
    (w0, z0), (w1, z1) = profile.at(u0), profile.at(u1)
    row[PROFILE] = float(profile.radius > 0.0)
    row[PW0 : PZ1 + 1] = (
        (profile.w, profile.z, profile.radius, 0.0) if profile.radius else (w0, z0, w1, z1)
    )
    row[[U0, U1, SIDE]] = u0, u1, side
    row[L_KIND : L_SIGN + 1] = left.end_columns(u0, u1)
    row[R_KIND : R_SIGN + 1] = right.end_columns(u0, u1)
    spread = [e.s_at(u) for e in (left, right) for u in (u0, u1)]
    low, high = min(spread), max(spread)
    if row[L_KIND] == row[R_KIND] == row[LB] == row[RB] == 0.0:
        row[FIXED], low, high = 1.0, row[LA], row[RA]
    if guide.kind:
        middle, half = 0.5 * (low + high), min(0.5 * (high - low), math.pi)
        row[L_COS : H_COS + 1] = (
            math.cos(low),
            math.sin(low),
            math.cos(high),
            math.sin(high),
            math.cos(middle),
            math.sin(middle),
            math.cos(half),
        )
    row[BX0 : BZ1 + 1] = _box(guide, (w0, w1), (z0, z1), low, high)
    return row


def point_strip(guide: Guide, w: float, z: float, low: float, high: float) -> Floats:
    """Return the strip (37,) of one edge of a level face: a guide at one offset and height, from s = low to s = high."""
    return strip_row(
        guide, Profile(w, z), 0.0, 0.0, TrimEdge(low, 0.0, low, 0.0), TrimEdge(high, 0.0, high, 0.0)
    )


def surfaces_from(faces: list[ContactFace]) -> Surfaces:
    """Return the arrays of faces given one by one."""
    empty = np.zeros((0, STRIP_COLUMNS))
    regions = [(row, f) for row, f in enumerate(faces) if len(f.outline)]
    starts = np.cumsum([0, *(len(f.outline) for _, f in regions)])
    return Surfaces(
        tag=np.array([f.tag for f in faces], dtype=int),
        strip=np.vstack([empty, *(f.strips for f in faces)]),
        strip_face=np.repeat(np.arange(len(faces)), [len(f.strips) for f in faces]),
        level=np.vstack([empty, *(f.level for f in faces)]),
        level_face=np.repeat(np.arange(len(faces)), [len(f.level) for f in faces]),
        region_z=np.array([f.z for _, f in regions]),
        region_face=np.array([row for row, _ in regions], dtype=int),
        region_box=np.array([_outline_box(f.outline) for _, f in regions]).reshape(-1, 4),
        region_start=starts,
        outline=np.vstack([np.zeros((0, EDGE_COLUMNS)), *(f.outline for _, f in regions)]),
        free=np.array([row for row, f in enumerate(faces) if f.is_free], dtype=int),
    )


@dataclass(frozen=True, slots=True, eq=False)
class ContactFace:
    """One face before it goes into `Surfaces`: strips (m, 37); of a level one also its area `level` (k, 37), outline (c, 7) and height.

    One without closed form `is_free`.
    """

    tag: int
    strips: Floats
    level: Floats
    outline: Floats
    z: float = 0.0
    is_free: bool = False


def level_face(
    tag: int, z: float, edges: list[TrimEdge], side: float = 1.0, progress: Progress = NO_PROGRESS
) -> ContactFace | None:
    """Return a level face from its outline's edges in plan (s is x, u is y); side +1 looks up, -1 down. None when the edges don't close."""
    boundary, outline, lying = [], [], []
    for e in progress.each(edges):
        if e.radius:
            a, b = math.atan2(e.u0 - e.uc, e.s0 - e.sc), math.atan2(e.u1 - e.uc, e.s1 - e.sc)
            b = a + (b - a + math.pi) % (2 * math.pi) - math.pi
            boundary.append(point_strip(Guide(1, e.sc, e.uc), e.radius, z, min(a, b), max(a, b)))
            outline.append([e.s0, e.u0, e.s1, e.u1, e.sc, e.uc, math.copysign(e.radius, b - a)])
            lying.append(e)
        elif (e.s0, e.u0) != (e.s1, e.u1):
            boundary.append(_line_strip((e.s0, e.u0), (e.s1, e.u1), z))
            outline.append([e.s0, e.u0, e.s1, e.u1, 0.0, 0.0, 0.0])
            lying.append(e)
    closed, bridges = closed_up(np.array(outline).reshape(-1, EDGE_COLUMNS))
    boundary += [_line_strip(row[:2], row[2:4], z) for row in bridges.tolist()]
    along, across = Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, z, 1.0, 0.0)
    level = strips_of(along, across, edges, -side, progress)
    if level is None:
        # Ends a little farther apart than rounding: the outline as it is closed for asking what is inside is that of the area.
        level = strips_of(along, across, _joined(lying, closed, bridges), -side, progress)
    if level is None:
        return None
    return ContactFace(
        tag,
        np.array(boundary).reshape(-1, STRIP_COLUMNS),
        level,
        np.vstack([closed, bridges]),
        z,
    )


def _joined(edges: list[TrimEdge], closed: Floats, bridges: Floats) -> list[TrimEdge]:
    """Return edges with their ends where `closed_up` has put them (c, 7), and the lines (b, 7) that bridge what gaps remain."""
    moved = [
        replace(e, s0=s0, u0=u0, s1=s1, u1=u1)
        for e, (s0, u0, s1, u1) in zip(edges, closed[:, :ECX].tolist(), strict=True)
    ]
    return moved + [TrimEdge(*row) for row in bridges[:, :ECX].tolist()]


def _line_strip(start: Sequence[float], end: Sequence[float], z: float) -> Floats:
    """Return the strip (37,) of a straight edge of a level face between two points (2,) in plan."""
    length = math.dist(start, end)
    along = Guide(0, start[0], start[1], (end[0] - start[0]) / length, (end[1] - start[1]) / length)
    return point_strip(along, 0.0, z, 0.0, length)


def closed_up(outline: Floats) -> tuple[Floats, Floats]:
    """Return an outline's edges (c, 7) with lines drawn to the ends that they meet, and lines (b, 7) that bridge what gaps remain.

    Whether a point is inside is decided by counting the edges a ray crosses; through a gap of one rounding error a ray slips uncounted, and
    the face would seem to cover its own openings. Ends meet when each is the other's nearest, no further than trimmed surfaces are sewn.
    Lines are moved by `tolerance.COINCIDENT` at most, arcs not at all: an end beside its circle would open the cap over its chord.
    """
    from scipy.spatial import cKDTree

    ends = outline[:, :ECX].reshape(-1, 2)
    if not len(ends):
        return outline, outline
    own = np.arange(len(ends))
    near = np.asarray(cKDTree(ends).query(ends, k=2, distance_upper_bound=tolerance.SEW)[1])
    other = np.where(near[:, 1] == own, near[:, 0], near[:, 1])
    other = np.where(other == len(ends), own, other)
    pairs = np.flatnonzero(
        (other[other] == own) & (own < other) & (ends != ends[other]).any(axis=1)
    )
    moved, bridges = ends.copy(), []
    straight = np.repeat(outline[:, ERADIUS] == 0.0, 2)
    for k, m in np.column_stack([pairs, other[pairs]]):
        if straight[[k, m]].any() and math.dist(ends[k], ends[m]) <= tolerance.COINCIDENT:
            to, end = (k, m) if straight[m] else (m, k)
            moved[end] = ends[to]
        else:
            bridges.append([*ends[k], *ends[m], 0.0, 0.0, 0.0])
    return np.hstack([moved.reshape(-1, ECX), outline[:, ECX:]]), np.array(bridges).reshape(
        -1, EDGE_COLUMNS
    )


def _outline_box(outline: Floats) -> list[float]:
    """Return the plan box (4,) of an outline's edges (c, 7): of their ends, and of the points where an arc turns back along x or y."""
    points = [outline[:, :EX1], outline[:, EX1:ECX]]
    arcs = outline[outline[:, ERADIUS] != 0.0]
    centre, radius, chord = (
        arcs[:, ECX:ERADIUS],
        np.abs(arcs[:, ERADIUS]),
        arcs[:, EX1:ECX] - arcs[:, :EX1],
    )
    for x, y in ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)):
        position = centre + radius[:, None] * [x, y]
        away = position - arcs[:, :EX1]
        left = chord[:, 0] * away[:, 1] - chord[:, 1] * away[:, 0]
        points.append(position[left * arcs[:, ERADIUS] <= 0.0])
    every = np.vstack(points)
    return [*every.min(axis=0).tolist(), *every.max(axis=0).tolist()]


def surfaces_of(part: Part, frame: Frame, progress: Progress = NO_PROGRESS) -> Surfaces:
    """Return the trimmed faces of a part in a frame, its z the tool's axis."""
    shapes = [(tag, part.face_shape(tag)) for tag in part.tags]
    return surfaces_from(
        [
            _face(tag, shape, frame, progress)
            for tag, shape in progress.over(shapes, "Reading the exact faces")
            if shape is not None
        ]
    )


def _distinct(values: list[float]) -> list[float]:
    out: list[float] = []
    for v in sorted(values):
        if not out or v - out[-1] > tolerance.COINCIDENT:
            out.append(v)
    return out


def _box(
    guide: Guide, w: tuple[float, float], z: tuple[float, float], low: float, high: float
) -> list[float]:
    if guide.kind:
        quarter = math.pi / 2
        angles = np.array(
            [
                low,
                high,
                *(
                    k * quarter
                    for k in range(math.ceil(low / quarter), math.floor(high / quarter) + 1)
                ),
            ]
        )
        x = guide.x + np.outer(w, np.cos(angles))
        y = guide.y + np.outer(w, np.sin(angles))
    else:
        x = np.array([guide.x - v * guide.dy + s * guide.dx for v in w for s in (low, high)])
        y = np.array([guide.y + v * guide.dx + s * guide.dy for v in w for s in (low, high)])
    return [x.min(), y.min(), x.max(), y.max(), min(z), max(z)]


# From here on CAD: one face's surface and edges, turned into the frame.


def _face(tag: int, shape: Any, frame: Frame, progress: Progress) -> ContactFace:
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType as Kind
    from OCP.TopoDS import TopoDS

    face = TopoDS.Face_s(shape.Oriented(_forward()))
    sign = 1.0 if shape.Orientation() == _forward() else -1.0
    surface = BRepAdaptor_Surface(face)
    kind = surface.GetType()
    made: ContactFace | None = None
    if kind == Kind.GeomAbs_Plane:
        made = _plane(tag, face, surface.Plane(), sign, frame, progress)
    elif kind in (
        Kind.GeomAbs_Cylinder,
        Kind.GeomAbs_Cone,
        Kind.GeomAbs_Torus,
        Kind.GeomAbs_Sphere,
    ):
        made = _round(tag, face, surface, sign, frame, progress)
    if made is not None:
        return made
    nothing = np.zeros((0, STRIP_COLUMNS))
    return ContactFace(tag, nothing, nothing, np.zeros((0, 4)), is_free=True)


def _forward() -> Any:
    from OCP.TopAbs import TopAbs_Orientation

    return TopAbs_Orientation.TopAbs_FORWARD


def _position(position: Any, frame: Frame) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the origin and the x, y and main directions of a surface's placement in a frame."""
    return (
        frame.to_local(xyz(position.Location())),
        frame.local_direction(xyz(position.XDirection())),
        frame.local_direction(xyz(position.YDirection())),
        frame.local_direction(xyz(position.Direction())),
    )


def _extent(face: Any) -> float:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(face, box)
    return math.sqrt(box.SquareExtent())


def _flat_enough(slope: float, extent: float) -> bool:
    """Return whether a slope over a face's extent stays far inside the bound of the contact engine."""
    return abs(slope) * extent < tolerance.CONTACT_BOUND / 4


def _plane(
    tag: int, face: Any, plane: Any, sign: float, frame: Frame, progress: Progress
) -> ContactFace | None:
    origin, x, y, _ = _position(plane.Position(), frame)
    normal = sign * np.cross(x, y)
    if _flat_enough(math.hypot(normal[0], normal[1]), _extent(face)):
        edges = _edges(face, np.array([x[:2], y[:2]]), origin[:2], progress)
        middle = origin[2] + np.mean(
            [
                [
                    (e.s0 - origin[0]) * -normal[0] / normal[2]
                    + (e.u0 - origin[1]) * -normal[1] / normal[2]
                ]
                for e in edges
            ]
            or [[0.0]]
        )
        return level_face(tag, float(middle), edges, math.copysign(1.0, normal[2]), progress)
    along = np.array([-normal[1], normal[0], 0.0]) / math.hypot(normal[0], normal[1])
    up = np.cross(normal, along)
    across = np.array([-along[1], along[0], 0.0])
    edges = _edges(
        face, np.array([[x @ along, x @ up], [y @ along, y @ up]]), np.zeros(2), progress
    )
    guide = Guide(0, origin[0], origin[1], along[0], along[1])
    dw = 0.0 if abs(up @ across) < tolerance.PARAMETRIC else float(up @ across)
    side = math.copysign(1.0, (normal @ across) * up[2] - normal[2] * dw)
    strips = strips_of(guide, Profile(0.0, origin[2], dw, up[2]), edges, side, progress)
    return (
        None
        if strips is None
        else ContactFace(tag, strips, np.zeros((0, STRIP_COLUMNS)), np.zeros((0, 4)))
    )


def _round(
    tag: int, face: Any, surface: Any, sign: float, frame: Frame, progress: Progress
) -> ContactFace | None:
    from OCP.GeomAbs import GeomAbs_SurfaceType as Kind

    kind = surface.GetType()
    shape = {
        Kind.GeomAbs_Cylinder: surface.Cylinder,
        Kind.GeomAbs_Cone: surface.Cone,
        Kind.GeomAbs_Torus: surface.Torus,
        Kind.GeomAbs_Sphere: surface.Sphere,
    }[kind]()
    origin, x, y, axis = _position(shape.Position(), frame)
    extent = _extent(face)
    if _flat_enough(math.hypot(axis[0], axis[1]), extent):
        up = math.copysign(1.0, axis[2])
        turn = math.copysign(1.0, x[0] * y[1] - x[1] * y[0])
        phase = math.atan2(x[1], x[0])
        if kind == Kind.GeomAbs_Cylinder:
            profile, outward = Profile(shape.Radius(), origin[2], 0.0, up), up
        elif kind == Kind.GeomAbs_Cone:
            lean = shape.SemiAngle()
            profile, outward = (
                Profile(shape.RefRadius(), origin[2], math.sin(lean), up * math.cos(lean)),
                up,
            )
        else:
            major, minor = (
                (shape.MajorRadius(), shape.MinorRadius())
                if kind == Kind.GeomAbs_Torus
                else (0.0, shape.Radius())
            )
            profile, outward = Profile(major, origin[2], radius=minor), 1.0
        v_scale = up if profile.radius else 1.0
        edges = _edges(
            face,
            np.array([[turn, 0.0], [0.0, v_scale]]),
            np.array([phase, 0.0]),
            progress,
            partial(profile.unit_lengths, turned=True),
        )
        # A right-handed placement's natural normal points away from the axis; a left-handed one's points towards it.
        handed = math.copysign(1.0, np.cross(x, y) @ axis)
        side = sign * outward * handed
        guide = Guide(1, origin[0], origin[1])
    elif kind == Kind.GeomAbs_Cylinder and _flat_enough(axis[2], extent):
        along = np.array([axis[0], axis[1], 0.0]) / math.hypot(axis[0], axis[1])
        across = np.array([-along[1], along[0], 0.0])
        phase = math.atan2(x[2], x @ across)
        turn = math.copysign(1.0, (x @ across) * y[2] - x[2] * (y @ across))
        profile, guide = (
            Profile(0.0, origin[2], radius=shape.Radius()),
            Guide(0, origin[0], origin[1], along[0], along[1]),
        )
        edges = _edges(
            face,
            np.array([[0.0, turn], [1.0, 0.0]]),
            np.array([0.0, phase]),
            progress,
            partial(profile.unit_lengths, turned=False),
        )
        side = sign * math.copysign(1.0, np.cross(x, y) @ axis)
    else:
        return None
    strips = strips_of(guide, profile, edges, side, progress)
    return (
        None
        if strips is None
        else ContactFace(tag, strips, np.zeros((0, STRIP_COLUMNS)), np.zeros((0, 4)))
    )


UnitLengths = Callable[[Floats], tuple[Floats, float]]
"""From u (k,) to how many mm a unit of s (k,) and one of u are there."""


def _in_mm(u: Floats) -> tuple[Floats, float]:
    return np.ones(len(u)), 1.0


def _edges(
    face: Any, matrix: Floats, shift: Floats, progress: Progress, unit_lengths: UnitLengths = _in_mm
) -> list[TrimEdge]:
    """Return the face's edges in (s, u): rows of the matrix are where the surface's two parameters go, `shift` where its origin goes."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d
    from OCP.GeomAbs import GeomAbs_CurveType as Kind
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    isometric = (
        abs(abs(np.linalg.det(matrix)) - 1.0) < tolerance.COINCIDENT
        and abs(matrix[0] @ matrix[1]) < tolerance.COINCIDENT
    )
    found: list[TrimEdge] = []
    walk = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while walk.More():
        progress.check()
        edge = TopoDS.Edge_s(walk.Current())
        walk.Next()
        curve = BRepAdaptor_Curve2d(edge, face)
        first, last = curve.FirstParameter(), curve.LastParameter()
        if curve.GetType() == Kind.GeomAbs_Line or BRep_Tool.Degenerated_s(edge):
            found += line_edges(_mapped(curve, np.array([first, last]), matrix, shift))
        elif curve.GetType() == Kind.GeomAbs_Circle and isometric:
            position = curve.Circle()
            centre = np.array([position.Location().X(), position.Location().Y()]) @ matrix + shift
            mid = (
                _mapped(curve, np.array([first, 0.5 * (first + last), last]), matrix, shift)
                - centre
            )
            angles = np.arctan2(mid[:, 1], mid[:, 0])
            halfway = (angles[1] - angles[0] + math.pi) % (2 * math.pi) - math.pi
            sweep = (
                math.copysign(last - first, halfway)
                if abs(halfway) < math.pi - tolerance.COINCIDENT
                else last - first
            )
            found += circle_edges(
                centre[0], centre[1], position.Radius(), angles[0], angles[0] + sweep
            )
        else:
            found += _sampled(curve, first, last, matrix, shift, unit_lengths)
    return found


def _mapped(curve: Any, parameters: Floats, matrix: Floats, shift: Floats) -> Floats:
    points = [curve.Value(float(t)) for t in parameters]
    return np.array([[p.X(), p.Y()] for p in points]) @ matrix + shift


def _sampled(
    curve: Any, first: float, last: float, matrix: Floats, shift: Floats, unit_lengths: UnitLengths
) -> list[TrimEdge]:
    """Return chords of a general trim, close enough in mm for the contact bound."""
    at = np.linspace(first, last, FEWEST_CHORDS + 1)
    path = _mapped(curve, at, matrix, shift)
    while True:
        middle = 0.5 * (at[:-1] + at[1:])
        between = _mapped(curve, middle, matrix, shift)
        along, across = unit_lengths(between[:, 1])
        away = np.abs(between - 0.5 * (path[:-1] + path[1:])) * np.column_stack(
            [along, np.full(len(middle), across)]
        )
        far = away.max(axis=1) > tolerance.CONTACT_BOUND / 4
        if not far.any() or len(at) > MOST_CHORDS:
            return line_edges(path)
        rows = np.flatnonzero(far) + 1
        at = np.insert(at, rows, middle[far])
        path = np.insert(path, rows, between[far], axis=0)
