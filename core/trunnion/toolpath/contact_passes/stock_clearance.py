"""Clearance of a leaning tool from stock: which poses keep neck, shank and holder out of it, and from where on rapids may go.

Near the part earlier operations have left more or less everywhere: tools keep a thickness from the part itself. What stands beyond is
known by positions (`plan.clearance.RemainingStockQuery`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery, RemainingStockQuery
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.toolpath.contact_passes.axis_search import thickened
from trunnion.toolpath.contact_passes.tool_moves import ToolMoves
from trunnion.toolpath.stock.remaining import NEAR

STOCK_SHARE, LEAST_STOCK = 2.0, NEAR
"""How much material near the part tools are kept clear of where there is space: times the depth of cut, and mm at least. Earlier cutters
leave more in corners than on faces."""
THICKER = (4.0 * tolerance.HOLDER_CLEARANCE, tolerance.HOLDER_CLEARANCE)
"""mm that a tool is taken thicker by on its moves: first by more, which few poses tell nearly everywhere."""
PIECE = math.radians(10.0)
"""Largest turn of the axis in one piece of a rapid's way."""
LIFTS = (0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
"""mm along its axis that a tool is moved off at feed until a rapid touches nothing: the first of them that does, or the last."""

Cones = Sequence[tuple[float, float, float, float]]
"""A body as cones (z0, r0, z1, r1) from the tip up, mm."""


@dataclass(frozen=True, eq=False)
class StockClearance:
    """Queries of one tool among stock: up to a `thickness` (mm) it may stand anywhere on the part."""

    drive: SurfaceDrive
    tool: Tool
    thickness: float

    @property
    def beyond(self) -> RemainingStockQuery | None:
        """What is known to stand farther off the part; None where nobody knows."""
        return self.drive.remaining_stock

    @property
    def has_stock(self) -> bool:
        """Whether anything is known to stand."""
        return self.beyond is not None and not self.beyond.is_empty

    def with_stock(self, query: ClearanceQuery) -> ClearanceQuery:
        """Return a query that demands of a pose, or all along a move, what another one does, and that nothing above the flutes is in
        stock."""
        beyond = self.beyond
        if beyond is None:
            return query
        bodies = [(t, thickened(self.tool, t).profile()) for t in THICKER]
        rows = bodies[-1][1]

        def both(
            tip: Floats,
            axis: Floats,
            *,
            start_tip: Floats | None = None,
            start_axis: Floats | None = None,
        ) -> Bools:
            tip, axis = (np.asarray(v, dtype=np.float64).reshape(-1, 3) for v in (tip, axis))
            clear = beyond.is_free(rows, tip, axis)
            some = np.flatnonzero(clear)
            starts = [None if v is None else v[some] for v in (start_tip, start_axis)]
            clear[some] = query(tip[some], axis[some], start_tip=starts[0], start_axis=starts[1])
            if start_tip is not None and clear.any():
                moves = ToolMoves(start_tip, axis if start_axis is None else start_axis, tip, axis)
                clear &= self._is_free_along(moves, clear, bodies)
            return clear

        return both

    def queries(
        self,
        query_for: Callable[[Tool], ClearanceQuery],
        query: ClearanceQuery,
        *,
        wary: bool = False,
    ) -> tuple[ClearanceQuery, ...]:
        """Return what poses are asked for, the safest first: clear of stock all over the part and of what stands beyond; of less on the
        part; of what stands beyond alone, and of the part, which `query` tells.

        What no axis comes to without a shank in what stands is left. `wary` leaves out the last, which asks for nothing on the part."""
        found = [
            self.with_stock(query_for(thickened(self.tool, t)))
            for t in sorted({self.thickness, LEAST_STOCK}, reverse=True)
        ]
        if wary:
            return tuple(found)
        return (*found, self.with_stock(query) if self.has_stock else query)

    def retreats(self, tip: Floats, axis: Floats) -> Floats:
        """Return how far (k,) in mm a tool at tips (k, 3) goes out along its axes (k, 3) before the rest of the way is clear of everything:
        the first of `LIFTS` that is, or the last. Asked for all together: one pose alone costs nearly as much as a hundred."""
        tip, axis = (np.asarray(v, dtype=np.float64).reshape(-1, 3) for v in (tip, axis))
        found, rows = np.full(len(tip), LIFTS[-1]), np.arange(len(tip))
        # Its body is nowhere slimmer than below: once it is clear it stays so.
        for lift in LIFTS[:-1]:
            axes = axis[rows]
            tips = tip[rows] + lift * axes
            clear = self._grown_query(tips - self.thickness * axes, axes)
            if self.beyond is not None:
                clear &= self.beyond.is_free(self._body, tips, axes)
            found[rows[clear]], rows = lift, rows[~clear]
            if not len(rows):
                break
        return found

    def is_free_between(
        self, start_tip: Floats, start_axis: Floats, tip: Floats, axis: Floats
    ) -> Bools:
        """Return which rapids (k,) from tips (k, 3) with axes (k, 3) to others keep the thickness off everything all along: the tip goes
        straight, the axis turns evenly."""
        rapids = ToolMoves(start_tip, start_axis, tip, axis)
        way, tips, axes = rapids.poses(np.ceil(rapids.turn / PIECE))
        # A grown tool's tip is lower by the thickness; within a piece that goes straight too, or nearly so.
        low, first = tips - self.thickness * axes, np.flatnonzero(np.diff(way) == 0)
        is_free = self._grown_query(
            low[first + 1], axes[first + 1], start_tip=low[first], start_axis=axes[first]
        )
        clear = np.ones(len(tip), dtype=bool)
        clear[way[first[~is_free]]] = False
        if clear.any():
            clear &= self._is_free_along(rapids, clear, [(self.thickness, self._body)])
        return clear

    def _is_free_along(
        self, moves: ToolMoves, some: Bools, bodies: Sequence[tuple[float, Cones]]
    ) -> Bools:
        """Return which of some moves (k,) keep the tool out of what stands beyond all along; of the others, all do.

        `bodies` are the tool thicker by some mm, from the thickest on: each is asked in the middles of pieces in which no position of the
        tool goes farther than that from where it is there, and what is not clear with one with the next."""
        clear = np.ones(len(some), dtype=bool)
        if self.beyond is None or self.beyond.is_empty:
            return clear
        left = np.flatnonzero(some)
        for thicker, body in bodies:
            moved = moves.travel[left] + self.tool.gauge_length * moves.turn[left]
            way, tips, axes = moves.of(left).middles(np.ceil(moved / (2.0 * thicker)))
            left = left[np.unique(way[~self.beyond.is_free(body, tips, axes)])]
        clear[left] = False
        return clear

    @cached_property
    def _grown_query(self) -> ClearanceQuery:
        assert self.drive.query_for is not None
        return self.drive.query_for(grown(self.tool, self.thickness))

    @cached_property
    def _body(self) -> Cones:
        return _whole_body(self.tool, self.thickness)


def grown(tool: Tool, thickness: float) -> Tool:
    """Return a tool that is thicker all round by a thickness in mm, nowhere slimmer than below; its tip is that much lower."""
    wide = thickened(tool, thickness)
    across = tool.diameter + 2.0 * thickness
    neck = max(wide.neck_diameter, across)
    return replace(
        wide,
        form="bull" if tool.form == "flat" else tool.form,
        diameter=across,
        corner_radius=tool.corner_radius + thickness,
        neck_diameter=neck,
        shank_diameter=max(wide.shank_diameter, neck),
        flute_length=tool.flute_length + thickness,
        neck_length=tool.neck_length + thickness,
        stickout=tool.stickout + thickness,
        gauge_length=tool.gauge_length + thickness,
    )


def _whole_body(tool: Tool, wider: float) -> Cones:
    """Return a whole tool as cones from the tip up, wider by some mm all round and nowhere slimmer than below."""
    rows, widest = [(-wider, tool.radius, tool.flute_length, tool.radius)], tool.radius
    for z0, r0, z1, r1 in tool.profile():
        rows.append((z0, max(r0, widest), z1, max(r1, widest)))
        widest = max(widest, r0, r1)
    return [(z0, r0 + wider, z1, r1 + wider) for z0, r0, z1, r1 in rows]
