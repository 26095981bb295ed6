"""Guide lines of swarf milling: positions round walls, and at each the ruling along which a cutter's flank lies on the wall.

On a developable face the ruling at a position is where the tangent planes of its neighbours meet: at right angles to the normals on both
sides of it. A plane has no ruling of its own: any turn in it keeps the flank on it. It takes the steepest, and near its ends turns to those
of the faces that it runs into; at an edge between planes that is the edge itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sphere import angle_between
from trunnion.plan.freeform.swarf.level_sections import SectionLine

FLAT = 1e-5
"""rad: a face whose normals along a line differ by no more has no ruling of its own."""
EVEN = 1e-4
"""Of unit normals: how far they may be from one plane for the face to be a cylinder, with one direction for all its rulings."""
STEEP = math.radians(45.0)
"""Rulings stand up by more than this: a cutter that lies along a flatter one has no tip down at the wall's foot."""
STEP = 2.0
"""mm: positions on a plane are no farther apart, and `ROLL` rad of turn where the cutter rolls round an edge."""
ROLL = math.radians(5.0)
TURN_OVER = 20.0
"""mm at the ends of a plane over which a flank turns to the ruling of what it runs into."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GuideLine:
    """Positions along walls, the material on their right: points (k, 3) on the faces, outward unit normals (k, 3), unit rulings upwards
    (k, 3), the tag (k,) of each one's face. A `closed` one ends where it begins."""

    point: Floats
    normal: Floats
    ruling: Floats
    face: Ints
    closed: bool = False

    def __len__(self) -> int:
        return len(self.face)

    @property
    def length(self) -> float:
        """How far it goes along the faces in mm."""
        return float(np.linalg.norm(np.diff(self.point, axis=0), axis=1).sum())

    def of(self, rows: Bools | Ints | slice) -> GuideLine:
        """Return a part of the line; it is not closed."""
        return GuideLine(
            point=self.point[rows],
            normal=self.normal[rows],
            ruling=self.ruling[rows],
            face=self.face[rows],
        )

    def at(self, point: Floats) -> GuideLine:
        """Return the line through other points (k, 3), each on the ruling of the one in its place."""
        return replace(self, point=point)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Run:
    """A stretch on one face, or on planes that go on smoothly; `ruling` (k, 3), None where the face has none of its own."""

    point: Floats
    normal: Floats
    face: Ints
    ruling: Floats | None

    @property
    def feed(self) -> Floats:
        """The unit directions (2, 3) in which it begins and ends."""
        way = np.diff(self.point, axis=0)[[0, -1]]
        return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Joint:
    """Where a run goes over into the next: the ruling (3,) there, None where both leave it open, and by which angle in rad about it the way
    turns, to the left where positive; 0 where the faces go on smoothly. `parts`: no flank goes on from the one to the other."""

    ruling: Floats | None = None
    turn: float = 0.0
    parts: bool = False


def guide_lines(section: SectionLine, radius: float) -> list[GuideLine]:
    """Return the guide lines along a level section for a flank of a radius (mm): in one piece as far as rulings stand up and go over into
    one another. A sharp inner corner is rounded as the flank does it, round a sharp outer one the flank rolls."""
    runs = _merged(section)
    n = len(runs)
    joints = [_joint(runs[k], runs[(k + 1) % n]) for k in range(n if section.closed else n - 1)]
    if section.closed and n == 1:
        joints = [_whole_joint(runs[0])]
    pieces = [_ruled(runs, joints, k, radius, closed=section.closed) for k in range(n)]
    found, some = list[GuideLine](), list[GuideLine]()
    breaks = [k for k in range(n) if pieces[k] is None or (k < len(joints) and joints[k].parts)]
    is_closed = section.closed and not breaks
    # A closed line that is parted somewhere begins behind that place.
    first = (breaks[0] + 1) % n if breaks and section.closed else 0
    for number in [(first + k) % n for k in range(n)]:
        piece = pieces[number]
        if piece is not None:
            some.append(piece)
            if number < len(joints):
                some += _rolled(runs[number], runs[(number + 1) % n], joints[number])
        if number in breaks and some:
            found.append(_strung(some))
            some = []
    if some:
        found.append(_strung(some))
    if is_closed and len(found) == 1:
        found = [_begun_within(found[0])]
    return [g for g in found if len(g) > 1]


def _merged(section: SectionLine) -> list[_Run]:
    """Return the runs of a section, planes that go on smoothly as one."""
    found = list[_Run]()
    for rows in section.runs():
        point, normal = section.point[rows], section.normal[rows]
        if np.linalg.norm(point[-1] - point[0]) <= tolerance.SEW and len(point) < 3:
            continue
        run = _Run(point=point, normal=normal, face=section.face[rows], ruling=_rulings(normal))
        if found and _is_one_plane(found[-1], run):
            run = _both(found.pop(), run)
        found.append(run)
    if section.closed and len(found) > 1 and _is_one_plane(found[-1], found[0]):
        found[0] = _both(found.pop(), found[0])
    return found


def _is_one_plane(one: _Run, other: _Run) -> bool:
    both_flat = one.ruling is None and other.ruling is None
    return both_flat and float(angle_between(one.normal[-1:], other.normal[:1])[0]) <= FLAT


def _both(one: _Run, other: _Run) -> _Run:
    return _Run(
        point=np.vstack([one.point, other.point[1:]]),
        normal=np.vstack([one.normal, other.normal[1:]]),
        face=np.concatenate([one.face, other.face[1:]]),
        ruling=None,
    )


def _rulings(normal: Floats) -> Floats | None:
    """Return the rulings (k, 3) of a face by its normals (k, 3) along a line; None for a plane."""
    if float(angle_between(normal, np.broadcast_to(normal[:1], normal.shape)).max()) <= FLAT:
        return None
    sizes, directions = np.linalg.svd(normal, full_matrices=True)[1:]
    if len(sizes) < 3 or sizes[-1] <= EVEN * math.sqrt(len(normal)):
        ruling = np.broadcast_to(directions[-1], normal.shape)
    else:
        # Tangent planes of neighbours meet in the ruling: n x n'.
        padded = np.vstack([normal[:1], normal, normal[-1:]])
        ruling = np.cross(padded[:-2], padded[2:])
        ruling = ruling / np.maximum(
            np.linalg.norm(ruling, axis=1, keepdims=True), tolerance.PARAMETRIC
        )
    return np.where(ruling[:, 2:] < 0.0, -ruling, ruling)


def _joint(one: _Run, other: _Run) -> _Joint:
    """Return how a run goes over into the next one."""
    before, after = one.normal[-1], other.normal[0]
    bend = float(angle_between(before[None], after[None])[0])
    own = [r for r in (one.ruling, other.ruling) if r is not None]
    if bend <= tolerance.TANGENT:
        if len(own) == 2:
            assert one.ruling is not None and other.ruling is not None
            parts = float(angle_between(one.ruling[-1:], other.ruling[:1])[0]) > ROLL
            return _Joint(parts=parts)
        if not own:
            return _Joint()
        return _Joint(ruling=one.ruling[-1] if one.ruling is not None else own[0][0])
    if own:
        # A flank that lies on a curved face up to a sharp edge has to leave it to go on.
        return _Joint(parts=True)
    ruling = np.cross(before, after)
    ruling /= np.linalg.norm(ruling)
    ruling = -ruling if ruling[2] < 0.0 else ruling
    is_concave = float(np.dot(np.cross(one.feed[1], other.feed[0]), ruling)) > 0.0
    return _Joint(ruling=ruling, turn=bend if is_concave else -bend)


def _whole_joint(run: _Run) -> _Joint:
    """Return how a closed run on one face goes over into itself."""
    bend = float(angle_between(run.normal[-1:], run.normal[:1])[0])
    return _Joint(parts=bend > tolerance.TANGENT)


def _ruled(
    runs: Sequence[_Run], joints: Sequence[_Joint], number: int, radius: float, *, closed: bool
) -> GuideLine | None:
    """Return a run with its rulings, shortened where a flank of a radius has no room in sharp inner corners at its ends; None where nothing
    is left of it or its rulings lie flat."""
    n = len(runs)
    run = runs[number]
    before = joints[(number - 1) % n] if closed or number else _Joint()
    after = joints[number] if number < len(joints) else _Joint()
    point, ruling = run.point, run.ruling
    if ruling is None:
        normal = run.normal[0]
        # A flank along the edge touches both planes R tan(turn / 2) off it.
        off = [radius * math.tan(0.5 * max(j.turn, 0.0)) for j in (before, after)]
        across = [
            float(np.linalg.norm(np.cross(f, j.ruling))) if j.ruling is not None else 1.0
            for f, j in zip(run.feed, (before, after), strict=True)
        ]
        trims = [o / max(a, math.sin(STEEP)) for o, a in zip(off, across, strict=True)]
        kept = _shortened(point, *trims)
        if kept is None:
            return None
        point = _spaced(kept, STEP)
        ruling = _turning(point, normal, before.ruling, after.ruling)
        run = _Run(
            point=point,
            normal=np.broadcast_to(normal, point.shape),
            face=np.full(len(point), run.face[0]),
            ruling=ruling,
        )
    if (ruling[:, 2] < math.sin(STEEP)).any():
        return None
    return GuideLine(point=run.point, normal=run.normal, ruling=ruling, face=run.face)


def _turning(point: Floats, normal: Floats, start: Floats | None, end: Floats | None) -> Floats:
    """Return directions (k, 3) in a plane at points (k, 3) of a line: the steepest, and near its ends turning evenly to the ones there.

    The steepest leans across the way alone: the cutter's end comes lowest at the wall, and leaves its fillet whole."""
    steepest = np.array([0.0, 0.0, 1.0]) - normal[2] * normal
    steepest /= np.linalg.norm(steepest)
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1))])
    over = max(min(TURN_OVER, 0.5 * gone[-1]), tolerance.SEW)
    side = np.cross(normal, steepest)
    turn = np.zeros(len(point))
    for direction, way in ((start, gone), (end, gone[-1] - gone)):
        if direction is not None:
            angle = math.atan2(float(np.dot(direction, side)), float(np.dot(direction, steepest)))
            turn += angle * np.clip(1.0 - way / over, 0.0, 1.0)
    return np.cos(turn)[:, None] * steepest + np.sin(turn)[:, None] * side


def _shortened(point: Floats, start: float, end: float) -> Floats | None:
    """Return a line (k, 3) without so many mm at its ends; None where nothing is left."""
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1))])
    low, high = start, gone[-1] - end
    if high - low <= tolerance.SEW:
        return None
    within = (gone > low) & (gone < high)
    at = np.concatenate([[low], gone[within], [high]])
    return np.column_stack([np.interp(at, gone, point[:, k]) for k in range(3)])


def _spaced(point: Floats, step: float) -> Floats:
    """Return positions along a line (k, 3), its own among them, no farther apart than a step (mm)."""
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1))])
    even = np.linspace(0.0, gone[-1], max(2, math.ceil(gone[-1] / step) + 1))
    return np.column_stack([np.interp(even, gone, point[:, k]) for k in range(3)])


def _rolled(one: _Run, other: _Run, joint: _Joint) -> list[GuideLine]:
    """Return the positions at which a flank rolls round a sharp outer edge; none at any other joint."""
    if joint.ruling is None or joint.turn >= 0.0:
        return []
    count = max(2, math.ceil(-joint.turn / ROLL) + 1)
    share = np.linspace(0.0, 1.0, count)[1:-1, None]
    angle = -joint.turn
    normal = (
        np.sin((1.0 - share) * angle) * one.normal[-1] + np.sin(share * angle) * other.normal[0]
    )
    normal /= math.sin(angle)
    at = (len(normal), 3)
    return [
        GuideLine(
            point=np.broadcast_to(one.point[-1], at),
            normal=normal,
            ruling=np.broadcast_to(joint.ruling, at),
            face=np.full(len(normal), one.face[-1]),
        )
    ]


def _strung(pieces: Sequence[GuideLine]) -> GuideLine:
    return GuideLine(
        point=np.vstack([p.point for p in pieces]),
        normal=np.vstack([p.normal for p in pieces]),
        ruling=np.vstack([p.ruling for p in pieces]),
        face=np.concatenate([p.face for p in pieces]),
    )


def _begun_within(line: GuideLine) -> GuideLine:
    """Return a closed line begun in the middle of its longest move: no lead is in a corner."""
    step = np.linalg.norm(np.diff(line.point, axis=0), axis=1)
    flat = (line.face[1:] == line.face[:-1]) & (
        angle_between(line.normal[1:], line.normal[:-1]) <= FLAT
    )
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flat, [False]]).astype(np.int8)))
    stretches = [(float(step[a:b].sum()), -a, b) for a, b in edges.reshape(-1, 2).tolist()]
    _, minus_start, end = max(stretches, default=(0.0, 0, 0))
    row = (end - minus_start) // 2
    rows = np.concatenate([np.arange(row, len(line)), np.arange(0, row + 1)])
    whole = line.of(rows)
    return replace(whole, closed=True)
