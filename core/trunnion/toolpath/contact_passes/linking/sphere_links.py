"""Paths of a leaning tool around a part: passes linked where they lie side by side, through the air over the blank, or round a sphere that
holds blank and fixtures.

A tool that is nowhere slimmer than below stays clear of everything on its way out along its axis if it is clear before: it is fed out by a
little, goes on at rapid until it stands outside of the sphere, turns round it, and comes in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sphere import angle_between
from trunnion.model.motion.toolpath import EMPTY, Mark, Motion, Toolpath
from trunnion.plan.clearance import ClearanceQuery
from trunnion.toolpath.contact_passes.linking.clearance_links import ClearanceLink, ClearanceLinks
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.motion.reorient import ClearanceSphere, turn

Retreat = Callable[[Floats, Floats], float]
"""From a tip and an axis (3,) to how far in mm a tool is fed out along its axis before it goes on at rapid."""

POSE = ("tip", "axis")
"""What a pass has of each pose."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SphereLinkParameters:
    """How passes are linked: those that begin within `near` mm of the end of the one before, with an axis that turns by less than `turn`
    rad, straight at feed; others through the air over the blank, where `air` finds it clear, else round the sphere. `feed` mm/min cuts, and
    goes the last `close` mm to a pass; `link_feed` links."""

    near: float
    turn: float
    feed: float
    link_feed: float
    sphere: ClearanceSphere
    retreat: Retreat
    query: ClearanceQuery
    close: float = 1.0
    air: ClearanceLinks | None = None


def linked_round(
    passes: Sequence[Pass], parameters: SphereLinkParameters, groups: Sequence[int] | None = None
) -> Toolpath:
    """Return the path that cuts passes in their order, without the way to its beginning and from its end: a rapid leads to its first pose,
    outside along the axis, and another one to its last. `groups` (one a pass): only passes of one group are linked straight."""
    if not passes:
        return EMPTY
    blocks = _Blocks(parameters)
    straight = straight_links(passes, parameters, groups or [0] * len(passes))
    over = _over_blank(passes, parameters, straight)
    for k, one in enumerate(passes):
        link = over[k - 1] if k else None
        if k and straight[k - 1]:
            blocks.add(one.tip[:1], one.axis[:1], parameters.feed, Mark.LINK)
        elif link is not None:
            blocks.off(passes[k - 1], link.tip[0])
            blocks.add(link.tip[1:], link.axis[1:], 0.0, Mark.RETRACT)
            blocks.down(one, link.tip[-1])
        else:
            if k:
                blocks.out(passes[k - 1])
                blocks.round(passes[k - 1].axis[-1], one.tip[0], one.axis[0])
            blocks.come(one)
        blocks.add(one.tip[1:], one.axis[1:], parameters.feed, Mark.CUT)
    blocks.out(passes[-1])
    return blocks.path()


def copied(path: Toolpath, copies: Sequence[float], sphere: ClearanceSphere) -> Toolpath:
    """Return a path and its copies turned about z by angles (rad), one after the other, led round the sphere from each to the next one,
    from an upright tool over the sphere and back to it."""
    if not len(path):
        return path
    parts: list[Toolpath] = []
    top = sphere.centre + sphere.radius * UPRIGHT
    here, axis = top, UPRIGHT
    for angle in copies:
        one = _turned(path, angle)
        parts.append(_way(here, axis, one.position[0], one.axis[0], sphere))
        parts.append(one)
        here, axis = one.position[-1], one.axis[-1]
    parts.append(_way(here, axis, top, UPRIGHT, sphere))
    return _moving(Toolpath.join([p for p in parts if len(p)]))


def _moving(path: Toolpath) -> Toolpath:
    """Return a path of straight moves without those that go nowhere, the first pose of two that are one."""
    step = np.linalg.norm(np.diff(path.position, axis=0), axis=1)
    step += np.linalg.norm(np.diff(path.axis, axis=0), axis=1)
    kept = np.concatenate([[True], step > tolerance.SHORT_MOVE])
    return replace(
        path,
        position=path.position[kept],
        axis=path.axis[kept],
        motion=path.motion[kept],
        centre=path.centre[kept],
        feed=path.feed[kept],
        mark=path.mark[kept],
    )


def _way(
    start: Floats, start_axis: Floats, end: Floats, end_axis: Floats, sphere: ClearanceSphere
) -> Toolpath:
    """Return the rapids from a pose to another one round the sphere, neither of them among these."""
    tips, axes = [sphere.above(start, start_axis)], [start_axis]
    directions = _over(start_axis, end_axis)
    tips += [sphere.centre + sphere.radius * a for a in directions]
    axes += list(directions)
    tips.append(sphere.above(end, end_axis))
    axes.append(end_axis)
    return _rapids(np.array(tips), np.array(axes))


def _over(first: Floats, last: Floats) -> Floats:
    """Return directions (k, 3) from one to another, over the top where the shortest way would lean more than either end."""
    turned = turn(first, last)
    if turned[:, 2].min() < min(first[2], last[2]) - tolerance.PARAMETRIC:
        turned = np.vstack([turn(first, UPRIGHT), turn(UPRIGHT, last)[1:]])
    return turned


def _rapids(tips: Floats, axes: Floats) -> Toolpath:
    """Return rapids through poses, those left out that go nowhere."""
    moved = np.linalg.norm(np.diff(tips, axis=0), axis=1) + np.linalg.norm(
        np.diff(axes, axis=0), axis=1
    )
    kept = np.concatenate([[True], moved > tolerance.SHORT_MOVE])
    n = int(kept.sum())
    return Toolpath(
        position=tips[kept],
        axis=axes[kept],
        motion=np.full(n, Motion.RAPID),
        centre=np.full((n, 3), np.nan),
        feed=np.zeros(n),
        mark=np.full(n, Mark.RETRACT),
    )


def _turned(path: Toolpath, angle: float) -> Toolpath:
    if angle == 0.0:
        return path
    c, s = math.cos(angle), math.sin(angle)
    matrix = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return replace(path, position=path.position @ matrix, axis=path.axis @ matrix)


def straight_links(
    passes: Sequence[Pass], parameters: SphereLinkParameters, groups: Sequence[int]
) -> list[bool]:
    """Return for each pass but the last whether the next one is reached straight at feed."""
    if len(passes) < 2:
        return []
    ends, end_axes = (np.array([getattr(p, name)[-1] for p in passes[:-1]]) for name in POSE)
    starts, axes = (np.array([getattr(p, name)[0] for p in passes[1:]]) for name in POSE)
    near = np.linalg.norm(starts - ends, axis=1) <= parameters.near
    near &= angle_between(end_axes, axes) <= parameters.turn
    near &= np.diff(groups) == 0
    rows = np.flatnonzero(near)
    if len(rows):
        near[rows] = parameters.query(
            starts[rows], axes[rows], start_tip=ends[rows], start_axis=end_axes[rows]
        )
    return [bool(v) for v in near]


def _over_blank(
    passes: Sequence[Pass], parameters: SphereLinkParameters, straight: Sequence[bool]
) -> list[ClearanceLink | None]:
    """Return for each pass but the last the link through the air to the next one, None where there is none or none is needed."""
    found: list[ClearanceLink | None] = [None] * len(straight)
    rows = [k for k, near in enumerate(straight) if not near]
    if parameters.air is None or not rows:
        return found
    ends, starts = (
        (
            np.array([passes[k + after].tip[position] for k in rows]),
            np.array([passes[k + after].axis[position] for k in rows]),
        )
        for after, position in ((0, -1), (1, 0))
    )
    for k, link in zip(rows, parameters.air.between(ends, starts), strict=True):
        found[k] = link
    return found


class _Blocks:
    """A path in the making."""

    def __init__(self, parameters: SphereLinkParameters) -> None:
        self._parameters = parameters
        self._parts: list[tuple[Floats, Floats, float, Mark]] = []

    def add(self, tips: Floats, axes: Floats, feed: float, mark: Mark) -> None:
        """Add moves to tips with axes (k, 3) at a feed, 0 for rapids."""
        if len(tips):
            self._parts.append((tips, axes, feed, mark))

    def come(self, one: Pass) -> None:
        """Bring the tool to the start of a pass along its axis, from outside of the sphere."""
        outside = self._parameters.sphere.above(one.tip[0], one.axis[0])
        self.add(outside[None], one.axis[:1], 0.0, Mark.RETRACT)
        self.down(one, outside)

    def out(self, one: Pass) -> None:
        """Bring the tool off the end of a pass along its axis, to outside of the sphere."""
        self.off(one, self._parameters.sphere.above(one.tip[-1], one.axis[-1]))

    def down(self, one: Pass, start: Floats) -> None:
        """Bring the tool from a tip (3,) above the start of a pass along its axis: at rapid, at the feed of links, at last that of cuts."""
        p, tip, axis = self._parameters, one.tip[0], one.axis[0]
        above = float((start - tip) @ axis)
        for lift, feed, mark in (
            (p.retreat(tip, axis), 0.0, Mark.RETRACT),
            (p.close, p.link_feed, Mark.LEAD),
            (0.0, p.feed, Mark.LEAD),
        ):
            if lift < above or lift == 0.0:
                self.add((tip + lift * axis)[None], axis[None], feed, mark)

    def off(self, one: Pass, end: Floats) -> None:
        """Bring the tool off the end of a pass along its axis to a tip (3,): at the feed of links, then at rapid."""
        p, tip, axis = self._parameters, one.tip[-1], one.axis[-1]
        lift = min(p.retreat(tip, axis), float((end - tip) @ axis))
        self.add((tip + lift * axis)[None], axis[None], p.link_feed, Mark.LEAD)
        self.add(end[None], axis[None], 0.0, Mark.RETRACT)

    def round(self, axis: Floats, tip: Floats, next_axis: Floats) -> None:
        """Turn the tool round the sphere from an axis to another one."""
        sphere = self._parameters.sphere
        directions = _over(axis, next_axis)
        self.add(sphere.centre + sphere.radius * directions, directions, 0.0, Mark.RETRACT)

    def path(self) -> Toolpath:
        """Return the path; moves that go nowhere are left out."""
        count = [len(p[0]) for p in self._parts]
        position, axis = (np.concatenate([p[k] for p in self._parts]) for k in (0, 1))
        feed = np.repeat([p[2] for p in self._parts], count)
        mark = np.repeat([int(p[3]) for p in self._parts], count)
        moved = np.linalg.norm(np.diff(position, axis=0), axis=1) + np.linalg.norm(
            np.diff(axis, axis=0), axis=1
        )
        kept = np.concatenate([[True], moved > tolerance.SHORT_MOVE])
        n = int(kept.sum())
        return Toolpath(
            position=position[kept],
            axis=axis[kept],
            motion=np.where(feed[kept] > 0.0, Motion.LINE, Motion.RAPID),
            centre=np.full((n, 3), np.nan),
            feed=feed[kept],
            mark=mark[kept],
        )
