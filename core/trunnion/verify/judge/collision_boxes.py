"""Where the tip of an upright tool is while shank, holder or any of it collides: what a plan has to keep it out of."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.boxes import boxes_around
from trunnion.geometry.frame import Frame
from trunnion.verify.contact import Contact, PartContact
from trunnion.verify.machine.kinematics import on_arcs
from trunnion.verify.motion import Moves, poses_of
from trunnion.verify.stock import StockRun

APART = 0.5
"""mm between the tips that are looked at on a colliding move."""
LATTICE = 1.0
"""mm between the tips that are looked at beside those that collide."""
ACROSS, OTHER = np.eye(3)[:2]
"""Directions of which the one that lies more across the tool is a side of the lattice."""
MOST_TIPS = 6_000
"""Tips of one operation that are looked at; more would say the same."""
MOST_BOXES = 12
"""Boxes of one operation: three for each side of a pocket."""
DECIMALS = 1
"""Decimals in mm that boxes are rounded outwards to."""

Box = tuple[float, ...]


def collision_boxes(
    moves: Moves, contact: Contact, stock: StockRun, parts: PartContact, rows: Ints, allowed: float
) -> tuple[Box, ...]:
    """Return the boxes (x, y, z, x, y, z), in the setup's frame, that the tip is in while feeds of one operation's rows collide: shank
    or holder deeper than allowed in the part or the stock, anything of the tool in a fixture.

    `contact` and `stock` are what was measured along the moves; `parts` measures again, position by position, also a diameter to every
    side, where passes may be laid instead. None for a tool that leans in its cuts: another tip is no help there.
    """
    rows = rows[~moves.rapid[rows]]
    axis = moves.end_axis[rows[:1]]
    if not len(rows) or not _constant_axis(moves, rows, axis):
        return ()
    met = (contact.depth[rows, 1] > allowed) | (contact.fixture_depth[rows] > allowed)
    in_stock, _ = _tips(moves, rows[~met & (stock.body_depth[rows] > allowed)])
    in_part = _colliding(moves, rows[met], axis, parts, allowed) if met.any() else in_stock[:0]
    return _rounded(boxes_around(np.concatenate([in_stock, in_part]), MOST_BOXES))


def _colliding(
    moves: Moves, rows: Ints, axis: Floats, parts: PartContact, allowed: float
) -> Floats:
    """Return tips (k, 3) at which the tool, its axis (1, 3), collides with part or fixtures, on some moves that do and near them."""
    tool = moves.tools[moves.tool[rows[0]]]

    def collides(tip: Floats) -> Bools:
        met = parts.along(poses_of(tool, tip, np.repeat(axis, len(tip), axis=0)), threads=1)
        return np.asarray((met.depth[:, 1] > allowed) | (met.fixture_depth > allowed))

    tip, of = _tips(moves, rows)
    hits = collides(tip)
    # What is met only between two tips is taken with all of its move.
    hits |= ~np.isin(of, of[hits])
    nearby = _nearby(tip[hits], axis[0], tool.diameter)
    return np.concatenate([tip[hits], nearby[collides(nearby)]])


def _rounded(boxes: Floats) -> tuple[Box, ...]:
    """Return boxes (b, 6) rounded outwards."""
    step, same = 10.0**DECIMALS, tolerance.COINCIDENT
    low = np.floor((boxes[:, :3] + same) * step) / step
    high = np.ceil((boxes[:, 3:] - same) * step) / step
    return tuple(tuple(float(v) + 0.0 for v in box) for box in np.hstack([low, high]))


def _constant_axis(moves: Moves, rows: Ints, axis: Floats) -> bool:
    """Return whether moves keep a tool axis (1, 3) all along."""
    turned = np.abs(np.stack([moves.start_axis[rows], moves.end_axis[rows]]) - axis)
    return float(turned.max()) < tolerance.COINCIDENT


def _nearby(tip: Floats, axis: Floats, far: float) -> Floats:
    """Return tips (k, 3) on a lattice across the axis as high as the nearest of some others and no farther from it: where passes may run
    when these are left out."""
    frame = Frame(np.zeros(3), ACROSS if abs(axis @ ACROSS) < abs(axis @ OTHER) else OTHER, axis)
    known = frame.to_local(tip)
    low, high = known[:, :2].min(axis=0) - far, known[:, :2].max(axis=0) + far
    pitch = max(LATTICE, math.sqrt(float((high - low).prod()) / MOST_TIPS))
    x, y = (np.arange(a, b, pitch) for a, b in zip(low, high, strict=True))
    plan = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    away, nearest = cKDTree(known[:, :2]).query(plan)
    at = np.column_stack([plan, known[nearest, 2]])[away < far]
    return np.asarray(frame.to_world(at))


def _tips(moves: Moves, rows: Ints) -> tuple[Floats, Ints]:
    """Return tips (k, 3) along some moves, both ends among them, and the move (k,) that each is on."""
    apart = max(APART, float(moves.length[rows].sum()) / MOST_TIPS)
    count = np.ceil(moves.length[rows] / apart).astype(np.int64) + 1
    owner, step = items_of(count)
    of, share = rows[owner], step / np.maximum(count[owner] - 1, 1)
    tip = moves.start[of] + share[:, None] * (moves.end[of] - moves.start[of])
    arc = moves.sweep[of] != 0.0
    tip[arc] = on_arcs(moves, of[arc], share[arc])
    return tip, of
