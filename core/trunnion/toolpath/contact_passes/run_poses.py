"""Where a leaning cutter is along a run of chosen axes: in blocks as long as their chord error and the chosen axes allow."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.sphere import angle_between
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.toolpath.contact_passes.axis_search import FreeAxes
from trunnion.toolpath.contact_passes.contacts import Contacts, between, slerp, value_at
from trunnion.toolpath.contact_passes.passes import Pass

SHARES = (0.25, 0.5, 0.75)
"""Where on a block its chord error is looked at, beside the contacts on its path."""
HALVINGS = 16
"""Times that a block is halved at most."""
MOST_AXES, FEWEST_BLOCKS = 16, 4
"""Chosen axes that one block spans at most, and blocks that a pass has at least before they are halved: the ends of a loop meet."""
ASTRAY = math.radians(0.5)
"""rad: how far a block's axis may be from the one that was chosen, between its ends."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RunPoses:
    """A run of axes along a contact pass, and the cutter on it: the `position` (k,) of each of its poses along the contacts."""

    contacts: Contacts
    run: FreeAxes
    tool: Tool
    allowance: float
    position: Floats
    poses: Pass

    @staticmethod
    def of(
        contacts: Contacts, run: FreeAxes, tool: Tool, chord: float, allowance: float = 0.0
    ) -> RunPoses:
        """Return where a cutter is along a run, in blocks as long as the chord error (mm) and the chosen axes allow."""
        axis_positions = run.position
        stride = max(1, min(MOST_AXES, (len(axis_positions) - 1) // FEWEST_BLOCKS))
        position = np.append(axis_positions[:-1:stride], axis_positions[-1])
        made = RunPoses.at(contacts, run, tool, allowance, position)
        radius = max(tool.corner_radius, 0.25 * tool.radius)
        travel = contacts.travel(radius)
        inside = np.arange(math.floor(position[0]), math.ceil(position[-1]), dtype=np.float64)
        inner = np.concatenate([inside, axis_positions[1:-1]])
        inner = inner[(inner > position[0]) & (inner < position[-1])]
        for _ in range(HALVINGS):
            worst = made._off(inner, travel, chord)
            split = np.flatnonzero(
                (worst > 1.0)
                & (
                    np.linalg.norm(np.diff(made.poses.tip, axis=0), axis=1)
                    > 2.0 * tolerance.SHORT_MOVE
                )
            )
            if not len(split):
                break
            middles = 0.5 * (made.position[split] + made.position[split + 1])
            made = made.with_positions(middles)
        return made

    @staticmethod
    def at(
        contacts: Contacts, run: FreeAxes, tool: Tool, allowance: float, position: Floats
    ) -> RunPoses:
        """Return the run with poses at positions (k,)."""
        point, normal = between(contacts.point, contacts.normal, contacts.feed, position)
        axis = run.at(position)
        tip = tip_at(tool, point + allowance * normal, normal, axis)
        return RunPoses(
            contacts=contacts,
            run=run,
            tool=tool,
            allowance=allowance,
            position=position,
            poses=Pass(tip=tip, axis=axis, normal=normal),
        )

    def with_positions(self, more: Floats) -> RunPoses:
        """Return the run with poses at more positions (m,)."""
        position = np.union1d(self.position, more)
        return RunPoses.at(self.contacts, self.run, self.tool, self.allowance, position)

    def axis_positions_within(self, blocks: Bools) -> Floats:
        """Return the positions (m,) of chosen axes within some of the blocks (k - 1,)."""
        block = np.searchsorted(self.position, self.run.position, side="right") - 1
        inside = (block < len(blocks)) & ~np.isin(self.run.position, self.position)
        return self.run.position[inside & blocks[np.minimum(block, len(blocks) - 1)]]

    def _off(self, inner: Floats, travel: Floats, chord: float) -> Floats:
        """Return how far each block (k - 1,) is off, in what it may be: the straight block from the contact's tip along the face's normal,
        against the chord error, and its axis, which turns evenly, from the chosen one, against `ASTRAY`.

        `inner` (m,): positions that are looked at beside `SHARES` of each block; travel (n,): how far the cutter has come at each contact.
        """
        position, tip, axis = self.position, self.poses.tip, self.poses.axis
        share = np.concatenate([position[:-1] + s * np.diff(position) for s in SHARES])
        probe = np.concatenate([inner, share])
        block = np.clip(np.searchsorted(position, probe, side="right") - 1, 0, len(position) - 2)
        gone, ends = value_at(travel, probe), value_at(travel, position)
        part = np.clip(
            (gone - ends[block]) / np.maximum(ends[block + 1] - ends[block], tolerance.PARAMETRIC),
            0.0,
            1.0,
        )
        turned = slerp(axis[block], axis[block + 1], part)
        c = self.contacts
        at, out = between(c.point, c.normal, c.feed, probe)
        tip_at_block = tip[block] + part[:, None] * (tip[block + 1] - tip[block])
        wanted = tip_at(self.tool, at + self.allowance * out, out, turned)
        off = np.abs(((tip_at_block - wanted) * out).sum(axis=1))
        astray = angle_between(turned, self.run.at(probe))
        worst = np.zeros(len(position) - 1)
        np.maximum.at(worst, block, np.maximum(off / chord, astray / ASTRAY))
        return worst
