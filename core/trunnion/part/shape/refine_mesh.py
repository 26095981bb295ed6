"""A part's faces opened into triangles within a chord error that is measured, edge by edge and face by face.

The CAD kernel's mesher is quick while the error allowed is coarse, and explodes below some microns. So it makes a coarse net, and the net's
edges are halved, on the face's own surface, until the middle of each and of every triangle is near enough. Where faces meet, the edge's own
curve says where its middle is, so that both sides get the same points. Only lines that leave the surface are halved: a net over a fillet
stays as wide along it as it may be.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput, OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.part.work import RefinedMeshWork
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part
    from trunnion.part.shape.evaluate import Evaluator

MOST_TRIANGLES = 4_000_000
"""About 1 GB with the tree over them."""
COARSE = 0.01
"""mm: least chord error that the kernel's mesher is given: finer ones take longer there than halving does (measured); from coarser ones
borders move past points beside them."""
BETWEEN = 1.07
"""What a triangle may be further off than at its middle and those of its edges: 1.066 at most for an even bend (searched)."""
ALONG = np.array([[0.5, 0.5], [0.75, 0.25], [0.25, 0.75]])
"""Where an edge is measured: one that crosses a surface that turns from hollow to round may be right in its middle."""
WITHIN = np.array([[1.0, 1.0, 1.0]]) / 3.0
"""Where a triangle is measured."""
ROUNDS, LATE = 16, 6
"""Times that edges are halved at most, and how often before the longest edge of a triangle is halved as well: where an edge beside it is
just within its limit, others would come nearer to that without end."""

MANY = 4000
"""Positions evaluated between two looks at cancel: some hundredths of a second where the kernel does it one by one."""
AT_ONCE = 1 << 16
"""Positions whose derivatives are held at once: each takes 144 bytes, and there are millions."""
PIECES = 1 << (ROUNDS + 2)
"""Numbers for all pieces of a piece of the border: halves of piece n are 2 n and 2 n + 1."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RefinedMesh:
    """Triangles of faces, in the part's coordinates. v points, t triangles, f faces in rows.

    tag (f,) of the faces; points, outward unit normals (v, 3); triangles (t, 3) rows of points, anticlockwise seen from outside;
    face (t,) rows of tag; bound (f,): how far each face's triangles may be from it, mm.
    """

    tag: Ints
    points: Floats
    normals: Floats
    triangles: Ints
    face: Ints
    bound: Floats


def opened(
    part: Part, chords: Mapping[int, float], progress: Progress = NO_PROGRESS
) -> RefinedMesh:
    """Return the faces of the tags in `chords` as triangles, each within its chord error (mm), as measured.

    Raises `BadInput` for a face that the mesher can't do and `OutOfMemory` beyond `MOST_TRIANGLES`.
    """
    from OCP.BRepTools import BRepTools

    tags = sorted(chords)
    if not tags:
        none = np.zeros((0, 3))
        return RefinedMesh(
            tag=np.zeros(0, np.int64),
            points=none,
            normals=none,
            triangles=none.astype(np.int64),
            face=np.zeros(0, np.int64),
            bound=np.zeros(0),
        )
    made: RefinedMesh | None = part.finished(
        RefinedMeshWork(tuple(sorted(chords.items()))), progress
    )
    if made is not None:
        return made
    BRepTools.Clean_s(part.shape)
    try:
        net = _coarse(part, tags, np.array([chords[tag] for tag in tags]), progress.part(0.0, 0.3))
    finally:
        BRepTools.Clean_s(part.shape)
    net.progress = progress.part(0.3, 1.0)
    net.refine()
    return net.result(tags, net.bounded())


@dataclass(slots=True)
class _Border:
    """Pieces of the faces' boundary edges: nodes (b, 2) at both ends, the edge's curve and the line of it in its face (b,) by their rows,
    the curve's parameters at both ends (b, 2), and a number (b,) that is the same for all faces that meet there."""

    nodes: Ints
    curve: Ints
    line: Ints
    t: Floats
    piece: Ints

    def key(self) -> Ints:
        return _key(self.nodes)

    def some(self, rows: Ints | Bools) -> _Border:
        return _Border(*(getattr(self, name)[rows] for name in _Border.__slots__))

    def halves(self, middle: Ints) -> tuple[_Border, _Border]:
        """Return both halves of every piece, given the nodes (b,) in their middles."""
        t, number = self.t.mean(axis=1), self.piece + self.piece % PIECES
        return (
            _Border(
                np.column_stack([self.nodes[:, 0], middle]),
                self.curve,
                self.line,
                np.column_stack([self.t[:, 0], t]),
                number,
            ),
            _Border(
                np.column_stack([middle, self.nodes[:, 1]]),
                self.curve,
                self.line,
                np.column_stack([t, self.t[:, 1]]),
                number + 1,
            ),
        )


def _key(pairs: Ints) -> Ints:
    """Return one number (k,) for each pair of nodes (k, 2), whichever comes first."""
    return np.asarray((pairs.min(axis=1) << 32) | pairs.max(axis=1))


def _side_keys(triangles: Ints) -> Ints:
    """Return the keys (3 t,) of the sides of triangles (t, 3), those of a triangle one after another."""
    ends = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    keys = np.minimum(*ends)
    keys <<= 32
    keys |= np.maximum(*ends)
    return keys


def _distinct(keys: Ints) -> tuple[Ints, Ints, Ints]:
    """Return what `np.unique` does with index and inverse, in half of its memory: there are millions."""
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    fresh = np.ones(len(keys), bool)
    np.not_equal(ordered[1:], ordered[:-1], out=fresh[1:])
    distinct, first = ordered[fresh], order[fresh]
    # The place of the sorted keys is that of their numbers from here on.
    np.cumsum(fresh, out=ordered)
    ordered -= 1
    which = np.empty_like(order)
    which[order] = ordered
    return distinct, first, which


@dataclass(slots=True)
class _Net:
    """The triangles while they are refined. uv (v, 2) is where points (v, 3) are on their faces' surfaces, owner (v,) the faces' rows;
    surface (v, 3): the surfaces' points there, from which those on edges may be as far as the part's tolerances allow; fixed (v, 2):
    whether u and v mean anything there (at a pole one of them doesn't)."""

    name: str
    evaluators: list[Evaluator]
    sides: Floats
    limits: Floats
    middles: Floats
    uv: Floats
    points: Floats
    surface: Floats
    owner: Ints
    triangles: Ints
    face: Ints
    border: _Border
    curves: list[Any]
    lines: list[Any]
    fixed: Bools
    bound: Floats
    progress: Progress = NO_PROGRESS

    def join_poles(self) -> None:
        """Make one point of all that lie in the same pole, and leave out the triangles between them, which have no area."""
        poles = np.flatnonzero(~self.fixed.all(axis=1))
        where = np.column_stack(
            [self.owner[poles], np.round(self.points[poles] / tolerance.COINCIDENT)]
        )
        _, first, back = np.unique(where, axis=0, return_index=True, return_inverse=True)
        one = np.arange(len(self.points))
        one[poles] = poles[first[back.ravel()]]
        self.triangles, self.border.nodes = one[self.triangles], one[self.border.nodes]
        a, b, c = self.triangles.T
        some = (a != b) & (b != c) & (c != a)
        self.triangles, self.face = self.triangles[some], self.face[some]

    def on(self, owner: Ints, uv: Floats) -> Floats:
        """Return points and derivatives (k, 6, 3) of faces, by row (k,), at uv (k, 2)."""
        out = np.empty((len(uv), 6, 3))
        order = np.argsort(owner, kind="stable")
        for rows in (
            np.split(order, np.flatnonzero(np.diff(owner[order])) + 1) if len(order) else []
        ):
            for some in np.split(rows, range(MANY, len(rows), MANY)):
                self.progress.check()
                out[some] = self.evaluators[int(owner[rows[0]])](uv[some])
        return out

    def between(self, nodes: Ints, share: Floats) -> Floats:
        """Return uv (k, 2) at shares (n,) between nodes (k, n); what means nothing at a pole doesn't count."""
        uv = sum(s * self.uv[n] for s, n in zip(share, nodes.T, strict=True))
        whole = np.asarray(self.fixed.all(axis=1))
        partly = np.flatnonzero(~whole[nodes].all(axis=1))
        counts = self.fixed[nodes[partly]] * share[:, None]
        counts = np.where(counts.sum(axis=1, keepdims=True) > 0.0, counts, share[:, None])
        uv[partly] = (self.uv[nodes[partly]] * counts).sum(axis=1) / counts.sum(axis=1)
        return np.asarray(uv)

    def off(self, nodes: Ints, shares: Floats) -> Floats:
        """Return how far (k,) the surface is at most from edges or triangles (k, n) of nodes, at shares (s, n) between those, along its
        normals there."""
        worst = np.zeros(len(nodes))
        for rows in _stretches(len(nodes)):
            some, far = nodes[rows], worst[rows]
            owner = self.owner[some[:, 0]]
            for share in shares:
                at = self.on(owner, self.between(some, share))
                away = at[:, 0] - np.einsum("knc,n->kc", self.surface[some], share)
                np.maximum(far, np.abs((away * self.normal(at)[0]).sum(axis=1)), out=far)
        return worst

    def normal(self, at: Floats) -> tuple[Floats, Bools]:
        """Return unit normals (k, 3) of a surface, not yet turned outward, and where there are some (k,)."""
        normal = np.cross(at[:, 1], at[:, 2])
        size = np.linalg.norm(normal, axis=1)
        lengths = np.linalg.norm(at[:, 1:3], axis=2).max(axis=1)
        there = size > tolerance.PARAMETRIC * np.maximum(lengths, tolerance.COINCIDENT)
        return np.divide(
            normal, size[:, None], out=np.zeros_like(normal), where=there[:, None]
        ), there

    def refine(self) -> None:
        """Halve edges until every edge and every triangle is within its face's limit."""
        known, known_off = np.zeros(0, np.int64), np.zeros(0)
        middle = np.full(len(self.triangles), np.nan)
        for k in range(ROUNDS + 1):
            self.progress.at(1.0 - 0.7**k, "Refining triangles")
            keys, first, edge = self._distinct(_side_keys(self.triangles))
            row, side = np.divmod(first, 3)
            edges = np.column_stack(
                [self.triangles[row, side], self.triangles[row, (side + 1) % 3]]
            )
            edge = edge.reshape(-1, 3)
            off, border = self._edges_off(keys, edges, known, known_off)
            limit = self.limits[self.owner[edges[:, 0]]]
            np.minimum.at(limit, border[border >= 0], self._border_limits()[border >= 0])
            split = off > limit
            self._measure(middle, edge, split)
            beyond = np.flatnonzero(np.nan_to_num(middle) > self.limits[self.face])
            split[edge[beyond, off[edge[beyond]].argmax(axis=1)]] = True
            if k == ROUNDS or not split.any():
                break
            if k >= LATE:
                length = np.linalg.norm(self.points[edges[:, 1]] - self.points[edges[:, 0]], axis=1)
                cut = edge[split[edge].any(axis=1)]
                split[np.take_along_axis(cut, length[cut].argmax(axis=1)[:, None], axis=1)] = True
            self._agree(split, border)
            known, known_off = keys[~split], off[~split]
            middle = self._halve(edges, edge, split, keys, middle)
        np.maximum.at(
            self.bound,
            self.face,
            BETWEEN * np.maximum(np.nan_to_num(middle), off[edge].max(axis=1)),
        )

    def _distinct(self, keys: Ints) -> tuple[Ints, Ints, Ints]:
        """Return the distinct ones of some keys, the first row of each, and which of them each key is."""
        return (
            self.progress.aside(lambda _: _distinct(keys)) if len(keys) > MANY else _distinct(keys)
        )

    def bounded(self) -> Floats:
        """Add to the bounds how far points on edges are from the faces' surfaces; return the normals (v, 3) at all points."""
        normals, partly = self.normals(), np.zeros(len(self.bound))
        np.maximum.at(
            partly, self.owner, np.abs(((self.points - self.surface) * normals).sum(axis=1))
        )
        self.bound += partly
        return normals

    def _agree(self, split: Bools, border: Ints) -> None:
        """Halve a piece of the border in all faces that meet there, or in none; border (b,) says which edge each piece is."""
        there = border >= 0
        _, back = np.unique(self.border.piece[there], return_inverse=True)
        wanted = np.zeros(len(back), bool)
        np.logical_or.at(wanted, back, split[border[there]])
        split[border[there]] = wanted[back]

    def _measure(self, middle: Floats, edge: Ints, split: Bools) -> None:
        """Measure the middles of triangles that have not been yet and whose edges stay."""
        rows = np.flatnonzero(np.isnan(middle) & ~split[edge].any(axis=1))
        middle[rows] = self.off(self.triangles[rows], WITHIN)

    def _edges_off(
        self, keys: Ints, edges: Ints, known: Ints, known_off: Floats
    ) -> tuple[Floats, Ints]:
        """Return how far off edges are, and for each piece of the border which edge it is (-1: none)."""
        off = np.full(len(keys), np.nan)
        at = np.searchsorted(keys, known)
        off[at] = known_off
        own = self.border.key()
        border = np.searchsorted(keys, own)
        border[(border >= len(keys)) | (keys[np.minimum(border, len(keys) - 1)] != own)] = -1
        fresh = (border >= 0) & np.isnan(off[border])
        off[border[fresh]] = self._border_off(self.border.some(fresh))
        rows = np.flatnonzero(np.isnan(off))
        off[rows] = self.off(edges[rows], ALONG)
        return off, border

    def _border_at(self, pieces: _Border, share: Floats) -> Floats:
        """Return the points (b, 3) at a share (2,) between the ends of pieces of the border, the same for all faces that meet there."""
        _, first, back = self._distinct(pieces.piece)
        middle = pieces.t[first] @ share
        points = np.array(
            [
                self.curves[c].Value(t).Coord()
                for c, t in self.progress.each(
                    zip(pieces.curve[first].tolist(), middle.tolist(), strict=True)
                )
            ]
        )
        return np.asarray(points.reshape(-1, 3)[back])

    def _border_off(self, pieces: _Border) -> Floats:
        start, end = np.moveaxis(self.points[pieces.nodes], 1, 0)
        along, worst = end - start, np.zeros(len(start))
        square = (along * along).sum(axis=1)
        for share in ALONG:
            away = self._border_at(pieces, share) - start
            at = np.divide(
                (away * along).sum(axis=1), square, out=np.zeros(len(away)), where=square > 0.0
            )
            worst = np.maximum(worst, np.linalg.norm(away - at[:, None] * along, axis=1))
        return worst

    def _border_limits(self) -> Floats:
        """Return the limit of the finest face (b,) at each piece of the border."""
        finest = np.full(len(self.curves), np.inf)
        np.minimum.at(finest, self.border.curve, self.limits[self.owner[self.border.nodes[:, 0]]])
        return np.asarray(finest[self.border.curve])

    def _halve(self, edges: Ints, edge: Ints, split: Bools, keys: Ints, middle: Floats) -> Floats:
        """Halve edges and cut the triangles at them; return the middles' errors of triangles, not a number for new ones."""
        rows = np.flatnonzero(split)
        node = np.full(len(split), -1)
        node[rows] = len(self.points) + np.arange(len(rows))
        owner = self.owner[edges[rows, 0]]
        uv = self.between(edges[rows], ALONG[0])
        own = self.border.key()
        at = np.searchsorted(keys, own)
        cut = (at < len(keys)) & (keys[np.minimum(at, len(keys) - 1)] == own)
        cut[cut] = split[at[cut]]
        pieces, new = self.border.some(cut), node[at[cut]]
        t = pieces.t.mean(axis=1)
        middles = self.progress.each(zip(pieces.line.tolist(), t.tolist(), strict=True))
        uv[new - len(self.points)] = np.array(
            [self.lines[k].Value(m).Coord() for k, m in middles]
        ).reshape(-1, 2)
        surface = np.empty((len(uv), 3))
        for some in _stretches(len(uv)):
            surface[some] = self.on(owner[some], uv[some])[:, 0]
        points = surface.copy()
        points[new - len(self.points)] = self._border_at(pieces, ALONG[0])
        kept = self.border.some(~cut)
        self.border = _Border(
            *(
                np.concatenate([getattr(b, name) for b in (kept, *pieces.halves(new))])
                for name in _Border.__slots__
            )
        )
        self.uv, self.points = np.vstack([self.uv, uv]), np.vstack([self.points, points])
        self.surface = np.vstack([self.surface, surface])
        self.owner = np.concatenate([self.owner, owner])
        self.fixed = np.vstack([self.fixed, np.ones((len(rows), 2), bool)])
        return self._cut(node[edge], middle)

    def _cut(self, new: Ints, middle: Floats) -> Floats:
        """Cut triangles at the new nodes (t, 3) on their edges (-1: none)."""
        count = (new >= 0).sum(axis=1)
        whole = count == 0
        made, owners = [self.triangles[whole]], [self.face[whole]]
        for n in (1, 2, 3):
            rows = np.flatnonzero(count == n)
            # Turn each so that a lone new node is on the first edge, or that the third edge is the one without.
            lead = (
                np.argmax(new[rows] >= 0, axis=1)
                if n == 1
                else (np.argmin(new[rows], axis=1) + 1) % 3
            )
            turn = (lead[:, None] + np.arange(3)) % 3
            a, b, c = np.take_along_axis(self.triangles[rows], turn, axis=1).T
            m, k, s = np.take_along_axis(new[rows], turn, axis=1).T
            if n == 1:
                parts = [(a, m, c), (m, b, c)]
            elif n == 2:
                shorter = np.linalg.norm(self.points[a] - self.points[k], axis=1) <= np.linalg.norm(
                    self.points[m] - self.points[c], axis=1
                )
                parts = [
                    (m, b, k),
                    (a, m, np.where(shorter, k, c)),
                    (np.where(shorter, a, m), k, c),
                ]
            else:
                parts = [(a, m, s), (m, b, k), (s, k, c), (m, k, s)]
            made += [np.column_stack(p) for p in parts]
            owners += [self.face[rows]] * len(parts)
        kept = int(whole.sum())
        self.triangles, self.face = np.vstack(made), np.concatenate(owners)
        _refuse_many(len(self.triangles), self.name, float(self.limits.min()))
        return np.concatenate([middle[whole], np.full(len(self.triangles) - kept, np.nan)])

    def normals(self) -> Floats:
        """Return the outward unit normals (v, 3) of the faces at all points."""
        normals = np.empty_like(self.points)
        for rows in _stretches(len(normals)):
            owner, uv = self.owner[rows], self.uv[rows]
            some, there = self.normal(self.on(owner, uv))
            lost = np.flatnonzero(~there)
            if len(lost):
                # Beside a pole, where the surface has no normal, the one next to it.
                partly = uv[lost] + tolerance.ANGLE * (self.middles[owner[lost]] - uv[lost])
                some[lost] = self.normal(self.on(owner[lost], partly))[0]
            normals[rows] = some * self.sides[owner][:, None]
        return normals

    def result(self, tags: list[int], normals: Floats) -> RefinedMesh:
        """Return what was made, in the order of the faces."""
        order = np.argsort(self.face, kind="stable")
        return RefinedMesh(
            tag=np.array(tags, dtype=np.int64),
            points=self.points,
            normals=normals,
            triangles=self.triangles[order],
            face=self.face[order],
            bound=self.bound,
        )


def _stretches(count: int) -> Iterator[slice]:
    """Yield rows in stretches of `AT_ONCE`."""
    for first in range(0, count, AT_ONCE):
        yield slice(first, first + AT_ONCE)


def _refuse_many(count: int, name: str, chord: float) -> None:
    if count > MOST_TRIANGLES:
        raise OutOfMemory(
            f"{name} needs more than {MOST_TRIANGLES} triangles at a chord error of {chord:g} mm: allow a larger one"
        )


def _coarse(part: Part, tags: list[int], limits: Floats, progress: Progress) -> _Net:
    """Return the kernel's own net of some faces of a part."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.IMeshTools import IMeshTools_Parameters
    from OCP.TopTools import TopTools_IndexedMapOfShape

    from trunnion.part.shape.evaluate import evaluator_of

    how = IMeshTools_Parameters()
    how.Deflection, how.Angle, how.Relative = (
        max(COARSE, float(limits.min(initial=np.inf))),
        np.pi,
        False,
    )
    index = TopTools_IndexedMapOfShape()
    curves: list[Any] = []
    lines: list[Any] = []
    evaluators, sides, middles = [], [], []
    parameters, points, owners, triangles, faces, borders = [], [], [], [], [], []
    count = made = 0
    for row, tag in enumerate(progress.over(tags, "Opening the faces into triangles")):
        shape = part.face_shape(tag)
        BRepMesh_IncrementalMesh(shape, how)
        adaptor = BRepAdaptor_Surface(shape)
        evaluators.append(evaluator_of(adaptor))
        uv, p, t, net = _net_of(shape)
        if not len(t):
            raise BadInput(
                f"face {tag} of {part.name} can't be opened into triangles: heal the part, or leave the face out of the solid"
            )
        sides.append(_side(shape))
        if not _looks_out(evaluators[-1], sides[-1], uv, p, t):
            t = t[:, ::-1]
        middles.append(
            (
                0.5 * (adaptor.FirstUParameter() + adaptor.LastUParameter()),
                0.5 * (adaptor.FirstVParameter() + adaptor.LastVParameter()),
            )
        )
        borders += _border_of(shape, net, uv, index, curves, lines, count)
        parameters.append(uv)
        points.append(p)
        owners.append(np.full(len(p), row))
        triangles.append(t + count)
        faces.append(np.full(len(t), row))
        count += len(p)
        made += len(t)
        _refuse_many(made, part.name, how.Deflection)
    border = _Border(
        *(np.concatenate([getattr(b, name) for b in borders]) for name in _Border.__slots__)
    )
    _, alike = np.unique(np.column_stack([border.curve, border.t]), axis=0, return_inverse=True)
    border.piece = alike.ravel() * PIECES + 1
    net = _Net(
        part.name,
        evaluators,
        np.array(sides),
        limits,
        np.array(middles),
        np.concatenate(parameters),
        np.concatenate(points),
        np.zeros((count, 3)),
        np.concatenate(owners),
        np.concatenate(triangles),
        np.concatenate(faces),
        border,
        curves,
        lines,
        np.ones((count, 2), bool),
        np.zeros(len(tags)),
    )
    at = net.on(net.owner, net.uv)
    net.surface, lengths = at[:, 0], np.linalg.norm(at[:, 1:3], axis=2)
    net.fixed = lengths > tolerance.PARAMETRIC * np.maximum(
        lengths.max(axis=1, keepdims=True), tolerance.COINCIDENT
    )
    net.join_poles()
    return net


def _side(shape: Any) -> float:
    from OCP.TopAbs import TopAbs_REVERSED

    return -1.0 if shape.Orientation() == TopAbs_REVERSED else 1.0


def _net_of(shape: Any) -> tuple[Floats, Floats, Ints, Any]:
    """Return the net that the mesher has left on a face: uv (v, 2), points (v, 3), triangles (t, 3), and the kernel's own object."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    where = TopLoc_Location()
    net = BRep_Tool.Triangulation_s(shape, where)
    if net is None or not net.NbTriangles():
        return np.zeros((0, 2)), np.zeros((0, 3)), np.zeros((0, 3), np.int64), net
    points = np.array([net.Node(n).Coord() for n in range(1, net.NbNodes() + 1)])
    uv = np.array([net.UVNode(n).Coord() for n in range(1, net.NbNodes() + 1)])
    triangles = (
        np.array([net.Triangle(n).Get() for n in range(1, net.NbTriangles() + 1)], dtype=np.int64)
        - 1
    )
    if not where.IsIdentity():
        move = where.Transformation()
        turn = np.array([[move.Value(r, c) for c in range(1, 5)] for r in range(1, 4)])
        points = points @ turn[:, :3].T + turn[:, 3]
    return uv, points, triangles, net


def _looks_out(
    evaluate: Evaluator, side: float, uv: Floats, points: Floats, triangles: Ints
) -> bool:
    """Return whether triangles run anticlockwise seen from outside: on surfaces of revolution the mesher's order doesn't show it
    (measured)."""
    corners = points[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    largest = np.argsort(-(across * across).sum(axis=1), kind="stable")[:1]
    at = evaluate(uv[triangles[largest]].mean(axis=1))
    return float((np.cross(at[:, 1], at[:, 2]) * across[largest]).sum()) * side > 0.0


def _border_of(
    shape: Any,
    net: Any,
    uv: Floats,
    index: Any,
    curves: list[Any],
    lines: list[Any],
    first: int,
) -> list[_Border]:
    """Return the pieces of a face's boundary edges, its nodes counted from `first`; adds to the curves and to their lines in faces."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
    from OCP.TopAbs import TopAbs_EDGE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    found = []
    walk = TopExp_Explorer(shape, TopAbs_EDGE)
    while walk.More():
        edge = TopoDS.Edge_s(walk.Current())
        walk.Next()
        # The net lies where the face does.
        where = TopLoc_Location()
        BRep_Tool.Triangulation_s(shape, where)
        chain = BRep_Tool.PolygonOnTriangulation_s(edge, net, where)
        if chain is None or BRep_Tool.Degenerated_s(edge) or not chain.HasParameters():
            continue
        curve = index.Add(edge) - 1
        if curve == len(curves):
            curves.append(BRepAdaptor_Curve(edge))
        nodes = np.array([chain.Node(k) for k in range(1, chain.NbNodes() + 1)], dtype=np.int64) - 1
        t = np.array([chain.Parameter(k) for k in range(1, chain.NbNodes() + 1)])
        # A seam has two lines, and which one goes with the net's own nodes isn't known.
        sides = (
            [edge, TopoDS.Edge_s(edge.Reversed())] if BRep_Tool.IsClosed_s(edge, shape) else [edge]
        )
        both = [BRepAdaptor_Curve2d(side, shape) for side in sides]
        lines.append(
            min(
                both,
                key=lambda line: np.hypot(*(np.array(line.Value(t[0]).Coord()) - uv[nodes[0]])),
            )
        )
        n, nodes = len(nodes) - 1, nodes + first
        found.append(
            _Border(
                np.column_stack([nodes[:-1], nodes[1:]]),
                np.full(n, curve),
                np.full(n, len(lines) - 1),
                np.column_stack([t[:-1], t[1:]]),
                np.zeros(n, np.int64),
            )
        )
    return found
