"""What a face's trim holds, for many positions at once: its outline as short pieces in the face's own parameters decides nearly all of
them, and the CAD kernel those beside it."""

from __future__ import annotations

from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.GeomAbs import GeomAbs_Line
from OCP.TopAbs import TopAbs_REVERSED, TopAbs_WIRE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels.outline import IN, NEAR
from trunnion.geometry.outlines import Outlines
from trunnion.part.topology.faces import TrimmedFace
from trunnion.progress import NO_PROGRESS, Progress

SAG = 1e-4
"""Of the face's size in its parameters: how far a piece may be from the outline."""
FEW = 40
"""Fewer positions are classified by the kernel alone: that is as quick as opening the outline."""
HALVINGS = 8
ON = 1e-6
"""Of the face's size in its parameters: a position this near to the outline where that runs along the bounds lies on it; the kernel's
bounds are wider by a tenth of this."""
TRIED = 8
"""Positions along both sides of a grid at which the outline must say the same as the kernel."""


_NOWHERE = Outlines.of(np.full((1, 4), 9.0), ON)
"""An outline beside all faces."""


class Trim:
    """The trimmed area of a face; `progress` is looked at while the kernel is queried."""

    def __init__(self, view: TrimmedFace, progress: Progress = NO_PROGRESS) -> None:
        self._view, self._progress = view, progress
        u0, u1, v0, v1 = view.bounds()
        self._turns = np.array([view.adaptor.IsUPeriodic(), view.adaptor.IsVPeriodic()])
        self._low, self._size = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
        self._outlines: Outlines | None = None
        self._along_bounds: Outlines | None = None
        self._tried = False

    def holds(self, uv: Floats, with_rim: bool = False) -> Bools:
        """Return which uv (k, 2) lie inside; with its rim, positions on the outline do too (else the kernel may say either)."""
        if not self._tried and len(uv) > FEW:
            self._tried = True
            self._outlines = self._opened()
        if self._outlines is None:
            return self._by_kernel(uv)
        share = (uv - self._low) / self._size
        position_class = self._outlines.within(share)
        # The kernel brings positions beyond a seam back; it is queried for those as well.
        unsure = (position_class == NEAR) | (((share < 0.0) | (share > 1.0)) & self._turns).any(
            axis=1
        )
        inside = position_class == IN
        if with_rim and unsure.any():
            # Where bounds are clipped to, most positions lie on the outline: the kernel takes 0.3 ms for each of these (measured).
            on_rim = np.zeros(len(uv), dtype=bool)
            on_rim[unsure] = self._on_rim(share[unsure])
            inside |= on_rim
            unsure &= ~on_rim
        inside[unsure] = self._by_kernel(uv[unsure])
        return inside

    def _on_rim(self, share: Floats) -> Bools:
        if self._along_bounds is None and self._outlines is not None:
            pieces = self._outlines.pieces
            ends = pieces.reshape(-1, 2, 2)
            at_bound = np.stack([np.abs(ends) < ON, np.abs(ends - 1.0) < ON])
            along = np.any(np.all(at_bound, axis=2), axis=(0, 2))
            self._along_bounds = Outlines.of(pieces[along], ON) if along.any() else _NOWHERE
        assert self._along_bounds is not None
        return np.asarray(self._along_bounds.within(share) == NEAR)

    def _by_kernel(self, uv: Floats) -> Bools:
        return np.array([self._holds(u, v) for u, v in uv.tolist()], dtype=bool)

    def _holds(self, u: float, v: float) -> bool:
        self._progress.check()
        return self._view.holds(u, v)

    def _opened(self) -> Outlines | None:
        """Return the face's outlines in shares of its size, or None when they don't close or don't say what the kernel says."""
        if not (np.isfinite(self._size).all() and (self._size > 0.0).all()):
            return None
        pieces = []
        walk = TopExp_Explorer(self._view.face, TopAbs_WIRE)
        while walk.More():
            chain = self._chain(TopoDS.Wire_s(walk.Current()))
            walk.Next()
            if chain is None:
                return None
            pieces.append(np.hstack([chain, np.roll(chain, -1, axis=0)]))
        if not pieces:
            return None
        made = Outlines.of(np.vstack(pieces), 3.0 * SAG)
        share = (np.arange(TRIED) + 0.5) / TRIED
        grid = np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
        position_class = made.within(grid)
        sure = position_class != NEAR
        return (
            made
            if (
                (position_class[sure] == IN) == self._by_kernel(self._low + grid[sure] * self._size)
            ).all()
            else None
        )

    def _chain(self, wire: Any) -> Floats | None:
        """Return the points (k, 2) along a wire, or None when its edges don't follow each other."""
        chains = []
        walk = BRepTools_WireExplorer(wire, self._view.face)
        while walk.More():
            edge = walk.Current()
            chain = self._along(BRepAdaptor_Curve2d(edge, self._view.face))
            chains.append(chain[::-1] if edge.Orientation() == TopAbs_REVERSED else chain)
            walk.Next()
        if not chains:
            return None
        gaps = [np.abs(chains[k][0] - chains[k - 1][-1]).max() for k in range(len(chains))]
        return np.vstack(chains) if max(gaps) < SAG else None

    def _along(self, line: Any) -> Floats:
        """Return points (k, 2) along an edge in shares of the face's size, so near that pieces between them follow it."""
        t = np.linspace(
            line.FirstParameter(), line.LastParameter(), 2 if line.GetType() == GeomAbs_Line else 17
        )
        at = self._at(line, t)
        for _ in range(HALVINGS if len(t) > 2 else 0):
            middle = 0.5 * (t[:-1] + t[1:])
            between = self._at(line, middle)
            far = np.linalg.norm(between - 0.5 * (at[:-1] + at[1:]), axis=1) > SAG
            if not far.any():
                break
            rows = np.flatnonzero(far) + 1
            t, at = np.insert(t, rows, middle[far]), np.insert(at, rows, between[far], axis=0)
        return at

    def _at(self, line: Any, t: Floats) -> Floats:
        return (
            np.array([line.Value(s).Coord() for s in t.tolist()]).reshape(-1, 2) - self._low
        ) / self._size
