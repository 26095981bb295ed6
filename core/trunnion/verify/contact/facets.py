"""A tool whose axis leans or turns, or faces of any form: the deepest contact with triangles, by a tree and bounds
(`kernels/contact/facets.py`).

A reported depth is attained on a triangle at a moment of the move; the true one is at most `tolerance.CONTACT_BOUND` deeper where the axis
keeps still and `tolerance.TURNING_BOUND` where it turns, plus `Facets.bound`, which is how far the triangles may be from the faces. Depths
beyond 1 mm are only known to be at least that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from threading import Lock

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.tool import Tool
from trunnion.part.shape.facets import Facets
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.verify.contact.obstacles import Obstacles
from trunnion.verify.contact.penetration import Penetration, deepen
from trunnion.verify.cutter import bodies_of_one
from trunnion.verify.kernels.contact import facets as kernel
from trunnion.verify.kernels.contact import pose_search
from trunnion.verify.kernels.contact.bvh import build_bvh
from trunnion.verify.motion import Moves, seen_from

CHUNK = 100
"""Moves between two looks at cancel, fewer when they are long."""
SHORT = 10.0
"""mm: a move so much longer than this counts as several."""
BATCH = 16
"""Positions whose poses are tried between two looks at cancel: some tens of milliseconds when nothing is known of what is in the way."""
LEAF = 4
"""Most triangles of a leaf."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetTree:
    """Triangles in the order of the leaves of trees of boxes, in preorder one behind the other; `kernels/contact/bvh.py` names the columns.

    The first tree has `leading` nodes.
    """

    boxes: Floats
    skip: Ints
    leaves: Ints
    node_face: Ints
    corners: Floats
    normals: Floats
    face: Ints
    leading: int

    def first(self) -> FacetTree:
        """Return the first tree alone, in the same memory."""
        t = int(self.leaves[: self.leading].sum(axis=1).max(initial=0))
        return FacetTree(
            boxes=self.boxes[: self.leading],
            skip=self.skip[: self.leading],
            leaves=self.leaves[: self.leading],
            node_face=self.node_face[: self.leading],
            corners=self.corners[:t],
            normals=self.normals[:t],
            face=self.face[:t],
            leading=self.leading,
        )


def tree_of(points: Floats, triangles: Ints, face: Ints, leading: Ints | None = None) -> FacetTree:
    """Return the tree over triangles (t, 3) of points (v, 3), each with the row of its face (t,).

    The faces of the rows `leading` have a tree of their own, the others one behind it: a traversal goes through both as if they were one.
    """
    ahead = np.ones(len(face), bool) if leading is None else np.isin(face, leading)
    rows = np.concatenate([np.flatnonzero(ahead), np.flatnonzero(~ahead)])
    corners, face, t = points[triangles[rows]], face[rows], len(rows)
    order, boxes = np.zeros(t, np.int64), np.zeros((2 * t, 6))
    skip, leaves, node_face = (
        np.zeros(2 * t, np.int64),
        np.zeros((2 * t, 2), np.int64),
        np.zeros(2 * t, np.int64),
    )
    counts = [0]
    for some in (slice(0, int(ahead.sum())), slice(int(ahead.sum()), t)):
        n = counts[-1]
        if some.start < some.stop:
            n += build_bvh(
                corners[some].min(axis=1),
                corners[some].max(axis=1),
                face[some],
                LEAF,
                order[some],
                boxes[n:],
                skip[n:],
                leaves[n:],
                node_face[n:],
            )
        skip[counts[-1] : n] += counts[-1]
        leaves[counts[-1] : n, 0] += some.start
        order[some] += some.start
        counts.append(n)
    corners = corners[order]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1, keepdims=True)
    # Any direction bounds a triangle without area.
    normals = np.where(
        size > 0.0, across / np.where(size > 0.0, size, 1.0), np.array([0.0, 0.0, 1.0])
    )
    count = counts[-1]
    return FacetTree(
        boxes=boxes[:count].copy(),
        skip=skip[:count].copy(),
        leaves=leaves[:count].copy(),
        node_face=node_face[:count].copy(),
        corners=corners.reshape(-1, 9),
        normals=normals,
        face=face[order],
        leading=counts[1],
    )


class FacetContact:
    """Triangles made ready for many questions. `facets` must be in the frame of the moves; `seen_from` serves moves in other ones.

    The faces of the rows `leading` can be asked alone (`of_leading`), by the same tree.
    """

    def __init__(self, facets: Facets, leading: Ints | None = None) -> None:
        self.facets, self._leading = facets, leading

    @cached_property
    def tree(self) -> FacetTree:
        """The tree over the triangles, built on first use."""
        return tree_of(self.facets.points, self.facets.triangles, self.facets.face, self._leading)

    def of_leading(self) -> FacetContact:
        """Return the leading faces alone, made ready together with all."""
        return _LeadingContact(self)

    def seen_from(self, frame: Frame, other: Frame) -> FacetContact:
        """Return the same triangles, given in a frame, for moves in another one: the moves are brought to the triangles, whose tree serves
        all frames."""
        return _ContactInFrame(self, frame, other)

    def ready(self, progress: Progress = NO_PROGRESS) -> FacetTree:
        """Return the tree, with looks at progress while it is built."""
        if "tree" not in self.__dict__:
            progress.aside(lambda _: self.tree)
        return self.tree

    def along(
        self, moves: Moves, rows: Ints, progress: Progress = NO_PROGRESS, threads: int = 0
    ) -> Penetration:
        """Return how deep the moves of some rows (k,) enter the faces, whichever way the tool stands."""
        return self._measure(moves, rows, progress, threads)

    def stopped(self, moves: Moves, rows: Ints, allowed: float) -> Floats:
        """Return a position (k, 3) of the faces that the tool enters deeper than allowed, for the moves of some rows (k,); NaN where
        none."""
        return self._measure(moves, rows, NO_PROGRESS, 1, allowed).deeper_than(allowed)

    def any_clear(
        self,
        tool: Tool,
        tips: Floats,
        axes: Floats,
        wanted: Bools,
        allowed: float,
        obstacles: Obstacles,
        progress: Progress = NO_PROGRESS,
        text: str = "",
        threads: int = 0,
    ) -> Bools:
        """Return for k positions whether one of the poses (k, a, 3) of a tool that are wanted (k, a) enters no face deeper than allowed.

        `obstacles` are the positions'; what stops a pose is added to them.
        """
        tree, bodies, found = self.ready(progress), bodies_of_one(tool), np.zeros(len(tips), bool)

        def some(first: int, last: int) -> None:
            pose_search.pose_search_loop(
                first,
                last,
                tips,
                axes,
                wanted,
                bodies.arc,
                bodies.piece,
                tree.boxes,
                tree.skip,
                tree.leaves,
                tree.corners,
                tree.normals,
                tree.face,
                len(self.facets.tag),
                allowed,
                tolerance.CONTACT_BOUND,
                obstacles.position,
                obstacles.count,
                found,
            )

        in_parallel(some, len(tips), BATCH, progress, text, threads)
        return found

    def _measure(
        self, moves: Moves, rows: Ints, progress: Progress, threads: int, settle: float = np.inf
    ) -> Penetration:
        tree, bodies, k, f = self.ready(progress), moves.bodies, len(rows), len(self.facets.tag)
        bound = np.where(moves.turning(rows), tolerance.TURNING_BOUND, tolerance.CONTACT_BOUND)
        enough = np.full(k, settle) if np.isfinite(settle) else bound
        penetration = Penetration(
            depth=np.full((k, 2), -np.inf),
            face=np.full((k, 2), -1),
            position=np.full((k, 2, 3), np.nan),
            face_depth=np.full((f, 2), -np.inf),
            face_move=np.full((f, 2), -1),
        )
        merging = Lock()

        starts = _starts(1.0 + moves.length[rows] / SHORT)

        def work(first: int, last: int) -> None:
            face_depth, face_move = np.full((f, 2), -np.inf), np.full((f, 2), -1)
            kernel.triangle_contact_loop(
                int(starts[first]),
                int(starts[last]),
                rows,
                moves.start,
                moves.end,
                moves.start_axis,
                moves.end_axis,
                moves.centre,
                moves.sweep,
                moves.tool,
                bodies.arc,
                bodies.piece,
                bodies.start,
                tree.boxes,
                tree.skip,
                tree.leaves,
                tree.node_face,
                tree.corners,
                tree.normals,
                tree.face,
                f,
                bound,
                enough,
                settle,
                penetration.depth,
                penetration.face,
                penetration.position,
                face_depth,
                face_move,
            )
            with merging:
                deepen(penetration.face_depth, penetration.face_move, face_depth, face_move)

        in_parallel(
            work,
            len(starts) - 1,
            1,
            progress,
            "Measuring gouges and collisions of leaning tools",
            threads,
        )
        return penetration


class _LeadingContact(FacetContact):
    """The leading faces of a contact."""

    def __init__(self, whole: FacetContact) -> None:
        super().__init__(whole.facets)
        self._whole = whole

    @cached_property
    def tree(self) -> FacetTree:
        """The first tree over the triangles of the whole."""
        return self._whole.tree.first()


class _ContactInFrame(FacetContact):
    """The triangles of a contact, given in a frame, for moves in another one."""

    def __init__(self, whole: FacetContact, frame: Frame, other: Frame) -> None:
        super().__init__(whole.facets)
        self._whole, self._frame, self._other = whole, frame, other

    @property
    def tree(self) -> FacetTree:
        """The tree over the triangles, where they are."""
        return self._whole.tree

    def ready(self, progress: Progress = NO_PROGRESS) -> FacetTree:
        """Return the tree, with looks at progress while it is built."""
        return self._whole.ready(progress)

    def of_leading(self) -> FacetContact:
        """Return the leading faces alone, for moves in the same frame."""
        return self._whole.of_leading().seen_from(self._frame, self._other)

    def any_clear(
        self,
        tool: Tool,
        tips: Floats,
        axes: Floats,
        wanted: Bools,
        allowed: float,
        obstacles: Obstacles,
        progress: Progress = NO_PROGRESS,
        text: str = "",
        threads: int = 0,
    ) -> Bools:
        """Return what `FacetContact.any_clear` does; the obstacles are in the frame of the poses."""
        known = obstacles.moved(self._other, self._frame)
        found = self._whole.any_clear(
            tool,
            self._frame.to_local(self._other.to_world(tips)),
            self._frame.local_direction(self._other.world_direction(axes)),
            wanted,
            allowed,
            known,
            progress,
            text,
            threads,
        )
        obstacles.put(np.arange(len(tips)), known.moved(self._frame, self._other))
        return found

    def _measure(
        self, moves: Moves, rows: Ints, progress: Progress, threads: int, settle: float = np.inf
    ) -> Penetration:
        here = seen_from(moves.some(rows), self._other, self._frame)
        every = np.arange(len(rows))
        found = self._whole._measure(here, every, progress, threads, settle)
        position = self._other.to_local(self._frame.to_world(found.position.reshape(-1, 3)))
        move = np.append(rows, -1)[found.face_move]
        return replace(found, position=position.reshape(-1, 2, 3), face_move=move)


def _starts(cost: Floats) -> Ints:
    """Return where chunks of moves (k,) begin, and their end, so that each costs about `CHUNK`; none is longer than that many moves."""
    chunk = (np.cumsum(cost) - cost) // CHUNK
    return np.append(np.flatnonzero(np.diff(chunk, prepend=-1.0)), len(cost))
