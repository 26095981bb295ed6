"""Sizes of bosses in the words of drawings: what outline it is, height, fillet, where it stands and how far its foot reaches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import SMOOTH
from trunnion.model.feature import Size
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.foot import FootBounds, bounds, foot_middle
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import BossOutline, OutlinePiece
from trunnion.recognize.grow import samples
from trunnion.tolerance import ANGLE, SLIVER
from trunnion.units import degrees, rounded

ROUND = ("cylinder", "torus")
"""Surfaces of fillets that say their radius."""
EQUAL = 0.01
"""mm: radii and lengths of one outline that differ by less are equal, as drawings go."""


def with_fillets(
    faces: CasingFaces, boss: BossFaces, outline: BossOutline, meridian: Meridian
) -> BossOutline:
    """Return an outline whose pieces say the radius of the fillet at their foot: that of its cylinders and tori, where it has any, else
    what fits side and ground (corners are written as splines that are a micrometre off)."""
    graph = faces.graph
    if not boss.fillets:
        return outline
    radius = {s: fillet_radius(faces, boss, s, meridian) for s in boss.sides}
    exact = [
        float(graph.radius[f] if graph.surface[f] == "cylinder" else graph.minor[f])
        for f in boss.fillets
        if graph.surface[f] in ROUND
    ]
    if exact:
        common = rounded(float(np.median(exact)))
        radius = {s: common if r else 0.0 for s, r in radius.items()}
    return replace(
        outline,
        pieces=tuple(replace(p, fillet=radius.get(p.side, 0.0)) for p in outline.pieces),
    )


def fillet_radius(faces: CasingFaces, boss: BossFaces, side: int, meridian: Meridian) -> float:
    """Return the radius (mm) of the fillets at the foot of a side, 0 where it has none.

    A ball of the radius f that touches the side at q, where side and fillet meet, has its centre at q + f m, m the side's normal, and
    lies on the ground: |q + f m| across the axis is rho(q + f m) + f sqrt(1 + k^2), a square equation in f.
    """
    graph = faces.graph
    found = []
    for edge in graph.edges_of[side]:
        if graph.convexity[edge] != SMOOTH or graph.across(edge, side) not in boss.fillets:
            continue
        point = graph.middle[edge]
        normal = _normal(faces, side, point)
        k = float(meridian.slope[meridian.piece(point[2:])][0])
        base = float(meridian.radius(point[2:])[0])
        rise = k * normal[2] + meridian.outward * np.hypot(1.0, k)
        a = float(normal[:2] @ normal[:2]) - rise**2
        b = 2.0 * float(point[:2] @ normal[:2]) - 2.0 * base * rise
        c = float(point[:2] @ point[:2]) - base**2
        roots = np.roots([a, b, c])
        real = [float(r.real) for r in roots if abs(r.imag) < SLIVER and r.real > 0.0]
        if real:
            found.append(min(real))
    return rounded(float(np.median(found))) if found else 0.0


def _normal(faces: CasingFaces, side: int, point: Floats) -> Floats:
    graph = faces.graph
    if graph.surface[side] == "cylinder":
        away = point - graph.axis_point[side]
        away = away - (away @ graph.axis[side]) * graph.axis[side]
        return np.asarray(away / np.linalg.norm(away) * (1.0 if graph.bend[side] > 0 else -1.0))
    at, normal = samples(graph, side)
    return np.asarray(normal[int(np.argmin(np.linalg.norm(at - point, axis=1)))])


def boss_sizes(
    faces: CasingFaces, boss: BossFaces, outline: BossOutline, meridian: Meridian
) -> dict[str, Size]:
    """Return the sizes of a boss by name: mm, and degrees about the main axis from the frame's x.

    `height` over the ground along the boss, `root_fillet`, `theta` and `z` where its middle stands; `theta_low`, `theta_high`, `z_low`,
    `z_high` the bounds of its foot, with `toe_` before those of the fillet's toe; `diameter`, `length_u` across and `length_v` along the
    main axis, `corner_radius`, `lobe_radius`, `concave_radius`, ... of its outline; `tilt` out of the ground's normal.
    """
    outline = with_fillets(faces, boss, outline, meridian)
    middle = foot_middle(outline, meridian)
    theta = float(np.arctan2(middle[1], middle[0])) % (2.0 * np.pi)
    fillet = max((p.fillet for p in outline.pieces), default=0.0)
    sizes: dict[str, Size] = {
        "height": rounded(float(np.linalg.norm(outline.frame.origin - middle))),
        "root_fillet": fillet,
        **outline_sizes(outline),
        "theta": rounded(degrees(theta)) % 360.0,
        "z": rounded(float(middle[2])),
        **_bound_sizes("", bounds(outline, meridian), theta),
    }
    if fillet:
        sizes.update(_bound_sizes("toe_", bounds(outline, meridian, toe=True), theta))
    tilt = _tilt(outline, meridian, middle)
    if tilt > ANGLE:
        sizes["tilt"] = rounded(degrees(tilt))
    return sizes


def boss_attributes(outline: BossOutline, meridian: Meridian) -> dict[str, Size]:
    """Return what is said of a boss in words: its outline, which side of the wall it stands on, whether something higher cuts it, and its
    direction in the casing's frame."""
    x, y, z = (round(float(v), 6) + 0.0 for v in outline.frame.z)
    found: dict[str, Size] = {
        "outline": outline_word(outline),
        "where": "outside" if meridian.outward > 0.0 else "inside",
        "normal": (x, y, z),
    }
    if any(p.side < 0 for p in outline.pieces):
        found["cut"] = True
    return found


def _bound_sizes(prefix: str, found: FootBounds, theta: float) -> dict[str, Size]:
    turns = (
        2.0 * np.pi * round((0.5 * (found.theta_low + found.theta_high) - theta) / (2.0 * np.pi))
    )
    return {
        f"{prefix}theta_low": round(degrees(found.theta_low - turns), 6),
        f"{prefix}theta_high": round(degrees(found.theta_high - turns), 6),
        f"{prefix}z_low": rounded(found.z_low),
        f"{prefix}z_high": rounded(found.z_high),
    }


def _tilt(outline: BossOutline, meridian: Meridian, middle: Floats) -> float:
    away, along = meridian.normal(middle[2:])[0]
    flat = middle[:2] / max(float(np.linalg.norm(middle[:2])), SLIVER)
    ground = np.array([away * flat[0], away * flat[1], along])
    return float(np.arccos(np.clip(ground @ outline.frame.z, -1.0, 1.0)))


def outline_word(outline: BossOutline) -> str:
    """Return what an outline is called: circle, slot, rectangle, triangle, lobe, polygon, or free where it is none of these."""
    lines, outer, inner = _sorts(outline.pieces)
    whole = outline.is_closed and all(p.side >= 0 for p in outline.pieces)
    if not lines and not inner and outer and _one_circle(outer):
        return "circle"
    if not whole:
        return "cut rectangle" if lines and not inner else "free"
    if not lines and inner and len(inner) == len(outer):
        return "lobe"
    if inner:
        return "notched" if lines else "free"
    if len(lines) == 2 and len(outer) == 2:
        return "slot"
    return {3: "triangle", 4: "rectangle"}.get(len(lines), "polygon" if lines else "free")


def outline_sizes(outline: BossOutline) -> dict[str, Size]:
    """Return the sizes of an outline by name, mm."""
    word = outline_word(outline)
    _, outer, inner = _sorts(outline.pieces)
    low, high = _box(outline)
    if word == "circle":
        return {"diameter": rounded(2.0 * outer[0].radius)}
    found: dict[str, Size] = {}
    if word == "slot":
        wide = 2.0 * outer[0].radius
        centres = float(np.linalg.norm(_centre(outer[0]) - _centre(outer[1])))
        return {"length": rounded(centres + wide), "diameter": rounded(wide)}
    if word == "lobe":
        return {
            "lobes": len(outer),
            "lobe_distance": rounded(
                float(
                    np.linalg.norm(
                        np.array([_centre(p) for p in outer])
                        - np.mean([_centre(p) for p in outer], axis=0),
                        axis=1,
                    ).mean()
                )
            ),
            "lobe_radius": rounded(outer[0].radius),
            "concave_radius": rounded(inner[0].radius),
        }
    found = {
        "length_u": rounded(float(high[0] - low[0])),
        "length_v": rounded(float(high[1] - low[1])),
    }
    if outer:
        found["corner_radius"] = rounded(min(p.radius for p in outer))
    if inner:
        found["concave_radius"] = rounded(min(p.radius for p in inner))
    return found


def _sorts(
    pieces: Sequence[OutlinePiece],
) -> tuple[list[OutlinePiece], list[OutlinePiece], list[OutlinePiece]]:
    """Return the lines of an outline, each once though it be in pieces, and its outer and inner arcs."""
    lines = [p for p in pieces if p.centre is None]
    bent = [
        b for a, b in pairwise([*lines[-1:], *lines]) if a is b or a.side != b.side or b.side < 0
    ]
    return (
        bent,
        [p for p in pieces if p.centre is not None and not p.hollow],
        [p for p in pieces if p.centre is not None and p.hollow],
    )


def _one_circle(arcs: Sequence[OutlinePiece]) -> bool:
    return all(
        abs(p.radius - arcs[0].radius) < EQUAL
        and np.linalg.norm(_centre(p) - _centre(arcs[0])) < EQUAL
        for p in arcs
    )


def _centre(piece: OutlinePiece) -> Floats:
    return piece.start if piece.centre is None else piece.centre


def _box(outline: BossOutline) -> tuple[Floats, Floats]:
    """Return the corners of the box around an outline; arcs count with their points farthest along u and v."""
    points = []
    for piece in outline.pieces:
        share = [0.0, 1.0]
        if piece.centre is not None:
            first = piece.start - piece.centre
            begin = float(np.arctan2(first[1], first[0]))
            for quarter in range(4):
                turn = (0.5 * np.pi * quarter - begin) % (2.0 * np.pi)
                turn = turn if piece.turn > 0.0 else turn - 2.0 * np.pi
                share += [turn / piece.turn] if 0.0 < turn / piece.turn < 1.0 else []
        points.append(piece.at(np.array(share)))
    if not points:
        return np.zeros(2), np.zeros(2)
    every = np.vstack(points)
    return every.min(axis=0), every.max(axis=0)
