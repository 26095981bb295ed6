"""The load of cutting on cutter and spindle, move by move: depth, removal rate, thickest chip, power and torque.

The stock engine says what a move removes and over which angle the cutter is engaged. Both come in steps of the stock's cells, so volumes
are taken over a stretch of the path around each move. Power follows Kienzle: k_c = k_c1.1 h^-m with the mean chip thickness h over the arc
of contact (O. Kienzle, Die Bestimmung von Kräften und Leistungen an spanenden Werkzeugen und Werkzeugmaschinen, VDI-Z 94, 1952); the
constants stand with their source in the catalogue of materials.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.material import Material
from trunnion.model.motion.program import STOPPED, ProgramSection
from trunnion.model.tool import Tool
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT
from trunnion.verify.motion import Moves
from trunnion.verify.stock import StockRun

STRETCH = 1.0
"""Length of the stretch over the cutter's diameter: corners of a pocket's rings load a cutter for less, and it bears that."""
CELLS = 4.0
"""Least length of the stretch in cells of the stock."""
NEWTON_METRES = SECONDS_PER_MINUTE * WATTS_PER_KILOWATT / (2.0 * math.pi)
"""Torque in Nm of one kW at one turn a minute."""
LEAST_CHIP = 1e-3
"""mm: below this a cutter rubs; Kienzle's formula is not held there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Load:
    """Load of moves n, 0 where nothing is cut.

    depth (n,) mm along the axis, the mean over the width that is engaged; rate (n,) cm3/min; chip (n,) mm the thickest, mean_chip (n,) mm
    over the arc of contact; power (n,) kW at the cutter; torque (n,) Nm.
    """

    depth: Floats
    rate: Floats
    chip: Floats
    mean_chip: Floats
    power: Floats
    torque: Floats


def load_of(
    moves: Moves,
    run: StockRun,
    speed: Floats,
    sections: Sequence[ProgramSection],
    cell: float,
    material: Material | None,
) -> Load:
    """Return the load of every move.

    speed (n,) mm/s of the tip; `cell` mm of the stock. Without a material there is no power; while the spindle stands there is no chip, no
    power and no torque, whatever the tool is pushed through.
    """
    radius = (
        np.array([t.core_radius for t in moves.tools])[moves.tool] if len(moves) else np.zeros(0)
    )
    teeth = (
        np.array([s.cutter.teeth for s in sections])[moves.section] if len(moves) else np.zeros(0)
    )
    spindle = np.array([s.spindle for s in sections])[moves.section] if len(moves) else np.zeros(0)
    flute = (
        np.array([t.flute_length for t in moves.tools])[moves.tool] if len(moves) else np.zeros(0)
    )
    seen = np.clip(run.engagement, 0.0, math.pi)
    width = radius * (1.0 - np.cos(seen))
    stretch = np.maximum(2.0 * STRETCH * radius, CELLS * cell)
    mean_area = stretched(moves, run.removed, stretch)
    # A long block cuts, where it is widest, what its mean says times how much wider it is there, and no more than fits.
    # What is narrower than the stock's cells is missing in the mean of widths: the widest stretch itself is the other bound.
    area = np.maximum(mean_area, np.minimum(mean_area * run.peak, run.widest * run.depth_of_cut))
    # What is in front of an insert does not change along its short blocks: the stretch's mean says it, without the cells' steps.
    locked = locked_moves(sections, moves)
    area = np.where(locked, mean_area, area)
    # Of a stretch's volume a move that meets no material has no share: it runs through the air before or behind it.
    cuts = (area > 0.0) & ~moves.rapid & ((run.removed > 0.0) | (run.engagement > 0.0))
    angle = np.maximum(seen, least_angle(area, radius, flute))
    feed = np.where(cuts, speed * SECONDS_PER_MINUTE, 0.0)
    # What a slower neighbour takes off goes at the neighbour's feed, in chips of that feed: a flat turn after a slow helix doesn't take
    # the helix's share at its own. What a quicker one takes is no load of this move.
    flow = stretched(moves, run.removed * speed * SECONDS_PER_MINUTE, stretch)
    flow = np.minimum(flow, mean_area * feed)
    wider = np.divide(area, mean_area, out=np.zeros(len(moves)), where=cuts)
    rate = flow * wider / MM_PER_METRE
    per_tooth, around = (
        np.divide(f, teeth * spindle, out=np.zeros(len(moves)), where=spindle > STOPPED)
        for f in (
            feed,
            np.divide(flow, mean_area, out=np.zeros(len(moves)), where=cuts),
        )
    )
    axial = drill_shares(sections)[moves.section] if len(moves) else np.zeros(0)
    drills = axial > 0.0
    chip = per_tooth * np.where(drills, axial, np.sin(np.minimum(angle, math.pi / 2.0)))
    mean = around * np.where(drills, axial, mean_share(angle))
    insert = insert_chip(area, radius, run.depth_of_cut)
    chip, mean = np.where(locked, insert, chip), np.where(locked, insert, mean)
    power = np.zeros(len(moves))
    if material is not None:
        power = np.where(
            (spindle > STOPPED) | locked,
            rate * specific_force(material, mean) / (SECONDS_PER_MINUTE * WATTS_PER_KILOWATT),
            0.0,
        )
    held = np.divide(area, width, out=np.zeros(len(moves)), where=cuts & (width > 0.0))
    torque = NEWTON_METRES * np.divide(
        power, spindle, out=np.zeros(len(moves)), where=spindle > STOPPED
    )
    return Load(
        depth=np.minimum(held, run.depth_of_cut),
        rate=rate,
        chip=np.where(cuts, chip, 0.0),
        mean_chip=np.where(cuts, mean, 0.0),
        power=power,
        torque=torque,
    )


def locked_moves(sections: Sequence[ProgramSection], moves: Moves) -> Bools:
    """Return which moves (n,) are of a turning insert in a locked spindle: the work moves, and its speed is the feed."""
    locked = np.array([s.tool.locked for s in sections], dtype=bool)
    return locked[moves.section] if len(moves) else np.zeros(0, dtype=bool)


def insert_chip(area: Floats, radius: Floats, depth: Floats) -> Floats:
    """Return the mean thickness (n,) mm of the chip of a round insert: the area (n,) mm2 that it takes over the length of its edge in
    contact, r acos(1 - depth / r), and no more than the cut is deep."""
    share = np.divide(depth, radius, out=np.zeros_like(depth), where=radius > 0.0)
    contact = radius * np.arccos(np.clip(1.0 - share, -1.0, 1.0))
    thick = np.divide(area, contact, out=np.zeros_like(area), where=contact > 0.0)
    return np.minimum(thick, depth)


def drill_shares(sections: Sequence[ProgramSection]) -> Floats:
    """Return for each section's tool the chip thickness over the feed per tooth where it cuts along its axis, sin(kappa) with kappa half a
    drill's point angle and 45 degrees at a reamer's lead (their edges cut all round, at one thickness); 0 for other tools."""
    return np.array([_axial_share(s.cutter) for s in sections])


def _axial_share(tool: Tool) -> float:
    if tool.form == "drill":
        return math.sin(math.radians(0.5 * tool.point_angle))
    return math.sqrt(0.5) if tool.form in ("reamer", "boring-bar") else 0.0


def least_angle(area: Floats, radius: Floats, flute: Floats) -> Floats:
    """Return the smallest angle of contact (n,) rad at which cutters take cross-sections of area (n,) mm2: all along their flutes (n,) mm.

    A cut narrower than the stock's cells is not seen by the probes, though its volume is.
    """
    width = np.minimum(
        np.divide(area, flute, out=np.zeros_like(area), where=flute > 0.0), 2.0 * radius
    )
    return np.arccos(1.0 - np.divide(width, radius, out=np.zeros_like(area), where=radius > 0.0))


def mean_share(angle: Floats) -> Floats:
    """Return the mean chip thickness over the feed per tooth for angles of contact (n,) rad that begin at the cutter's side.

    The chip is fz sin(a) thick, a from 0 to the angle: its mean is fz (1 - cos(angle)) / angle.
    """
    return np.divide(1.0 - np.cos(angle), angle, out=np.zeros_like(angle), where=angle > 0.0)


def specific_force(material: Material, chip: Floats) -> Floats:
    """Return the specific cutting force k_c in N/mm2 at mean chip thicknesses (n,) mm."""
    return np.asarray(material.force * np.maximum(chip, LEAST_CHIP) ** -material.force_exponent)


def stretched(moves: Moves, removed: Floats, stretch: Floats) -> Floats:
    """Return the cross-section (n,) mm2 that each feed move takes away: volume (n,) over path length, on a stretch (n,) mm around it.

    A stretch does not go beyond a rapid: it ends there.
    """
    feeds = ~moves.rapid
    length, volume = np.where(feeds, moves.length, 0.0), np.where(feeds, removed, 0.0)
    # Rapids are given a way that no stretch bridges, along which neither way nor volume grows.
    gap = float(stretch.max(initial=0.0))
    at = np.concatenate([[0.0], np.cumsum(length + np.where(feeds, 0.0, gap))])
    run, taken = (np.concatenate([[0.0], np.cumsum(v)]) for v in (length, volume))
    spare = 0.5 * np.maximum(stretch - length, 0.0)
    low, high = at[:-1] - spare, at[1:] + spare
    distance = np.interp(high, at, run) - np.interp(low, at, run)
    cut = np.interp(high, at, taken) - np.interp(low, at, taken)
    return np.divide(cut, distance, out=np.zeros(len(moves)), where=feeds & (distance > 0.0))
